#include "studies/drawing/design_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "design/io/design_json.h"
#include "geometry/outline/plan_region.h"
#include "studies/drawing/array_figures.h"

namespace retrace::studies {
namespace {

using geometry::Arrangement, geometry::Part, geometry::PartSpec, geometry::Rectangle, geometry::RtpElement,
    geometry::Vec2;
using Side = Dimension::Side;

// Number of elements along an axis above which the drawing has a detail.
constexpr double kFewElements = 3.2;
// Size of the window of a detail, in pitches of the elements.
constexpr double kDetailElements = 2.6;
// Distance by which the window of a detail extends beyond the dimensioned elements, in elements.
constexpr double kBeyond = 0.35;
constexpr double kSmallest = 1e-9;

void add(std::vector<Dimension>& dimensions, Side side, const Vec2& from, const Vec2& to, const char* name) {
  const bool across = side == Side::below || side == Side::above;
  const double value = across ? to.x() - from.x() : to.y() - from.y();
  dimensions.push_back({side, from, to, name, value});
}

/// Adds the dimensions of one prism, its gaps and the shift of its row.
void add_prism(std::vector<Dimension>& dimensions, const PartSpec& spec, const ArrayFigures& a) {
  const auto& element = std::get<RtpElement>(spec.element);
  const Vec2 corner = a.element_mm;
  const Vec2 end = corner + Vec2(element.base_mm, element.width_mm);
  dimensions.push_back({Side::below, corner, {end.x(), corner.y()}, "base", element.base_mm});
  dimensions.push_back({Side::left, corner, {corner.x(), end.y()}, "width", element.width_mm});
  if (spec.array.arrangement == Arrangement::single) return;
  const double x_gap = spec.array.x_gap_mm;
  const double y_gap = spec.array.y_gap_mm;
  if (x_gap > 0.0 && a.count.x() > 1.0)
    dimensions.push_back({Side::below, {end.x(), corner.y()}, {end.x() + x_gap, corner.y()}, "x gap", x_gap});
  if (y_gap > 0.0 && a.count.y() > 1.0)
    dimensions.push_back({Side::left, {corner.x(), end.y()}, {corner.x(), end.y() + y_gap}, "y gap", y_gap});
  if (x_gap > 0.0 && a.count.x() > 1.0)
    add(dimensions, Side::below, corner, corner + Vec2(a.pitch_mm.x(), 0.0), "x pitch");
  if (y_gap > 0.0 && a.count.y() > 1.0)
    add(dimensions, Side::left, corner, corner + Vec2(0.0, a.pitch_mm.y()), "y pitch");
  if (a.shift_mm > 0.0) {
    // The shift is dimensioned at the line between this row and the next.
    const Vec2 between(corner.x() - (a.element_is_shifted ? a.shift_mm : 0.0), end.y() + 0.5 * y_gap);
    dimensions.push_back({Side::above, between, between + Vec2(a.shift_mm, 0.0), "shift", a.shift_mm});
  }
}

/// Adds the dimensions of one cube corner and its distances to its neighbours.
void add_cube(PlanPanel& panel, const PartSpec& spec, const ArrayFigures& a) {
  const double radius = 0.5 * a.aperture_mm;
  const Vec2 apex = a.element_mm;
  const bool hexagonal = std::holds_alternative<geometry::HexagonalCube>(spec.element);
  panel.circle_radius_mm = radius;
  panel.circle_mm = apex;
  const bool is_round = std::holds_alternative<geometry::RoundCube>(spec.element);
  panel.dimensions.push_back({Side::below, apex - Vec2(radius, 0.0), apex + Vec2(radius, 0.0),
                              is_round ? "diameter" : "aperture", a.aperture_mm});
  if (is_round) return;
  const double half_side = 0.5 * std::numbers::sqrt3 * radius;
  if (hexagonal) {
    add(panel.dimensions, Side::left, apex + Vec2(-0.5 * radius, -half_side), apex + Vec2(-0.5 * radius, half_side),
        "across flats");
  } else {
    add(panel.dimensions, Side::left, apex + Vec2(-0.5 * radius, -half_side), apex + Vec2(-0.5 * radius, half_side),
        "side");
  }
  if (spec.array.arrangement != Arrangement::single && a.has_neighbours)
    add(panel.dimensions, Side::above, apex, apex + 0.5 * a.pitch_mm, "column pitch");
}

void add_element(PlanPanel& panel, const PartSpec& spec, const ArrayFigures& a) {
  if (std::holds_alternative<geometry::RuledCells>(spec.element)) return;
  if (std::holds_alternative<RtpElement>(spec.element))
    add_prism(panel.dimensions, spec, a);
  else
    add_cube(panel, spec, a);
}

/// Adds the margins and lengths of a finite array, or the period of an infinite one.
void add_extent(PlanPanel& panel, const PartSpec& spec, const ArrayFigures& a) {
  const Rectangle& e = a.extent_mm;
  if (spec.array.extent == geometry::Extent::infinite) {
    panel.period_mm = e;
    add(panel.dimensions, Side::above, {e.lower.x(), e.upper.y()}, e.upper, "x period");
    add(panel.dimensions, Side::right, {e.upper.x(), e.lower.y()}, e.upper, "y period");
    return;
  }
  if (spec.array.arrangement == Arrangement::single) return;
  const Vec2 margin = a.block_mm.lower - e.lower;
  const double least = kSmallest * e.size().maxCoeff();
  if (margin.x() > least) add(panel.dimensions, Side::below, e.lower, {a.block_mm.lower.x(), e.lower.y()}, "x margin");
  if (margin.y() > least) add(panel.dimensions, Side::left, e.lower, {e.lower.x(), a.block_mm.lower.y()}, "y margin");
  panel.dimensions.push_back({Side::below, e.lower, {e.upper.x(), e.lower.y()}, "x length", spec.array.x_length_mm});
  panel.dimensions.push_back({Side::left, e.lower, {e.lower.x(), e.upper.y()}, "y length", spec.array.y_length_mm});
}

PlanPanel panel_of(const Part& part, const Rectangle& window, const char* title) {
  PlanPanel panel;
  panel.title = title;
  panel.outline_mm = part.outline;
  if (const auto& outline = part.spec.array.outline; outline && !outline->is_box()) {
    const std::vector<geometry::PolygonLoop>& borders = outline->whole.borders;
    panel.outline_mm = borders.front();
    panel.holes_mm.assign(borders.begin() + 1, borders.end());
  }
  if (faces_near(part, window) <= kMaxPlanFaces)
    panel.view = plan_view(part, window);
  else
    panel.omits_faces = true;
  panel.view.window_mm = window;
  return panel;
}

/// Returns the window of the detail: the first elements of the array, or the elements at its centre.
Rectangle detail_window(const PartSpec& spec, const ArrayFigures& a) {
  const Vec2 beyond = kBeyond * a.size_mm;
  Rectangle window;
  if (std::holds_alternative<RtpElement>(spec.element)) {
    const Vec2 first = a.element_mm - Vec2(a.element_is_shifted ? a.shift_mm : 0.0, 0.0);
    window = {first - beyond, a.element_mm + kDetailElements * a.pitch_mm};
  } else {
    window = {a.element_mm - 1.1 * a.size_mm, a.element_mm + 1.3 * a.size_mm};
  }
  window.lower = window.lower.cwiseMax(a.extent_mm.lower);
  window.upper = window.upper.cwiseMin(a.extent_mm.upper);
  return window;
}

void add_plan(DesignDrawing& drawing, const Part& part, const ArrayFigures& a) {
  const PartSpec& spec = part.spec;
  if (spec.array.extent == geometry::Extent::infinite) {
    const Vec2 beyond = 0.75 * a.size_mm;
    const Rectangle window{a.extent_mm.lower - beyond, a.extent_mm.upper.cwiseMax(a.element_mm + a.pitch_mm) + beyond};
    drawing.plan.push_back(panel_of(part, window, "One period and its surroundings"));
    add_element(drawing.plan.back(), spec, a);
    add_extent(drawing.plan.back(), spec, a);
    return;
  }
  const bool has_detail = spec.array.arrangement != Arrangement::single && a.count.maxCoeff() > kFewElements;
  drawing.plan.push_back(panel_of(part, a.extent_mm, "Seen from the light"));
  if (has_detail) {
    const Rectangle window = detail_window(spec, a);
    drawing.plan.push_back(panel_of(part, window, "Detail A"));
    drawing.plan.front().detail_mm = window;
  }
  add_element(drawing.plan.back(), spec, a);
  add_extent(drawing.plan.front(), spec, a);
}

/// Returns the angle between the planes of the element's facets in the section.
AngleDimension apex_angle(const PartSpec& spec, const Vec2& root) {
  double steepest_right = 0.0;
  double steepest_left = 0.0;
  for (const geometry::CellFacet& facet : geometry::element_cell(spec.element, spec.angle_errors).facets) {
    steepest_right = std::max(steepest_right, facet.plane.slope.x());
    steepest_left = std::min(steepest_left, facet.plane.slope.x());
  }
  AngleDimension angle;
  angle.apex_mm = root;
  angle.left = Vec2(-1.0, -steepest_left).normalized();
  angle.right = Vec2(1.0, steepest_right).normalized();
  angle.deg = std::acos(std::clamp(angle.left.dot(angle.right), -1.0, 1.0)) * 180.0 / std::numbers::pi;
  return angle;
}

/// Adds the height dimensions of the entrance face to a section. They are the height at the right end and, for a curved
/// face, the height of the highest point.
void add_heights(SectionPanel& panel, const Part& part) {
  const SectionView& view = panel.view;
  if (view.entrance_corners == 2 && std::holds_alternative<geometry::RoundCube>(part.spec.element)) {
    add(panel.dimensions, Side::right, {view.x_to_mm, -part.element_depth_mm}, {view.x_to_mm, part.thickness_mm},
        "length");
    return;
  }
  if (view.entrance_corners == 2) {
    panel.dimensions.push_back(
        {Side::right, {view.x_to_mm, 0.0}, {view.x_to_mm, part.thickness_mm}, "thickness", part.thickness_mm});
    return;
  }
  const std::vector<Vec2> entrance = view.entrance_mm();
  const auto is_lower = [](const Vec2& a, const Vec2& b) { return a.y() < b.y(); };
  const Vec2 highest = *std::max_element(entrance.begin(), entrance.end(), is_lower);
  const Vec2 edge = entrance.front();
  add(panel.dimensions, Side::right, {edge.x(), 0.0}, edge, "height at edge");
  if (highest.y() > edge.y() + kSmallest * view.x_to_mm)
    add(panel.dimensions, Side::right, {highest.x(), 0.0}, highest, "highest point");
}

void add_section(DesignDrawing& drawing, const design::Design& design, const Part& part, const ArrayFigures& a,
                 const geometry::EntranceHeights& entrance_height = {}) {
  const bool whole = part.spec.array.arrangement == Arrangement::single || !design.elements() ||
                     (entrance_height && a.count.x() <= kMaxSectionElements);
  double from = a.extent_mm.lower.x();
  double to = a.extent_mm.upper.x();
  if (!whole) {
    const bool infinite = part.spec.array.extent == geometry::Extent::infinite;
    const double left = a.root_mm.x() - 0.85 * a.size_mm.x();
    const double right = a.root_mm.x() + 2.2 * a.size_mm.x();
    from = infinite ? left : std::max(from, left);
    to = infinite ? right : std::min(to, right);
  }
  const auto view = section_view(part, a.section_y_mm, from, to, entrance_height);
  if (!view) {
    drawing.warnings.push_back(
        {"no_section", design.source_name() +
                           ": no section is drawn, because the back of the part has an overhang in the section plane"});
    return;
  }
  SectionPanel panel;
  panel.title = "Section B\u2013B";
  panel.view = *view;
  panel.is_continued = !whole;
  const double left = view->x_from_mm;
  const double deepest = -part.element_depth_mm;
  add_heights(panel, part);
  panel.dimensions.push_back(
      {Side::left, {!design.elements() ? left : a.root_mm.x(), deepest}, {left, 0.0}, "depth", part.element_depth_mm});
  if (const auto* rtp = std::get_if<RtpElement>(&part.spec.element); rtp != nullptr && design.elements()) {
    const double middle = a.root_mm.x();
    panel.dimensions.push_back(
        {Side::below, {middle - 0.5 * rtp->base_mm, 0.0}, {middle + 0.5 * rtp->base_mm, 0.0}, "base", rtp->base_mm});
  }
  if (design.elements() && !design.facet_planes() && part.spec.random_tilts.sigma_arcmin == 0.0)
    panel.angle =
        apex_angle(part.spec, {a.root_mm.x(), -geometry::element_depth_mm(part.spec.element, part.spec.angle_errors)});
  drawing.section = std::move(panel);
}

std::string arrangement_text(const Part& part) {
  const PartSpec& spec = part.spec;
  if (spec.array.arrangement == Arrangement::single) return "one element";
  if (spec.array.extent == geometry::Extent::infinite)
    return fmt::format("infinite array, {} elements per period", part.elements_full);
  std::string text = fmt::format("{} full elements", part.elements_full);
  if (part.elements_partial > 0) text += fmt::format(", {} cut by the border", part.elements_partial);
  if (spec.array.arrangement == Arrangement::offset)
    text += fmt::format("; {} rows shifted (rows are counted from the bottom)",
                        spec.array.shifted_rows == geometry::RowParity::even ? "even" : "odd");
  if (spec.array.arrangement == Arrangement::checker) text += "; every second element rotated by 90 degrees";
  return text;
}

/// Adds remarks about the mount and the chamfer of a round cube corner.
void add_stops(std::vector<std::string>& remarks, const PartSpec& spec) {
  const auto* const cube = std::get_if<geometry::RoundCube>(&spec.element);
  if (cube == nullptr) return;
  if (cube->mount_diameter_mm > 0.0)
    remarks.push_back(fmt::format("edge of the mount: diameter {:.6g}, {:.6g} above the face", cube->mount_diameter_mm,
                                  cube->recess_mm));
  if (cube->chamfer_mm > 0.0) remarks.push_back(fmt::format("chamfer of the face: width {:.6g}", cube->chamfer_mm));
}

std::string zones_text(const Part& part) {
  return fmt::format("{} zones, {} full elements, {} cut by their borders", part.zones.size(), part.elements_full,
                     part.elements_partial);
}

/// Returns the centres of the cells of a zone. All cells are in one patch, ordered by zone.
std::vector<Vec2> centres_of_cells(const Part& part, std::size_t zone) {
  std::size_t first = 0;
  for (std::size_t k = 0; k < zone; ++k) first += part.zones[k].cells;
  std::vector<Vec2> centres;
  const auto& cells = part.patches.front().cells;
  for (std::size_t k = first; k < first + part.zones[zone].cells; ++k)
    centres.push_back(0.5 * (cells[k].lower + cells[k].upper).head<2>());
  return centres;
}

/// Returns the position of a zone's number if the zone consists of elements: the centre of the element that is farthest
/// from the elements of all other zones, or of the first such element.
Vec2 label_of_cells(const Part& part, std::size_t zone) {
  constexpr std::size_t kMaxCandidates = 400;
  const std::vector<Vec2> own = centres_of_cells(part, zone);
  std::vector<Vec2> others;
  for (std::size_t k = 0; k < part.zones.size(); ++k) {
    if (k == zone) continue;
    const std::vector<Vec2> more = centres_of_cells(part, k);
    others.insert(others.end(), more.begin(), more.end());
  }
  const std::size_t step = own.size() / kMaxCandidates + 1;
  Vec2 best = own.front();
  double farthest = -1.0;
  for (std::size_t k = 0; k < own.size(); k += step) {
    double nearest = INFINITY;
    for (const Vec2& other : others) nearest = std::min(nearest, (other - own[k]).norm());
    if (nearest > farthest * (1.0 + 1e-9)) {
      farthest = nearest;
      best = own[k];
    }
  }
  return best;
}

std::string zone_text(const design::ZonedPart& zoned, const Part& part, std::size_t zone) {
  const geometry::ZoneElements& elements = part.zones[zone];
  double all_mm2 = 0.0;
  for (const geometry::ZoneElements& other : part.zones) all_mm2 += other.area_mm2;
  std::string text;
  if (const double deg = zoned.spec.zones[zone].rotation_deg; deg != 0.0)
    text += fmt::format("rotated by {:.6g}°, ", deg);
  for (const design::ZoneChange& change : zoned.changes[zone]) text += change.text + ", ";
  text += fmt::format("{} full elements", elements.full);
  if (elements.partial > 0) text += fmt::format(" and {} cut", elements.partial);
  return text + fmt::format(", {:.1f} % of the area", 100.0 * elements.area_mm2 / all_mm2);
}

/// Adds the portions of a zone's regions that are inside the outline of the part.
void add_regions(PlanZone& zone, const geometry::ZonedSpec& spec, const std::vector<geometry::Polygon>& regions) {
  for (const geometry::Polygon& region : regions) {
    const std::vector<geometry::Polygon> inside = geometry::within_plate(spec, region);
    if (inside.empty()) continue;
    const auto largest =
        std::ranges::max_element(inside, {}, [](const auto& polygon) { return geometry::area(polygon); });
    zone.labels_mm.push_back(geometry::centroid(*largest));
    zone.regions_mm.insert(zone.regions_mm.end(), inside.begin(), inside.end());
    if (spec.cutting_outline() == nullptr) continue;
    for (std::size_t k = 0; k < region.size(); ++k)
      for (const geometry::Polygon& piece : spec.cutting_outline()->whole.pieces)
        if (const auto side = geometry::clip_segment(region[k], region[(k + 1) % region.size()], piece))
          zone.sides_mm.emplace_back((*side)[0], (*side)[1]);
  }
}

std::vector<PlanZone> zones_of(const design::ZonedPart& zoned, const Part& part) {
  std::vector<PlanZone> zones;
  for (std::size_t k = 0; k < part.zones.size(); ++k) {
    PlanZone zone;
    if (!zoned.spec.is_by_cell) add_regions(zone, zoned.spec, zoned.spec.zones[k].regions);
    if (zone.labels_mm.empty() && part.zones[k].cells > 0) zone.labels_mm.push_back(label_of_cells(part, k));
    zone.description = zone_text(zoned, part, k);
    zones.push_back(std::move(zone));
  }
  return zones;
}

/// Returns the y coordinate of a row of elements near the centre of the part. In this row, elements are shifted along x
/// by the same distance as in the row of the dimensioned element.
double row_near_centre_mm(const ArrayFigures& a) {
  const double centre_mm = a.extent_mm.centre().y();
  const double step_mm = (a.shift_mm > 0.0 ? 2.0 : 1.0) * a.pitch_mm.y();
  if (!(step_mm > 0.0)) return centre_mm;
  return a.root_mm.y() + step_mm * std::round((centre_mm - a.root_mm.y()) / step_mm);
}

}  // namespace

DesignDrawing draw_plan(const design::Design& design, const Part& part) {
  DesignDrawing drawing;
  drawing.title = design::short_name(design);
  const ArrayFigures a = array_figures(design, part);
  if (!design.elements()) {
    drawing.remarks.push_back(design.zoned()                                        ? zones_text(part)
                              : std::holds_alternative<design::Plate>(design.shape) ? "plate with a plane back"
                                                                                    : "part read from a mesh");
    drawing.plan.push_back(panel_of(part, a.extent_mm, "Seen from the light"));
    PlanPanel& panel = drawing.plan.back();
    if (design.zoned()) panel.zones = zones_of(*design.zoned(), part);
    add(panel.dimensions, Side::below, a.extent_mm.lower, a.extent_mm.upper, "x length");
    add(panel.dimensions, Side::left, a.extent_mm.lower, a.extent_mm.upper, "y length");
  } else {
    drawing.remarks.push_back(arrangement_text(part));
    add_stops(drawing.remarks, part.spec);
    add_plan(drawing, part, a);
  }
  drawing.remarks.emplace_back("lengths in mm");
  return drawing;
}

DesignDrawing draw_curved_design(const design::Design& design, const Part& part,
                                 const geometry::EntranceHeights& entrance_height) {
  DesignDrawing drawing = draw_plan(design, part);
  ArrayFigures a = array_figures(design, part);
  if (a.count.x() <= kMaxSectionElements) {
    a.section_y_mm = row_near_centre_mm(a);
    a.root_mm.y() = a.section_y_mm;
  }
  drawing.plan.front().section_y_mm = a.section_y_mm;
  add_section(drawing, design, part, a, entrance_height);
  return drawing;
}

DesignDrawing draw_design(const design::Design& design, const Part& part) {
  DesignDrawing drawing = draw_plan(design, part);
  const ArrayFigures a = array_figures(design, part);
  drawing.plan.back().section_y_mm = a.section_y_mm;
  add_section(drawing, design, part, a);
  return drawing;
}

}  // namespace retrace::studies
