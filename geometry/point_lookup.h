#pragma once

// Stores values at points in space, and finds them by coordinates with a tolerance.

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "geometry/vec.h"

namespace retrace::geometry {

/// Values that are stored at points in space. A search finds all points within a tolerance in each coordinate.
template <class Value>
class PointLookup {
 public:
  /// \param tolerance > 0, and much larger than the rounding errors of the coordinates
  explicit PointLookup(double tolerance) : tolerance_(tolerance), cell_(8.0 * tolerance) {}

  void insert(const Vec3& p, Value value) { entries_.emplace(key_of(p), Entry{p, std::move(value)}); }

  /// Calls visit(value) for every value whose point is within the tolerance of `p`, in arbitrary order.
  template <class Visit>
  void visit(const Vec3& p, const Visit& visit) const {
    const Vec3 reach = Vec3::Constant(tolerance_);
    const Key low = key_of(p - reach);
    const Key high = key_of(p + reach);
    Key key;
    for (key[0] = low[0]; key[0] <= high[0]; ++key[0])
      for (key[1] = low[1]; key[1] <= high[1]; ++key[1])
        for (key[2] = low[2]; key[2] <= high[2]; ++key[2]) {
          const auto [first, last] = entries_.equal_range(key);
          for (auto it = first; it != last; ++it)
            if ((it->second.at - p).cwiseAbs().maxCoeff() <= tolerance_) visit(it->second.value);
        }
  }

 private:
  using Key = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t hash = 0;
      for (const std::int64_t k : key)
        hash = (hash ^ (hash >> 29) ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15U;
      return hash ^ (hash >> 32);
    }
  };
  struct Entry {
    Vec3 at;
    Value value;
  };

  Key key_of(const Vec3& p) const {
    Key key;
    for (Eigen::Index k = 0; k < 3; ++k)
      key[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(p[k] / cell_));
    return key;
  }

  double tolerance_;
  double cell_;
  std::unordered_multimap<Key, Entry, Hash> entries_;
};

}  // namespace retrace::geometry
