// SPDX-License-Identifier: GPL-3.0-or-later
// The tangent K = -df/dx of all elements and pressures, element by element.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "fem/elements.hpp"

namespace drogue::fem {

class TangentStiffness {
 public:
  /// `elements` outlive it.
  explicit TangentStiffness(const Elements& elements);

  /// The matrices at positions `x`. Threads share the work; results do not depend on their number.
  void update(std::span<const Vec3> x);

  /// Where the 3 x 3 block of two nodes of an element is kept.
  struct Block {
    const double* first;
    int row, column;  ///< distances of neighbouring rows and columns
    double operator()(int i, int j) const { return first[i * row + j * column]; }
  };
  struct Coupling {
    int node, other;
    Block block;  ///< minus the derivative of the force on `node` with the position of the `other` [N/m]
  };
  /// Of all elements in a fixed order, always the same; the blocks stay where they are.
  std::vector<Coupling> couplings() const;

  /// K u [N] of the last update.
  std::vector<Vec3> times(std::span<const Vec3> u) const;

 private:
  struct Group {
    const ForceGroup* elements;
    std::vector<Pack> matrices;
    int rows() const { return 3 * elements->nodes_per_element(); }
  };
  const Elements& elements_;
  std::vector<Group> groups_;
};

}  // namespace drogue::fem
