#pragma once

// The tool as a convex wedge, and what it removes along a line while it moves straight: the kernel of the exact cutting
// simulation.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/angle.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_motion.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// The diamond as an endless wedge, in the frame of the machine relative to its tip. Of a chisel: between clearance
/// face and rake face, and between two planes at the ends of its edge. Of a V: between its clearance face and two
/// flanks, with the leading edge for its edge, of no width. A chisel's tip is the crossing of those two tangents of the
/// edge's circle that lie in the facets, so that a rounded edge sweeps the same two planes as the sharp one
/// (docs/theory/verification.md).
struct ToolWedge {
  static constexpr std::size_t kMostSides = 40;
  /// inward . p <= bound
  struct Side {
    geometry::Vec3 outward = geometry::Vec3::Zero();
    double bound_mm = 0.0;
  };
  /// Clearance face, rake face, ends of the edge at +X and -X; of a V clearance face, leading and trailing flank, and
  /// the trailing one again; of one with a nose the planes that touch it too. At most kMostSides.
  std::vector<Side> sides;
  geometry::Vec3 edge = geometry::Vec3::UnitX();
  geometry::Vec3 clearance_direction = geometry::Vec3::UnitZ();  ///< up the clearance face
  geometry::Vec3 rake_direction = geometry::Vec3::UnitZ();       ///< up the rake face
  std::vector<geometry::Vec3> rays;  ///< edges of the wedge that go up from its tip, or from the ends of its edge
  double half_width_mm = 0.0;
  geometry::Vec3 tip_mm = geometry::Vec3::Zero();  ///< from the tool reference point; 0 at an apex of 90 degrees
};

/// \param apex included angle of the two facets that are cut; the other tangent is the one in the facet that the tool
/// does not plunge
ToolWedge tool_wedge(const Tool& tool, const Machine& machine, Angle apex);

/// The V-shaped tool of a machine whose head tilts, as it stands to the facet that it cuts.
ToolWedge v_tool_wedge(const Tool& tool, const Machine& machine);

/// A straight move of the tool's tip in one pose, as points of the machine frame.
struct SweptVolume {
  std::uint32_t pose = 0;
  NcPlace place;
  bool is_rapid = false;
  geometry::Vec3 from_mm = geometry::Vec3::Zero();
  geometry::Vec3 to_mm = geometry::Vec3::Zero();
  std::uint32_t program = 0;  ///< which of those that are run, from 0
};

/// The half-spaces whose intersection is the body that a wedge sweeps, in the frame of the machine: those of the wedge
/// at t travel, 0 <= t <= 1, of which t is eliminated (Fourier-Motzkin). Some may be redundant; of those that bound it
/// `outward` has length 1.
std::vector<ToolWedge::Side> swept_sides(const ToolWedge& wedge, const SweptVolume& sweep);

/// Part of a line that a sweep removes.
struct LineSpan {
  double low = 0.0;
  double high = 0.0;
  std::int32_t line = 0;  ///< NC line of the sweep
};

/// The part of the line point + s direction (in the frame of the machine) within the convex body that the wedge sweeps.
/// That body is { q + t (to - from) : q in the wedge at `from`, 0 <= t <= 1 }, so the part is a linear programme in s
/// and t, of which t is eliminated (Fourier-Motzkin): exact to rounding.
std::optional<LineSpan> swept_span(const ToolWedge& wedge, const SweptVolume& sweep, const geometry::Vec3& point_mm,
                                   const geometry::Vec3& direction);

/// What is left along a line from far inside the material (s = -infinity) to the outside at `exit`.
struct LineSurface {
  double top = 0.0;           ///< s above which everything is removed
  std::int32_t top_line = 0;  ///< NC line of the move that made the surface there; 0: the blank's face
  double lowest = 0.0;        ///< least s that was removed
  std::int32_t lowest_line = 0;
  double exit = 0.0;  ///< where the line leaves the blank
};

/// The surface along a line that leaves the blank at s = exit. `spans` is used up as working space.
LineSurface surface_along(std::vector<LineSpan>& spans, double exit);

}  // namespace retrace::fabrication
