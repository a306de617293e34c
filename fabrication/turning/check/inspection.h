#pragma once

// Inspects what turning programs leave: cusps against their closed form, form error, interference, rms.

#include <optional>
#include <vector>

#include "fabrication/turning/check/envelope.h"
#include "geometry/surface/freeform_surface.h"

namespace retrace::fabrication::turning {

/// Turns or lines next to the rim and the centre that have no neighbours or turn on the spot: the surface is not judged
/// there.
inline constexpr double kRimFeeds = 4.0;

/// The region that is inspected: a circle's or a rectangle's, without the rim that neighbouring cuts do not finish.
struct InspectedRegion {
  bool is_round = true;
  double radius_mm = 1.0;
  double half_width_mm = 1.0;   ///< along the lines of a raster (y)
  double half_height_mm = 1.0;  ///< across them (x)
  double feed_mm = 5e-3;
};

/// A short profile across the cuts.
struct CuspSample {
  geometry::Vec2 at_mm = geometry::Vec2::Zero();
  double scallop_nm = 0.0;    ///< mean height of its cusps above the valleys beside them, square to the surface
  double predicted_nm = 0.0;  ///< the closed form there; 0 where the curvature changes too much for it
  double valley_nm = 0.0;     ///< the deepest or highest valley's deviation from the design: the form error
};

/// What programs leave against the design. Deviations are square to the surface, positive where material is left.
struct Inspection {
  std::vector<CuspSample> cusps;
  std::size_t compared = 0;      ///< of them, with a closed form
  double form_error_nm = 0.0;    ///< largest |valley|
  double interference_nm = 0.0;  ///< deepest cut below the design
  double scallop_nm = 0.0;       ///< mean of the cusps
  double scallop_most_nm = 0.0;
  double scallop_ratio_low = 0.0;  ///< of simulated by predicted heights, over those
  double scallop_ratio_high = 0.0;
  double rms_nm = 0.0;      ///< about the design, at a place drawn in each pixel of the map
  std::size_t columns = 0;  ///< of the map, a square round the region; x rises along a row
  double map_width_mm = 0.0;
  std::vector<double> map_nm;  ///< greatest by size in each pixel; not a number outside; rows from the largest y down
};

/// \param pixels of the map on a side \throw InputError if the programs leave a place of the region uncut
Inspection inspect(const Envelope& envelope, const geometry::FreeformSurface& design, const TurningTool& tool,
                   const InspectedRegion& region, std::size_t pixels);

/// One profile across the cuts from a place outwards (raster: along x), three feeds long. Nothing where the design
/// changes from one zone to another along it, or a cut is missing.
std::optional<CuspSample> cusps_at(const Envelope& envelope, const geometry::FreeformSurface& design,
                                   const TurningTool& tool, const geometry::Vec2& at_mm, const geometry::Vec2& outward,
                                   double feed_mm, bool is_spiral);

}  // namespace retrace::fabrication::turning
