// SPDX-License-Identifier: GPL-3.0-or-later
#include "fluid/probe.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace drogue::fluid {

namespace {

constexpr int n = amr::block_size;
constexpr int taps = 4;

/// Lagrange's weights of the values at 0, 1, 2, 3 for one at `s`.
std::array<double, taps> cubic_weights(double s) {
  return {-(s - 1.0) * (s - 2.0) * (s - 3.0) / 6.0, s * (s - 2.0) * (s - 3.0) / 2.0, -s * (s - 1.0) * (s - 3.0) / 2.0,
          s * (s - 1.0) * (s - 2.0) / 6.0};
}

int floor_division(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

}  // namespace

std::optional<Probe::Sample> Probe::operator()(const Vec3& place) {
  const auto home = fluid_.forest().locate(place);
  if (!home) return std::nullopt;
  for (int level = fluid_.forest().block(home->block).level; level >= 0; --level) {
    if (const auto found = sample(place, level)) return found;
  }
  return std::nullopt;
}

/// Nothing if cells of the stencil are covered by a coarser level only.
std::optional<Probe::Sample> Probe::sample(const Vec3& place, int level) {
  const amr::Forest& forest = fluid_.forest();
  const Index3 across = forest.blocks_across(level);
  Index3 first;  // cell of the level
  std::array<std::array<double, taps>, 3> weight;
  for (int axis = 0; axis < 3; ++axis) {
    const double s = (place[axis] - forest.domain().box.lower[axis]) / forest.spacing(level) - 0.5;
    first[axis] = static_cast<int>(std::floor(s)) - 1;
    if (!forest.domain().periodic[axis]) first[axis] = std::clamp(first[axis], 0, across[axis] * n - taps);
    weight[axis] = cubic_weights(s - first[axis]);
  }
  Sample sum;
  for (int i = 0; i < taps * taps * taps; ++i) {
    const Index3 tap{i % taps, i / taps % taps, i / (taps * taps)};
    Index3 block, cell;
    double w = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const int global = first[axis] + tap[axis];
      block[axis] = floor_division(global, n);
      cell[axis] = global - n * block[axis];
      w *= weight[axis][tap[axis]];
    }
    const BlockFields* from = fields(level, block);
    if (!from) return std::nullopt;
    const int at = (cell[2] * n + cell[1]) * n + cell[0];
    for (int axis = 0; axis < 3; ++axis) sum.velocity[axis] += w * from->velocity[axis][at];
    sum.pressure += w * from->pressure[at];
  }
  return sum;
}

/// Null where the level has neither a leaf nor the parent of leaves.
const BlockFields* Probe::fields(int level, const Index3& block) {
  const amr::Forest& forest = fluid_.forest();
  const int id = forest.find(level, block);
  if (id == amr::none || forest.block(id).kind == amr::Kind::ghost || forest.block(id).kind == amr::Kind::boundary) {
    return nullptr;
  }
  auto& fields = read_[id];
  if (!fields) {
    fields = std::make_unique<BlockFields>();
    fluid_.read_block(id, *fields);
  }
  return fields.get();
}

}  // namespace drogue::fluid
