#pragma once

// Criteria by which Monte Carlo paths split and end.

#include <cstdint>

namespace retrace::raytrace {

/// Parameters for the tracing of paths.
struct PathPolicy {
  double cutoff = 1e-10;      ///< minimum power of a path; the power of weaker paths is added to `truncated`
  double split_power = 1e-2;  ///< both branches of an interface are traced if each has at least this power
  /// Maximum number of interfaces on a path; the remaining power is then added to `truncated`. Total reflection can
  /// trap a path in a clear body for ever.
  std::uint32_t max_events = 1'000'000;
  /// Maximum number of segments of a ray, summed over all paths into which it splits.
  std::uint64_t max_segments = 10'000'000;
};

}  // namespace retrace::raytrace
