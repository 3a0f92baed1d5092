// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "fluid/views.hpp"

namespace drogue::fluid {

void ForceField::open(std::span<const int> blocks) {
  for (int id : blocks) {
    if (slot_[id] != amr::none) continue;
    slot_[id] = static_cast<int>(opened_.size());
    opened_.push_back(id);
    if (storage_.size() < opened_.size()) {
      storage_.push_back(std::make_unique<float[]>(block_floats));
      is_zero_.push_back(true);
    }
    if (!is_zero_[slot_[id]]) std::fill_n(storage_[slot_[id]].get(), block_floats, 0.0f);
    is_zero_[slot_[id]] = false;
  }
}

void ForceField::clear() {
  for (int id : opened_) slot_[id] = amr::none;
  opened_.clear();
}

}  // namespace drogue::fluid
