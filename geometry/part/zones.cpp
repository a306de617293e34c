#include "geometry/part/zones.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "core/error.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/part/tiling.h"

namespace retrace::geometry {
namespace {

/// Corners that are nearer to each other than this share of the smallest element are one.
constexpr double kSamePlace = 1e-9;

/// A turn about a place of a sheet and a move from there to a place of the part.
class Turn {
 public:
  Turn(double deg, const Vec2& on_sheet, const Vec2& in_part)
      : cos_(std::cos(deg * std::numbers::pi / 180.0)),
        sin_(std::sin(deg * std::numbers::pi / 180.0)),
        on_sheet_(on_sheet),
        in_part_(in_part) {}

  Vec2 turned(const Vec2& v) const { return {cos_ * v.x() - sin_ * v.y(), sin_ * v.x() + cos_ * v.y()}; }
  Vec2 place(const Vec2& p) const { return turned(p - on_sheet_) + in_part_; }
  /// Where a place of the part lies, seen from in_part and turned back.
  Vec2 back(const Vec2& p) const {
    const Vec2 v = p - in_part_;
    return {cos_ * v.x() + sin_ * v.y(), -sin_ * v.x() + cos_ * v.y()};
  }

 private:
  double cos_;
  double sin_;
  Vec2 on_sheet_;
  Vec2 in_part_;
};

void turn(Tile& tile, const Turn& by) {
  const double at_origin_mm = tile.plane.at(Vec2::Zero());
  const Vec2 slope = by.turned(tile.plane.slope);
  tile.plane = {at_origin_mm - slope.dot(by.place(Vec2::Zero())), slope};
  for (Vec2& p : tile.outline) p = by.place(p);
  if (tile.middle_mm) tile.middle_mm = by.place(*tile.middle_mm);
}

bool is_box(const Polygon& region, double tolerance_mm) {
  const Rectangle box = bounding_box(region);
  return region.size() == 4 && std::ranges::all_of(region, [&](const Vec2& p) {
           return (p - box.lower).cwiseAbs().cwiseMin((p - box.upper).cwiseAbs()).maxCoeff() <= tolerance_mm;
         });
}

/// The tiles of one cell, consecutive, within a region.
class RegionCutter {
 public:
  RegionCutter(const Polygon& region, PartialElements partial, double tolerance_mm)
      : region_(region), partial_(partial), tolerance_mm_(tolerance_mm) {}

  /// Leaves of all cells what lies in the region, and counts elements anew.
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
  void add_cell(std::vector<Tile> tiles, ArrayTiles& within) const {
    const bool is_element = std::ranges::any_of(tiles, [](const Tile& t) { return t.role == FacetRole::retro_facet; });
    double lost_mm2 = 0.0;
    for (Tile& tile : tiles) {
      const double before_mm2 = area(tile.outline);
      tile.outline = clip(tile.outline, region_, tolerance_mm_);
      lost_mm2 += before_mm2 - (tile.outline.empty() ? 0.0 : area(tile.outline));
    }
    std::erase_if(tiles, [](const Tile& tile) { return tile.outline.empty(); });
    if (tiles.empty()) return;
    const bool is_cut = lost_mm2 > tolerance_mm_ * bounding_box(tiles.front().outline).size().norm();
    if (is_element) (is_cut ? within.partial : within.full) += 1;
    if (is_element && is_cut && partial_ == PartialElements::omit)
      for (Tile& tile : tiles) tile = {std::move(tile.outline), {}, FacetRole::flat_back, tile.cell, true, {}};
    within.tiles.insert(within.tiles.end(), std::make_move_iterator(tiles.begin()),
                        std::make_move_iterator(tiles.end()));
  }

  const Polygon& region_;
  PartialElements partial_;
  double tolerance_mm_;
};

Vec2 pitch_of(const PartSpec& spec) {
  return bounding_box(aperture_outline(spec.element)).size() + Vec2(spec.array.x_gap_mm, spec.array.y_gap_mm);
}

/// What stands in a region, in the part frame.
ArrayTiles tiles_of(const PartZone& zone, const Polygon& region, double tolerance_mm) {
  const Rectangle box = bounding_box(region);
  PartSpec spec = zone.elements;
  const auto lay_out = [&](const Vec2& lengths_mm) {
    spec.array.x_length_mm = lengths_mm.x();
    spec.array.y_length_mm = lengths_mm.y();
    return array_tiles(spec);
  };
  if (zone.rotation_deg == 0.0 && is_box(region, tolerance_mm)) {
    ArrayTiles array = lay_out(box.size());
    const Turn to_box(0.0, Vec2::Zero(), box.lower);
    for (Tile& tile : array.tiles) turn(tile, to_box);
    return array;
  }
  const Turn to_middle(zone.rotation_deg, Vec2::Zero(), box.middle());
  Vec2 reach = Vec2::Zero();
  for (const Vec2& p : region) reach = reach.cwiseMax(to_middle.back(p).cwiseAbs());
  const Vec2 lengths_mm = 2.0 * (reach + 2.0 * pitch_of(spec));
  ArrayTiles array = lay_out(lengths_mm);
  const Turn about_middle(zone.rotation_deg, 0.5 * lengths_mm, box.middle());
  for (Tile& tile : array.tiles) turn(tile, about_middle);
  RegionCutter(region, spec.array.partial_elements, tolerance_mm).cut(array);
  return array;
}

/// Corners beside the plate's border by less than the tolerance lie on it.
void settle_on_border(Polygon& outline, const Vec2& size_mm, double tolerance_mm) {
  for (Vec2& p : outline)
    for (const Eigen::Index axis : {0, 1})
      for (const double bound : {0.0, size_mm[axis]})
        if (std::abs(p[axis] - bound) <= tolerance_mm) p[axis] = bound;
}

/// The tiles of zone after zone.
class ZoneTiler {
 public:
  ZoneTiler(const Vec2& size_mm, double tolerance_mm) : size_mm_(size_mm), tolerance_mm_(tolerance_mm) {}

  ZoneElements add(const PartZone& zone) {
    ZoneElements elements;
    for (const Polygon& region : zone.regions) {
      ArrayTiles array = tiles_of(zone, region, tolerance_mm_);
      elements.full += array.full;
      elements.partial += array.partial;
      append(std::move(array.tiles));
    }
    return elements;
  }
  const std::vector<Tile>& tiles() const { return tiles_; }

 private:
  void append(std::vector<Tile> tiles) {
    const std::uint32_t first = cells_;
    for (Tile& tile : tiles) {
      settle_on_border(tile.outline, size_mm_, tolerance_mm_);
      tile.cell += first;
      tile.owned = true;
      cells_ = std::max(cells_, tile.cell + 1);
      tiles_.push_back(std::move(tile));
    }
  }

  Vec2 size_mm_;
  double tolerance_mm_;
  std::uint32_t cells_ = 0;
  std::vector<Tile> tiles_;
};

/// Of the smallest element, the scale for tolerances.
double size_of(const ZonedSpec& spec) {
  double size_mm = spec.size_mm.minCoeff();
  for (const PartZone& zone : spec.zones)
    size_mm = std::min(size_mm, bounding_box(aperture_outline(zone.elements.element)).size().minCoeff());
  return size_mm;
}

}  // namespace

double area(const PartZone& zone) {
  double sum_mm2 = 0.0;
  for (const Polygon& region : zone.regions) sum_mm2 += area(region);
  return sum_mm2;
}

std::optional<ZoneFault> fault_of_zones(const ZonedSpec& spec) {
  // What is farther apart than corners that are welded is a gap.
  const double near_mm = 0.5 * kSamePlace * size_of(spec);
  const double near_mm2 = near_mm * spec.size_mm.norm();
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
      if (!contains({Vec2::Zero(), spec.size_mm}, region, near_mm)) return ZoneFault{z, "reaches beyond the part"};
      for (const Placed& other : placed) {
        const bool is_apart = (box.lower.array() >= other.box.upper.array()).any() ||
                              (other.box.lower.array() >= box.upper.array()).any();
        if (is_apart) continue;
        const Polygon both = clip(region, *other.region, near_mm);
        if (!both.empty() && area(both) > near_mm2)
          return ZoneFault{
              z, fmt::format("overlaps {}", other.zone == z ? "itself" : fmt::format("zone {}", other.zone + 1))};
      }
      placed.push_back({z, &region, box});
      covered_mm2 += area(region);
    }
  if (spec.area_mm2() - covered_mm2 > near_mm2)
    return ZoneFault{spec.zones.size() - 1,
                     fmt::format("and those before it leave {:.6g} of {:.6g} mm2 of the part free",
                                 spec.area_mm2() - covered_mm2, spec.area_mm2())};
  return std::nullopt;
}

double element_estimate(const ZonedSpec& spec) {
  double sum = 0.0;
  for (const PartZone& zone : spec.zones) {
    const auto* const prism = std::get_if<RtpElement>(&zone.elements.element);
    sum += area(zone) /
           (prism != nullptr ? pitch_of(zone.elements).prod() : area(aperture_outline(zone.elements.element)));
  }
  return sum;
}

void add_zones(Part& part, const ZonedSpec& spec) {
  part.size_mm = size_of(spec);
  // As wide as the steps that light is followed in.
  part.spec.element = RtpElement{part.size_mm, part.size_mm, 90.0};
  part.spec.thickness_mm = spec.thickness_mm;
  const Rectangle plate{Vec2::Zero(), spec.size_mm};
  part.outline = to_polygon(plate);
  ZoneTiler tiler(spec.size_mm, kSamePlace * part.size_mm);
  for (const PartZone& zone : spec.zones) {
    part.zones.push_back(tiler.add(zone));
    part.elements_full += part.zones.back().full;
    part.elements_partial += part.zones.back().partial;
  }
  part.patches.push_back(build_patch(tiler.tiles(), plate, part.size_mm));
  part.placements.push_back({0, Vec2::Zero()});
}

}  // namespace retrace::geometry
