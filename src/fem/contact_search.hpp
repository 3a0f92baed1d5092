// SPDX-License-Identifier: GPL-3.0-or-later
// Which points of a surface are near which of its faces: cell lists (Hockney & Eastwood 1988) behind a list with a
// margin (Verlet, Phys. Rev. 159 (1967) 98), which stays valid until two points have moved by the margin relative to
// each other; by more, if nothing that is not in the list was just beyond it. Places that are near along the surface
// itself are left out. Functions whose "work is shared" divide it among the threads of the parallel region they are
// called in; what they find does not depend on the number of threads.
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

  /// Notes how far the points have moved since the last find(). Work is shared, without a barrier at the end.
  /// `place(point)` tells where one is [m].
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
  /// By how much a point and a face may have come nearer to each other since the last find(), on the same condition
  /// [m].
  double approach() const;

  /// A point with faces that may be nearer than the distance.
  struct Seeker {
    int point;
    int first, last;  ///< in near_faces()
    double distance;  ///< to the nearest of them at the last find(), from below [m]
  };
  /// Seeks anew; `place`: of all points now [m]. Work is shared, up to a barrier.
  void find(std::span<const Vec3> place);
  const std::vector<Seeker>& seekers() const { return seekers_; }
  const std::vector<int>& near_faces() const { return near_faces_; }

 private:
  struct Resident {
    int point;
    Vec3 place;
  };
  struct Near {
    int point, face;
    double distance;  ///< from below [m]
    auto operator<=>(const Near&) const = default;
  };
  /// By one thread.
  struct Found {
    std::vector<Near> near;
    double beyond = 0.0;         ///< from there on there may be others [m]
    std::vector<int> marked_by;  ///< of each point, the last face that left it out
  };
  double moved() const;
  void note(const Box& moved);
  void leave_out_vicinities(const ContactGraph& graph, double reach);
  void fill_cells(std::span<const Vec3> place);
  Index3 cell_of(const Vec3& place) const;
  std::size_t bucket_of(const Index3& cell) const;
  void find_near(int face, std::span<const Vec3> place, Found& found) const;
  void collect(std::span<const Vec3> place);

  std::vector<ContactFace> faces_;
  std::vector<int> points_;
  std::vector<int> first_neighbour_, neighbour_;  ///< of each face: points that are never near it
  double distance_, reach_;                       ///< that is asked for, and with the margin [m]
  double look_;                                   ///< how far to look for what is beyond the reach [m]
  double cell_;                                   ///< edge of a cell of the lists [m]
  double spare_ = 0.0;                            ///< relative motion up to which the list is valid [m]
  std::vector<Vec3> found_at_;                    ///< where each of points_ was at the last find() [m]
  std::vector<Box> moved_;                        ///< since then, thread by thread
  std::vector<int> first_resident_;               ///< of each bucket
  std::vector<Resident> resident_;
  std::vector<Found> found_;  ///< thread by thread
  std::vector<Seeker> seekers_;
  std::vector<int> near_faces_;
};

}  // namespace drogue::fem
