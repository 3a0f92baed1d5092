// SPDX-License-Identifier: GPL-3.0-or-later
// Linear equations (K + B) u = f for the free coordinates of a body, by a sparse factorisation: L D L^T where the
// matrix is symmetric (minimum-degree ordering), L U with pivoting where a pressure on a free edge or an active stress
// makes it unsymmetric.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fem/stiffness.hpp"

namespace drogue::fem {

/// Symmetric matrix B that couples coordinates along the same axis alone, of a node with itself and of the two nodes of
/// a pair: masses, dampers, springs.
struct NodalMatrix {
  struct Pair {
    int a, b;
    double value;
  };
  std::vector<Vec3> diagonal;
  std::vector<Pair> pairs;

  std::vector<Vec3> times(std::span<const Vec3> u) const;
};

class SparseSystem {
 public:
  using Held = std::vector<std::array<bool, 3>>;  ///< node by node, axis by axis

  /// `stiffness` outlives it; `pairs` are those of any matrix that will be added.
  SparseSystem(const TangentStiffness& stiffness, const Held& held, std::span<const NodalMatrix::Pair> pairs);

  /// Sums K and `added`, both without what is held, and factorises. False if the matrix is singular or, being
  /// symmetric, not positive definite, and then nothing can be solved. Results do not depend on the number of threads.
  bool factorise(const NodalMatrix& added);
  /// u for a load; zero along what is held.
  std::vector<Vec3> solve(const std::vector<Vec3>& load) const;

  int unknowns() const { return static_cast<int>(matrix_.rows()); }
  /// Multiplications of a symmetric factorisation, known from the pattern alone.
  double operations() const { return factor_.operations(); }

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  struct Factor : Eigen::SimplicialLDLT<Matrix> {
    double operations() const;
  };
  void find_pattern(std::span<const NodalMatrix::Pair> pairs);
  void sum(const NodalMatrix& added);
  bool is_symmetric() const;

  struct Neighbour {
    int node;
    int first_block;  ///< in `blocks_`; the next neighbour's is where they end
  };
  const TangentStiffness& stiffness_;
  std::vector<std::array<int, 3>> unknown_;  ///< of each coordinate, or -1
  std::vector<int> first_neighbour_;         ///< of each node
  std::vector<Neighbour> neighbours_;        ///< those whose force it moves, in order; one more at the end
  std::vector<TangentStiffness::Block> blocks_;
  Matrix matrix_;
  Factor factor_;
  Eigen::SparseLU<Matrix> unsymmetric_;
  bool symmetric_ = true;
};

}  // namespace drogue::fem
