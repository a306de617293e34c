#pragma once

// Computes the tool path of freeform turning with compensation of the nose radius, and speed, acceleration and jerk of
// its axes.

#include <cstddef>
#include <vector>

#include "core/error.h"
#include "fabrication/turning/path_options.h"
#include "fabrication/turning/plan/single_contact_map.h"
#include "fabrication/turning/tool.h"
#include "geometry/surface/freeform_surface.h"

namespace retrace::fabrication::turning {

/// Axis positions at a point of the path. X, Y and Z are the position of the lowest point of the tool's edge.
struct PathPoint {
  double x_mm = 0.0, y_mm = 0.0, z_mm = 0.0;
  double c_deg = 0.0;
  double seconds = 0.0;   ///< time since the previous point; 0 for the first point
  double servo_mm = 0.0;  ///< part of z that a fast tool servo adds to the slide
};

/// Maximum number of points of a path.
inline constexpr std::size_t kMaxPathPoints = std::size_t{1} << 26;

/// Sequence of points that are cut without lifting the tool.
using Pass = std::vector<PathPoint>;

/// Computes the path of the tool. Machine frame: X towards the side of the tool, Z along the spindle and out of the
/// part. C increases and rotates the part about Z by the right-hand rule. The tool therefore cuts towards -Y, and the
/// angles of its positions in the part decrease. With a skew, the tool of a spiral is at X = r cos(skew), Y = -r
/// sin(skew), and a raster is cut at C = -skew. The rake face remains perpendicular to Y. The nose radius is
/// compensated only along Z, by raising the tool, so that X, Y and C are smooth.
/// \throw InputError at `where` for a path of more than 2^26 points
std::vector<Pass> make_path(const geometry::FreeformSurface& surface, const TurningTool& tool,
                            const PathOptions& options, const InputLocation& where);

/// Computes the height of the lowest point of the tool's edge when the edge touches the surface. This height is the
/// maximum, over the sharp arc, of the surface height at an edge point minus the height of this point above the lowest
/// point. The edge is along `across` and is inclined by the rake against the direction of the cut.
class NoseCompensation {
 public:
  /// \param map positions at which there is only one point of contact. At other positions, the whole arc is searched
  NoseCompensation(const geometry::FreeformSurface& surface, const TurningTool& tool, SingleContactMap map = {});

  /// Returns the height at a position of the part.
  /// \param across unit vector along the edge, in the part
  /// \param cut unit vector along the cut, in the part
  /// \param start_rad angle on the nose at which the search starts; receives the angle of the point of contact
  double height_mm(double x_mm, double y_mm, const geometry::Vec2& across, const geometry::Vec2& cut,
                   double& start_rad) const;

  /// Returns the angle of the ends of the sharp arc, on both sides.
  double end_rad() const { return end_rad_; }

 private:
  /// Result of a search by Newton's method.
  struct SearchResult {
    double height_mm = 0.0;
    bool is_found = false;  ///< true if the search ended at a maximum or at an end of the arc
  };
  SearchResult searched(double x_mm, double y_mm, const geometry::Vec2& across, const geometry::Vec2& cut,
                        double& angle) const;
  double sampled(double x_mm, double y_mm, const geometry::Vec2& across, const geometry::Vec2& cut, double angle) const;

  const geometry::FreeformSurface& surface_;
  SingleContactMap map_;
  double radius_mm_;
  double sin_rake_;
  double cos_rake_;
  double end_rad_;  ///< angle of the ends of the sharp arc, on both sides
};

/// Range of the positions of an axis over a path, and maxima of its speed, acceleration and jerk. The maxima are
/// computed from finite differences of the positions.
struct AxisFigures {
  double low_mm = 0.0, high_mm = 0.0;
  double speed_mm_per_s = 0.0;
  double acceleration_mm_per_s2 = 0.0;
  double jerk_mm_per_s3 = 0.0;
  double acceleration_jump_mm_per_s2 = 0.0;  ///< largest change of acceleration from one point to the next
};

/// Motion of one axis at one point, for tables and plots.
struct AxisState {
  double time_s = 0.0, position_mm = 0.0;
  double speed_mm_per_s = 0.0;
  double acceleration_mm_per_s2 = 0.0;
  double jerk_mm_per_s3 = 0.0;
};

/// Computes the motion of an axis over a pass.
/// \param axis 0, 1, 2: X, Y, Z as programmed; 3: the part of the servo
std::vector<AxisState> axis_states(const Pass& pass, int axis);
AxisFigures axis_figures(const std::vector<Pass>& passes, int axis);

double path_seconds(const std::vector<Pass>& passes);

}  // namespace retrace::fabrication::turning
