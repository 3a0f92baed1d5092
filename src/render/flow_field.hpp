// SPDX-License-Identifier: GPL-3.0-or-later
// A scalar derived from a flow snapshot, and its values on a uniform grid of points.
//
// The scalar is formed on the cells of every block with central differences of the block's own spacing,
//   speed |u|,   vorticity |curl u|,   Q = (|Omega|^2 - |S|^2) / 2   (Hunt, Wray & Moin, CTR-S88 (1988) 193),
// and interpolated linearly between cell centres of the finest block that holds a point. Neighbours that a level does
// not have are interpolated from the coarser level, so a surface crosses a change of level without a gap; its slope may
// kink there, and the interpolation error jumps by O(dx^2).
#pragma once

#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "io/fluid_snapshot.hpp"

namespace drogue::render {

enum class Quantity { speed, vorticity, q_criterion };

/// Points at lower + spacing * (i, j, k) [m]; values are stored x fastest.
struct PointGrid {
  Vec3 lower = Vec3::Zero();
  double spacing = 1.0;
  Index3 size{1, 1, 1};

  std::size_t points() const { return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]); }
};

class FlowField {
 public:
  FlowField(const io::FluidSnapshot& snapshot, Quantity quantity);

  /// Value at a point [m]; outside the domain that of the nearest cell.
  float at(const Vec3& point) const;
  std::vector<float> sample(const PointGrid& grid) const;
  /// Box [m] of the blocks whose values reach `threshold`, and the finest spacing among them; an empty box
  /// (upper < lower) if none does.
  struct Reach {
    Box box;
    double spacing;
  };
  Reach reach(double threshold) const;
  const Box& domain() const { return domain_; }
  double finest_spacing() const { return levels_.back().spacing; }

 private:
  struct Level {
    double spacing;
    Index3 cells;                                   // across the domain
    std::unordered_map<std::uint64_t, int> number;  // block coordinates -> place in the arrays
    std::vector<Index3> block;
    std::vector<float> value;  // with one layer of neighbours: [block][18][18][18]
  };

  int find(const Level& level, const Index3& block) const;
  void pad(int level, int components, const std::vector<std::vector<float>>& cells, int block, float* padded) const;
  void cell_value(int level, Index3 cell, int components, const std::vector<std::vector<float>>& cells,
                  float* value) const;
  float interpolate(const Level& level, int block, const Vec3& point) const;

  Box domain_;
  std::vector<Level> levels_;
};

}  // namespace drogue::render
