#pragma once

// Turning tools as mounted, and whether they clear a surface: clearance of the flank and sharp arc of the nose at every
// slope.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/angle.h"
#include "core/warning.h"
#include "fabrication/turning/path_options.h"
#include "geometry/surface/freeform_surface.h"
#include "geometry/vec.h"

namespace retrace::fabrication::turning {

/// A diamond with a round nose and a conical flank, as it is mounted.
struct TurningTool {
  double nose_radius_mm = 0.2;
  double window_deg = 120.0;    ///< angle of the arc that is sharp (its sweep), symmetric about the tool's axis
  double clearance_deg = 12.0;  ///< of the conical flank, against the normal of the rake face
  double rake_deg = 0.0;        ///< positive: the rake face leans back
  double skew_deg = 0.0;        ///< turn of the tool about its shank, from the cutting direction towards outwards
};

/// What A. Sohn and N. Naples tried with good finish (Single-point diamond turning of features with large azimuthal
/// slope, Fig. 10).
inline constexpr double kTriedRakeLowDeg = -45.0;
inline constexpr double kTriedRakeHighDeg = 18.0;
inline constexpr double kTriedSkewDeg = 60.0;

/// Remarks on rake and skew outside of what was tried.
Warnings tool_warnings(const TurningTool& tool);

/// Directions of the tool in cylindrical components of the part: outward, along the cut, up.
struct ToolFrame {
  geometry::Vec3 rake_normal;  ///< t, out of the rake face, in the direction of the cut
  geometry::Vec3 across;       ///< s, along the edge at its lowest point
  geometry::Vec3 up;           ///< u = from the lowest point to the middle of the nose, in the rake face
};
ToolFrame tool_frame(const TurningTool& tool);

/// How a tool stands to a surface where it touches it.
struct Contact {
  double clearance_needed_deg = 0.0;  ///< asin(n . t): the conical clearance must not be less
  double window_angle_deg = 0.0;      ///< of the touching point on the nose, from its lowest point; sign as `across`
};

/// The vector test: the surface's normal n against the rake normal t. The flank's line behind the touching point,
/// -t cos a + m sin a, m the part of n in the rake face, stays above the surface as long as n . t <= sin a.
/// \param normal unit, out of the material, in the same components as ToolFrame
Contact contact_of(const ToolFrame& frame, const geometry::Vec3& normal);

/// asin(sin a / cos skew): the steepest fall along the cut that a tool with that clearance can follow (Sohn, Naples,
/// eq. 1): the vector test for zero rake and a surface without radial slope. \pre sin a <= cos skew
Angle clearance_along_cut(Angle clearance, Angle skew);

/// The largest of both over a surface.
struct ClearanceFigures {
  double clearance_needed_deg = -90.0;
  geometry::Vec2 clearance_at_mm = geometry::Vec2::Zero();
  double window_needed_deg = 0.0;  ///< twice the largest angle on the nose
  geometry::Vec2 window_at_mm = geometry::Vec2::Zero();

  bool clears(const TurningTool& tool) const {
    return clearance_needed_deg <= tool.clearance_deg && window_needed_deg <= tool.window_deg;
  }
};

/// Where a tool touches: a place of the part, its outward and cutting direction, the surface's slopes.
struct SlopeSample {
  geometry::Vec2 at_mm = geometry::Vec2::Zero();
  double radial = 0.0;  ///< dz/dr, or across the raster's lines
  double along = 0.0;   ///< dz along the cut
};

/// The slopes that a tool meets along a path: every place once, sampled on circles or lines.
std::vector<SlopeSample> slopes_along(const geometry::FreeformSurface& surface, const PathOptions& options);

ClearanceFigures clearance_figures(const TurningTool& tool, const std::vector<SlopeSample>& samples);

/// The skew nearest to 0 within +-most_deg with which the tool clears all samples, to 0.01 degrees; nothing if none
/// does.
std::optional<double> least_skew_deg(TurningTool tool, const std::vector<SlopeSample>& samples, double most_deg);

}  // namespace retrace::fabrication::turning
