#include "geometry/elements/array_sheet.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "geometry/elements/facet_planes.h"
#include "geometry/elements/plane_polygon.h"
#include "geometry/elements/substrate_checks.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/plane_math.h"

namespace retrace::geometry {
namespace {

/// Maximum relative deviation between a length and a whole number of elements at which the length counts as whole.
constexpr double kWhole = 1e-9;
// kEndlessPeriods is the number of periods of an infinite array's sheet on each side of the origin. kEndlessReaches is
// the margin of the block of cube corners around the sheet on a substrate, in multiples of the sheet's size. Both are
// larger than any region that is traced or drawn.
constexpr double kEndlessPeriods = 1e3;
constexpr double kEndlessReaches = 10.0;

/// Snaps the part to the block. If a bound of the part equals the corresponding bound of the block within rounding
/// errors, it is set to exactly this bound.
void snap(Rectangle& part, const Rectangle& block, const Vec2& length) {
  const auto one = [](double& bound, double to, double scale) {
    if (std::abs(bound - to) <= 2.0 * kWhole * scale) bound = to;
  };
  for (const Eigen::Index axis : {0, 1}) {
    one(part.lower[axis], block.lower[axis], length[axis]);
    one(part.upper[axis], block.upper[axis], length[axis]);
  }
}

Rectangle round_all(const Rectangle& a, const Rectangle& b) {
  return {a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
}

Rectangle widened(const Rectangle& r, const Vec2& by) {
  return {r.lower - by, r.upper + by};
}

Element without_cant(Element element) {
  if (auto* cube = std::get_if<HexagonalCube>(&element)) cube->cant = {};
  if (auto* cube = std::get_if<TriangularCube>(&element)) cube->cant = {};
  return element;
}

/// Returns the heights of the corners of an element's nominal outline above the substrate.
std::vector<double> rim_heights(const Cell& cell, const Element& element) {
  constexpr double kRounding = 1e-12;
  const double depth_mm = element_depth_mm(element);
  const Cell nominal = element_in_place_of(cell, without_cant(element), AngleErrors{});
  std::vector<double> heights;
  if (std::holds_alternative<RuledCells>(element)) return std::vector<double>(cell.outline.size(), 0.0);
  for (const Vec2& p : cell.outline) {
    double height = -depth_mm;
    for (const CellFacet& facet : nominal.facets) height = std::max(height, facet.plane.at(p));
    heights.push_back(std::abs(height) < kRounding * depth_mm ? 0.0 : height);
  }
  return heights;
}

/// Returns the intersection of two convex polygons. Returns an empty polygon if the intersection is not wider than the
/// tolerance.
Polygon common(Polygon polygon, const Polygon& other, double tolerance_mm) {
  for (std::size_t k = 0; k < other.size() && !polygon.empty(); ++k) {
    const Vec2 along = (other[(k + 1) % other.size()] - other[k]).normalized();
    const HeightPlane inward{-plane::cross(along, other[k]), {-along.y(), along.x()}};
    polygon = where_higher(polygon, inward, HeightPlane{});
  }
  if (other.empty() || (!polygon.empty() && area(polygon) <= tolerance_mm * bounding_box(polygon).size().norm()))
    polygon.clear();
  return polygon;
}

}  // namespace

ArraySheet::ArraySheet(const PartSpec& of) : spec(&of) {
  tolerance_mm = sliver_mm = kWhole * bounding_box(aperture_outline(of.element)).size().minCoeff();
  if (of.array.extent == Extent::infinite)
    lay_out_infinite();
  else
    lay_out_finite();
  measure_cells();
}

void ArraySheet::lay_out_infinite() {
  lattice = make_lattice(*spec, true);
  part_mm = coverage_mm = block_mm = widened({}, kEndlessPeriods * lattice.period_mm);
}

void ArraySheet::lay_out_finite() {
  const Vec2 length(spec->array.x_length_mm, spec->array.y_length_mm);
  centre_mm = 0.5 * length;
  part_mm = coverage_mm = {Vec2::Zero(), length};
  // A rectangle whose margin is equal to the offsets of the array needs no outline.
  const PlanRegion* const given = spec->array.outline.get();
  if (given != nullptr && !(given->is_box() && given->margin_mm == spec->array.x_offset_mm)) outline = given;
  if (spec->substrate) lay_on_substrate();
  if (const auto* prism = std::get_if<RtpElement>(&spec->element))
    lay_out_prisms(*prism);
  else
    lay_out_cubes();
  if (!is_upright) return;
  snap(part_mm, block_mm, length);
  coverage_mm = part_mm;
}

void ArraySheet::lay_on_substrate() {
  surface.emplace(substrate_surface_of(*spec));
  const SubstrateMeasures measures = measure_substrate(*surface, centre_mm);
  zero_mm = surface->is_offset() ? measures.lowest_mm : measures.highest_mm;
  is_upright = surface->is_upright();
  if (is_upright) return;
  tolerance_mm = std::max(sliver_mm, 2.0 * kWhole * centre_mm.maxCoeff());
  coverage_mm = arcs_of_border();
}

/// Lays out prisms as a flat array. On a substrate, the flat array has the size of the substrate unrolled into a plane.
void ArraySheet::lay_out_prisms(const RtpElement& prism) {
  const Rectangle all = is_upright ? part_mm : moved(surface->arc_reach(), centre_mm);
  ArrayLayout array = spec->array;
  array.x_length_mm = all.size().x();
  array.y_length_mm = all.size().y();
  prisms = prism_block(array, prism);
  if (prisms->counts.columns < 1 || prisms->counts.rows < 1) throw InputError("the array is smaller than one element");
  block_mm = moved(prisms->filled, all.lower);
  anchor_mm = block_mm.lower;
  lattice = make_lattice(*spec, prisms->counts.rows > 1);
}

void ArraySheet::lay_out_cubes() {
  const Vec2 margin(spec->array.x_offset_mm, spec->array.y_offset_mm);
  block_mm = is_upright ? widened(part_mm, -margin) : widened(coverage_mm, kEndlessReaches * coverage_mm.size());
  anchor_mm = centre_mm;
  lattice = make_lattice(*spec, false);
}

/// Returns the bounding box of the part's border in arc coordinates, enlarged by the size of an element.
Rectangle ArraySheet::arcs_of_border() const {
  constexpr int kSteps = 128;
  Rectangle box;
  for (int k = 0; k <= kSteps; ++k) {
    const double along = 2.0 * k / kSteps - 1.0;
    for (const Vec2& p : {Vec2(along, -1.0), Vec2(along, 1.0), Vec2(-1.0, along), Vec2(1.0, along)}) {
      const Vec2 arc = surface->arc_of(centre_mm.cwiseProduct(p));
      box = round_all(box, {arc, arc});
    }
  }
  return moved(widened(box, Vec2::Constant(1.5 * width_across_mm(spec->element))), centre_mm);
}

void ArraySheet::measure_cells() {
  for (const Cell& cell : lattice.cells) {
    reference_points_mm.push_back(reference_position(*spec, cell));
    rims_mm.push_back(cell.is_element ? rim_heights(cell, spec->element)
                                      : std::vector<double>(cell.outline.size(), 0.0));
  }
}

IndexRange ArraySheet::indices() const {
  Rectangle cells = bounding_box(lattice.cells.front().outline);
  for (const Cell& cell : lattice.cells) cells = round_all(cells, bounding_box(cell.outline));
  IndexRange range;
  for (const Eigen::Index axis : {0, 1}) {
    const auto k = static_cast<std::size_t>(axis);
    const double period = lattice.period_mm[axis];
    const double low = (coverage_mm.lower[axis] - anchor_mm[axis] - cells.upper[axis]) / period;
    const double high = (coverage_mm.upper[axis] - anchor_mm[axis] - cells.lower[axis]) / period;
    range.lower[k] = static_cast<std::int64_t>(std::floor(low));
    range.upper[k] = static_cast<std::int64_t>(std::ceil(high)) + 1;
  }
  return range;
}

Vec2 ArraySheet::at_mm(std::int64_t i, std::int64_t j) const {
  return anchor_mm + Vec2(static_cast<double>(i), static_cast<double>(j)).cwiseProduct(lattice.period_mm);
}

bool ArraySheet::repeats_along(std::size_t axis) const {
  return !surface || (axis == 0 ? surface->repeats_along_u() : surface->repeats_along_v());
}

SheetPortion::SheetPortion(const ArraySheet& sheet, std::int64_t i, std::int64_t j, bool is_alone)
    : sheet_(&sheet), at_(sheet.at_mm(i, j)), origin_(at_) {
  if (sheet.surface) {
    const Vec3 origin = sheet.surface->frame_at(at_ - sheet.centre_mm).origin;
    if (!sheet.is_upright) origin_ = sheet.centre_mm + origin.head<2>();
    height_ = is_alone ? sheet.zero_mm : origin.z();
  }
  part_ = moved(sheet.part_mm, -origin_);
  reach_ = moved(sheet.coverage_mm, -at_);
  block_ = moved(sheet.block_mm, -at_);
}

Vec2 SheetPortion::plan_of(const Vec2& on_sheet, double rim_mm) const {
  if (sheet_->is_upright) return on_sheet;
  Vec2 plan = sheet_->surface->plan_of(at_ + on_sheet - sheet_->centre_mm);
  if (rim_mm != 0.0) plan += rim_mm * sheet_->surface->normal_at(plan).head<2>();
  return plan + sheet_->centre_mm - origin_;
}

SubstrateFrame SheetPortion::frame_at(const Vec2& on_sheet) const {
  SubstrateFrame frame;
  frame.origin.head<2>() = on_sheet;
  if (!sheet_->surface) return frame;
  frame = sheet_->surface->frame_at(at_ + on_sheet - sheet_->centre_mm);
  frame.origin.head<2>() += sheet_->centre_mm - origin_;
  frame.origin.z() -= height_;
  return frame;
}

SheetCell SheetPortion::sheet_cell(std::size_t cell, const Vec2& shift_mm) const {
  SheetCell place;
  place.shift_mm = shift_mm;
  place.on_sheet = moved(sheet_->lattice.cells[cell].outline, shift_mm);
  place.frame = frame_at(sheet_->reference_points_mm[cell] + shift_mm);
  if (sheet_->surface && sheet_->surface->is_offset())
    place.frame.origin.z() = sheet_->surface->lowest_over(moved(place.on_sheet, at_ - sheet_->centre_mm)) - height_;
  place.outline = place.on_sheet;
  if (!sheet_->is_upright)
    for (std::size_t k = 0; k < place.outline.size(); ++k)
      place.outline[k] = plan_of(place.on_sheet[k], sheet_->rims_mm[cell][k]);
  return place;
}

BorderRelation SheetPortion::border_relation(const SheetCell& place) const {
  if (contains(block_, place.on_sheet, sheet_->sliver_mm) &&
      (sheet_->is_upright || contains(part_, place.outline, sheet_->tolerance_mm)) && is_in_element_area(place.outline))
    return BorderRelation::inside;
  const Polygon inner = within(place, place.outline, block_);
  return inner.empty() || in_element_area(inner).empty() ? BorderRelation::outside : BorderRelation::crossing;
}

bool SheetPortion::is_clear_of_part(const SheetCell& place) const {
  const Rectangle box = bounding_box(place.outline);
  return (box.lower.array() > part_.upper.array()).any() || (box.upper.array() < part_.lower.array()).any();
}

Polygon SheetPortion::within(const SheetCell& place, const Polygon& outline, const Rectangle& on_sheet) const {
  if (sheet_->is_upright) return clip(outline, on_sheet, sheet_->sliver_mm);
  Polygon inner = outline;
  if (!contains(on_sheet, place.on_sheet, sheet_->sliver_mm)) {
    Polygon in_plan = clip(place.on_sheet, on_sheet, sheet_->sliver_mm);
    for (Vec2& p : in_plan) p = plan_of(p);
    inner = common(outline, in_plan, sheet_->sliver_mm);
  }
  return contains(part_, inner, 0.0) ? inner : clip(inner, part_, sheet_->tolerance_mm);
}

bool SheetPortion::is_in_element_area(const Polygon& in_plan) const {
  return sheet_->outline == nullptr ||
         is_within(moved(in_plan, origin_), sheet_->outline->elements, sheet_->tolerance_mm);
}

std::vector<Polygon> SheetPortion::clipped(Polygon in_plan, ConvexRegion PlanRegion::*region) const {
  if (in_plan.empty()) return {};
  if (sheet_->outline == nullptr) return {std::move(in_plan)};
  std::vector<Polygon> portions =
      clip(moved(std::move(in_plan), origin_), sheet_->outline->*region, sheet_->tolerance_mm);
  for (Polygon& portion : portions) portion = moved(std::move(portion), -origin_);
  return portions;
}

std::vector<Polygon> SheetPortion::in_element_area(Polygon in_plan) const {
  return clipped(std::move(in_plan), &PlanRegion::elements);
}

std::vector<Polygon> SheetPortion::in_outline_margin(Polygon in_plan) const {
  if (sheet_->outline == nullptr) return {};
  return clipped(std::move(in_plan), &PlanRegion::margin);
}

std::vector<Polygon> SheetPortion::in_outline(Polygon in_plan) const {
  return clipped(std::move(in_plan), &PlanRegion::whole);
}

std::vector<PolygonLoop> SheetPortion::outline_borders() const {
  std::vector<PolygonLoop> borders;
  if (sheet_->outline == nullptr) return borders;
  for (const ConvexRegion* region : {&sheet_->outline->whole, &sheet_->outline->elements})
    for (const PolygonLoop& border : region->borders) borders.push_back(moved(border, -origin_));
  return borders;
}

Rectangle SheetPortion::plan_bounding_box(const Rectangle& on_sheet) const {
  Polygon corners = to_polygon(on_sheet);
  for (Vec2& p : corners) p = plan_of(p);
  return bounding_box(corners);
}

Rectangle SheetPortion::block_in_plan() const {
  if (sheet_->is_upright) return block_;
  if (!std::holds_alternative<RtpElement>(sheet_->spec->element)) return part_;
  return {plan_of(block_.lower).cwiseMax(part_.lower), plan_of(block_.upper).cwiseMin(part_.upper)};
}

}  // namespace retrace::geometry
