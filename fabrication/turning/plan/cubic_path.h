#pragma once

// Computes the spiral of a turned part for controls that interpolate by cubic polynomials of time: few points, with
// velocities.

#include <vector>

#include "fabrication/program/program.h"
#include "fabrication/turning/plan/path.h"

namespace retrace::fabrication::turning {

/// Axis positions and velocities at the end of a move.
struct CubicPoint {
  PathPoint point;
  Velocities velocities{};
  double highest_mm = 0.0;  ///< maximum Z along the move that ends at this point
};

struct CubicPath {
  std::vector<CubicPoint> points;
  double error_nm = 0.0;  ///< maximum distance, at the tool, between cubic moves and spiral, at the compared points
};

/// Time step of cubic moves, in s. Their durations are whole multiples of the step, which the coarsest control requires
/// (docs/nc_dialects.md).
inline constexpr double kCubicStepS = 1e-3;

/// Computes a spiral of cubic moves that starts and ends at rest. The moves are as long as `options.cubic_error_nm`
/// allows. Cubic moves and spiral are compared at as many points as the straight path would have.
/// \param min_block_s minimum duration of a move
/// \pre options.cubic_error_nm and options.spin_deg_per_s2 are given, and there is no fast tool servo
/// \throw InputError at `where` if the error of the shortest moves is too large, or for more than 2^26 points
CubicPath cubic_path(const geometry::FreeformSurface& surface, const TurningTool& tool, const PathOptions& options,
                     double min_block_s, const InputLocation& where);

}  // namespace retrace::fabrication::turning
