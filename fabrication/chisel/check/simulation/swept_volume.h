#pragma once

// Kernel of the exact cutting simulation: models the tool as a convex wedge, and computes the part of a line that a
// straight move of this wedge removes.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/angle.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_motion.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Diamond tool as an infinite convex wedge, in the machine frame relative to its tip. A chisel is bounded by its
/// clearance face, its rake face and two planes at the ends of its edge. A V-shaped tool is bounded by its clearance
/// face and two flanks. Its `edge` is the leading edge, and its width is 0. The tip of a chisel with a rounded edge is
/// the intersection of the edge circle's tangents in the two facets. The rounded edge then sweeps the same two planes
/// as a sharp edge (docs/theory/verification.md).
struct ToolWedge {
  static constexpr std::size_t kMaxSides = 40;
  /// Half-space outward . p <= bound_mm.
  struct Side {
    geometry::Vec3 outward = geometry::Vec3::Zero();
    double bound_mm = 0.0;
  };
  /// Sides of the wedge, at most kMaxSides. Chisel: clearance face, rake face, ends of the edge at +X and -X. V-shaped
  /// tool: clearance face, leading flank, trailing flank, and the trailing flank again as the fourth side. A rounded
  /// nose adds planes that are tangent to its arc.
  std::vector<Side> sides;
  geometry::Vec3 edge = geometry::Vec3::UnitX();                 ///< direction of the edge
  geometry::Vec3 clearance_direction = geometry::Vec3::UnitZ();  ///< upward direction in the clearance face
  geometry::Vec3 rake_direction = geometry::Vec3::UnitZ();       ///< upward direction in the rake face
  std::vector<geometry::Vec3>
      rays;  ///< directions of the wedge's edges upward from its tip or from the ends of its edge
  double half_width_mm = 0.0;
  geometry::Vec3 tip_mm = geometry::Vec3::Zero();  ///< tip relative to the tool reference point; 0 for a 90 degree apex
};

/// Returns the wedge of a chisel.
/// \param apex angle between the two facets that are cut. It determines the edge circle's tangent in the facet that is
///        not plunged
ToolWedge tool_wedge(const Tool& tool, const Machine& machine, Angle apex);

/// Returns the wedge of a V-shaped tool on a machine with a tilting head, in its orientation relative to the facet that
/// is cut.
ToolWedge v_tool_wedge(const Tool& tool, const Machine& machine);

/// Straight move of the tool's tip in one pose. Its end points are given in the machine frame.
struct SweptVolume {
  std::uint32_t pose = 0;
  NcLocation location;
  bool is_rapid = false;
  geometry::Vec3 from_mm = geometry::Vec3::Zero();
  geometry::Vec3 to_mm = geometry::Vec3::Zero();
  std::uint32_t program = 0;  ///< index of the program, from 0
};

/// Returns the half-spaces whose intersection is the body that a wedge sweeps, in the machine frame. The wedge is
/// displaced by t * travel with 0 <= t <= 1, and t is eliminated from the inequalities (Fourier-Motzkin elimination).
/// Some half-spaces may be redundant. The vector `outward` of every half-space has length 1.
std::vector<ToolWedge::Side> swept_sides(const ToolWedge& wedge, const SweptVolume& sweep);

/// Part of a line that a sweep removes, as a range of the line parameter.
struct LineSpan {
  double low = 0.0;
  double high = 0.0;
  std::int32_t line = 0;  ///< NC line of the sweep
};

/// Returns the part of the line point + s * direction (machine frame) inside the convex body that the wedge sweeps. The
/// body is { q + t (to - from) : q in the wedge at `from`, 0 <= t <= 1 }. Eliminating t from its inequalities (Fourier-
/// Motzkin elimination) gives the range of s, which is exact except for rounding errors.
std::optional<LineSpan> swept_span(const ToolWedge& wedge, const SweptVolume& sweep, const geometry::Vec3& point_mm,
                                   const geometry::Vec3& direction);

/// Machined surface along a line that begins inside the material (s = -infinity) and leaves the blank at s = `exit`.
struct LineSurface {
  double top = 0.0;           ///< parameter s above which all material is removed
  std::int32_t top_line = 0;  ///< NC line of the move that produced the surface at `top`; 0: the blank's face
  double lowest = 0.0;        ///< minimum s at which material is removed
  std::int32_t lowest_line = 0;
  double exit = 0.0;  ///< parameter s at which the line leaves the blank
};

/// Returns the machined surface along a line that leaves the blank at s = exit.
/// \param spans removed parts of the line; the function changes their order
LineSurface surface_along(std::vector<LineSpan>& spans, double exit);

}  // namespace retrace::fabrication
