// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact_search.hpp"

#include <omp.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <queue>
#include <set>

namespace drogue::fem {
namespace {

constexpr double spent = 0.75;  // of the spare motion; the rest is for what happens until the next watch()

/// Points within `reach` [m] of one along the graph, and all its neighbours.
std::vector<int> vicinity(const ContactGraph& graph, int start, double reach) {
  using Stop = std::pair<double, int>;
  std::priority_queue<Stop, std::vector<Stop>, std::greater<>> open;
  std::set<int> reached;
  open.emplace(0.0, start);
  while (!open.empty()) {
    const auto [distance, point] = open.top();
    open.pop();
    if (!reached.insert(point).second) continue;
    for (const auto& [next, length] : graph[point]) {
      if (distance + length <= reach) open.emplace(distance + length, next);
    }
  }
  for (const auto& [next, length] : graph[start]) reached.insert(next);
  return {reached.begin(), reached.end()};
}

Box box_of(const ContactFace& face, std::span<const Vec3> place) {
  Box box{place[face.point[0]], place[face.point[0]]};
  for (int corner = 1; corner < face.corners(); ++corner) {
    box.lower = box.lower.cwiseMin(place[face.point[corner]]);
    box.upper = box.upper.cwiseMax(place[face.point[corner]]);
  }
  return box;
}

}  // namespace

ContactSearch::ContactSearch(std::vector<ContactFace> faces, const ContactGraph& graph, std::span<const Vec3> place,
                             double distance)
    : faces_(std::move(faces)), distance_(distance), reach_(2.0 * distance) {
  std::set<int> points;
  double extent = 0.0;
  for (const ContactFace& face : faces_) {
    points.insert(face.point.begin(), face.point.begin() + face.corners());
    extent += box_of(face, place).size().maxCoeff();
  }
  // Of a sheet whose faces are wider than the distance, nothing else is nearer than one face.
  look_ = reach_ + extent / static_cast<double>(faces_.size());
  cell_ = 2.0 * look_;
  points_.assign(points.begin(), points.end());
  leave_out_vicinities(graph, 1.5 * distance);
  // Until the first find() nothing is known.
  found_at_.assign(points_.size(), Vec3::Constant(INFINITY));
  moved_.assign(omp_get_max_threads(), Box{Vec3::Zero(), Vec3::Zero()});
  found_.resize(moved_.size());
}

void ContactSearch::leave_out_vicinities(const ContactGraph& graph, double reach) {
  std::vector<std::vector<int>> of_point(graph.size());
  for (const int point : points_) of_point[point] = vicinity(graph, point, reach);
  first_neighbour_.assign(1, 0);
  for (const ContactFace& face : faces_) {
    std::set<int> of_face;
    for (int corner = 0; corner < face.corners(); ++corner) {
      of_face.insert(of_point[face.point[corner]].begin(), of_point[face.point[corner]].end());
    }
    neighbour_.insert(neighbour_.end(), of_face.begin(), of_face.end());
    first_neighbour_.push_back(static_cast<int>(neighbour_.size()));
  }
}

void ContactSearch::note(const Box& moved) { moved_[omp_get_thread_num()] = moved; }

/// No two points can have moved further relative to each other [m].
double ContactSearch::moved() const {
  Box moved = moved_[0];
  for (const Box& by_thread : moved_) {
    moved.lower = moved.lower.cwiseMin(by_thread.lower);
    moved.upper = moved.upper.cwiseMax(by_thread.upper);
  }
  return moved.size().norm();
}

// Holds of what is no number, too.
bool ContactSearch::is_outdated() const { return !(moved() <= spent * spare_); }

double ContactSearch::approach() const { return moved() + (1.0 - spent) * spare_; }

Index3 ContactSearch::cell_of(const Vec3& place) const {
  const Vec3 cell = (place / cell_).array().floor();
  return {static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())};
}

std::size_t ContactSearch::bucket_of(const Index3& cell) const {
  // Teschner et al., Optimized spatial hashing for collision detection of deformable objects, VMV 2003.
  const auto hash = static_cast<unsigned>(cell[0]) * 73856093U ^ static_cast<unsigned>(cell[1]) * 19349663U ^
                    static_cast<unsigned>(cell[2]) * 83492791U;
  return hash & (first_resident_.size() - 2);
}

void ContactSearch::fill_cells(std::span<const Vec3> place) {
  first_resident_.assign(std::bit_ceil(2 * points_.size()) + 1, 0);
  for (const int point : points_) ++first_resident_[bucket_of(cell_of(place[point])) + 1];
  for (std::size_t b = 1; b < first_resident_.size(); ++b) first_resident_[b] += first_resident_[b - 1];
  std::vector<int> next(first_resident_.begin(), first_resident_.end() - 1);
  resident_.resize(points_.size());
  for (const int point : points_) {
    resident_[next[bucket_of(cell_of(place[point]))]++] = {point, place[point]};
  }
}

/// Adds every point within reach of the box of a face, along each axis.
void ContactSearch::find_near(int face, std::span<const Vec3> place, Found& found) const {
  const Box box = box_of(faces_[face], place);
  for (int k = first_neighbour_[face]; k < first_neighbour_[face + 1]; ++k) found.marked_by[neighbour_[k]] = face;
  const Index3 first = cell_of(box.lower.array() - look_), last = cell_of(box.upper.array() + look_);
  for (int z = first[2]; z <= last[2]; ++z) {
    for (int y = first[1]; y <= last[1]; ++y) {
      for (int x = first[0]; x <= last[0]; ++x) {
        const std::size_t bucket = bucket_of({x, y, z});  // may hold other cells as well
        for (int k = first_resident_[bucket]; k < first_resident_[bucket + 1]; ++k) {
          const Resident& resident = resident_[k];
          if (found.marked_by[resident.point] == face) continue;
          const double distance = (box.lower - resident.place).cwiseMax(resident.place - box.upper).maxCoeff();
          if (distance <= reach_) {
            found.near.push_back({resident.point, face, distance});
          } else {
            found.beyond = std::min(found.beyond, distance);
          }
        }
      }
    }
  }
}

void ContactSearch::find(std::span<const Vec3> place) {
#pragma omp single
  {
    fill_cells(place);
    for (Found& found : found_) {
      found.near.clear();
      found.beyond = look_;
    }
  }
  Found& found = found_[omp_get_thread_num()];
  found.marked_by.assign(place.size(), -1);
  const int faces = static_cast<int>(faces_.size());
#pragma omp for schedule(static)
  for (int face = 0; face < faces; ++face) find_near(face, place, found);
#pragma omp single
  collect(place);
}

/// What the threads have found.
void ContactSearch::collect(std::span<const Vec3> place) {
  std::vector<Near> all;
  double beyond = look_;
  for (const Found& found : found_) {
    all.insert(all.end(), found.near.begin(), found.near.end());
    beyond = std::min(beyond, found.beyond);
  }
  spare_ = beyond - distance_;
  std::ranges::sort(all);
  all.erase(std::ranges::unique(all).begin(), all.end());
  seekers_.clear();
  near_faces_.clear();
  for (const auto& [point, face, distance] : all) {
    const int next = static_cast<int>(near_faces_.size());
    if (seekers_.empty() || seekers_.back().point != point) seekers_.push_back({point, next, next, distance});
    seekers_.back().last = next + 1;
    seekers_.back().distance = std::min(seekers_.back().distance, distance);
    near_faces_.push_back(face);
  }
  for (std::size_t k = 0; k < points_.size(); ++k) found_at_[k] = place[points_[k]];
  std::ranges::fill(moved_, Box{Vec3::Zero(), Vec3::Zero()});
}

}  // namespace drogue::fem
