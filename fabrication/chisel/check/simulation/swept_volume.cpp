#include "fabrication/chisel/check/simulation/swept_volume.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "fabrication/job/v_tool.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Maximum gap between two removed parts of a line that are considered connected. It is far below 1 nm, and far above
/// the rounding errors at 1 m.
constexpr double kTouchMm = 1e-10;

/// Inequality s * a <= c + t * b for the line parameter s and the travel parameter t.
struct Inequality {
  double a;  // no default values, because large arrays of this type are mostly unused
  double b;
  double c;
};

/// Reduces the interval [low, high] of s by the inequality s * a <= c.
/// \return true if the interval is not empty
bool narrow(double a, double c, double& low, double& high) {
  if (a > 0.0)
    high = std::min(high, c / a);
  else if (a < 0.0)
    low = std::max(low, c / a);
  else
    return c >= 0.0;
  return low < high;
}

}  // namespace

ToolWedge tool_wedge(const Tool& tool, const Machine& machine, Angle apex) {
  const Vec3 x = edge_direction(machine);
  const Vec3 up = tool_rotation(machine) * machine.z.direction.value;
  const Vec3 z = (up - x * x.dot(up)).normalized();
  const Vec3 y = z.cross(x);
  const double clearance = Angle::from_deg(tool.clearance_deg).rad();
  const double rake = Angle::from_deg(tool.clearance_deg + tool.wedge_deg).rad();
  ToolWedge wedge;
  wedge.edge = x;
  wedge.half_width_mm = 0.5 * tool.width_mm;
  // The tool reference point is the intersection of the edge circle's vertical tangent (the plunged facet) and its
  // horizontal tangent. The tangent in the other facet is inclined to the vertical by the apex angle. It intersects the
  // vertical tangent below or above the reference point.
  const double radius_mm = 1e-3 * tool.edge_radius_um;
  const double below_mm = radius_mm * (1.0 - std::sin(apex.rad()) + std::cos(apex.rad())) / std::sin(apex.rad());
  wedge.tip_mm = -below_mm * plunged_normal(machine).cross(x);
  wedge.clearance_direction = -std::sin(clearance) * y + std::cos(clearance) * z;
  wedge.rake_direction = -std::sin(rake) * y + std::cos(rake) * z;
  wedge.rays = {wedge.clearance_direction, wedge.rake_direction};
  wedge.sides = {{std::cos(clearance) * y + std::sin(clearance) * z, 0.0},
                 {-std::cos(rake) * y - std::sin(rake) * z, 0.0},
                 {x, wedge.half_width_mm},
                 {-x, wedge.half_width_mm}};
  return wedge;
}

ToolWedge v_tool_wedge(const Tool& tool, const Machine& machine) {
  // Frame of the facet that is cut: its normal, and its two dihedral edges, which are at 45 degrees to its upward
  // direction.
  const Vec3 normal = plunged_normal(machine);
  const Vec3 level = (horizontal_direction(machine) - normal * normal.dot(horizontal_direction(machine))).normalized();
  const Vec3 up = level.cross(normal);
  const Vec3 first = (up - level).normalized();
  const Vec3 second = (up + level).normalized();
  const VToolEdges edges = v_tool_edges(tool);
  const auto placed = [&](const Vec3& e) -> Vec3 { return e.x() * first + e.y() * second + e.z() * normal; };
  const Vec3 leading = placed(edges.leading);
  const Vec3 trailing = placed(edges.trailing);
  const Vec3 spine = placed(edges.spine);
  const auto side = [](const Vec3& a, const Vec3& b, const Vec3& within) {
    const Vec3 across = a.cross(b).normalized();
    return ToolWedge::Side{across.dot(within) > 0.0 ? Vec3(-across) : across, 0.0};
  };
  ToolWedge wedge;
  wedge.edge = leading;
  wedge.clearance_direction = trailing;
  wedge.rake_direction = spine;
  wedge.rays = {leading, trailing, spine};
  const ToolWedge::Side flank = side(trailing, spine, leading);
  wedge.sides = {side(leading, trailing, spine), side(leading, spine, trailing), flank, flank};
  return wedge;
}

std::optional<LineSpan> swept_span(const ToolWedge& wedge, const SweptVolume& sweep, const Vec3& point_mm,
                                   const Vec3& direction) {
  const Vec3 travel = sweep.to_mm - sweep.from_mm;
  const Vec3 start = point_mm - sweep.from_mm;
  // An inequality with b > 0 is a lower bound of t, and one with b < 0 is an upper bound. The first bounds are 0 <= t
  // and t <= 1.
  std::array<Inequality, ToolWedge::kMaxSides + 1> lower;
  std::array<Inequality, ToolWedge::kMaxSides + 1> upper;
  lower[0] = {0.0, 1.0, 0.0};
  upper[0] = {0.0, -1.0, 1.0};
  std::size_t lowers = 1;
  std::size_t uppers = 1;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  for (const ToolWedge::Side& side : wedge.sides) {
    const Inequality i = {side.outward.dot(direction), side.outward.dot(travel),
                          side.bound_mm - side.outward.dot(start)};
    if (i.b > 0.0)
      lower[lowers++] = i;
    else if (i.b < 0.0)
      upper[uppers++] = i;
    else if (!narrow(i.a, i.c, low, high))
      return std::nullopt;
  }
  for (std::size_t l = 0; l < lowers; ++l)
    for (std::size_t u = 0; u < uppers; ++u) {
      const Inequality& below = lower[l];
      const Inequality& above = upper[u];
      if (!narrow(-above.b * below.a + below.b * above.a, -above.b * below.c + below.b * above.c, low, high))
        return std::nullopt;
    }
  return LineSpan{low, high, sweep.location.line};
}

std::vector<ToolWedge::Side> swept_sides(const ToolWedge& wedge, const SweptVolume& sweep) {
  // Sides with a smaller outward displacement per unit of t are considered parallel to the travel.
  constexpr double kLevel = 1e-15;
  struct Bound {
    ToolWedge::Side side;
    double rate = 0.0;  ///< outward displacement of the side per unit of t
  };
  const Vec3 travel = sweep.to_mm - sweep.from_mm;
  std::vector<Bound> lower = {{{Vec3::Zero(), 0.0}, 1.0}};
  std::vector<Bound> upper = {{{Vec3::Zero(), 1.0}, -1.0}};
  std::vector<ToolWedge::Side> sides;
  for (std::size_t k = 0; k < wedge.sides.size(); ++k) {
    const ToolWedge::Side& side = wedge.sides[k];
    if (k > 0 && side.outward == wedge.sides[k - 1].outward && side.bound_mm == wedge.sides[k - 1].bound_mm) continue;
    const ToolWedge::Side placed{side.outward, side.bound_mm + side.outward.dot(sweep.from_mm)};
    const double rate = side.outward.dot(travel);
    if (std::abs(rate) <= kLevel)
      sides.push_back(placed);
    else
      (rate > 0.0 ? lower : upper).push_back({placed, rate});
  }
  for (const Bound& below : lower)
    for (const Bound& above : upper) {
      const Vec3 outward = below.rate * above.side.outward - above.rate * below.side.outward;
      const double length = outward.norm();
      if (length <= kLevel) continue;
      sides.push_back(
          {outward / length, (below.rate * above.side.bound_mm - above.rate * below.side.bound_mm) / length});
    }
  return sides;
}

LineSurface surface_along(std::vector<LineSpan>& spans, double exit) {
  std::sort(spans.begin(), spans.end(), [](const LineSpan& a, const LineSpan& b) { return a.high > b.high; });
  LineSurface surface{exit, 0, exit, 0, exit};
  bool is_open = true;
  for (const LineSpan& span : spans) {
    if (span.low < surface.lowest) {
      surface.lowest = span.low;
      surface.lowest_line = span.line;
    }
    is_open = is_open && span.high >= surface.top - kTouchMm;
    if (!is_open || span.low >= surface.top) continue;
    surface.top = span.low;
    surface.top_line = span.line;
  }
  return surface;
}

}  // namespace retrace::fabrication
