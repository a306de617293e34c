#pragma once

// When Monte-Carlo paths split in two and when they end.

#include <cstdint>

namespace retrace::raytrace {

/// How paths are followed.
struct PathPolicy {
  double cutoff = 1e-10;      ///< power below which a path ends in `truncated`
  double split_power = 1e-2;  ///< both branches of an interface are followed while each carries at least this
  std::uint32_t max_events = 1'000'000;  ///< hits on one path before it ends in `truncated`
};

}  // namespace retrace::raytrace
