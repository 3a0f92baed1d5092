// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/wake.hpp"

#include <cmath>
#include <map>
#include <memory>
#include <optional>

namespace drogue::app {

namespace {

constexpr int first_step = 4;  // half cells behind the body: nearer the diffuse surface still moves the fluid

/// The velocity at any place, linear between cells; blocks are read when they are first asked for.
class FlowProbe {
 public:
  explicit FlowProbe(const fluid::FluidSolver& fluid) : fluid_(fluid) {}

  /// [m/s]; nothing outside the domain. Beside a change of level the cells around the place are the nearest of both.
  std::optional<Vec3> velocity(const Vec3& place) {
    const amr::Forest& forest = fluid_.forest();
    const auto home = forest.locate(place);
    if (!home) return std::nullopt;
    const double dx = forest.spacing(forest.block(home->block).level);
    const Vec3 s = (place - forest.lower(home->block)) / dx - Vec3::Constant(0.5);
    const Vec3 low = s.array().floor(), share = s - low;
    Vec3 sum = Vec3::Zero();
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 bit(corner & 1, corner >> 1 & 1, corner >> 2);
      const double weight = (bit.array() > 0.5).select(share.array(), 1.0 - share.array()).prod();
      const Vec3 cell_centre = forest.lower(home->block) + dx * (low + bit + Vec3::Constant(0.5));
      sum += weight * cell_velocity(forest.locate(cell_centre).value_or(*home));
    }
    return sum;
  }

 private:
  Vec3 cell_velocity(const amr::Location& at) {
    auto& fields = blocks_[at.block];
    if (!fields) {
      fields = std::make_unique<fluid::BlockFields>();
      fluid_.read_block(at.block, *fields);
    }
    const int cell = (at.cell[2] * amr::block_size + at.cell[1]) * amr::block_size + at.cell[0];
    return {fields->velocity[0][cell], fields->velocity[1][cell], fields->velocity[2][cell]};
  }

  const fluid::FluidSolver& fluid_;
  std::map<int, std::unique_ptr<fluid::BlockFields>> blocks_;
};

}  // namespace

double wake_length(const fluid::FluidSolver& fluid, const Vec3& rear, const Vec3& direction) {
  FlowProbe probe(fluid);
  const double step = 0.5 * fluid.forest().spacing(fluid.forest().finest());
  double before = 0.0;
  for (int i = first_step;; ++i) {
    const auto u = probe.velocity(rear + i * step * direction);
    const double along = u ? u->dot(direction) : 0.0;
    if (!u || (along >= 0.0 && i == first_step)) return 0.0;
    if (along >= 0.0) return (i - along / (along - before)) * step;
    before = along;
  }
}

}  // namespace drogue::app
