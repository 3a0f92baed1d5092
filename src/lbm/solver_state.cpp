// SPDX-License-Identifier: GPL-3.0-or-later
// The state of the solver as others see it: fields to write, integrals, checkpoints.
#include <cmath>
#include <memory>
#include <span>
#include <string>

#include "lbm/solver.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;

}  // namespace

template <class S>
void BasicSolver<S>::read_block(int block, fluid::BlockFields& fields) const {
  using Layout = RowLayout<S>;
  const amr::Block& b = forest_.block(block);
  if (b.kind == amr::Kind::parent) {
    constexpr int half = n / 2;
    const auto average = [](const auto& from, auto& to, int octant) {
      const Index3 base{octant & 1, octant >> 1 & 1, octant >> 2};
      for (int z = 0; z < half; ++z)
        for (int y = 0; y < half; ++y)
          for (int x = 0; x < half; ++x) {
            float sum = 0.0f;
            for (int i = 0; i < 8; ++i)
              sum += from[((2 * z + (i >> 2)) * n + 2 * y + (i >> 1 & 1)) * n + 2 * x + (i & 1)];
            to[((z + half * base[2]) * n + y + half * base[1]) * n + x + half * base[0]] = sum / 8.0f;
          }
    };
    const auto child = std::make_unique<fluid::BlockFields>();
    for (int octant = 0; octant < 8; ++octant) {
      read_block(b.child[octant], *child);
      for (int a = 0; a < 3; ++a) average(child->velocity[a], fields.velocity[a], octant);
      average(child->pressure, fields.pressure, octant);
    }
    return;
  }
  const Real velocity = static_cast<Real>(units_.velocity), pressure = static_cast<Real>(units_.pressure);
  std::array<Real, 3> lead;
  for (int a = 0; a < 3; ++a) lead[a] = static_cast<Real>(levels_[b.level].lead[a]);
  for (int r = 0; r < rows_per_block; ++r) {
    const std::byte* row = field_[levels_[b.level].now].block(block) + r * Layout::bytes;
    for (int x = 0; x < n; ++x) {
      fields.pressure[r * n + x] = static_cast<float>(pressure * Layout::macro(row, drho)[x]);
      for (int a = 0; a < 3; ++a)
        fields.velocity[a][r * n + x] = static_cast<float>(velocity * (Layout::macro(row, ux + a)[x] - lead[a]));
    }
  }
}

template <class S>
std::array<double, 4> BasicSolver<S>::mass_and_momentum() const {
  using Layout = RowLayout<S>;
  std::array<double, 4> total{};
  for (int level = 0; level < forest_.levels(); ++level) {
    const auto leaves = forest_.range(level, amr::Kind::leaf);
    std::vector<std::array<double, 4>> part(leaves.size());
#pragma omp parallel for schedule(static)
    for (int id = leaves.begin; id < leaves.end; ++id) {
      std::array<double, 4> sum{};
      for (int r = 0; r < rows_per_block; ++r) {
        const std::byte* row = field_[levels_[level].now].block(id) + r * Layout::bytes;
        for (int x = 0; x < n; ++x) {
          const double rho = 1.0 + double{Layout::macro(row, drho)[x]};
          sum[0] += rho;
          for (int a = 0; a < 3; ++a) sum[1 + a] += rho * (Layout::macro(row, ux + a)[x] - levels_[level].lead[a]);
        }
      }
      part[id - leaves.begin] = sum;
    }
    const double cell_mass = specification_.density * std::pow(forest_.spacing(level), 3);
    if (level < forest_.finest()) total[0] += cell_mass * reflux_[level].owed();
    for (const auto& p : part) {
      total[0] += cell_mass * p[0];
      for (int a = 0; a < 3; ++a) total[1 + a] += cell_mass * units_.velocity * p[1 + a];
    }
  }
  return total;
}

/// The present of leaves and parents; everything else is filled from it in the course of a step.
template <class S>
void BasicSolver<S>::transfer_state(Archive& archive) {
  for (int level = 0; level < forest_.levels(); ++level) {
    Level& l = levels_[level];
    MomentField<S>& field = field_[l.now];
    const auto leaves = forest_.range(level, amr::Kind::leaf), parents = forest_.range(level, amr::Kind::parent);
    const std::size_t bytes = (parents.end - leaves.begin) * RowLayout<S>::block_bytes;
    const std::string name = "level" + std::to_string(level);
    archive.transfer(name + "/time", l.time);
    archive.transfer(name + "/moments", std::span(field.block(leaves.begin), bytes));
    for (int id = leaves.begin; id < leaves.end; ++id) field.refresh_columns(id);
    if (forced_) set_kick(level, l.time);
    if (level < forest_.finest()) archive.transfer(name + "/interface", reflux_[level]);
  }
  join_levels();
  archive.transfer("boundaries", fill_boundary_);
  archive.transfer("cell_updates", statistics_.cell_updates);
  archive.transfer("max_mach", statistics_.max_mach);
  archive.transfer("max_speed", statistics_.max_speed);
}

#ifdef __F16C__
template void BasicSolver<HalfStress>::read_block(int, fluid::BlockFields&) const;
template std::array<double, 4> BasicSolver<HalfStress>::mass_and_momentum() const;
template void BasicSolver<HalfStress>::transfer_state(Archive&);
#endif
template void BasicSolver<FloatStress>::read_block(int, fluid::BlockFields&) const;
template std::array<double, 4> BasicSolver<FloatStress>::mass_and_momentum() const;
template void BasicSolver<FloatStress>::transfer_state(Archive&);
template void BasicSolver<DoubleStress>::read_block(int, fluid::BlockFields&) const;
template std::array<double, 4> BasicSolver<DoubleStress>::mass_and_momentum() const;
template void BasicSolver<DoubleStress>::transfer_state(Archive&);

}  // namespace drogue::lbm
