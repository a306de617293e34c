#pragma once

// Selects the moves of the tool that determine the machined surface along each line of a family of parallel lines. Most
// lines cross the cuts of many layers, but only a few of these cuts determine the surface.

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "fabrication/chisel/check/simulation/swept_volume.h"

namespace retrace::fabrication {

/// Body that a move sweeps, as half-spaces in the machine frame.
struct SweptBody {
  const SweptVolume* move = nullptr;
  std::vector<ToolWedge::Side> sides;
};

/// Parallel lines origin + slant * up + s * direction in the workpiece frame, where s is the parameter of a line.
struct LineFamily {
  geometry::Vec3 origin_mm = geometry::Vec3::Zero();
  geometry::Vec3 up = geometry::Vec3::UnitX();
  geometry::Vec3 direction = geometry::Vec3::UnitZ();
  std::vector<double> slants_mm;  ///< positions of the lines, in ascending order
  std::vector<double> exits_mm;   ///< parameter s at which each line leaves the blank
  double reach_mm = 0.0;          ///< maximum absolute value of s at which moves are considered
};

/// Function that measures the line with the given index. Its second argument contains the selected moves.
using MeasureLine = std::function<void(std::size_t line, std::span<const SweptVolume* const> moves)>;

/// Calls `measure` for each line in ascending order, with moves that determine the result of surface_along(). A move is
/// omitted if it does not cross the line. It is also omitted if another move cuts the line deeper and is open up to the
/// blank's face. The order of the moves is kept.
///
/// The function halves the family recursively. A move that is omitted for a whole part of the family is not considered
/// for the lines of this part. The time is therefore not proportional to the product of the numbers of lines and moves.
/// \param poses machine_from_workpiece for each SweptVolume::pose
void for_each_line(const LineFamily& lines, std::span<const SweptBody* const> bodies,
                   std::span<const RigidMotion> poses, const MeasureLine& measure);

}  // namespace retrace::fabrication
