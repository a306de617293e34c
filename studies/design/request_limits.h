#pragma once

// Limits of request values, used by several studies. The command line, the library and the Python module share them.

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "core/error.h"

namespace retrace::studies {

/// Maximum number of rays for each point of a result.
inline constexpr std::uint64_t kMaxRaysOfPoint = std::uint64_t{1} << 36;

/// Checks the number of rays of a request.
/// \throw InputError at --samples
inline void check_rays(std::uint64_t rays) {
  if (rays < 1 || rays > kMaxRaysOfPoint)
    throw InputError({"", 0, "--samples"}, fmt::format("must be 1 to {}, got {}", kMaxRaysOfPoint, rays));
}

/// Checks the azimuth of the light. Larger angles are refused because they leave too few digits after the decimal
/// point.
/// \throw InputError at --azimuth
inline void check_azimuth(double azimuth_deg) {
  if (!(std::abs(azimuth_deg) <= 360.0))
    throw InputError({"", 0, "--azimuth"}, fmt::format("must be -360 to 360 degrees, got {}", azimuth_deg));
}

}  // namespace retrace::studies
