// SPDX-License-Identifier: GPL-3.0-or-later
// How the state of a run is saved and restored. What has state lists it once, for both ways:
//   void transfer_state(Archive& archive) { archive.transfer("position", position_); archive.transfer("part", part_); }
// State is what decides the further course of the run to the last bit and does not follow from the case.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace drogue {

class Archive {
 public:
  virtual ~Archive() = default;

  /// Saves the value under its name, or replaces it by the one that was saved there. Names may hold slashes. Throws
  /// InputError if another number of values was saved, std::runtime_error if nothing was, or it cannot be read or
  /// written.
  void transfer(const std::string& name, std::span<std::byte> values) { exchange(path_ + name, values); }
  void transfer(const std::string& name, double& value) { exchange(path_ + name, std::span(&value, 1)); }
  void transfer(const std::string& name, std::int64_t& value) { exchange(path_ + name, std::span(&value, 1)); }
  void transfer(const std::string& name, int& value) {
    std::int64_t wide = value;
    transfer(name, wide);
    value = static_cast<int>(wide);
  }
  void transfer(const std::string& name, Vec3& value) { transfer(name, std::span(&value, 1)); }
  void transfer(const std::string& name, std::span<Vec3> values) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    exchange(path_ + name, std::span(reinterpret_cast<double*>(values.data()), 3 * values.size()));
  }
  /// Takes the size of what was saved.
  void transfer(const std::string& name, std::vector<double>& values) {
    values.resize(size(path_ + name, values.size()));
    exchange(path_ + name, std::span(values));
  }
  /// A part with state of its own; its names are below `name`.
  template <class T>
  requires requires(T& part, Archive& archive) { part.transfer_state(archive); }
  void transfer(const std::string& name, T& part) {
    const std::string outer = std::exchange(path_, path_ + name + '/');
    part.transfer_state(*this);
    path_ = outer;
  }

 private:
  virtual void exchange(const std::string& path, std::span<std::byte> values) = 0;
  virtual void exchange(const std::string& path, std::span<double> values) = 0;
  virtual void exchange(const std::string& path, std::span<std::int64_t> values) = 0;
  /// Number of values under `path`: those that are saved, or the `own` ones that will be.
  virtual std::size_t size(const std::string& path, std::size_t own) const = 0;

  std::string path_;
};

}  // namespace drogue
