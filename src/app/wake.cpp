// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/wake.hpp"

#include "fluid/probe.hpp"

namespace drogue::app {

namespace {

constexpr int first_step = 4;  // half cells behind the body: nearer the diffuse surface still moves the fluid

}  // namespace

double wake_length(const fluid::FluidSolver& fluid, const Vec3& rear, const Vec3& direction) {
  fluid::Probe probe(fluid);
  const double step = 0.5 * fluid.forest().spacing(fluid.forest().finest());
  double before = 0.0;
  for (int i = first_step;; ++i) {
    const auto flow = probe(rear + i * step * direction);
    const double along = flow ? flow->velocity.dot(direction) : 0.0;
    if (!flow || (along >= 0.0 && i == first_step)) return 0.0;
    if (along >= 0.0) return (i - along / (along - before)) * step;
    before = along;
  }
}

}  // namespace drogue::app
