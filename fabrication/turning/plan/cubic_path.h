#pragma once

// The spiral of a turned part for controls that join points by cubics over time: few points, with velocities.

#include <vector>

#include "fabrication/program/program.h"
#include "fabrication/turning/plan/path.h"

namespace retrace::fabrication::turning {

/// Where the axes are and how fast they go, at the end of a move.
struct CubicPoint {
  PathPoint place;
  Velocities velocities{};
  double highest_mm = 0.0;  ///< of Z along the move that ends here
};

struct CubicPath {
  std::vector<CubicPoint> points;
  double error_nm = 0.0;  ///< largest distance at the tool between cubics and spiral where both were compared
};

/// Times of such moves are whole multiples of this: what the coarsest of these controls takes (docs/nc_dialects.md).
inline constexpr double kCubicStepS = 1e-3;

/// A spiral from a standstill to a standstill, its moves as long as the cubics of the axes stay within
/// `options.cubic_error_nm` of it. Both are compared as densely as the straight path would have points.
/// \param least_block_s no move is shorter
/// \pre options.cubic_error_nm and options.spin_deg_per_s2; the slide alone makes the motion
/// \throw InputError at `where` if the shortest moves are not within it, or for more than 2^26 points
CubicPath cubic_path(const geometry::FreeformSurface& surface, const TurningTool& tool, const PathOptions& options,
                     double least_block_s, const InputLocation& where);

}  // namespace retrace::fabrication::turning
