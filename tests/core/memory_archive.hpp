// SPDX-License-Identifier: GPL-3.0-or-later
// Saved state in memory, for tests: what one object saved, another of its kind restores.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "core/archive.hpp"

namespace drogue::testing {

class MemoryArchive : public Archive {
 public:
  /// From now on `transfer` restores.
  void rewind() { restoring_ = true; }

 private:
  void exchange(const std::string& path, std::span<std::byte> values) override {
    std::vector<std::byte>& saved = saved_[path];
    if (restoring_) {
      std::ranges::copy(saved, values.begin());
    } else {
      saved.assign(values.begin(), values.end());
    }
  }
  void exchange(const std::string& path, std::span<double> values) override {
    exchange(path, std::as_writable_bytes(values));
  }
  void exchange(const std::string& path, std::span<std::int64_t> values) override {
    exchange(path, std::as_writable_bytes(values));
  }
  std::size_t size(const std::string& path, std::size_t own) const override {
    return restoring_ ? saved_.at(path).size() / sizeof(double) : own;
  }

  std::map<std::string, std::vector<std::byte>> saved_;
  bool restoring_ = false;
};

/// Gives `to` the state of `from`.
template <class T>
void copy_state(T& from, T& to) {
  MemoryArchive archive;
  archive.transfer("state", from);
  archive.rewind();
  archive.transfer("state", to);
}

}  // namespace drogue::testing
