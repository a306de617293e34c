#pragma once

// The tool path of freeform turning with compensation of the nose radius, and speed, acceleration and jerk of its axes.

#include <cstddef>
#include <vector>

#include "core/error.h"
#include "fabrication/turning/path_options.h"
#include "fabrication/turning/plan/touch_map.h"
#include "fabrication/turning/tool.h"
#include "geometry/surface/freeform_surface.h"

namespace retrace::fabrication::turning {

/// Words of the machine at a point of the path: position of the tool's lowest edge point, and the spindle.
struct PathPoint {
  double x_mm = 0.0;
  double y_mm = 0.0;
  double z_mm = 0.0;
  double c_deg = 0.0;
  double seconds = 0.0;   ///< since the point before it; 0 for the first
  double servo_mm = 0.0;  ///< of z, what a fast tool servo adds to the slide
};

/// Of a path, at most.
inline constexpr std::size_t kMostPathPoints = std::size_t{1} << 26;

/// Points that are cut without lifting the tool.
using Pass = std::vector<PathPoint>;

/// Frame of the machine: X to the side on which the tool stands, Z along the spindle, out of the part. C rises and
/// turns the part by the right hand about Z, so that the tool cuts towards -Y and, in the part, against the sense of
/// angles. A skew of a spiral puts the tool to X = r cos(skew), Y = -r sin(skew), that of a raster turns the part to
/// C = -skew: the rake face stays square to Y. Nose radius
/// compensation is along Z alone: the tool is raised by what it would otherwise cut too much, so that X, Y and C stay
/// smooth. \throw InputError at `where` for a path of more than 2^26 points
std::vector<Pass> make_path(const geometry::FreeformSurface& surface, const TurningTool& tool,
                            const PathOptions& options, const InputLocation& where);

/// Height of the tool's lowest edge point over (x, y) of the part at which its edge touches the surface: the maximum
/// over the sharp arc of z at an edge point less the point's own height. The edge lies along `across` and leans against
/// the cut's direction by the rake.
class NoseCompensation {
 public:
  /// \param map where one touching place is known to be the only one; elsewhere the whole arc is searched for others
  NoseCompensation(const geometry::FreeformSurface& surface, const TurningTool& tool, TouchMap map = {});

  /// \param across, cut unit vectors in the part \param start angle on the nose where the search starts; where it ends
  double height_mm(double x_mm, double y_mm, const geometry::Vec2& across, const geometry::Vec2& cut,
                   double& start_rad) const;

  /// End of the sharp arc, to both sides.
  double end_rad() const { return end_rad_; }

 private:
  /// What Newton's rule finds from an angle.
  struct Touch {
    double height_mm = 0.0;
    bool is_found = false;  ///< a maximum, or the arc's end; not just the last step
  };
  Touch searched(double x_mm, double y_mm, const geometry::Vec2& across, const geometry::Vec2& cut,
                 double& angle) const;
  double sampled(double x_mm, double y_mm, const geometry::Vec2& across, const geometry::Vec2& cut, double angle) const;

  const geometry::FreeformSurface& surface_;
  TouchMap map_;
  double radius_mm_;
  double sin_rake_;
  double cos_rake_;
  double end_rad_;  ///< of the sharp arc, to both sides
};

/// What an axis does over a path, by difference quotients of its positions.
struct AxisFigures {
  double low_mm = 0.0;
  double high_mm = 0.0;
  double speed_mm_per_s = 0.0;
  double acceleration_mm_per_s2 = 0.0;
  double jerk_mm_per_s3 = 0.0;
  double acceleration_jump_mm_per_s2 = 0.0;  ///< largest change of acceleration from one point to the next
};

/// One axis at one point, for tables and plots.
struct AxisState {
  double time_s = 0.0;
  double position_mm = 0.0;
  double speed_mm_per_s = 0.0;
  double acceleration_mm_per_s2 = 0.0;
  double jerk_mm_per_s3 = 0.0;
};

/// 0, 1, 2: X, Y, Z as programmed; 3: the servo's share.
std::vector<AxisState> axis_states(const Pass& pass, int axis);
AxisFigures axis_figures(const std::vector<Pass>& passes, int axis);

double path_seconds(const std::vector<Pass>& passes);

}  // namespace retrace::fabrication::turning
