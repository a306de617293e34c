#pragma once

// Inspects the surface that turning programs produce: cusp heights compared with their closed form, form error,
// interference and rms.

#include <optional>
#include <vector>

#include "fabrication/turning/check/envelope.h"
#include "geometry/surface/freeform_surface.h"

namespace retrace::fabrication::turning {

/// Width of the margins at the rim and at the centre that are not inspected, as a multiple of the feed. Cuts at the rim
/// have a neighbour on one side only. At the centre, the tool hardly moves over the part.
inline constexpr double kRimFeeds = 4.0;

/// Region of the part that is inspected: a circle or a rectangle. A margin at the rim is excluded.
struct InspectedRegion {
  bool is_round = true;
  double radius_mm = 1.0;
  double half_width_mm = 1.0;   ///< half of the size along the lines of a raster (y)
  double half_height_mm = 1.0;  ///< half of the size across the lines of a raster (x)
  double feed_mm = 5e-3;
};

/// Short profile of the surface across the cuts.
struct CuspSample {
  geometry::Vec2 at_mm = geometry::Vec2::Zero();
  double scallop_nm = 0.0;    ///< mean height of the cusps above the neighbouring valleys, along the surface normal
  double predicted_nm = 0.0;  ///< height by the closed form; 0 if the curvature changes too much for this form
  double valley_nm = 0.0;     ///< form error: largest deviation of a valley from the design, with its sign
};

/// Result of an inspection. Deviations are along the surface normal and positive if material is left.
struct Inspection {
  std::vector<CuspSample> cusps;
  std::size_t compared = 0;      ///< number of profiles that have a predicted height
  double form_error_nm = 0.0;    ///< largest absolute value of CuspSample::valley_nm
  double interference_nm = 0.0;  ///< depth of the deepest cut below the design
  double scallop_nm = 0.0;       ///< mean height of all cusps
  double scallop_nm_max = 0.0;
  double scallop_ratio_low = 0.0;  ///< minimum ratio of simulated to predicted height, over the compared profiles
  double scallop_ratio_high = 0.0;
  double rms_nm = 0.0;  ///< rms deviation from the design, at one random point in each pixel of the map
  /// Number of columns of the map, which is a square around the region; x increases along a row.
  std::size_t columns = 0;
  double map_width_mm = 0.0;
  /// Deviation with the largest absolute value in each pixel; NaN outside of the region; the first row is at the
  /// largest y.
  std::vector<double> map_nm;
};

/// Inspects the machined surface.
/// \param pixels number of pixels along each side of the map
/// \throw InputError if the programs leave a part of the region uncut
Inspection inspect(const Envelope& envelope, const geometry::FreeformSurface& design, const TurningTool& tool,
                   const InspectedRegion& region, std::size_t pixels);

/// Evaluates one profile across the cuts. It starts at a point and is three feeds long, outwards or along x for a
/// raster. Returns nothing if the profile crosses a border between zones of the design, or if a cut is missing.
std::optional<CuspSample> cusps_at(const Envelope& envelope, const geometry::FreeformSurface& design,
                                   const TurningTool& tool, const geometry::Vec2& at_mm, const geometry::Vec2& outward,
                                   double feed_mm, bool is_spiral);

}  // namespace retrace::fabrication::turning
