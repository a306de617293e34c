#pragma once

// Memory for many rays with one array per value, padded for SIMD.

#include <algorithm>
#include <cstddef>
#include <vector>

#include "raytrace/cells/cell_lanes.h"

namespace retrace::raytrace {

/// Rays, stored with one array per value.
class RayStore {
 public:
  /// \param numbers number of values per ray, see lanes::Rays
  explicit RayStore(std::size_t numbers) : numbers_(numbers) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  void clear() { size_ = 0; }

  /// Reserves memory for `size` rays and the SIMD padding. The stored rays are kept.
  void reserve(std::size_t size) {
    if (size + lanes::kPadding <= capacity_) return;
    const std::size_t capacity = std::max(size + lanes::kPadding, 2 * capacity_);
    std::vector<double> values(numbers_ * capacity);
    for (std::size_t k = 0; k < numbers_; ++k)
      std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(k * capacity_), size_,
                  values.begin() + static_cast<std::ptrdiff_t>(k * capacity));
    values_.swap(values);
    capacity_ = capacity;
  }
  /// \pre memory for `size` rays has been reserved
  void resize(std::size_t size) { size_ = size; }

  /// Returns the arrays, beginning at ray `first`.
  lanes::Rays rays(std::size_t first = 0) {
    lanes::Rays all;
    all.component_count = numbers_;
    for (std::size_t k = 0; k < numbers_; ++k) all.at[k] = values_.data() + k * capacity_ + first;
    return all;
  }

  /// \pre both stores have the same number of values per ray
  void swap(RayStore& other) noexcept {
    values_.swap(other.values_);
    std::swap(capacity_, other.capacity_);
    std::swap(size_, other.size_);
  }

 private:
  std::size_t numbers_;
  std::vector<double> values_;
  std::size_t capacity_ = 0;
  std::size_t size_ = 0;
};

}  // namespace retrace::raytrace
