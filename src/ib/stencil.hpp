// SPDX-License-Identifier: GPL-3.0-or-later
// The cells a marker's delta function touches, and the two sums over them. A stencil that crosses block faces is the
// sum of its parts in up to eight blocks. Along x every part is a window of four cells inside its block, whose weights
// are zero where the stencil does not reach: the inner loop is always one vector, and a sheet that lies in a block face
// costs twice, not many times, what it costs elsewhere.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "amr/forest.hpp"
#include "core/types.hpp"

namespace drogue::ib {

/// The home of a stencil is the block of its lowest cell, so the other blocks are the home's neighbours towards +x, +y,
/// +z. They are numbered by `side`: bit a is set for those beyond the home's upper face of axis a.
struct Stencil {
  Index3 home{};               ///< block coordinates on the finest level
  int crossed = -1;            ///< bit a: reaches beyond the home along axis a; -1 before it is placed
  std::array<int, 8> block{};  ///< ids by side; `none` where it does not reach
  Index3 low{};                ///< lowest cell, inside the home
  int points = 0;              ///< cells per axis, at most four
  std::array<double, 10> x{};  ///< the four weights between two times three zeros
  std::array<double, 4> y{}, z{};
};

using Float4 = float __attribute__((vector_size(4 * sizeof(float))));
using Double4 = double __attribute__((vector_size(4 * sizeof(double))));

template <class Vector, class Scalar>
Vector load(const Scalar* from) {
  Vector v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

/// Cells first .. last - 1 of a block along one axis; `weight` belongs to the first.
struct Run {
  int first, last;
  const double* weight;

  Run(int low, int points, const double* weights, bool beyond)
      : first(beyond ? 0 : low),
        last(beyond ? low + points - amr::block_size : std::min(low + points, amr::block_size)),
        weight(beyond ? weights + amr::block_size - low : weights) {}
};

/// What a stencil covers of one block: four cells from `x` on, the rows `y`, the planes `z`.
struct Part {
  int x;
  Double4 weight;
  Run y, z;

  Part(const Stencil& s, int side)
      : x(side & 1 ? 0 : std::min(s.low[0], amr::block_size - 4)),
        weight(load<Double4>(&s.x[3 + x + (side & 1 ? amr::block_size : 0) - s.low[0]])),
        y(s.low[1], s.points, s.y.data(), side & 2),
        z(s.low[2], s.points, s.z.data(), side & 4) {}
};

/// Between neighbours along component, y and z in a block of floats; neighbours along x are adjacent.
struct Strides {
  std::ptrdiff_t component, y, z;
};

/// Sum of the weights times the field at `base`, the block on `side`, one vector of partial sums per component.
inline void gather(const Stencil& stencil, int side, const float* base, const Strides& stride,
                   std::array<Double4, 3>& total) {
  const Part part(stencil, side);
  std::array<Double4, 3> sum{};
  for (int k = part.z.first; k < part.z.last; ++k) {
    for (int j = part.y.first; j < part.y.last; ++j) {
      const double weight = part.z.weight[k - part.z.first] * part.y.weight[j - part.y.first];
      const float* row = base + k * stride.z + j * stride.y + part.x;
      for (int a = 0; a < 3; ++a) {
        sum[a] += weight * __builtin_convertvector(load<Float4>(row + a * stride.component), Double4);
      }
    }
  }
  for (int a = 0; a < 3; ++a) total[a] += sum[a] * part.weight;
}

/// Adds `value` times the weights to the field at `base`, the block on `side`.
inline void scatter(const Stencil& stencil, int side, const Vec3& value, const Strides& stride, float* base) {
  const Part part(stencil, side);
  for (int k = part.z.first; k < part.z.last; ++k) {
    for (int j = part.y.first; j < part.y.last; ++j) {
      const Double4 weight = part.weight * (part.z.weight[k - part.z.first] * part.y.weight[j - part.y.first]);
      float* row = base + k * stride.z + j * stride.y + part.x;
      for (int a = 0; a < 3; ++a) {
        float* cells = row + a * stride.component;
        const Float4 sum = load<Float4>(cells) + __builtin_convertvector(value[a] * weight, Float4);
        std::memcpy(cells, &sum, sizeof sum);
      }
    }
  }
}

}  // namespace drogue::ib
