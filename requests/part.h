#pragma once

// Requests for the export of files for other programs: solids of a design, and materials that reflect light in the same
// way as a part.

#include <cstdint>
#include <optional>
#include <string>

namespace retrace {

/// Selects the solid to export from a design: one element on its plate, the whole array, or the mould. The mould is a
/// block whose upper face fits the back surface of the part.
struct SolidRequest {
  /// Solid: element, array, or mould (the block behind the part's back).
  std::string what = "array";
  /// Thickness of the mould below its deepest point, in mm; > 0 and <= 1e+06. Default: the plate's thickness.
  std::optional<double> block_mm = {};
  /// Maximum distance along z between an exact entrance surface and the triangles that approximate it, in mm; >= 1e-06
  /// and <= 10. Default: 0.001.
  std::optional<double> surface_error_mm = {};
};

/// Settings for a material that reflects light in the same way as a part (docs/theory/appearance.md). The
/// reflectance values of the material are means over the discs of the light source and the receiver.
struct MaterialRequest {
  /// Largest entrance angle, in degrees; >= 1 and <= 40.
  double entrance_deg = 20.0;
  /// Largest angle between view and source, in degrees; >= 0.1 and <= 5.
  double window_deg = 1.0;
  /// Angular diameter of the source, in arc minutes; >= 1 and <= 120.
  double source_arcmin = 10.0;
  /// Angular diameter of the receiver, in arc minutes; >= 1 and <= 120.
  double receiver_arcmin = 10.0;
  /// Relative error to reach; >= 0.001 and <= 0.5.
  double error = 0.02;
  /// Maximum number of directions of light that are computed; a whole number >= 64 and <= 10000.
  std::uint64_t max_directions = 1000;
};

}  // namespace retrace
