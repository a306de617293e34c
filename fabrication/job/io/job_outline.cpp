#include "fabrication/job/io/job_outline.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/number_format.h"
#include "core/schema/access.h"
#include "core/schema/conditions.h"
#include "geometry/elements/part_spec.h"
#include "geometry/io/element_keys.h"
#include "geometry/outline/outline.h"
#include "geometry/outline/plan_region.h"

namespace retrace::fabrication {
namespace {

using namespace schema;
using geometry::ArrayLayout;

/// Maximum relative difference between the lengths of an array and the size of its outline that counts as rounding.
constexpr double kSameLength = 1e-9;
/// Maximum number of corners of each border, maximum number of borders, and maximum total number of polygon corners
/// that replace all borders of an outline.
constexpr std::size_t kMaxBorderCorners = 2000;
constexpr std::size_t kMaxBorders = 101;
constexpr double kMaxPolygonCorners = 2000.0;
constexpr double kMaxBulge = 100.0;

Value get_corners(const JobBorder& border) {
  std::vector<std::vector<double>> corners;
  for (const geometry::OutlineSide& side : border.sides)
    corners.push_back({side.from_mm.x(), side.from_mm.y(), side.bulge});
  return corners;
}
void set_corners(JobBorder& border, const Value& value) {
  border.sides.clear();
  const auto& corners = std::get<std::vector<std::vector<double>>>(value);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::vector<double>& from = corners[k];
    const std::vector<double>& to = corners[(k + 1) % corners.size()];
    border.sides.push_back({{from[0], from[1]}, {to[0], to[1]}, from[2]});
  }
}

constexpr Condition kOfArraysOnly[] = {is_not("array.arrangement", only(geometry::kArrangementWords, "single"))};
constexpr Row kBorderRows[] = {
    {"corners_mm", NumberRows{3, {.low = -1e4, .high = 1e4}, 2, kMaxBorderCorners, "corners"}, kRequired,
     "`[[x, y, bulge], ...]`: corners of the border in their order, in x and y of the part. `bulge` describes the side "
     "from this corner to the next: 0 for a straight side, otherwise the tangent of a quarter of the arc's angle, "
     "positive if the arc runs counter-clockwise.",
     access_by<get_corners, set_corners>}};
constexpr Row kOutlineRows[] = {{"tolerance_mm", Number{{.low = 1e-6, .high = 1e4}}, 0.005,
                                 "Maximum distance between an arc and the sides of the polygon that replaces it.",
                                 access<&JobOutline::tolerance_mm>}};

constexpr Child kOutline = {
    [](const void* job) -> std::size_t { return static_cast<const Job*>(job)->outline ? 1 : 0; },
    [](const void* job, std::size_t) -> const void* { return &*static_cast<const Job*>(job)->outline; },
    [](void* job) -> void* { return &static_cast<Job*>(job)->outline.emplace(); }};
constexpr Table kOutlineTables[] = {
    {.name = "borders",
     .meaning = "Borders of the outline: the outer border, followed by the borders of holes. At most 101 borders are "
                "allowed.",
     .rows = kBorderRows,
     .child = children<&JobOutline::borders>,
     .presence = Presence::list}};

/// Checks the borders of the outline, and checks that the lengths of the array are the size of the outline.
void check_borders(const Job& job, const Refuse& refuse) {
  double corners = 0.0;
  for (std::size_t k = 0; k < job.outline->borders.size(); ++k) {
    const std::vector<geometry::OutlineSide>& sides = job.outline->borders[k].sides;
    for (const geometry::OutlineSide& side : sides)
      if (std::abs(side.bulge) > kMaxBulge)
        refuse(path_in(path_of_entry("outline.borders", k), "corners_mm"),
               fmt::format("must have bulges from -{0} to {0}, got {1}", shortest(kMaxBulge), shortest(side.bulge)));
    for (std::size_t i = 0; i < sides.size(); ++i)
      if (sides[i].from_mm == sides[i].to_mm)
        refuse(path_in(path_of_entry("outline.borders", k), "corners_mm"),
               fmt::format("must contain each corner only once, got [{}, {}] twice in succession",
                           shortest(sides[i].from_mm.x()), shortest(sides[i].from_mm.y())));
    corners += geometry::estimated_corner_count(sides, job.outline->tolerance_mm);
  }
  if (job.outline->borders.empty() || job.outline->borders.size() > kMaxBorders)
    refuse("outline.borders", fmt::format("must be 1 to {} borders, got {}", kMaxBorders, job.outline->borders.size()));
  if (corners > kMaxPolygonCorners)
    refuse(
        "outline.tolerance_mm",
        fmt::format("must be larger, because the polygon of the outline would have about {:.0f} corners, but at most "
                    "{:.0f} are allowed, got {}",
                    corners, kMaxPolygonCorners, shortest(job.outline->tolerance_mm)));
}

}  // namespace

schema::Table outline_table() {
  return {.name = "outline",
          .meaning =
              "Outline of a part that is not a rectangle. Only elements that are completely inside it, and outside of "
              "the margin `x_offset_mm` = `y_offset_mm` along its borders, are cut.",
          .rows = kOutlineRows,
          .tables = kOutlineTables,
          .child = kOutline,
          .presence = Presence::optional,
          .when = kOfArraysOnly};
}

void check_outline(const Job& job, const Refuse& refuse) {
  if (!job.outline) return;
  check_borders(job, refuse);
  const ArrayLayout& array = job.array;
  if (array.x_offset_mm != array.y_offset_mm)
    refuse("array.y_offset_mm", fmt::format("must equal x_offset_mm ({}) together with [outline], got {}",
                                            shortest(array.x_offset_mm), shortest(array.y_offset_mm)));
  if (!array.pattern.empty() && !cuts_prisms(job))
    refuse("array.pattern", "only allowed for prisms together with [outline]");
  std::optional<geometry::OutlineFault> fault;
  const geometry::PlanRegion plan = plan_of_outline(job, fault);
  if (fault)
    refuse(fault->subject == geometry::OutlineFault::Subject::margin ? "array.x_offset_mm" : "outline.borders",
           fault->text);
  const geometry::Vec2 size_mm = plan.box_mm.size();
  for (const auto& [key, given_mm, needed_mm] : {std::tuple("array.x_length_mm", array.x_length_mm, size_mm.x()),
                                                 {"array.y_length_mm", array.y_length_mm, size_mm.y()}})
    if (std::abs(given_mm - needed_mm) > kSameLength * needed_mm)
      refuse(key, fmt::format("must be {}, the size of the outline, got {}", fixed_apart(needed_mm, given_mm, 6),
                              shortest(given_mm)));
  Job cut = job;
  cut.array.outline = std::make_shared<const geometry::PlanRegion>(plan);
  if (cut_elements(cut).empty()) refuse("outline", "must have room for at least one whole element");
}

}  // namespace retrace::fabrication
