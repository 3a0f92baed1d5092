// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.hpp"
#include "fem/thin_solid.hpp"

namespace drogue::fem {
namespace {

const ContactOptions& checked(const ContactOptions& options) {
  const auto& [gap, stiffness, damping] = options;
  if (!(gap > 0.0 && std::isfinite(gap))) {
    throw InputError(fmt::format("the gap of the contact is {} m; expected a positive number", gap));
  }
  if (!(stiffness > 0.0 && stiffness <= 1.0)) {
    throw InputError(fmt::format("the stiffness of the contact is {}; expected more than 0, at most 1", stiffness));
  }
  if (!(damping >= 0.0 && damping <= 1.0)) {
    throw InputError(fmt::format("the damping of the contact is {}; expected 0 to 1", damping));
  }
  return options;
}

/// Appends the surfaces of membranes and solids; point_of[node] tells the point of a node. The two faces of a thin
/// solid are one; those around its rim are none.
void add_surface(std::vector<ContactFace>& faces, const ContactBody& body, const std::vector<int>& point_of) {
  std::set<std::set<int>> seen;
  const auto add = [&](const auto& nodes) {
    ContactFace face{{-1, -1, -1, -1}};
    for (std::size_t a = 0; a < nodes.size(); ++a) face.point[a] = point_of[nodes[a]];
    std::set<int> points(face.point.begin(), face.point.begin() + face.corners());
    if (static_cast<int>(points.size()) == face.corners() && seen.insert(std::move(points)).second)
      faces.push_back(face);
  };
  std::ranges::for_each(outer_faces(body.mesh), add);
  for (const Region& region : body.regions) {
    if (!std::holds_alternative<Membrane>(region.kind)) continue;
    const ElementSet set = elements_of(body.mesh, region);
    for (const int e : set.quadrilaterals) add(body.mesh.quadrilaterals[e]);
    for (const int e : set.triangles) add(body.mesh.triangles[e]);
  }
}

/// Joins the points of each element.
void join_points(ContactGraph& graph, const Mesh& mesh, const std::vector<int>& point_of,
                 const std::vector<Vec3>& place) {
  const auto join = [&](const auto& cells) {
    for (const auto& nodes : cells) {
      for (const int a : nodes) {
        for (const int b : nodes) {
          const int p = point_of[a], q = point_of[b];
          if (p != q) graph[p].emplace_back(q, (place[p] - place[q]).norm());
        }
      }
    }
  };
  join(mesh.hexahedra);
  join(mesh.quadrilaterals);
  join(mesh.triangles);
}

ContactSearch make_search(const std::vector<ContactBody>& bodies, double gap) {
  std::vector<ContactFace> faces;
  ContactGraph graph;
  std::vector<Vec3> place;
  for (const ContactBody& body : bodies) {
    std::vector<int> point_of(body.mesh.nodes.size());
    for (const Point& p : body.points) {
      point_of[p.a] = static_cast<int>(place.size());
      if (p.is_pair()) point_of[p.b] = point_of[p.a];
      place.push_back(p.mean_of(body.mesh.nodes));
    }
    graph.resize(place.size());
    add_surface(faces, body, point_of);
    join_points(graph, body.mesh, point_of, place);
  }
  if (faces.empty()) throw InputError("contact needs surfaces of membranes or solids, but there are none");
  return {std::move(faces), graph, place, gap};
}

/// Weights of the corners a, b, c that make up the point of their triangle closest to p (Ericson, Real-Time Collision
/// Detection, 2005, section 5.1.5).
Vec3 closest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0.0 && d2 <= 0.0) return {1.0, 0.0, 0.0};
  if (d3 >= 0.0 && d4 <= d3) return {0.0, 1.0, 0.0};
  if (d6 >= 0.0 && d5 <= d6) return {0.0, 0.0, 1.0};
  const double of_c = d1 * d4 - d3 * d2, of_b = d5 * d2 - d1 * d6, of_a = d3 * d6 - d5 * d4;
  if (of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {1.0 - d1 / (d1 - d3), d1 / (d1 - d3), 0.0};
  if (of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {1.0 - d2 / (d2 - d6), 0.0, d2 / (d2 - d6)};
  const double along = d4 - d3, back = d5 - d6;
  if (of_a <= 0.0 && along >= 0.0 && back >= 0.0) {
    const double share = along / (along + back);
    return {0.0, 1.0 - share, share};
  }
  return Vec3(of_a, of_b, of_c) / (of_a + of_b + of_c);
}

}  // namespace

std::vector<Contact::Member> Contact::members_of(const std::vector<ContactBody>& bodies) {
  std::vector<Member> members;
  for (const ContactBody& body : bodies) {
    for (const Point& point : body.points) members.push_back({&point, &body.x, &body.v});
  }
  return members;
}

Contact::Contact(const ContactOptions& options, const std::vector<ContactBody>& bodies, double squared_frequency)
    : members_(members_of(bodies)),
      first_{0},
      gap_(checked(options).gap),
      frequency_(std::sqrt(options.stiffness * squared_frequency)),
      damping_(options.damping),
      search_(make_search(bodies, gap_)),
      place_(members_.size()),
      force_(members_.size(), Vec3::Zero()) {
  for (const ContactBody& body : bodies) first_.push_back(first_.back() + body.points.size());
}

std::span<const Vec3> Contact::forces_on(std::size_t body) const {
  if (touched_.empty()) return {};
  return std::span(force_).subspan(first_[body], first_[body + 1] - first_[body]);
}

/// Finds what is near what. Work is shared, up to a barrier.
void Contact::renew() {
#pragma omp for schedule(static)
  for (std::size_t i = 0; i < members_.size(); ++i) place_[i] = members_[i].place();
  search_.find(place_);
#pragma omp single
  touch_.assign(search_.seekers().size(), Touch{});
}

Contact::Touch Contact::touch(const ContactSearch::Seeker& seeker) const {
  const Member& point = members_[seeker.point];
  const Vec3 place = point.place();
  Touch touch;
  Vec3 way = Vec3::Zero(), across = Vec3::Zero();
  double nearest = gap_ * gap_;
  for (int k = seeker.first; k < seeker.last; ++k) {
    const ContactFace& face = search_.faces()[search_.near_faces()[k]];
    std::array<Vec3, 4> corner;
    for (int a = 0; a < face.corners(); ++a) corner[a] = members_[face.point[a]].place();
    for (int half = 0; half < face.corners() - 2; ++half) {
      const Vec3 &a = corner[0], &b = corner[half + 1], &c = corner[half + 2];
      const Vec3 weight = closest_in_triangle(place, a, b, c);
      const Vec3 from = place - (weight[0] * a + weight[1] * b + weight[2] * c);
      if (!(from.squaredNorm() < nearest)) continue;
      nearest = from.squaredNorm();
      way = from;
      across = (b - a).cross(c - a);
      touch.face = search_.near_faces()[k];
      touch.weight = {};
      touch.weight[0] = weight[0];
      touch.weight[half + 1] = weight[1];
      touch.weight[half + 2] = weight[2];
    }
  }
  if (touch.face < 0) return touch;
  // A point in the surface itself goes either way.
  const Vec3 normal = nearest > 0.0 ? Vec3(way / std::sqrt(nearest)) : across.normalized();
  Vec3 closing = point.velocity();
  double inverse_mass = 1.0 / point.mass();
  const ContactFace& face = search_.faces()[touch.face];
  for (int a = 0; a < face.corners(); ++a) {
    const Member& corner = members_[face.point[a]];
    closing -= touch.weight[a] * corner.velocity();
    inverse_mass += touch.weight[a] / corner.mass();
  }
  touch.stiffness = frequency_ * frequency_ / inverse_mass;
  const double push =
      touch.stiffness * (gap_ - std::sqrt(nearest)) - 2.0 * damping_ * frequency_ / inverse_mass * closing.dot(normal);
  touch.force = std::max(push, 0.0) * normal;
  return touch;
}

void Contact::compute_forces() {
  if (search_.is_outdated()) {
#pragma omp barrier  // before one thread changes what the others are asking for
    renew();
  }
  const auto& seekers = search_.seekers();
  if (seekers.empty() && touched_.empty()) return;
  const double near = gap_ + search_.approach();
#pragma omp for schedule(dynamic, 16)
  for (std::size_t s = 0; s < seekers.size(); ++s) {
    touch_[s] = seekers[s].distance < near ? touch(seekers[s]) : Touch{};
  }
#pragma omp single
  sum_forces();
}

void Contact::sum_forces() {
  for (const int point : touched_) force_[point].setZero();
  touched_.clear();
  const auto add = [this](int point, const Vec3& force) {
    force_[point] += force;
    touched_.push_back(point);
  };
  for (std::size_t s = 0; s < touch_.size(); ++s) {
    const Touch& touch = touch_[s];
    if (touch.face < 0) continue;
    add(search_.seekers()[s].point, touch.force);
    const ContactFace& face = search_.faces()[touch.face];
    for (int a = 0; a < face.corners(); ++a) add(face.point[a], -touch.weight[a] * touch.force);
  }
}

// With the weights g = (1, -w) of a contact the matrix is sum k g g^T, whose rows, over the masses, sum up to 2 k |g| /
// m.
double Contact::largest_squared_frequency() const {
  if (touched_.empty()) return 0.0;
  std::vector<double> stiffness(members_.size(), 0.0);
  for (std::size_t s = 0; s < touch_.size(); ++s) {
    const Touch& touch = touch_[s];
    if (touch.face < 0) continue;
    stiffness[search_.seekers()[s].point] += touch.stiffness;
    const ContactFace& face = search_.faces()[touch.face];
    for (int a = 0; a < face.corners(); ++a) stiffness[face.point[a]] += touch.weight[a] * touch.stiffness;
  }
  double largest = 0.0;
  for (const int point : touched_) largest = std::max(largest, 2.0 * stiffness[point] / members_[point].mass());
  return largest;
}

}  // namespace drogue::fem
