#pragma once

// Request for the evaluation of a measured surface.

#include <cstddef>
#include <optional>
#include <string>

namespace retrace {

/// Settings of the evaluation of a measured surface, as in `retrace metrology`. The spacing along y is that along x
/// unless it is given.
struct MetrologyRequest {
  std::string form = "plane";
  double cutoff_um = 80.0;
  std::optional<double> x_pixel_um = {};
  std::optional<double> y_pixel_um = {};
  std::optional<std::string> height_unit = {};
  std::optional<std::string> lateral_unit = {};
  std::optional<std::size_t> channel = {};
  std::optional<double> feed_mm_per_min = {};
  bool edge = false;
};

}  // namespace retrace
