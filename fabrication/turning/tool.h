#pragma once

// Turning tools as mounted. Computes the clearance of the flank and the sharp arc of the nose that a surface requires.

#include <optional>
#include <vector>

#include "core/angle.h"
#include "core/warning.h"
#include "fabrication/turning/path_options.h"
#include "geometry/surface/freeform_surface.h"
#include "geometry/vec.h"

namespace retrace::fabrication::turning {

/// Diamond tool with a round nose and a conical flank, as mounted.
struct TurningTool {
  double nose_radius_mm = 0.2;
  double window_deg = 120.0;    ///< angle of the sharp arc (sweep), symmetric about the axis of the tool
  double clearance_deg = 12.0;  ///< clearance angle of the conical flank, relative to the normal of the rake face
  double rake_deg = 0.0;        ///< rake angle; positive: the rake face is inclined backwards
  double skew_deg = 0.0;        ///< rotation of the tool about its shank, from the cutting direction outwards
};

/// Range of rake and skew angles that gave a good finish in published tests (A. Sohn and N. Naples, Single-point
/// diamond turning of features with large azimuthal slope, Fig. 10).
inline constexpr double kMinTestedRakeDeg = -45.0;
inline constexpr double kMaxTestedRakeDeg = 18.0;
inline constexpr double kTestedSkewDeg = 60.0;

/// Returns warnings if rake or skew is outside of the tested range.
Warnings tool_warnings(const TurningTool& tool);

/// Directions of the tool, in cylindrical components of the part: outward, along the cut, up.
struct ToolFrame {
  geometry::Vec3 rake_normal;  ///< vector t: normal out of the rake face, in the direction of the cut
  geometry::Vec3 across;       ///< vector s: direction along the edge at its lowest point
  geometry::Vec3 up;           ///< vector u: direction from the lowest point to the nose's centre, in the rake face
};
ToolFrame tool_frame(const TurningTool& tool);

/// Requirements on the tool at a point of contact.
struct Contact {
  double clearance_needed_deg = 0.0;  ///< minimum conical clearance angle: asin(n . t)
  double window_angle_deg = 0.0;  ///< angle of the point of contact on the nose, from its lowest point towards `across`
};

/// Compares the surface normal n with the rake normal t. The line of the flank behind the point of contact has the
/// direction -t cos a + m sin a, where m is the component of n in the rake face. It is above the surface if
/// n . t <= sin a.
/// \param normal unit normal out of the material, in the components of ToolFrame
Contact contact_of(const ToolFrame& frame, const geometry::Vec3& normal);

/// Returns the maximum slope along the cut that a tool with a given clearance can follow: asin(sin a / cos skew) (Sohn,
/// Naples, eq. 1). It is the result of contact_of() for zero rake and a surface without radial slope.
/// \pre sin a <= cos skew
Angle clearance_along_cut(Angle clearance, Angle skew);

/// Maximum requirements on the tool over a surface.
struct ClearanceFigures {
  double clearance_needed_deg = -90.0;
  geometry::Vec2 clearance_at_mm = geometry::Vec2::Zero();
  double window_needed_deg = 0.0;  ///< twice the largest angle on the nose
  geometry::Vec2 window_at_mm = geometry::Vec2::Zero();

  bool clears(const TurningTool& tool) const {
    return clearance_needed_deg <= tool.clearance_deg && window_needed_deg <= tool.window_deg;
  }
};

/// Point of contact on the part, and the slopes of the surface in the outward and the cutting direction.
struct SlopeSample {
  geometry::Vec2 at_mm = geometry::Vec2::Zero();
  double radial = 0.0;  ///< slope dz/dr, or slope across the lines of a raster
  double along = 0.0;   ///< slope along the cut
};

/// Returns the slopes of the surface along a path, sampled on circles or lines.
std::vector<SlopeSample> slopes_along(const geometry::FreeformSurface& surface, const PathOptions& options);

ClearanceFigures clearance_figures(const TurningTool& tool, const std::vector<SlopeSample>& samples);

/// Returns the skew closest to 0, within +-`max_deg`, with which the tool clears all samples. The resolution is 0.01
/// degrees. Returns nothing if there is no such skew.
std::optional<double> min_skew_deg(TurningTool tool, const std::vector<SlopeSample>& samples, double max_deg);

}  // namespace retrace::fabrication::turning
