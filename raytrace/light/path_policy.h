#pragma once

// Criteria by which Monte Carlo paths split and end.

#include <cstdint>

namespace retrace::raytrace {

/// Parameters for the tracing of paths.
struct PathPolicy {
  double cutoff = 1e-10;      ///< power below which a path ends in `truncated`
  double split_power = 1e-2;  ///< both branches of an interface are followed while each carries at least this
  /// Maximum number of surfaces that one path meets before it ends in `truncated`. Total reflection can trap a path in
  /// a clear body for ever.
  std::uint32_t max_events = 1'000'000;
  /// Maximum number of segments of all paths that one ray splits into.
  std::uint64_t max_segments = 10'000'000;
};

}  // namespace retrace::raytrace
