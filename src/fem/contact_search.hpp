// SPDX-License-Identifier: GPL-3.0-or-later
// Which points of a surface are near which of its faces: cell lists (Hockney & Eastwood 1988) behind a list with a
// margin (Verlet, Phys. Rev. 159 (1967) 98), which stays valid until two points have moved by the margin relative to
// each other. Places that are near along the surface itself are left out.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/types.hpp"

namespace drogue::fem {

/// A triangle, or a quadrilateral cut from corner 0 to 2.
struct ContactFace {
  std::array<int, 4> point;  ///< in order around; the last is -1 of a triangle

  int corners() const { return point[3] < 0 ? 3 : 4; }
};

/// Points that are joined by an element and their distance [m] in the reference state, both ways.
using ContactGraph = std::vector<std::vector<std::pair<int, double>>>;

class ContactSearch {
 public:
  /// `place`: of all points in the reference state [m]; faces name some of them. Points within 1.5
  /// distances of a corner along the `graph`, and all that share an element with one, are never near a face.
  ContactSearch(std::vector<ContactFace> faces, const ContactGraph& graph, std::span<const Vec3> place,
                double distance);

  const std::vector<ContactFace>& faces() const { return faces_; }
  const std::vector<int>& points() const { return points_; }  ///< of the faces, ascending

  /// Notes how far the points have moved since the last find(); the work is shared among the threads of the parallel
  /// region it is called in, without a barrier at the end. `place(point)` tells where one is [m].
  template <class Place>
  void watch(const Place& place) {
    Box moved{Vec3::Constant(INFINITY), Vec3::Constant(-INFINITY)};
    const int count = static_cast<int>(points_.size());
#pragma omp for schedule(static) nowait
    for (int k = 0; k < count; ++k) {
      const Vec3 way = place(points_[k]) - found_at_[k];
      moved.lower = moved.lower.cwiseMin(way);
      moved.upper = moved.upper.cwiseMax(way);
    }
    note(moved);
  }
  /// After watch() by all threads: whether a point may have come near a face unnoticed, or may before the next watch(),
  /// if that follows within a small part of the time since the last find().
  bool is_outdated() const;

  /// A point with faces that may be nearer than the distance.
  struct Seeker {
    int point;
    int first, last;  ///< in near_faces()
  };
  /// Seeks anew; `place`: of all points now [m].
  void find(std::span<const Vec3> place);
  const std::vector<Seeker>& seekers() const { return seekers_; }
  const std::vector<int>& near_faces() const { return near_faces_; }

 private:
  struct Resident {
    int point;
    Index3 cell;
  };
  void note(const Box& moved);
  void leave_out_vicinities(const ContactGraph& graph, double reach);
  void fill_cells(std::span<const Vec3> place);
  Index3 cell_of(const Vec3& place) const;
  std::size_t bucket_of(const Index3& cell) const;
  void find_near(int face, std::span<const Vec3> place, std::vector<int>& marked_by,
                 std::vector<std::array<int, 2>>& found) const;

  std::vector<ContactFace> faces_;
  std::vector<int> points_;
  std::vector<int> first_neighbour_, neighbour_;  ///< of each face: points that are never near it
  double margin_, reach_;                         ///< [m]
  double cell_;                                   ///< edge of a cell of the lists [m]
  std::vector<Vec3> found_at_;                    ///< where each of points_ was at the last find() [m]
  std::vector<Box> moved_;                        ///< since then, thread by thread
  std::vector<int> first_resident_;               ///< of each bucket
  std::vector<Resident> resident_;
  std::vector<Seeker> seekers_;
  std::vector<int> near_faces_;
};

}  // namespace drogue::fem
