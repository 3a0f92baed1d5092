// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/sparse_system.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace drogue::fem {
namespace {

/// A pivot this much smaller than what it was before elimination is rounding.
constexpr double smallest_pivot = 1e-12;

}  // namespace

std::vector<Vec3> NodalMatrix::times(std::span<const Vec3> u) const {
  std::vector<Vec3> product(u.size());
  for (std::size_t node = 0; node < u.size(); ++node) product[node] = diagonal[node].cwiseProduct(u[node]);
  for (const auto& [a, b, value] : pairs) {
    product[a] += value * u[b];
    product[b] += value * u[a];
  }
  return product;
}

double SparseSystem::Factor::operations() const { return m_nonZerosPerCol.cast<double>().array().square().sum(); }

SparseSystem::SparseSystem(const TangentStiffness& stiffness, const Held& held,
                           std::span<const NodalMatrix::Pair> pairs)
    : stiffness_(stiffness), unknown_(held.size()) {
  int unknowns = 0;
  for (std::size_t node = 0; node < held.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) unknown_[node][axis] = held[node][axis] ? -1 : unknowns++;
  }
  matrix_.resize(unknowns, unknowns);
  find_pattern(pairs);
  factor_.analyzePattern(matrix_);
}

void SparseSystem::find_pattern(std::span<const NodalMatrix::Pair> pairs) {
  // Of each node that moves, the nodes whose force changes, with the blocks that say by how much.
  std::vector<std::map<int, std::vector<TangentStiffness::Block>>> of_node(unknown_.size());
  for (const auto& [node, other, block] : stiffness_.couplings()) of_node[other][node].push_back(block);
  for (const auto& [a, b, value] : pairs) {
    of_node[a][b];
    of_node[b][a];
  }
  std::vector<Eigen::Triplet<double>> entries;
  first_neighbour_.assign(1, 0);
  for (std::size_t column = 0; column < of_node.size(); ++column) {
    for (auto& [row, blocks] : of_node[column]) {
      neighbours_.push_back({row, static_cast<int>(blocks_.size())});
      blocks_.insert(blocks_.end(), blocks.begin(), blocks.end());
      for (const int i : unknown_[row]) {
        for (const int j : unknown_[column]) {
          if (i >= 0 && j >= 0) entries.emplace_back(i, j, 0.0);
        }
      }
    }
    first_neighbour_.push_back(static_cast<int>(neighbours_.size()));
  }
  neighbours_.push_back({-1, static_cast<int>(blocks_.size())});
  matrix_.setFromTriplets(entries.begin(), entries.end());
}

void SparseSystem::sum(const NodalMatrix& added) {
  double* value = matrix_.valuePtr();
  const int* first = matrix_.outerIndexPtr();
#pragma omp parallel for schedule(static)
  for (std::size_t column = 0; column < unknown_.size(); ++column) {
    std::array<int, 3> next{};
    for (int j = 0; j < 3; ++j) next[j] = unknown_[column][j] < 0 ? -1 : first[unknown_[column][j]];
    for (int n = first_neighbour_[column]; n < first_neighbour_[column + 1]; ++n) {
      Mat3 total = Mat3::Zero();
      for (int k = neighbours_[n].first_block; k < neighbours_[n + 1].first_block; ++k) {
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) total(i, j) += blocks_[k](i, j);
        }
      }
      const int row = neighbours_[n].node;
      if (row == static_cast<int>(column)) total.diagonal() += added.diagonal[row];
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; next[j] >= 0 && i < 3; ++i) {
          if (unknown_[row][i] >= 0) value[next[j]++] = total(i, j);
        }
      }
    }
  }
  for (const auto& [a, b, coupling] : added.pairs) {
    for (int axis = 0; axis < 3; ++axis) {
      const int i = unknown_[a][axis], j = unknown_[b][axis];
      if (i < 0 || j < 0) continue;
      matrix_.coeffRef(i, j) += coupling;
      matrix_.coeffRef(j, i) += coupling;
    }
  }
}

bool SparseSystem::is_symmetric() const {
  const Matrix difference = matrix_ - Matrix(matrix_.transpose());
  return difference.norm() <= 1e-9 * matrix_.norm();
}

bool SparseSystem::factorise(const NodalMatrix& added) {
  sum(added);
  symmetric_ = is_symmetric();
  if (!symmetric_) {
    unsymmetric_.compute(matrix_);
    return unsymmetric_.info() == Eigen::Success;
  }
  factor_.factorize(matrix_);
  if (factor_.info() != Eigen::Success) return false;
  const Eigen::VectorXd pivots = factor_.permutationPinv() * Eigen::VectorXd(factor_.vectorD());
  return (pivots.array() > smallest_pivot * matrix_.diagonal().array().abs()).all();
}

std::vector<Vec3> SparseSystem::solve(const std::vector<Vec3>& load) const {
  Eigen::VectorXd right(unknowns());
  const auto each = [&](const auto& action) {
    for (std::size_t node = 0; node < unknown_.size(); ++node) {
      for (int axis = 0; axis < 3; ++axis) {
        if (unknown_[node][axis] >= 0) action(node, axis, unknown_[node][axis]);
      }
    }
  };
  each([&](std::size_t node, int axis, int i) { right[i] = load[node][axis]; });
  const Eigen::VectorXd solution = symmetric_ ? Eigen::VectorXd(factor_.solve(right)) : unsymmetric_.solve(right);
  std::vector<Vec3> u(load.size(), Vec3::Zero());
  each([&](std::size_t node, int axis, int i) { u[node][axis] = solution[i]; });
  return u;
}

}  // namespace drogue::fem
