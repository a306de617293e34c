#include "design/io/outline_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/named_file.h"
#include "core/number_format.h"
#include "design/io/design_rows.h"
#include "design/io/step_choice_reader.h"
#include "geometry/io/dxf_outline.h"
#include "geometry/io/step_reader.h"

namespace retrace::design {
namespace {

using geometry::OutlineFault, geometry::OutlineLoop, geometry::PlanRegion, geometry::Vec2, schema::Document;

constexpr std::string_view kPolygon = "outline.polygon_mm";
constexpr std::string_view kCircle = "outline.circle_mm";
constexpr std::string_view kDxf = "outline.dxf";
constexpr std::string_view kStep = "outline.file";
constexpr std::string_view kSagitta = "outline.side_sagitta_mm";
constexpr std::string_view kCornerRadius = "outline.corner_radius_mm";
constexpr std::string_view kHoles = "outline.holes_mm";
constexpr std::string_view kMargin = "outline.margin_mm";
constexpr std::string_view kTolerance = "outline.tolerance_mm";
/// Maximum number of corners of the polygons that replace all loops. It limits the time of tests for crossings.
constexpr double kMaxCorners = 2000.0;
/// Maximum sagitta of an arc, divided by its chord.
constexpr double kMaxSagittaPerChord = 5.0;

/// Returns one number for each corner or side of the outline. A single number in the document applies to all of them.
/// \param count number of corners or sides
/// \param items "corners" or "sides", for error messages
std::vector<double> list_of(const Document& document, std::string_view key, std::size_t count, std::string_view items) {
  std::vector<double> values = document.numbers(key);
  if (values.size() == 1 && !document.is_list(key)) values.resize(count, values.front());
  if (values.size() != count)
    document.fail(key, fmt::format("must have one number for each of the {} {}, got {}", count, items, values.size()));
  return values;
}

OutlineLoop polygon_of_outline(const Document& document) {
  std::vector<Vec2> corners;
  for (const std::vector<double>& p : document.rows(kPolygon)) corners.emplace_back(p[0], p[1]);
  const std::size_t count = corners.size();
  for (std::size_t k = 0; k < count; ++k)
    if (corners[k] == corners[(k + 1) % count])
      document.fail(kPolygon, fmt::format("must contain each corner only once, got [{}, {}] twice in succession",
                                          shortest(corners[k].x()), shortest(corners[k].y())));
  std::vector<double> sagitta(count, 0.0);
  if (document.has(kSagitta)) sagitta = list_of(document, kSagitta, count, "sides");
  const double outwards = geometry::area(corners) < 0.0 ? -1.0 : 1.0;
  OutlineLoop loop;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec2& from = corners[k];
    const Vec2& to = corners[(k + 1) % count];
    const double chord = (to - from).norm();
    if (std::abs(sagitta[k]) > kMaxSagittaPerChord * chord)
      document.fail(kSagitta, fmt::format("must be at most {} times the length of the side, {} mm, got {}",
                                          shortest(kMaxSagittaPerChord), shortest(chord), shortest(sagitta[k])));
    loop.push_back({from, to, outwards * 2.0 * sagitta[k] / chord});
  }
  std::optional<geometry::CornerFault> fault;
  const std::vector<double> radii = list_of(document, kCornerRadius, count, "corners");
  loop = geometry::with_rounded_corners(loop, radii, fault);
  if (fault)
    document.fail(kCornerRadius,
                  fmt::format("must be smaller at corner {}, whose arc does not fit between its neighbours, got {}",
                              fault->corner + 1, shortest(radii[fault->corner])));
  return loop;
}

OutlineLoop circle_of(const Document& document, std::string_view key, const std::vector<double>& values) {
  if (!(values[2] > 0.0)) document.fail(key, fmt::format("must have a radius > 0, got {}", shortest(values[2])));
  return geometry::circle({values[0], values[1]}, values[2]);
}

/// Returns the loops that the document describes: the outer border, and also the holes if the outline is a DXF or
/// STEP file.
std::vector<OutlineLoop> border_of(const Document& document) {
  if (document.has(kDxf)) {
    const std::filesystem::path file = document.file(kDxf);
    const geometry::DxfSelection selection = {document.text_if("outline.dxf_layer"),
                                              document.number_if("outline.dxf_scale")};
    return geometry::parse_dxf_outline(read_file(file, geometry::kMaxDxfBytes), file.string(), selection);
  }
  if (document.has(kStep))
    return read_named(document.where(kStep),
                      [&] { return geometry::read_step_outline(read_step_face(document, "outline").choice); });
  if (document.has(kCircle)) return {circle_of(document, kCircle, document.numbers(kCircle))};
  return {polygon_of_outline(document)};
}

/// Returns the key at which a fault of the outline is reported.
std::string_view key_of(const Document& document, OutlineFault::Subject subject) {
  switch (subject) {
    case OutlineFault::Subject::hole: return document.has(kHoles) ? kHoles : outline_key(document);
    case OutlineFault::Subject::margin: return kMargin;
    case OutlineFault::Subject::border: break;
  }
  return outline_key(document);
}

}  // namespace

bool has_outline(const Document& document) {
  return document.has("outline");
}

std::string_view outline_key(const Document& document) {
  for (const std::string_view key : {kDxf, kStep, kCircle})
    if (document.has(key)) return key;
  return kPolygon;
}

OutlineKeys outline_keys(const Document& document) {
  OutlineKeys keys;
  for (const schema::Row& row : outline_rows()) {
    const std::string path = schema::path_in("outline", row.key);
    if (document.has(path) && path != kMargin && path != kTolerance)
      keys.values.emplace_back(row.key, document.value(path));
  }
  for (const std::string_view key : {kDxf, kStep})
    if (document.has(key)) keys.file = document.file(key);
  return keys;
}

PlanRegion read_outline(const Document& document) {
  const double tolerance_mm = document.number(kTolerance);
  const auto region_of = [&](std::vector<OutlineLoop> loops, double margin_mm) {
    double corners = 0.0;
    for (const OutlineLoop& loop : loops) corners += geometry::estimated_corner_count(loop, tolerance_mm);
    if (corners > kMaxCorners)
      document.fail(kTolerance,
                    fmt::format("must be larger, because the polygon of the outline would have about {:.0f} "
                                "corners, but at most {:.0f} are allowed, got {}",
                                corners, kMaxCorners, shortest(tolerance_mm)));
    std::optional<OutlineFault> fault;
    PlanRegion plan = geometry::plan_region(geometry::oriented(std::move(loops)), margin_mm, tolerance_mm, fault);
    if (fault) document.fail(key_of(document, fault->subject), fault->text);
    return plan;
  };
  std::vector<OutlineLoop> loops = border_of(document);
  const double margin_mm = document.number(kMargin);
  if (!document.has(kHoles)) return region_of(std::move(loops), margin_mm);
  // The border is checked without the holes first: a border that crosses itself can enclose a smaller area than a hole.
  static_cast<void>(region_of(loops, 0.0));
  double border_mm2 = 0.0;
  for (const OutlineLoop& loop : loops) border_mm2 = std::max(border_mm2, std::abs(geometry::enclosed_area_mm2(loop)));
  for (const std::vector<double>& hole : document.rows(kHoles)) {
    loops.push_back(circle_of(document, kHoles, hole));
    if (geometry::enclosed_area_mm2(loops.back()) >= border_mm2)
      document.fail(kHoles, "must be inside the outer border, but a hole is larger than the outline");
  }
  return region_of(std::move(loops), margin_mm);
}

}  // namespace retrace::design
