#include "geometry/part/zones.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "geometry/direction.h"
#include "geometry/elements/array_sheet.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/lattice.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/part/tiling.h"

namespace retrace::geometry {
namespace {

/// Distance below which two corners are treated as the same corner, relative to the size of the smallest element.
constexpr double kSamePlace = 1e-9;

/// Rotation about a point of a sheet, followed by a translation that moves this point to a point of the part. A sheet
/// is the plane on which an array is laid out.
class Turn {
 public:
  Turn(double deg, const Vec2& on_sheet, const Vec2& in_part)
      : along_(direction_at(Angle::from_deg(deg))), on_sheet_(on_sheet), in_part_(in_part) {}

  Vec2 turned(const Vec2& v) const {
    return {along_.x() * v.x() - along_.y() * v.y(), along_.y() * v.x() + along_.x() * v.y()};
  }
  Vec2 place(const Vec2& p) const { return turned(p - on_sheet_) + in_part_; }
  /// Applies the inverse rotation to the vector from in_part_ to a point of the part.
  Vec2 back(const Vec2& p) const {
    const Vec2 v = p - in_part_;
    return {along_.x() * v.x() + along_.y() * v.y(), -along_.y() * v.x() + along_.x() * v.y()};
  }

 private:
  Vec2 along_;  ///< direction of the sheet's x axis in the part frame
  Vec2 on_sheet_;
  Vec2 in_part_;
};

void turn(Tile& tile, const Turn& by) {
  const double at_origin_mm = tile.plane.at(Vec2::Zero());
  const Vec2 slope = by.turned(tile.plane.slope);
  tile.plane = {at_origin_mm - slope.dot(by.place(Vec2::Zero())), slope};
  for (Vec2& p : tile.outline) p = by.place(p);
  if (tile.centroid_mm) tile.centroid_mm = by.place(*tile.centroid_mm);
}

bool is_box(const Polygon& region, double tolerance_mm) {
  const Rectangle box = bounding_box(region);
  return region.size() == 4 && std::ranges::all_of(region, [&](const Vec2& p) {
           return (p - box.lower).cwiseAbs().cwiseMin((p - box.upper).cwiseAbs()).maxCoeff() <= tolerance_mm;
         });
}

/// Returns true if the area that was cut off is larger than rounding errors can explain.
/// \param left polygon that remains after the cut
bool is_loss(double lost_mm2, const Polygon& left, double tolerance_mm) {
  return lost_mm2 > tolerance_mm * bounding_box(left).size().norm();
}

/// Clips the tiles of an array to a region, and to the area that an outline leaves for elements. Tiles that belong to
/// the same cell must be consecutive.
class RegionCutter {
 public:
  /// \param outline outline of the plate, or null
  RegionCutter(const Polygon& region, const PlanRegion* outline, PartialElements partial, double tolerance_mm)
      : region_(region), outline_(outline), partial_(partial), tolerance_mm_(tolerance_mm) {}

  /// Clips all cells to the region, and counts complete and partial elements again.
  void cut(ArrayTiles& array) const {
    ArrayTiles within;
    for (auto first = array.tiles.begin(); first != array.tiles.end();) {
      const auto end = std::find_if(first, array.tiles.end(), [&](const Tile& t) { return t.cell != first->cell; });
      add_cell({std::make_move_iterator(first), std::make_move_iterator(end)}, within);
      first = end;
    }
    array = std::move(within);
  }

 private:
  std::vector<Polygon> portions_of(const Polygon& polygon) const {
    Polygon within = clip(polygon, region_, tolerance_mm_);
    if (within.empty()) return {};
    if (outline_ == nullptr) return {std::move(within)};
    return clip(within, outline_->elements, tolerance_mm_);
  }

  void add_cell(const std::vector<Tile>& whole, ArrayTiles& within) const {
    const bool is_element = std::ranges::any_of(whole, [](const Tile& t) { return t.role == FacetRole::retro_facet; });
    std::vector<Tile> tiles;
    double lost_mm2 = 0.0;
    for (const Tile& tile : whole) {
      double kept_mm2 = 0.0;
      for (Polygon& portion : portions_of(tile.outline)) {
        kept_mm2 += area(portion);
        tiles.push_back(tile);
        tiles.back().outline = std::move(portion);
      }
      lost_mm2 += area(tile.outline) - kept_mm2;
    }
    if (tiles.empty()) return;
    const bool is_cut = is_loss(lost_mm2, tiles.front().outline, tolerance_mm_);
    if (is_element) (is_cut ? within.partial : within.full) += 1;
    if (is_element && is_cut && partial_ == PartialElements::omit)
      for (Tile& tile : tiles) tile = {std::move(tile.outline), {}, FacetRole::flat_back, tile.cell, true, {}};
    within.tiles.insert(within.tiles.end(), std::make_move_iterator(tiles.begin()),
                        std::make_move_iterator(tiles.end()));
  }

  const Polygon& region_;
  const PlanRegion* outline_;
  PartialElements partial_;
  double tolerance_mm_;
};

/// Adds flat tiles where a region overlaps the margin of the outline.
/// \param outline outline of the plate, or null
void add_margin(const Polygon& region, const PlanRegion* outline, double tolerance_mm, ArrayTiles& array) {
  if (outline == nullptr) return;
  std::uint32_t cell = array.tiles.empty() ? 0 : array.tiles.back().cell;
  for (Polygon& portion : clip(region, outline->margin, tolerance_mm))
    array.tiles.push_back({std::move(portion), {}, FacetRole::flat_back, ++cell, true, {}});
}

Vec2 pitch_of(const PartSpec& spec) {
  return bounding_box(aperture_outline(spec.element)).size() + Vec2(spec.array.x_gap_mm, spec.array.y_gap_mm);
}

/// Returns the tiles of the zone's cells. Each element is rotated about its centroid.
/// \param outline outline of the plate, or null
ArrayTiles tiles_of_cells(const PartZone& zone, const PartSpec& spec, const ArrayPlan& plan, const PlanRegion* outline,
                          double tolerance_mm) {
  ArrayTiles array{uncut_tiles(spec, zone.cells), 0, 0};
  if (zone.rotation_deg != 0.0) {
    auto cell = plan.cells.begin();
    for (Tile& tile : array.tiles) {
      while (cell->number != tile.cell) ++cell;
      const Vec2 middle = centroid(cell->outline);
      if (cell->is_element) turn(tile, Turn(zone.rotation_deg, middle, middle));
    }
  }
  const Polygon block = to_polygon(plan.block_mm);
  RegionCutter(block, outline, spec.array.partial_elements, tolerance_mm).cut(array);
  return array;
}

/// Array that fills a region. If the array is clipped later (is_cut), it extends beyond the region on all sides.
/// Otherwise it has the size of the region's bounding box.
struct FillingArray {
  PartSpec spec;
  Turn to_part;  ///< maps coordinates relative to the centre of the array to the part frame
  bool is_cut = false;

  FillingArray(const PartZone& zone, const Polygon& region, double tolerance_mm)
      : spec(zone.elements), to_part(zone.rotation_deg, Vec2::Zero(), bounding_box(region).centre()) {
    is_cut = zone.rotation_deg != 0.0 || !is_box(region, tolerance_mm);
    Vec2 lengths_mm = bounding_box(region).size();
    if (is_cut) {
      Vec2 reach = Vec2::Zero();
      for (const Vec2& p : region) reach = reach.cwiseMax(to_part.back(p).cwiseAbs());
      lengths_mm = 2.0 * (reach + 2.0 * pitch_of(spec));
    }
    spec.array.x_length_mm = lengths_mm.x();
    spec.array.y_length_mm = lengths_mm.y();
  }
  Vec2 middle_mm() const { return 0.5 * Vec2(spec.array.x_length_mm, spec.array.y_length_mm); }
};

/// Returns the tiles of the elements in a region, in the part frame.
/// \param outline outline of the plate, or null
ArrayTiles tiles_of(const PartZone& zone, const Polygon& region, const PlanRegion* outline, double tolerance_mm) {
  FillingArray filling(zone, region, tolerance_mm);
  const Rectangle box = bounding_box(region);
  if (outline != nullptr && !filling.is_cut)
    filling.spec.array.outline = std::make_shared<const PlanRegion>(moved(*outline, -box.lower));
  ArrayTiles array = array_tiles(filling.spec);
  const Turn to_part =
      filling.is_cut ? Turn(zone.rotation_deg, filling.middle_mm(), box.centre()) : Turn(0.0, Vec2::Zero(), box.lower);
  for (Tile& tile : array.tiles) turn(tile, to_part);
  if (!filling.is_cut) return array;
  RegionCutter(region, outline, filling.spec.array.partial_elements, tolerance_mm).cut(array);
  add_margin(region, outline, tolerance_mm, array);
  return array;
}

/// Appends the elements of a zone's array that are completely within a region and within the outline.
/// \param plate outline of the plate, or null
void add_whole_elements(const PartZone& zone, const Polygon& region, const PlanRegion* plate, double tolerance_mm,
                        std::vector<ElementPlacement>& elements) {
  const FillingArray filling(zone, region, tolerance_mm);
  const Polygon round_apex = element_cell(filling.spec.element).outline;
  for (const WholeElement& whole : whole_elements(filling.spec.array, filling.spec.element)) {
    Polygon outline = round_apex;
    for (Vec2& p : outline) p = filling.to_part.place(whole.centre_mm + (whole.is_rotated ? -1.0 : 1.0) * p);
    const Polygon left = clip(outline, region, tolerance_mm);
    if (left.empty() || is_loss(area(outline) - area(left), left, tolerance_mm)) continue;
    if (plate != nullptr && !is_within(outline, plate->elements, tolerance_mm)) continue;
    elements.push_back({filling.to_part.place(whole.centre_mm), zone.rotation_deg + (whole.is_rotated ? 180.0 : 0.0)});
  }
}

/// Moves corners that are within the tolerance of the plate's border onto the border.
void settle_on_border(Polygon& outline, const Vec2& size_mm, double tolerance_mm) {
  for (Vec2& p : outline)
    for (const Eigen::Index axis : {0, 1})
      for (const double bound : {0.0, size_mm[axis]})
        if (std::abs(p[axis] - bound) <= tolerance_mm) p[axis] = bound;
}

std::array<Vec2, 2> periods_of(const PartSpec& elements, double rotation_deg) {
  const Vec2 period_mm = make_lattice(elements, true).period_mm;
  const Turn to_zone(rotation_deg, Vec2::Zero(), Vec2::Zero());
  return {to_zone.turned({period_mm.x(), 0.0}), to_zone.turned({0.0, period_mm.y()})};
}

/// Collects the tiles of all zones, one zone after the other.
class ZoneTiler {
 public:
  ZoneTiler(const ZonedSpec& spec, double tolerance_mm)
      : spec_(spec), outline_(spec.cutting_outline()), tolerance_mm_(tolerance_mm) {}

  ZoneElements add_regions(const PartZone& zone) {
    ZoneElements elements;
    for (const Polygon& region : zone.regions) {
      append(tiles_of(zone, region, outline_, tolerance_mm_), elements);
      for (const Polygon& inner : within_plate(spec_, region)) elements.area_mm2 += area(inner);
    }
    return elements;
  }

  /// \param land_mm flat areas next to the elements
  ZoneElements add_cells(const PartZone& zone, const PartSpec& array, const ArrayPlan& plan,
                         const std::vector<Rectangle>& land_mm) {
    ZoneElements elements;
    ArrayTiles tiles = tiles_of_cells(zone, array, plan, outline_, tolerance_mm_);
    if (&zone == &spec_.zones.front()) add_margin(to_polygon(plan.block_mm), outline_, tolerance_mm_, tiles);
    std::uint32_t last = tiles.tiles.empty() ? 0 : tiles.tiles.back().cell;
    for (const Rectangle& land : land_mm)
      for (Polygon& portion : within_plate(spec_, to_polygon(land)))
        tiles.tiles.push_back({std::move(portion), {}, FacetRole::flat_back, ++last, true, {}});
    for (const Tile& tile : tiles.tiles) elements.area_mm2 += area(tile.outline);
    append(std::move(tiles), elements);
    return elements;
  }
  const std::vector<Tile>& tiles() const { return tiles_; }

 private:
  /// Appends tiles, and adds the numbers of their elements and cells to `elements`.
  void append(ArrayTiles array, ZoneElements& elements) {
    elements.full += array.full;
    elements.partial += array.partial;
    std::optional<std::uint32_t> last;
    for (Tile& tile : array.tiles) {
      settle_on_border(tile.outline, spec_.size_mm, tolerance_mm_);
      if (last != tile.cell) {
        ++cells_;
        ++elements.cells;
      }
      last = tile.cell;
      tile.cell = cells_;
      tile.is_output = true;
      tiles_.push_back(std::move(tile));
    }
  }

  const ZonedSpec& spec_;
  const PlanRegion* outline_;
  double tolerance_mm_;
  std::uint32_t cells_ = 0;
  std::vector<Tile> tiles_;
};

/// Returns the size of the smallest element, which is the scale for tolerances.
double size_of(const ZonedSpec& spec) {
  double size_mm = spec.size_mm.minCoeff();
  for (const PartZone& zone : spec.zones)
    size_mm = std::min(size_mm, bounding_box(aperture_outline(zone.elements.element)).size().minCoeff());
  return size_mm;
}

/// Returns true if two polygons have the same corners. The first corner may differ.
bool is_same(const Polygon& a, const Polygon& b, double near_mm) {
  const auto has = [&](const Vec2& p) {
    return std::ranges::any_of(b, [&](const Vec2& q) { return (p - q).norm() <= near_mm; });
  };
  return a.size() == b.size() && std::ranges::all_of(a, has);
}

/// Returns true if the elements and land of two arrays have equal outlines at equal positions.
bool are_alike(const ArraySheet& own, const ArraySheet& first, double near_mm) {
  const auto is_near = [&](const Vec2& a, const Vec2& b) { return (a - b).norm() <= near_mm; };
  return is_near(own.lattice.period_mm, first.lattice.period_mm) && is_near(own.anchor_mm, first.anchor_mm) &&
         std::equal(own.lattice.cells.begin(), own.lattice.cells.end(), first.lattice.cells.begin(),
                    first.lattice.cells.end(), [&](const Cell& a, const Cell& b) {
                      return a.is_element == b.is_element && is_same(a.outline, b.outline, near_mm);
                    });
}

/// Returns true if a rotation of each element about its centroid maps the outline of the element to itself.
bool may_turn(const ArraySheet& sheet, double deg, double near_mm) {
  return std::ranges::all_of(sheet.lattice.cells, [&](const Cell& cell) {
    const Vec2 middle = centroid(cell.outline);
    const Turn about_middle(deg, middle, middle);
    Polygon turned = cell.outline;
    for (Vec2& p : turned) p = about_middle.place(p);
    return !cell.is_element || is_same(turned, cell.outline, near_mm);
  });
}

/// Returns the smallest rotation for which may_turn() is true. Outlines have at most six corners.
double min_rotation_deg(const ArraySheet& sheet, double near_mm) {
  for (int times = 6; times > 1; --times)
    if (may_turn(sheet, 360.0 / times, near_mm)) return 360.0 / times;
  return 360.0;
}

/// Returns nothing if the elements of a zone fit into the cells of the first zone's array. Otherwise, returns the
/// reason.
std::optional<ZoneFault> misfit(std::size_t zone, const ArraySheet& own, const ArraySheet& first, double rotation_deg,
                                double near_mm) {
  if (!are_alike(own, first, near_mm))
    return ZoneFault{zone,
                     "must not change the outlines and positions of the elements, which must be the same as in zone 1",
                     ZoneFault::Subject::elements};
  if (!may_turn(own, rotation_deg, near_mm))
    return ZoneFault{zone,
                     fmt::format("must be a multiple of {:.6g} degrees, so that the rotation maps the outline of each "
                                 "element to itself, got {:.17g}",
                                 min_rotation_deg(own, near_mm), rotation_deg),
                     ZoneFault::Subject::rotation};
  return std::nullopt;
}

std::string words_of(const ArrayCell& cell) {
  const Vec2 at = centroid(cell.outline);
  return fmt::format("the element at x = {:.6g}, y = {:.6g} mm", at.x(), at.y());
}

std::optional<ZoneFault> fault_of_cells(const ZonedSpec& spec) {
  const double near_mm = kSamePlace * size_of(spec);
  const PartSpec first_array = array_of_cells(spec, spec.zones.front());
  const ArraySheet first_sheet(first_array);
  const ArrayPlan first = plan_of_array(first_array);
  std::map<std::uint32_t, std::size_t> holder;
  for (std::size_t z = 0; z < spec.zones.size(); ++z) {
    const PartZone& zone = spec.zones[z];
    const PartSpec array = array_of_cells(spec, zone);
    if (auto fault = misfit(z, ArraySheet(array), first_sheet, zone.rotation_deg, near_mm)) return fault;
    bool has_elements = false;
    for (const std::uint32_t number : zone.cells) {
      const ArrayCell& cell = *std::lower_bound(first.cells.begin(), first.cells.end(), number,
                                                [](const ArrayCell& c, std::uint32_t n) { return c.number < n; });
      has_elements |= cell.is_element;
      if (const auto [other, is_new] = holder.try_emplace(number, z); !is_new)
        return ZoneFault{
            z, fmt::format("the zone contains {}, which is also in zone {}", words_of(cell), other->second + 1)};
    }
    if (!has_elements) return ZoneFault{z, "the zone contains no element"};
  }
  const auto is_free = [&](const ArrayCell& cell) { return !holder.contains(cell.number); };
  const auto free = std::ranges::find_if(first.cells, is_free);
  if (free == first.cells.end()) return std::nullopt;
  return ZoneFault{
      spec.zones.size() - 1,
      fmt::format("each cell must be in a zone, but {} of {} cells are in no zone, for example {}",
                  std::count_if(first.cells.begin(), first.cells.end(), is_free), first.cells.size(), words_of(*free))};
}

/// Returns the area in plan of one element and the land that belongs to it.
double room_of_element(const PartSpec& elements) {
  const bool is_prism = std::holds_alternative<RtpElement>(elements.element);
  return is_prism ? pitch_of(elements).prod() : area(aperture_outline(elements.element));
}

}  // namespace

PartSpec array_of_cells(const ZonedSpec& spec, const PartZone& zone) {
  PartSpec array = zone.elements;
  array.array.x_length_mm = spec.size_mm.x();
  array.array.y_length_mm = spec.size_mm.y();
  array.array.outline = spec.outline;
  array.array.x_offset_mm = array.array.y_offset_mm = spec.outline ? spec.outline->margin_mm : 0.0;
  return array;
}

const PlanRegion* ZonedSpec::cutting_outline() const {
  return outline && !(outline->is_box() && outline->margin_mm == 0.0) ? outline.get() : nullptr;
}

std::vector<Polygon> within_plate(const ZonedSpec& spec, const Polygon& region) {
  const PlanRegion* const outline = spec.cutting_outline();
  if (outline == nullptr) return {region};
  return clip(region, outline->whole, kSamePlace * size_of(spec));
}

namespace {

double area_in_plate(const ZonedSpec& spec, const Polygon& region) {
  double sum = 0.0;
  for (const Polygon& inner : within_plate(spec, region)) sum += area(inner);
  return sum;
}

}  // namespace

std::optional<ZoneFault> fault_of_zones(const ZonedSpec& spec) {
  if (spec.is_by_cell) return fault_of_cells(spec);
  // Corners within the relative distance kSamePlace are merged later. The tolerance for gaps and overlaps is half of
  // this distance.
  const double near_mm = 0.5 * kSamePlace * size_of(spec);
  const PlanRegion* const outline = spec.cutting_outline();
  // Each convex polygon of an outline contributes rounding errors from its sides.
  const double cuts = outline != nullptr ? 4.0 * static_cast<double>(outline->whole.pieces.size()) : 1.0;
  const double near_mm2 = cuts * near_mm * spec.size_mm.norm();
  struct Placed {
    std::size_t zone;
    const Polygon* region;
    Rectangle box;
  };
  std::vector<Placed> placed;
  double covered_mm2 = 0.0;
  for (std::size_t z = 0; z < spec.zones.size(); ++z)
    for (const Polygon& region : spec.zones[z].regions) {
      const Rectangle box = bounding_box(region);
      if (!contains({Vec2::Zero(), spec.size_mm}, region, near_mm))
        return ZoneFault{z, "the zone extends beyond the part"};
      for (const Placed& other : placed) {
        const bool is_apart = (box.lower.array() >= other.box.upper.array()).any() ||
                              (other.box.lower.array() >= box.upper.array()).any();
        if (is_apart) continue;
        const Polygon both = clip(region, *other.region, near_mm);
        if (!both.empty() && area_in_plate(spec, both) > near_mm2)
          return ZoneFault{z, fmt::format("the zone overlaps {}",
                                          other.zone == z ? "itself" : fmt::format("zone {}", other.zone + 1))};
      }
      placed.push_back({z, &region, box});
      covered_mm2 += area_in_plate(spec, region);
    }
  for (std::size_t z = 0; outline != nullptr && z < spec.zones.size(); ++z)
    if (std::ranges::all_of(spec.zones[z].regions,
                            [&](const Polygon& region) { return area_in_plate(spec, region) <= near_mm2; }))
      return ZoneFault{z, "the zone is outside the outline of the part"};
  if (spec.area_mm2() - covered_mm2 > near_mm2)
    return ZoneFault{
        spec.zones.size() - 1,
        fmt::format("the zones must cover the whole part, but {:.6g} mm2 of its {:.6g} mm2 are not covered",
                    spec.area_mm2() - covered_mm2, spec.area_mm2())};
  return std::nullopt;
}

double element_estimate(const ZonedSpec& spec) {
  if (spec.is_by_cell) return spec.area_mm2() / room_of_element(spec.zones.front().elements);
  double sum = 0.0;
  for (const PartZone& zone : spec.zones)
    for (const Polygon& region : zone.regions) sum += area(region) / room_of_element(zone.elements);
  return sum;
}

std::vector<std::vector<ElementPlacement>> whole_elements(const ZonedSpec& spec) {
  const double tolerance_mm = kSamePlace * size_of(spec);
  std::vector<std::vector<ElementPlacement>> elements(spec.zones.size());
  if (!spec.is_by_cell) {
    for (std::size_t z = 0; z < spec.zones.size(); ++z)
      for (const Polygon& region : spec.zones[z].regions)
        add_whole_elements(spec.zones[z], region, spec.cutting_outline(), tolerance_mm, elements[z]);
    return elements;
  }
  const ArrayPlan plan = plan_of_array(array_of_cells(spec, spec.zones.front()));
  for (std::size_t z = 0; z < spec.zones.size(); ++z) {
    const PartZone& zone = spec.zones[z];
    auto cell = plan.cells.begin();
    for (const std::uint32_t number : zone.cells) {
      while (cell->number != number) ++cell;
      if (!cell->is_element || !contains(plan.block_mm, cell->outline, tolerance_mm)) continue;
      if (const PlanRegion* const plate = spec.cutting_outline();
          plate != nullptr && !is_within(cell->outline, plate->elements, tolerance_mm))
        continue;
      const Vec2 apex = centroid(cell->outline);
      // A triangle that is rotated by 180 degrees has no corner in the direction +x from its centroid.
      const bool is_rotated = std::ranges::none_of(
          cell->outline, [&](const Vec2& p) { return p.x() - apex.x() > 0.75 * (p - apex).norm(); });
      elements[z].push_back({apex, zone.rotation_deg + (is_rotated ? 180.0 : 0.0)});
    }
  }
  return elements;
}

namespace {

/// Returns the borders of the plate in the form that build_patch() requires.
PatchRim rim_of(const ZonedSpec& spec) {
  PatchRim rim;
  const PlanRegion* const outline = spec.cutting_outline();
  if (outline == nullptr) return rim;
  for (const ConvexRegion* region : {&outline->whole, &outline->elements})
    rim.borders.insert(rim.borders.end(), region->borders.begin(), region->borders.end());
  if (outline->is_convex()) return rim;
  rim.hull = outline->hull;
  rim.top_mm = spec.thickness_mm;
  return rim;
}

}  // namespace

void add_zones(Part& part, const ZonedSpec& spec) {
  part.size_mm = size_of(spec);
  // BeamWalk limits the size of its beam fragments to the size of this prism. A zoned part may have several kinds of
  // elements, so the size of the smallest element is used.
  part.spec.element = RtpElement{part.size_mm, part.size_mm, 90.0};
  part.spec.thickness_mm = spec.thickness_mm;
  const Rectangle plate{Vec2::Zero(), spec.size_mm};
  const PlanRegion* const outline = spec.cutting_outline();
  part.outline = outline != nullptr ? outline->hull : to_polygon(plate);
  part.spec.array.outline = spec.outline;
  if (outline != nullptr && !outline->is_convex()) part.entrance_pieces = outline->whole.pieces;
  ZoneTiler tiler(spec, kSamePlace * part.size_mm);
  ArrayPlan plan;
  if (spec.is_by_cell) {
    const PartSpec array = array_of_cells(spec, spec.zones.front());
    plan = plan_of_array(array);
    for (const Polygon& piece : within_plate(spec, part.outline))
      part.lattice_regions.push_back({piece, periods_of(array, 0.0)});
  }
  for (const PartZone& zone : spec.zones) {
    const bool is_first = &zone == &spec.zones.front();
    part.zones.push_back(spec.is_by_cell ? tiler.add_cells(zone, array_of_cells(spec, zone), plan,
                                                           is_first ? plan.land_mm : std::vector<Rectangle>())
                                         : tiler.add_regions(zone));
    for (const Polygon& region : zone.regions)
      for (const Polygon& inner : within_plate(spec, region))
        part.lattice_regions.push_back({inner, periods_of(zone.elements, zone.rotation_deg)});
    part.elements_full += part.zones.back().full;
    part.elements_partial += part.zones.back().partial;
  }
  part.patches.push_back(build_patch(tiler.tiles(), plate, part.size_mm, rim_of(spec)));
  part.placements.push_back({0, Vec2::Zero()});
}

}  // namespace retrace::geometry
