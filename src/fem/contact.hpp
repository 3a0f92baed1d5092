// SPDX-License-Identifier: GPL-3.0-or-later
// Penalty contact of the surfaces of bodies, with each other and with themselves: a point of a surface (a node, or the
// mean of a pair through the thickness) that is nearer than the gap g to the closest point c of another surface is
// pushed away from it,
//   f = k (g - d) n,   d = |x - c|,  n = (x - c) / d,
// and the corners of that face share -f by the weights w that make up c. Force and reaction lie on one line, so linear
// and angular momentum are kept. k / omega^2 = 1 / (1 / m + sum w / m_corner) gives every contact about the same
// frequency omega, a share of what the sub-step resolves. No friction. Surfaces are those of membranes and solids, on
// either side alike: one that has passed through another, faster than the penalty could stop it, is pushed out on the
// wrong side. Edges do not see edges, so the gap should not be less than about half an element.
#pragma once

#include <span>
#include <vector>

#include "core/types.hpp"
#include "fem/contact_search.hpp"
#include "fem/mesh.hpp"
#include "fem/point.hpp"
#include "fem/region.hpp"

namespace drogue::fem {

struct ContactOptions {
  double gap = 0.0;         ///< distance within which surfaces push each other apart [m]
  double stiffness = 0.03;  ///< squared frequency of two points in contact, over the largest of the elements
  double damping = 0.0;     ///< of that motion, over the critical one
};

/// A body that may touch: its surfaces, its points, and where its nodes are [m] and how fast [m/s].
struct ContactBody {
  const Mesh& mesh;
  const std::vector<Region>& regions;
  const std::vector<Point>& points;
  const std::vector<Vec3>&x, &v;
};

/// Points are numbered through, one body after the other. Functions whose "work is shared" divide it among the threads
/// of the parallel region they are called in. Results do not depend on the number of threads.
class Contact {
 public:
  /// What `bodies` refer to outlives it; `squared_frequency`: the largest of the elements [1/s^2]. Throws InputError
  /// for options out of range, and if there are no surfaces.
  Contact(const ContactOptions& options, const std::vector<ContactBody>& bodies, double squared_frequency);

  /// Notes how far surfaces have moved. Work is shared, without a barrier at the end.
  void watch() {
    search_.watch([this](int point) { return members_[point].place(); });
  }
  /// Forces at the places and velocities that the bodies have. After watch() by all threads, no longer ago than a few
  /// sub-steps. Work is shared, up to a barrier.
  void compute_forces();

  /// Of the last compute_forces(), on the points of a body [N]; empty if nothing touches.
  std::span<const Vec3> forces_on(std::size_t body) const;
  /// Of it, from above: largest eigenvalue of stiffness over mass [1/s^2] and of damping over mass [1/s].
  double largest_squared_frequency() const;
  double largest_damping_rate() const { return 2.0 * damping_ / frequency_ * largest_squared_frequency(); }

 private:
  /// A point of a body.
  struct Member {
    const Point* point;
    const std::vector<Vec3>*x, *v;
    Vec3 place() const { return point->mean_of(*x); }
    Vec3 velocity() const { return point->mean_of(*v); }
    double mass() const { return point->mean.mass; }
  };
  /// Of a seeker with the face that is closest to it.
  struct Touch {
    int face = -1;  ///< none if negative
    std::array<double, 4> weight{};
    double stiffness = 0.0;     ///< [N/m]
    Vec3 force = Vec3::Zero();  ///< [N]
  };
  static std::vector<Member> members_of(const std::vector<ContactBody>& bodies);
  void renew();
  Touch touch(const ContactSearch::Seeker& seeker) const;
  void sum_forces();

  std::vector<Member> members_;     ///< all points
  std::vector<std::size_t> first_;  ///< member of each body, and the end
  double gap_;                      ///< [m]
  double frequency_;                ///< of two points in contact [1/s]
  double damping_;                  ///< of that motion, over the critical one
  ContactSearch search_;
  std::vector<Vec3> place_;   ///< of each point when contact_search.hpp was asked last [m]
  std::vector<Touch> touch_;  ///< of each seeker
  std::vector<Vec3> force_;   ///< on each point [N]
  std::vector<int> touched_;  ///< points whose force is not zero
};

}  // namespace drogue::fem
