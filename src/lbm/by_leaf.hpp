// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "amr/forest.hpp"

namespace drogue::lbm {

/// A few items for some of the leaves of a level.
template <class Item>
class ByLeaf {
 public:
  ByLeaf(const amr::Forest& forest, int level)
      : first_(forest.range(level, amr::Kind::leaf).begin), items_(forest.range(level, amr::Kind::leaf).size()) {}

  /// Place of a leaf among those of its level.
  int index(int leaf) const { return leaf - first_; }
  std::vector<Item>& operator[](int leaf) { return items_[index(leaf)]; }
  const std::vector<Item>& operator[](int leaf) const { return items_[index(leaf)]; }
  auto begin() const { return items_.begin(); }
  auto end() const { return items_.end(); }

 private:
  int first_;
  std::vector<std::vector<Item>> items_;
};

}  // namespace drogue::lbm
