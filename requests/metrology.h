#pragma once

// Request for the evaluation of a measured surface.

#include <cstddef>
#include <optional>
#include <string>

namespace retrace {

/// Settings of the evaluation of a measured surface, as in `retrace metrology`. If only the spacing of the points along
/// x is given, the spacing along y is equal to it.
struct MetrologyRequest {
  /// Form to remove: none, plane, or a polynomial of degree 2 to 8: poly2, poly3, poly4, poly5, poly6, poly7 or poly8.
  std::string form = "plane";
  /// Cut-off of the Gaussian filter between roughness and waviness, in um; > 0.
  double cutoff_um = 80.0;
  std::optional<double> x_pixel_um = {};
  std::optional<double> y_pixel_um = {};
  /// Unit of the heights: m, mm, um, nm or pm. Default: as in the file.
  std::optional<std::string> height_unit = {};
  /// Unit of lateral lengths without a unit: m, mm, um, nm or pm. Default: as in the file.
  std::optional<std::string> lateral_unit = {};
  /// Channel of a GWY file; a whole number >= 0 and <= 999999. Default: the first.
  std::optional<std::size_t> channel = {};
  /// Feed of the cut, in mm/min; if it is given, the frequencies of waves are also reported in Hz; > 0. Default: no
  /// frequencies.
  std::optional<double> feed_mm_per_min = {};
  /// Rows are profiles across an edge: fit its radius and chamfer.
  bool edge = false;
};

}  // namespace retrace
