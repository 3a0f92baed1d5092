// SPDX-License-Identifier: GPL-3.0-or-later
// Large aligned memory on huge pages, untouched until first written, so that the thread that writes a page first owns
// it.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <utility>

namespace drogue {

/// Zero-filled bytes, aligned to a page; moves only.
class HugeArray {
 public:
  HugeArray() = default;
  explicit HugeArray(std::size_t bytes) : bytes_(bytes) {
    if (bytes == 0) return;
    data_ = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (data_ == MAP_FAILED) throw std::bad_alloc();
    madvise(data_, bytes, MADV_HUGEPAGE);
  }
  HugeArray(HugeArray&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
  HugeArray& operator=(HugeArray&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~HugeArray() {
    if (data_) munmap(data_, bytes_);
  }

  std::byte* data() { return static_cast<std::byte*>(data_); }
  const std::byte* data() const { return static_cast<const std::byte*>(data_); }
  std::size_t size() const { return bytes_; }

 private:
  void* data_ = nullptr;
  std::size_t bytes_ = 0;
};

/// Elements that are all zero bytes at first.
template <class T>
class HugeVector {
 public:
  explicit HugeVector(std::size_t count) : bytes_(count * sizeof(T)) {}

  T& operator[](std::size_t i) { return reinterpret_cast<T*>(bytes_.data())[i]; }
  const T& operator[](std::size_t i) const { return reinterpret_cast<const T*>(bytes_.data())[i]; }

 private:
  HugeArray bytes_;
};

}  // namespace drogue
