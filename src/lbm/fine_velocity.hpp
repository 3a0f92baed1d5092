// SPDX-License-Identifier: GPL-3.0-or-later
// The velocity of the finest level as the immersed boundary sees it: where the state is in floats, the state itself;
// where it is in doubles, a copy.
#pragma once

#include <utility>
#include <vector>

#include "fluid/views.hpp"
#include "lbm/moments.hpp"

namespace drogue::lbm {

template <class S>
class FineVelocity {
 public:
  explicit FineVelocity(const amr::Forest& forest) : forest_(&forest), base_(forest.size(), nullptr) {}

  /// Valid until the field changes or the next call. `velocity` [m/s] is that of one cell per step.
  fluid::VelocityView view(const MomentField<S>& field, double velocity) {
    constexpr int n = amr::block_size;
    const auto finest = forest_->range(forest_->finest(), amr::Kind::leaf);
    if constexpr (!is_float) copy_.resize(std::size_t(finest.size()) * rows_per_block * row);
#pragma omp parallel for schedule(static)
    for (int id = finest.begin; id < finest.end; ++id) {
      if constexpr (is_float) {
        base_[id] = RowLayout<S>::macro(field.block(id), ux);
      } else {
        float* to = copy_.data() + std::size_t(id - finest.begin) * rows_per_block * row;
        base_[id] = to;
        for (int r = 0; r < rows_per_block; ++r, to += row) {
          const auto* from = RowLayout<S>::macro(field.block(id) + r * RowLayout<S>::bytes, ux);
          for (int i = 0; i < row; ++i) to[i] = static_cast<float>(from[i]);
        }
      }
    }
    return {forest_, base_.data(), lanes, row, n * row, static_cast<float>(velocity)};
  }

 private:
  static constexpr bool is_float = std::is_same_v<typename S::Real, float>;
  static constexpr int row = is_float ? RowLayout<S>::bytes / sizeof(float) : 3 * lanes;  // floats from row to row

  const amr::Forest* forest_;
  std::vector<const float*> base_;  // per block
  std::vector<float> copy_;
};

}  // namespace drogue::lbm
