// SPDX-License-Identifier: GPL-3.0-or-later
#include "lbm/solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "lbm/level_transfer.hpp"

namespace drogue::lbm {
namespace {

constexpr int n = amr::block_size;
/// A level of so many leaves, 7 MB in both fields, finds in a cache what its last step has stored (docs/benchmarks.md).
constexpr int blocks_in_cache = 32;
constexpr double sound_speed_squared = 1.0 / 3.0;  // cells^2 per step^2

Units units_of(const fluid::Specification& s) {
  const double velocity = s.reference_velocity / s.lattice_velocity;
  return {velocity, s.density * velocity * velocity * sound_speed_squared};
}

double relaxation_time(double lattice_viscosity) { return 0.5 + lattice_viscosity / sound_speed_squared; }

/// beta of Pneq = P + beta lap P, in cells squared. A fluid in which it would be large needs no correction.
double stress_defect(double tau) { return 1.0 / 6.0 + 0.5 * (std::min(tau, 1.0) - 1.0); }

bool is_forced(const fluid::Specification& s) {
  return std::ranges::any_of(s.force,
                             [](const Expression& f) { return !f.is_constant() || f(Vec3::Zero(), 0.0) != 0.0; });
}

double eddy_factor(const fluid::Specification& s) {
  const bool linear = s.eddy_viscosity == fluid::EddyViscosity::vreman;
  return linear ? s.eddy_constant : s.eddy_constant * s.eddy_constant;
}

template <class S>
std::array<MomentField<S>, 2> fields_for(const amr::Forest& forest) {
  const std::vector<bool> deep = deep_blocks(forest);
  return {MomentField<S>(forest.size(), deep), MomentField<S>(forest.size(), deep)};
}

}  // namespace

template <class S>
BasicSolver<S>::BasicSolver(amr::Forest forest, fluid::Specification specification)
    : forest_(std::move(forest)),
      specification_(std::move(specification)),
      units_(units_of(specification_)),
      field_(fields_for<S>(forest_)),
      in_columns_(columns_beside(forest_)),
      fill_boundary_(forest_, specification_, units_),
      forced_(is_forced(specification_)),
      force_(forest_),
      fine_velocity_(forest_),
      update_(block_update<S>(specification_.collision, specification_.eddy_viscosity)) {
  levels_.resize(forest_.levels());
  for (int level = 0; level < forest_.levels(); ++level) {
    Level& l = levels_[level];
    const double dx = forest_.spacing(level);
    l.dt = dx / units_.velocity;
    l.relaxation = {relaxation_time(specification_.viscosity * l.dt / (dx * dx)), specification_.hrr_sigma,
                    eddy_factor(specification_), Vec3::Zero()};
  }
  for (int level = 0; level < forest_.levels(); ++level) {
    Level& l = levels_[level];
    if (level > 0) l.to_parents = plan_restriction(forest_, level);
    if (level < forest_.finest()) {
      interpolation_.emplace_back(forest_, level + 1, stress_curvature(level, level + 1));
      reflux_.emplace_back(forest_, specification_, level);
    }
    if (forced_) set_kick(level, 0.0);
    build_sponge(level);
  }
  initialise();
}

template <class S>
void BasicSolver<S>::step(fluid::FineStepHook* hook) {
  statistics_.max_mach = statistics_.max_speed = 0.0;
  advance(0, hook);
}

template <class S>
void BasicSolver<S>::advance(int level, fluid::FineStepHook* hook) {
  Level& l = levels_[level];
  if (level < forest_.finest()) reflux_[level].settle(field_[l.now]);
  fill_boundary_(level, l.time, field_[l.now]);
  if (forced_) set_kick(level, l.time + l.dt);
  stream_and_collide(level);
  fill_boundary_.balance(level, 1.0 - 1.0 / l.relaxation.tau, field_[l.now], field_[1 - l.now]);
  apply_sponge(level);
  if (level < forest_.finest())
    advance_twice(level + 1, hook);
  else if (hook)
    couple(*hook);
  l.now = 1 - l.now;
  l.time += l.dt;
  if (level > 0) restrict_changed(level, field_[1 - levels_[level - 1].now]);
}

/// A level, within a step of the coarser one.
template <class S>
void BasicSolver<S>::advance_twice(int level, fluid::FineStepHook* hook) {
  const Level &fine = levels_[level], &coarse = levels_[level - 1];
  Interpolation<S>& interpolation = interpolation_[level - 1];
  MomentField<S>& coarse_end = field_[1 - coarse.now];
  interpolation.fill_rims(conversion(level - 1, level, fine.time), field_[fine.now]);
  advance(level, hook);
  interpolation.take_half_way(coarse_end);
  interpolation.fill_rims(conversion(level - 1, level, fine.time), field_[fine.now]);
  advance(level, hook);
  interpolation.take_end(coarse_end);
}

template <class S>
void BasicSolver<S>::stream_and_collide(int level) {
  const Level& l = levels_[level];
  const auto leaves = forest_.range(level, amr::Kind::leaf);
  float max_speed_squared = 0.0f;
  bool diverged = false;
  const Conversion to_parents = level > 0 ? conversion(level, level - 1, l.time + l.dt) : Conversion{};
#pragma omp parallel reduction(max : max_speed_squared) reduction(|| : diverged)
  {
    const auto restriction =
        level > 0 ? std::make_unique<Restriction<S>>(forest_, stress_curvature(level, level - 1)) : nullptr;
    const auto sums = std::make_unique_for_overwrite<LayerSums<S>>();
#pragma omp for schedule(static)
    for (int id = leaves.begin; id < leaves.end; ++id) {
      BlockNeighbourhood<S> blocks = neighbourhood(id, l.now);
      const BlockNeighbourhood<S> next = neighbourhood(std::min(id + 1, leaves.end - 1), l.now);
      blocks.next = &next;
      blocks.past_caches = leaves.size() > blocks_in_cache;
      sums->begin();
      if (level > 0) restriction->request((*l.to_parents)[id], *sums);
      if (level < forest_.finest()) interpolation_[level].request(id, *sums);
      if (!sums->empty()) blocks.sums = sums.get();
      if (level > 0) reflux_[level - 1].of_fine().count(id, field_[l.now], l.relaxation);
      if (level < forest_.finest()) reflux_[level].of_coarse().count(id, field_[l.now], l.relaxation);
      const BlockRecord record = update_(blocks, l.relaxation);
      sums->finish();
      if (level > 0) restriction->write(id, (*l.to_parents)[id], to_parents, field_[1 - levels_[level - 1].now]);
      field_[1 - l.now].forget_changes(id);
      max_speed_squared = std::max(max_speed_squared, record.max_speed_squared);
      diverged = diverged || record.diverged;
    }
  }
  if (diverged) report_divergence(level);
  if (level > 0) reflux_[level - 1].end_fine_step();
  if (level < forest_.finest()) reflux_[level].end_coarse_step();
  statistics_.cell_updates += std::int64_t{leaves.size()} * amr::block_cells;
  const double speed = std::sqrt(max_speed_squared);
  statistics_.max_speed = std::max(statistics_.max_speed, speed * units_.velocity);
  statistics_.max_mach = std::max(statistics_.max_mach, speed / std::sqrt(sound_speed_squared));
}

template <class S>
BlockNeighbourhood<S> BasicSolver<S>::neighbourhood(int block, int from) {
  BlockNeighbourhood<S> blocks;
  for (int slot = 0; slot < 27; ++slot) {
    const int id = forest_.block(block).neighbour[slot];
    blocks.source[slot] = field_[from].block(id);
    blocks.columns[slot] = in_columns_[block] >> slot & 1 ? field_[from].columns(id) : nullptr;
  }
  MomentField<S>& target = field_[1 - from];
  blocks.target = target.block(block);
  blocks.target_columns = target.columns(block);
  return blocks;
}

template <class S>
void BasicSolver<S>::apply_sponge(int level) {
  const Level& l = levels_[level];
  MomentField<S>& field = field_[1 - l.now];
  const int count = static_cast<int>(l.sponge.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) {
    const SpongeBlock& sponge = l.sponge[i];
    for (const SpongeCell& s : sponge.cells) {
      std::byte* row = field.row(sponge.block, s.cell[1], s.cell[2]);
      for (const Moment m : {drho, ux, uy, uz}) {
        Real& value = RowLayout<S>::macro(row, m)[s.cell[0]];
        value += s.damping * (s.rest[m] - value);
      }
    }
    field.refresh_columns(sponge.block);
  }
}

/// Once more for the leaves that something has changed since they were updated.
template <class S>
void BasicSolver<S>::restrict_changed(int level, MomentField<S>& coarse) {
  MomentField<S>& fine = field_[levels_[level].now];
  const auto leaves = forest_.range(level, amr::Kind::leaf);
  const RestrictionPlan& plan = *levels_[level].to_parents;
  std::vector<int> changed;
  for (int id = leaves.begin; id < leaves.end; ++id) {
    if (fine.changed(id) && !plan[id].empty()) changed.push_back(id);
    fine.forget_changes(id);
  }
  if (changed.empty()) return;
  const int count = static_cast<int>(changed.size());
  const Conversion to_parents = conversion(level, level - 1, levels_[level].time);
#pragma omp parallel
  {
    const auto restriction = std::make_unique<Restriction<S>>(forest_, stress_curvature(level, level - 1));
    const auto sums = std::make_unique_for_overwrite<LayerSums<S>>();
#pragma omp for schedule(dynamic, 4)
    for (int i = 0; i < count; ++i) {
      const int id = changed[i];
      sums->begin();
      restriction->request(plan[id], *sums);
      sums->sum(fine.block(id));
      restriction->write(id, plan[id], to_parents, coarse);
    }
  }
}

/// From a state of leaves alone.
template <class S>
void BasicSolver<S>::join_levels() {
  for (int level = forest_.finest(); level > 0; --level) {
    MomentField<S>& coarse = field_[levels_[level - 1].now];
    restrict_changed(level, coarse);
    interpolation_[level - 1].start(coarse);
  }
}

/// Pneq = -2 rho c_s^2 tau S dt: per step of each level, so it scales with tau dt.
template <class S>
Conversion BasicSolver<S>::conversion(int from, int to, double time) const {
  Conversion result{tau(to) * levels_[to].dt / (tau(from) * levels_[from].dt)};
  if (forced_) result.velocity_shift = half_kick(to, time) - half_kick(from, time);
  return result;
}

/// What the second-order parts of Pneq differ by, in cells of `from` squared: see docs/theory.md, Levels.
template <class S>
double BasicSolver<S>::stress_curvature(int from, int to) const {
  const double ratio = forest_.spacing(to) / forest_.spacing(from);
  return ratio * ratio * stress_defect(tau(to)) - stress_defect(tau(from));
}

template <class S>
void BasicSolver<S>::couple(fluid::FineStepHook& hook) {
  using Layout = RowLayout<S>;
  const Level& l = levels_.back();
  const int field = 1 - l.now;
  const fluid::VelocityView u_star = fine_velocity_.view(field_[field], units_.velocity);
  force_.clear();
  const double kappa = l.dt / specification_.density;
  fluid::FineStep fine_step{l.time + l.dt, l.dt, u_star, force_, kappa};
  hook.on_fine_step(fine_step);
  const Real lattice_kappa = static_cast<Real>(kappa / units_.velocity);
  const auto opened = force_.opened();
  const int count = static_cast<int>(opened.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) {
    force_.drain(opened[i], [&](int r, const float* force) {
      std::byte* row = field_[field].block(opened[i]) + r * Layout::bytes;
      for (int a = 0; a < 3; ++a, force += fluid::ForceField::stride_component) {
        Real* u = Layout::macro(row, ux + a);
        __builtin_prefetch(Layout::macro(row + n * Layout::bytes, ux + a), 1);  // where a sheet goes on, one plane up
        store(u, load(u) + lattice_kappa * __builtin_convertvector(load_unaligned(force), Vec<Real>));
      }
      field_[field].velocity_to_columns(opened[i], r % n, r / n);
    });
  }
}

template <class S>
fluid::VelocityView BasicSolver<S>::fine_velocity() const {
  return fine_velocity_.view(field_[levels_.back().now], units_.velocity);
}

template <class S>
void BasicSolver<S>::report_divergence(int level) const {
  using Layout = RowLayout<S>;
  const auto leaves = forest_.range(level, amr::Kind::leaf);
  const Level& l = levels_[level];
  for (int id = leaves.begin; id < leaves.end; ++id)
    for (int cell = 0; cell < amr::block_cells; ++cell) {
      const Index3 at = amr::cell_at(cell);
      const std::byte* row = field_[1 - l.now].row(id, at[1], at[2]);
      Real speed = 0;
      for (const Moment m : {ux, uy, uz}) speed += Layout::get(row, m, at[0]) * Layout::get(row, m, at[0]);
      speed = std::sqrt(speed);
      const Real density = Layout::get(row, drho, at[0]);
      if (speed < speed_limit && std::abs(density) < density_limit) continue;
      const std::string what =
          std::isfinite(speed) && std::isfinite(density)
              ? fmt::format("speed {:.3g} m/s, density off by {:.3g} %", speed * units_.velocity, 100 * density)
              : "not a number";
      throw Diverged("the fluid diverged: " + what, l.time + l.dt, level, id, at, forest_.cell_centre(id, at));
    }
  throw Diverged("the fluid diverged on level " + std::to_string(level));
}

std::unique_ptr<fluid::FluidSolver> make_solver(amr::Forest forest, const fluid::Specification& specification) {
  switch (specification.storage) {
    case fluid::Storage::half_stress:
      return std::make_unique<BasicSolver<DefaultStress>>(std::move(forest), specification);
    case fluid::Storage::float32:
      return std::make_unique<BasicSolver<FloatStress>>(std::move(forest), specification);
    case fluid::Storage::float64:
      return std::make_unique<BasicSolver<DoubleStress>>(std::move(forest), specification);
  }
  return nullptr;
}

#ifdef __F16C__
template class BasicSolver<HalfStress>;
#endif
template class BasicSolver<FloatStress>;
template class BasicSolver<DoubleStress>;

}  // namespace drogue::lbm
