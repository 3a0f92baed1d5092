// SPDX-License-Identifier: GPL-3.0-or-later
#include "ib/markers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"

namespace drogue::ib {

namespace {

/// The field as block id -> floats, and their strides.
template <class BlockOf>
Vec3 gather(const Stencil& stencil, const BlockOf& block_of, const Strides& stride) {
  std::array<Double4, 3> sum{};
  for (int side = 0; side < 8; ++side) {
    if (stencil.block[side] == amr::none) continue;
    if (const float* base = block_of(stencil.block[side])) gather(stencil, side, base, stride, sum);
  }
  const auto total = [](const Double4& v) { return (v[0] + v[1]) + (v[2] + v[3]); };
  return {total(sum[0]), total(sum[1]), total(sum[2])};
}

Vec3 gather(const Stencil& stencil, const fluid::VelocityView& u) {
  return double{u.scale} *
         gather(stencil, [&](int id) { return u.block(id); }, {u.stride_component, u.stride_y, u.stride_z});
}

constexpr Strides force_strides{fluid::ForceField::stride_component, fluid::ForceField::stride_y,
                                fluid::ForceField::stride_z};

Vec3 gather(const Stencil& stencil, const fluid::ForceField& f) {
  return gather(
      stencil, [&](int id) { return f.block(id); }, force_strides);
}

}  // namespace

Markers::Markers(const amr::Forest& forest, Delta delta, std::string body)
    : forest_(&forest),
      delta_(delta),
      body_(std::move(body)),
      spacing_(forest.spacing(forest.finest())),
      cells_(forest.blocks_across(forest.finest())),
      slot_(forest.size(), amr::none) {
  for (int& n : cells_) n *= amr::block_size;
}

void Markers::move_to(std::span<const Vec3> position) {
  const int markers = static_cast<int>(position.size());
  bool regroup = size() != markers;
  if (regroup) stencils_.assign(markers, Stencil{});
  int lost = markers;
#pragma omp parallel for schedule(static) reduction(|| : regroup) reduction(min : lost)
  for (int l = 0; l < markers; ++l) {
    const Placement placement = place(position[l], stencils_[l]);
    if (placement == Placement::changed) regroup = true;
    if (placement == Placement::lost) lost = std::min(lost, l);
  }
  if (lost < markers) {
    stencils_.clear();
    throw_lost(lost, position[lost]);
  }
  if (regroup) group_by_block();
}

Markers::Placement Markers::place(const Vec3& position, Stencil& stencil) const {
  const amr::Domain& domain = forest_->domain();
  std::array<AxisWeights, 3> axis;
  Index3 home;
  int crossed = 0;
  stencil.points = support(delta_);
  for (int a = 0; a < 3; ++a) {
    const double s = (position[a] - domain.box.lower[a]) / spacing_ - 0.5;
    if (!(std::abs(s) < 1e9)) return Placement::lost;
    axis[a] = axis_weights(delta_, s);
    const int low = axis[a].low;
    if (!domain.periodic[a] && (low < 0 || low + stencil.points > cells_[a])) return Placement::lost;
    stencil.low[a] = low & (amr::block_size - 1);
    home[a] = (low - stencil.low[a]) / amr::block_size;
    if (stencil.low[a] + stencil.points > amr::block_size) crossed |= 1 << a;
  }
  std::copy(axis[0].weight.begin(), axis[0].weight.end(), stencil.x.begin() + 3);
  stencil.y = axis[1].weight;
  stencil.z = axis[2].weight;
  if (home == stencil.home && crossed == stencil.crossed) return Placement::kept;
  stencil.home = home;
  stencil.crossed = crossed;
  return find_blocks(stencil) ? Placement::changed : Placement::lost;
}

bool Markers::find_blocks(Stencil& stencil) const {
  stencil.block.fill(amr::none);
  const int home = forest_->find(forest_->finest(), stencil.home);
  bool found = home != amr::none;
  for (int side = 0; side < 8 && found; ++side) {
    if ((side & stencil.crossed) != side) continue;
    const int id = forest_->block(home).neighbour[amr::neighbour_slot(side & 1, side >> 1 & 1, side >> 2)];
    found = id != amr::none && forest_->block(id).kind == amr::Kind::leaf;
    stencil.block[side] = found ? id : amr::none;
  }
  if (!found) stencil.crossed = -1;
  return found;
}

void Markers::throw_lost(int marker, const Vec3& position) const {
  const double reach = 0.5 * support(delta_) * spacing_;
  int coarsest = forest_->finest();
  bool inside = position.allFinite();
  for (int corner = 0; corner < 8 && inside; ++corner) {
    const Vec3 offset(corner & 1 ? reach : -reach, corner & 2 ? reach : -reach, corner & 4 ? reach : -reach);
    const auto location = forest_->locate(position + offset);
    inside = location.has_value();
    if (inside) coarsest = std::min(coarsest, forest_->block(location->block).level);
  }
  const std::string found =
      inside ? fmt::format("cells of level {} ({:g} m)", coarsest, forest_->spacing(coarsest)) : "out of the domain";
  throw InputError(
      fmt::format("body '{}': marker {} at ({:g}, {:g}, {:g}) m must lie in cells of the finest level {} ({:g} m) with "
                  "a margin of {:g} "
                  "m, but reaches {}; enlarge the refined region so that it holds the body wherever it moves",
                  body_, marker, position.x(), position.y(), position.z(), forest_->finest(), spacing_, reach, found));
}

void Markers::group_by_block() {
  for (int id : blocks_) slot_[id] = amr::none;
  blocks_.clear();
  first_.assign(1, 0);
  for (const Stencil& stencil : stencils_) {
    for (int id : stencil.block) {
      if (id == amr::none) continue;
      if (slot_[id] == amr::none) {
        slot_[id] = static_cast<int>(blocks_.size());
        blocks_.push_back(id);
        first_.push_back(0);
      }
      ++first_[slot_[id] + 1];
    }
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];

  touches_.resize(first_.back());
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (int l = 0; l < size(); ++l) {
    for (int side = 0; side < 8; ++side) {
      const int id = stencils_[l].block[side];
      if (id != amr::none) touches_[next[slot_[id]]++] = {l, side};
    }
  }
}

void Markers::interpolate(const fluid::VelocityView& u, std::span<Vec3> out) const {
#pragma omp parallel for schedule(static)
  for (int l = 0; l < size(); ++l) out[l] = gather(stencils_[l], u);
}

void Markers::interpolate(const fluid::ForceField& f, std::span<Vec3> out) const {
#pragma omp parallel for schedule(static)
  for (int l = 0; l < size(); ++l) out[l] = gather(stencils_[l], f);
}

void Markers::interpolate(const fluid::FineStep& step, std::span<Vec3> out) const {
#pragma omp parallel for schedule(static)
  for (int l = 0; l < size(); ++l) {
    out[l] = gather(stencils_[l], step.u_star) + step.velocity_per_force * gather(stencils_[l], step.f);
  }
}

void Markers::spread(std::span<const Vec3> force, fluid::ForceField& f) const {
  f.open(blocks_);
  const double per_volume = 1.0 / (spacing_ * spacing_ * spacing_);
  const int blocks = static_cast<int>(blocks_.size());
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < blocks; ++i) {
    float* base = f.block(blocks_[i]);
    for (int t = first_[i]; t < first_[i + 1]; ++t) {
      const auto [l, side] = touches_[t];
      scatter(stencils_[l], side, per_volume * force[l], force_strides, base);
    }
  }
}

}  // namespace drogue::ib
