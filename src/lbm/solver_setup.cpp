// SPDX-License-Identifier: GPL-3.0-or-later
// What the solver does once: the initial state and the sponge layers.
#include <algorithm>
#include <cmath>
#include <utility>

#include "lbm/solver.hpp"

namespace drogue::lbm {
namespace {

/// Initial moments of one cell: Pneq = -2/3 rho tau S from central differences of the given velocity; the stored
/// velocity is ahead by `lead` (lbm/body_force.cpp).
std::array<double, moments> initial_moments(const fluid::Specification& s, const Vec3& x, double dx, double tau,
                                            const Units& units, const Vec3& lead) {
  std::array<double, moments> m{};
  if (s.initial_pressure) m[drho] = (*s.initial_pressure)(x, 0.0) / units.pressure;
  Mat3 gradient = Mat3::Zero();  // [component][along], lattice units
  for (int a = 0; a < 3; ++a) {
    const Expression& u = s.initial_velocity[a];
    m[ux + a] = u(x, 0.0) / units.velocity + lead[a];
    for (int b = 0; b < 3 && !u.is_constant(); ++b)
      gradient(a, b) = (u(x + dx * Vec3::Unit(b), 0.0) - u(x - dx * Vec3::Unit(b), 0.0)) / (2.0 * units.velocity);
  }
  const Mat3 stress = -(1.0 + m[drho]) * tau / 3.0 * (gradient + gradient.transpose());
  for (int a = 0; a < 3; ++a) m[pxx + a] = stress(a, a);
  m[pxy] = stress(0, 1);
  m[pxz] = stress(0, 2);
  m[pyz] = stress(1, 2);
  return m;
}

}  // namespace

template <class S>
void BasicSolver<S>::initialise() {
  for (int level = 0; level < forest_.levels(); ++level) {
    // the kinds one after the other, with the schedule of the steps, so that each thread first touches what it will
    // update
    for (const auto kind : {amr::Kind::leaf, amr::Kind::parent, amr::Kind::ghost, amr::Kind::boundary}) {
      const auto range = forest_.range(level, kind);
#pragma omp parallel
      {
        const fluid::Specification mine = specification_;  // formulas are evaluated on copies
#pragma omp for schedule(static)
        for (int id = range.begin; id < range.end; ++id) initialise_block(id, mine);
      }
    }
  }
  join_levels();
  for (int level = 0; level < forest_.levels(); ++level) fill_boundary_.start(level, field_[levels_[level].now]);
}

template <class S>
void BasicSolver<S>::initialise_block(int block, const fluid::Specification& specification) {
  using Layout = RowLayout<S>;
  const int level = forest_.block(block).level;
  const bool uniform = std::all_of(specification.initial_velocity.begin(), specification.initial_velocity.end(),
                                   [](const Expression& e) { return e.is_constant(); }) &&
                       (!specification.initial_pressure || specification.initial_pressure->is_constant());
  std::array<double, moments> m;
  for (int cell = 0; cell < amr::block_cells; ++cell) {
    const Index3 at = amr::cell_at(cell);
    if (cell == 0 || !uniform)
      m = initial_moments(specification, forest_.cell_centre(block, at), forest_.spacing(level),
                          levels_[level].relaxation.tau, units_, levels_[level].lead);
    for (auto& field : field_)
      for (int i = 0; i < moments; ++i) Layout::put(field.row(block, at[1], at[2]), i, at[0], static_cast<Real>(m[i]));
  }
  if (forest_.block(block).kind == amr::Kind::leaf)
    for (auto& field : field_) field.refresh_columns(block);
}

/// Damping that grows with the square of the depth and takes e^-3 of a sound wave on its way through the layer; where
/// layers overlap the stronger one acts.
template <class S>
void BasicSolver<S>::build_sponge(int level) {
  Level& l = levels_[level];
  const auto leaves = forest_.range(level, amr::Kind::leaf);
  const Box& domain = forest_.domain().box;
  const double wave_speed = sound_speed * units_.velocity;
  for (int id = leaves.begin; id < leaves.end; ++id) {
    SpongeBlock sponge{id, {}};
    for (int i = 0; i < amr::block_cells; ++i) {
      SpongeCell s{amr::cell_at(i), 0, {}};
      const Vec3 x = forest_.cell_centre(id, s.cell);
      for (int f = 0; f < 6; ++f) {
        const fluid::Face& face = specification_.face[f];
        const int axis = f / 2;
        const double depth = face.sponge - (f & 1 ? domain.upper[axis] - x[axis] : x[axis] - domain.lower[axis]);
        if (face.sponge <= 0.0 || depth <= 0.0) continue;
        const double rate = 9.0 * wave_speed / face.sponge * std::pow(depth / face.sponge, 2);
        const auto damping = static_cast<Real>(1.0 - std::exp(-rate * l.dt));
        if (damping <= s.damping) continue;
        s.damping = damping;
        s.rest[drho] = static_cast<Real>(face.pressure / units_.pressure);
      }
      if (s.damping == 0) continue;
      for (int a = 0; a < 3; ++a)
        s.rest[ux + a] = static_cast<Real>(specification_.initial_velocity[a](x, 0.0) / units_.velocity + l.lead[a]);
      sponge.cells.push_back(s);
    }
    if (!sponge.cells.empty()) l.sponge.push_back(std::move(sponge));
  }
}

#ifdef __F16C__
template void BasicSolver<HalfStress>::initialise();
template void BasicSolver<HalfStress>::build_sponge(int);
#endif
template void BasicSolver<FloatStress>::initialise();
template void BasicSolver<FloatStress>::build_sponge(int);
template void BasicSolver<DoubleStress>::initialise();
template void BasicSolver<DoubleStress>::build_sponge(int);

}  // namespace drogue::lbm
