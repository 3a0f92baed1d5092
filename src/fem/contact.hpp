// SPDX-License-Identifier: GPL-3.0-or-later
// Penalty contact of the surfaces of a body, with each other and with themselves: a point of a surface (a node, or the
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
#include "fem/loads.hpp"
#include "fem/mesh.hpp"
#include "fem/point.hpp"
#include "fem/region.hpp"

namespace drogue::fem {

/// Functions whose "work is shared" divide it among the threads of the parallel region they are called in. Results do
/// not depend on the number of threads.
class Contact {
 public:
  /// `points` outlive it; `squared_frequency`: the largest of the elements [1/s^2]. Throws InputError for options out
  /// of range, and if there are no surfaces.
  Contact(const ContactOptions& options, const Mesh& mesh, const std::vector<Region>& regions,
          const std::vector<Point>& points, double squared_frequency);

  /// Notes how far surfaces have moved. Work is shared, without a barrier at the end.
  void watch(std::span<const Vec3> x) {
    search_.watch([&](int point) { return (*points_)[point].mean_of(x); });
  }
  /// After watch() by all threads.
  bool is_outdated() const { return search_.is_outdated(); }
  /// Finds what is near what, by one thread.
  void renew(std::span<const Vec3> x);
  /// Forces at positions `x` [m] and velocities `v` [m/s], for force_on(). Work is shared, up to a barrier.
  void compute_forces(std::span<const Vec3> x, std::span<const Vec3> v);

  /// Of the last compute_forces(): whether anything touches, and the force on a point [N].
  bool touches() const { return touches_; }
  const Vec3& force_on(std::size_t point) const { return force_[point]; }
  /// Of it, from above: largest eigenvalue of stiffness over mass [1/s^2] and of damping over mass [1/s].
  double largest_squared_frequency() const;
  double largest_damping_rate() const { return 2.0 * damping_ / frequency_ * largest_squared_frequency(); }

 private:
  /// Of a seeker with the face that is closest to it.
  struct Touch {
    int face = -1;  ///< none if negative
    std::array<double, 4> weight{};
    double stiffness = 0.0;     ///< [N/m]
    Vec3 force = Vec3::Zero();  ///< [N]
  };
  Touch touch(const ContactSearch::Seeker& seeker, std::span<const Vec3> x, std::span<const Vec3> v) const;
  void sum_forces();

  const std::vector<Point>* points_;
  double gap_;        ///< [m]
  double frequency_;  ///< of two points in contact [1/s]
  double damping_;    ///< of that motion, over the critical one
  ContactSearch search_;
  std::vector<Touch> touch_;  ///< of each seeker
  std::vector<Vec3> force_;   ///< on each point [N]
  std::vector<int> touched_;  ///< points whose force is not zero
  bool touches_ = false;
};

}  // namespace drogue::fem
