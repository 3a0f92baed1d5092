// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/flow_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "amr/forest.hpp"

namespace drogue::render {
namespace {

using amr::block_cells;
using amr::block_size;

constexpr int padded_size = block_size + 2;
constexpr int padded_cells = padded_size * padded_size * padded_size;

constexpr int cell_offset(int i, int j, int k) { return (k * block_size + j) * block_size + i; }
// Place of cell (i, j, k), each from -1 to block_size.
constexpr int padded_offset(int i, int j, int k) { return ((k + 1) * padded_size + j + 1) * padded_size + i + 1; }
constexpr std::array<int, 3> padded_stride{1, padded_size, padded_size* padded_size};

std::uint64_t key(const Index3& block) {
  return static_cast<std::uint64_t>(block[0]) | static_cast<std::uint64_t>(block[1]) << 21 |
         static_cast<std::uint64_t>(block[2]) << 42;
}

// `u` is the velocity of a cell inside a padded block with interleaved components.
float derive(Quantity quantity, const float* u, double spacing) {
  if (quantity == Quantity::speed) return std::hypot(u[0], u[1], u[2]);
  Mat3 gradient;  // (a, b): derivative of component a along b
  for (int b = 0; b < 3; ++b)
    for (int a = 0; a < 3; ++a)
      gradient(a, b) = (u[3 * padded_stride[b] + a] - u[-3 * padded_stride[b] + a]) / (2.0 * spacing);
  const Mat3 rotation = 0.5 * (gradient - gradient.transpose());
  if (quantity == Quantity::vorticity) return static_cast<float>(std::sqrt(2.0) * rotation.norm());
  const Mat3 strain = 0.5 * (gradient + gradient.transpose());
  return static_cast<float>(0.5 * (rotation.squaredNorm() - strain.squaredNorm()));
}

}  // namespace

FlowField::FlowField(const io::FluidSnapshot& snapshot, Quantity quantity) {
  std::vector<std::vector<float>> velocity;
  Index3 blocks_across{0, 0, 0};
  for (const Index3& block : snapshot.levels.front().block)
    for (int a = 0; a < 3; ++a) blocks_across[a] = std::max(blocks_across[a], block[a] + 1);
  for (const auto& stored : snapshot.levels) {
    Level level{stored.spacing, {}, {}, stored.block, {}};
    for (int a = 0; a < 3; ++a) level.cells[a] = blocks_across[a] * block_size << levels_.size();
    for (std::size_t b = 0; b < stored.block.size(); ++b) level.number[key(stored.block[b])] = static_cast<int>(b);
    levels_.push_back(std::move(level));
    velocity.push_back(stored.velocity);
  }
  const Level& coarsest = levels_.front();
  domain_.lower = snapshot.origin;
  for (int a = 0; a < 3; ++a) domain_.upper[a] = domain_.lower[a] + coarsest.cells[a] * coarsest.spacing;

  std::vector<std::vector<float>> scalar;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    scalar.emplace_back(levels_[l].block.size() * block_cells);
#pragma omp parallel
    {
      std::vector<float> padded(3 * padded_cells);
#pragma omp for schedule(dynamic, 8)
      for (std::size_t b = 0; b < levels_[l].block.size(); ++b) {
        pad(static_cast<int>(l), 3, velocity, static_cast<int>(b), padded.data());
        for (int k = 0; k < block_size; ++k)
          for (int j = 0; j < block_size; ++j)
            for (int i = 0; i < block_size; ++i)
              scalar[l][b * block_cells + cell_offset(i, j, k)] =
                  derive(quantity, &padded[3 * padded_offset(i, j, k)], levels_[l].spacing);
      }
    }
  }
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    levels_[l].value.resize(levels_[l].block.size() * padded_cells);
#pragma omp parallel for schedule(dynamic, 8)
    for (std::size_t b = 0; b < levels_[l].block.size(); ++b)
      pad(static_cast<int>(l), 1, scalar, static_cast<int>(b), &levels_[l].value[b * padded_cells]);
  }
}

int FlowField::find(const Level& level, const Index3& block) const {
  const auto found = level.number.find(key(block));
  return found == level.number.end() ? amr::none : found->second;
}

// Value of a cell anywhere, in cells of the level: outside the domain that of the nearest cell, where the level has no
// block interpolated from the coarser one.
void FlowField::cell_value(int level, Index3 cell, int components, const std::vector<std::vector<float>>& cells,
                           float* value) const {
  const Level& here = levels_[level];
  Index3 block, inside;
  for (int a = 0; a < 3; ++a) {
    cell[a] = std::clamp(cell[a], 0, here.cells[a] - 1);
    block[a] = cell[a] / block_size;
    inside[a] = cell[a] % block_size;
  }
  if (const int b = find(here, block); b != amr::none) {
    const std::size_t place = std::size_t(b) * block_cells + cell_offset(inside[0], inside[1], inside[2]);
    std::copy_n(&cells[level][components * place], components, value);
    return;
  }
  std::fill_n(value, components, 0.0f);
  for (int corner = 0; corner < 8; ++corner) {
    Index3 coarse;
    float weight = 1.0f;
    for (int a = 0; a < 3; ++a) {
      const bool far = corner >> a & 1;
      coarse[a] = cell[a] / 2 + (far ? (cell[a] % 2 == 0 ? -1 : 1) : 0);
      weight *= far ? 0.25f : 0.75f;
    }
    std::array<float, 3> coarse_value;
    cell_value(level - 1, coarse, components, cells, coarse_value.data());
    for (int c = 0; c < components; ++c) value[c] += weight * coarse_value[c];
  }
}

void FlowField::pad(int level, int components, const std::vector<std::vector<float>>& cells, int block,
                    float* padded) const {
  const Index3& index = levels_[level].block[block];
  const float* own = &cells[level][std::size_t(block) * block_cells * components];
  const auto is_inside = [](int i) { return i >= 0 && i < block_size; };
  for (int k = -1; k <= block_size; ++k)
    for (int j = -1; j <= block_size; ++j)
      for (int i = -1; i <= block_size; ++i) {
        float* target = padded + components * padded_offset(i, j, k);
        if (is_inside(i) && is_inside(j) && is_inside(k))
          std::copy_n(own + components * cell_offset(i, j, k), components, target);
        else
          cell_value(level, {index[0] * block_size + i, index[1] * block_size + j, index[2] * block_size + k},
                     components, cells, target);
      }
}

float FlowField::interpolate(const Level& level, int block, const Vec3& point) const {
  const float* value = &level.value[std::size_t(block) * padded_cells];
  int base = 0;
  std::array<float, 3> t;
  for (int a = 0; a < 3; ++a) {
    const double x = (point[a] - domain_.lower[a]) / level.spacing - level.block[block][a] * block_size + 0.5;
    const int i = std::clamp(static_cast<int>(std::floor(x)), 0, block_size);
    t[a] = static_cast<float>(std::clamp(x - i, 0.0, 1.0));
    base += i * padded_stride[a];
  }
  const auto along_x = [&](int offset) {
    const float* v = value + base + offset;
    return v[0] + t[0] * (v[1] - v[0]);
  };
  const auto along_y = [&](int offset) {
    const float low = along_x(offset), high = along_x(offset + padded_stride[1]);
    return low + t[1] * (high - low);
  };
  const float low = along_y(0), high = along_y(padded_stride[2]);
  return low + t[2] * (high - low);
}

float FlowField::at(const Vec3& point) const {
  const Vec3 nearest = point.cwiseMax(domain_.lower).cwiseMin(domain_.upper);
  for (auto level = levels_.rbegin(); level != levels_.rend(); ++level) {
    Index3 block;
    for (int a = 0; a < 3; ++a) {
      const int cell = static_cast<int>(std::floor((nearest[a] - domain_.lower[a]) / level->spacing));
      block[a] = std::clamp(cell, 0, level->cells[a] - 1) / block_size;
    }
    if (const int b = find(*level, block); b != amr::none) return interpolate(*level, b, nearest);
  }
  return 0.0f;  // not reached: level 0 fills the domain
}

std::vector<float> FlowField::sample(const PointGrid& grid) const {
  std::vector<float> values(grid.points());
#pragma omp parallel for collapse(2) schedule(static)
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i)
        values[(std::size_t(k) * grid.size[1] + j) * grid.size[0] + i] = at(grid.lower + grid.spacing * Vec3(i, j, k));
  return values;
}

FlowField::Reach FlowField::reach(double threshold) const {
  Reach reach{
      {Vec3::Constant(std::numeric_limits<double>::max()), Vec3::Constant(std::numeric_limits<double>::lowest())},
      levels_.front().spacing};
  for (const Level& level : levels_)
    for (std::size_t b = 0; b < level.block.size(); ++b) {
      const auto first = level.value.begin() + static_cast<std::ptrdiff_t>(b * padded_cells);
      if (*std::max_element(first, first + padded_cells) < threshold) continue;
      for (int a = 0; a < 3; ++a) {
        const double lower = domain_.lower[a] + level.block[b][a] * block_size * level.spacing;
        reach.box.lower[a] = std::min(reach.box.lower[a], lower);
        reach.box.upper[a] = std::max(reach.box.upper[a], lower + block_size * level.spacing);
      }
      reach.spacing = level.spacing;
    }
  return reach;
}

}  // namespace drogue::render
