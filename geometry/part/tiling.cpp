#include "geometry/part/tiling.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/random.h"
#include "geometry/elements/edges.h"
#include "geometry/elements/plane_polygon.h"
#include "geometry/part/zones.h"

namespace retrace::geometry {
namespace {

// Maximum number of elements in a patch if the sheet (the plane on which the array is laid out) repeats along only one
// axis. Patches are then short along the other axis.
constexpr double kElementsPerColumnPatch = 256.0;
// kFacetsPerPatch is the approximate number of facets in a shared patch, including those of rounded edges.
// kFewestPeriods is the minimum number of periods in a shared patch. Smaller patches would be inefficient, because one
// additional period on all sides is laid out together with each patch.
constexpr double kFacetsPerPatch = 16384.0;
constexpr double kFewestPeriods = 4.0;
// Number of periods on each side of the central period. An infinite array is stored as one patch with all these
// periods, so that rays rarely have to be moved back to the central period.
constexpr int kPeriodsBeyond = 2;
constexpr std::uint32_t kNoPatch = UINT32_MAX;

/// Returns the errors of element number `number` of period (i, j): the common errors plus random tilts.
AngleErrors errors_of(const PartSpec& spec, std::int64_t i, std::int64_t j, std::uint32_t number) {
  constexpr std::uint32_t kTiltStream = 3;
  AngleErrors errors = spec.angle_errors;
  if (!(spec.random_tilts.sigma_arcmin > 0.0)) return errors;
  const auto words = philox({spec.random_tilts.seed, kTiltStream}, static_cast<std::uint32_t>(i),
                            static_cast<std::uint32_t>(j), number);
  // Box-Muller transform. The small addend avoids the logarithm of 0.
  const auto radius = [&](std::size_t k) { return std::sqrt(-2.0 * std::log(unit_interval(words[k]) + 0x1p-33)); };
  const auto angle = [&](std::size_t k) { return 2.0 * std::numbers::pi * unit_interval(words[k]); };
  const std::array<double, 3> normal = {radius(0) * std::cos(angle(1)), radius(0) * std::sin(angle(1)),
                                        radius(2) * std::cos(angle(3))};
  for (std::size_t k = 0; k < 3; ++k) errors.facet_tilt_arcmin[k] += spec.random_tilts.sigma_arcmin * normal[k];
  return errors;
}

/// Returns the four strips between the extent of the array and its block of elements. Strips may be empty.
std::array<Rectangle, 4> margins(const Rectangle& extent, const Rectangle& block) {
  return {Rectangle{extent.lower, {block.lower.x(), extent.upper.y()}},
          Rectangle{{block.upper.x(), extent.lower.y()}, extent.upper},
          Rectangle{{block.lower.x(), extent.lower.y()}, {block.upper.x(), block.lower.y()}},
          Rectangle{{block.lower.x(), block.upper.y()}, {block.upper.x(), extent.upper.y()}}};
}

/// Converts a plane from a local frame to the part frame.
HeightPlane placed_plane(const HeightPlane& own, const SubstrateFrame& frame) {
  const Vec3 normal = own.slope.x() * frame.along_u + own.slope.y() * frame.along_v - frame.normal;
  const Vec3 point = frame.origin + own.height_mm * frame.normal;
  HeightPlane plane;
  plane.slope = -normal.head<2>() / normal.z();
  plane.height_mm = point.z() - plane.slope.dot(point.head<2>());
  return plane;
}

/// Converts a point from a local frame to the part frame and returns it in plan.
Vec2 placed(const Vec2& own, double height_mm, const SubstrateFrame& frame) {
  return (frame.origin + own.x() * frame.along_u + own.y() * frame.along_v + height_mm * frame.normal).head<2>();
}

/// Moves a cell in plan and along z.
void move_facets(Cell& cell, const Vec2& shift_mm, double height_mm) {
  for (CellFacet& facet : cell.facets) {
    facet.outline = moved(std::move(facet.outline), shift_mm);
    facet.plane.height_mm -= facet.plane.slope.dot(shift_mm);
    if (height_mm != 0.0) facet.plane.height_mm += height_mm;
    if (facet.centroid_mm) *facet.centroid_mm += shift_mm;
  }
}

FacetRole role_of(const Cell& cell, const CellFacet& facet) {
  return (cell.is_element && !facet.is_flat) || facet.is_edge ? FacetRole::retro_facet : FacetRole::flat_back;
}

class Tiler {
 public:
  Tiler(Part& part, const ArraySheet& sheet, const FacetPlanes* planes)
      : part_(part), sheet_(sheet), spec_(part.spec), planes_(planes) {}

  void add_all(const Vec2& origin_mm, double elements_per_patch) {
    const IndexRange all = sheet_.indices();
    const std::array<std::int64_t, 2> step = patch_size(all, elements_per_patch);
    is_one_ = step[0] >= all.upper[0] - all.lower[0] && step[1] >= all.upper[1] - all.lower[1];
    for (std::int64_t j = all.lower[1]; j < all.upper[1]; j += step[1])
      for (std::int64_t i = all.lower[0]; i < all.upper[0]; i += step[0])
        add_piece({{i, j}, {std::min(i + step[0], all.upper[0]), std::min(j + step[1], all.upper[1])}}, origin_mm);
    check_cover();
  }

  ArrayTiles all_tiles() {
    Piece piece;
    collect(piece, begin_whole());
    return {tiles_of_part(), piece.full, piece.partial};
  }

  std::vector<Tile> uncut_tiles(const std::vector<std::uint32_t>& cells) {
    auto next = cells.begin();
    visit_cells(begin_whole(), [&](const Index& index, std::uint32_t number, const Vec2& shift_mm, bool) {
      while (next != cells.end() && *next < number) ++next;
      if (next == cells.end() || *next != number) return;
      const std::size_t first = tiles_.size();
      Cell cell = cell_at(index, here_->sheet_cell(index.number, shift_mm));
      for (CellFacet& facet : cell.facets)
        add_tile(std::move(facet.outline), facet.plane, role_of(cell, facet), facet.centroid_mm);
      for (std::size_t t = first; t < tiles_.size(); ++t) tiles_[t].cell = number;
    });
    return tiles_of_part();
  }

  ArrayPlan plan() {
    ArrayPlan plan;
    visit_cells(begin_whole(), [&](const Index& index, std::uint32_t number, const Vec2& shift_mm, bool) {
      const SheetCell place = here_->sheet_cell(index.number, shift_mm);
      if (here_->in_element_area(here_->within(place, place.outline, here_->block())).empty()) return;
      plan.cells.push_back(
          {number, moved(place.outline, here_->origin_mm()), sheet_.lattice.cells[index.number].is_element});
    });
    plan.block_mm = sheet_.block_mm;
    for (const Rectangle& margin : margins(sheet_.coverage_mm, sheet_.block_mm))
      if (!margin.empty()) plan.land_mm.push_back(margin);
    return plan;
  }

  void add_periods() {
    add_piece({{-kPeriodsBeyond, -kPeriodsBeyond}, {kPeriodsBeyond + 1, kPeriodsBeyond + 1}}, Vec2::Zero());
  }

 private:
  /// A patch and its numbers of complete and partial elements. Equal portions of the array share one patch.
  struct Piece {
    std::uint32_t patch = kNoPatch;  ///< kNoPatch if no portion of the patch is within the part
    std::int64_t full = 0;
    std::int64_t partial = 0;
    double area_mm2 = 0.0;  ///< area of all tiles in plan
  };
  using Key = std::array<std::int64_t, 13>;

  std::array<std::int64_t, 2> patch_size(const IndexRange& all, double elements_per_patch) const {
    const double each = std::max(1, sheet_.lattice.elements_per_period);
    const double periods = std::max(1.0, elements_per_patch / each);
    if (sheet_.coverage_mm.size().cwiseQuotient(sheet_.lattice.period_mm).prod() <= periods)
      return {all.upper[0] - all.lower[0], all.upper[1] - all.lower[1]};
    const bool repeats_once = sheet_.repeats_along(0) != sheet_.repeats_along(1);
    double most = repeats_once ? std::min(periods, kElementsPerColumnPatch / each) : periods;
    if (are_shared() && sheet_.repeats_along(0) && sheet_.repeats_along(1))
      most = std::min(most, std::max(kFewestPeriods, kFacetsPerPatch / facets_of_period()));
    const auto side = static_cast<std::int64_t>(std::max(1.0, std::floor(std::sqrt(most))));
    return {side, side};
  }

  /// Returns true if portions of the array may be equal and share a patch.
  bool are_shared() const { return planes_ == nullptr && !(spec_.random_tilts.sigma_arcmin > 0.0); }

  double facets_of_period() const {
    std::size_t facets = 0;
    for (const Cell& cell : sheet_.lattice.cells) facets += cell.facets.size();
    return static_cast<double>(std::max<std::size_t>(1, facets));
  }

  void add_piece(const IndexRange& range, const Vec2& origin_mm) {
    here_.emplace(sheet_, range.lower[0], range.lower[1], is_one_);
    if (!are_shared()) known_.clear();
    const auto [it, is_new] = known_.try_emplace(key_of(range));
    Piece& piece = it->second;
    if (is_new) fill(piece, range);
    if (piece.patch == kNoPatch) return;
    part_.placements.push_back({piece.patch, origin_mm + here_->origin_mm(), here_->height_mm()});
    part_.elements_full += piece.full;
    part_.elements_partial += piece.partial;
    covered_mm2_ += piece.area_mm2;
  }

  /// Returns a key that is equal for equal portions of the array. It contains the positions of borders and the shape of
  /// the substrate. The position of a border that is more than two periods away from the portion has no effect.
  Key key_of(const IndexRange& range) {
    const double quantum = 1e-7 * sheet_.lattice.period_mm.minCoeff();
    const Vec2 reach = 2.0 * sheet_.lattice.period_mm;
    const Vec2 size =
        Vec2(static_cast<double>(range.upper[0] - range.lower[0]), static_cast<double>(range.upper[1] - range.lower[1]))
            .cwiseProduct(sheet_.lattice.period_mm);
    const Rectangle round{-reach, size + reach};
    const Rectangle in_plan = here_->plan_bounding_box(round);
    Key key{};
    std::size_t k = 0;
    // Portions that an outline crosses are not shared.
    if (!here_->is_in_element_area(to_polygon(in_plan))) key.back() = ++portions_at_outline_;
    for (const Eigen::Index axis : {0, 1}) {
      const auto a = static_cast<std::size_t>(axis);
      const auto add = [&](const Rectangle& border, const Rectangle& within) {
        for (const double bound : {border.lower[axis], border.upper[axis]})
          key[k++] = std::llround(std::clamp(bound, within.lower[axis], within.upper[axis]) / quantum);
      };
      add(here_->part(), in_plan);
      add(here_->block(), round);
      key[k++] = range.upper[a] - range.lower[a];
      key[k++] = sheet_.repeats_along(a) ? 0 : range.lower[a];
    }
    return key;
  }

  /// Builds a patch from the tiles in a range of the lattice. The tiles of one additional period on all sides are used
  /// as neighbours.
  void fill(Piece& piece, const IndexRange& range) {
    collect(piece, range);
    for (const Tile& tile : tiles_) piece.area_mm2 += tile.is_output ? area(tile.outline) : 0.0;
    if (std::none_of(tiles_.begin(), tiles_.end(), [](const Tile& tile) { return tile.is_output; })) return;
    piece.patch = static_cast<std::uint32_t>(part_.patches.size());
    part_.patches.push_back(build_patch(tiles_, here_->block_in_plan(), part_.size_mm, rim_of_part()));
  }

  /// Returns the borders of a part with an outline, relative to the portion that is being built.
  PatchRim rim_of_part() const {
    PatchRim rim;
    if (sheet_.outline == nullptr) return rim;
    rim.borders = here_->outline_borders();
    if (sheet_.outline->is_convex()) return rim;
    rim.hull = moved(sheet_.outline->hull, -here_->origin_mm());
    rim.top_mm = spec_.thickness_mm - here_->height_mm();
    return rim;
  }

  /// Cell of the lattice: its period and its number within the period.
  struct Index {
    std::int64_t i = 0;
    std::int64_t j = 0;
    std::uint32_t number = 0;
  };

  /// Visits the cells of a range and of one additional period on all sides. The arguments of `visit` are the cell, a
  /// consecutive number, the shift of the cell from the lattice, and true if the cell is within the range.
  template <class Visit>
  void visit_cells(const IndexRange& range, const Visit& visit) const {
    std::uint32_t number = 0;
    for (std::int64_t j = range.lower[1] - 1; j <= range.upper[1]; ++j)
      for (std::int64_t i = range.lower[0] - 1; i <= range.upper[0]; ++i) {
        const bool owned = i >= range.lower[0] && i < range.upper[0] && j >= range.lower[1] && j < range.upper[1];
        const Vec2 index(static_cast<double>(i - range.lower[0]), static_cast<double>(j - range.lower[1]));
        for (std::uint32_t c = 0; c < sheet_.lattice.cells.size(); ++c)
          visit(Index{i, j, c}, number++, index.cwiseProduct(sheet_.lattice.period_mm), owned);
      }
  }

  /// \param piece patch whose numbers of elements are increased
  void collect(Piece& piece, const IndexRange& range) {
    tiles_.clear();
    visit_cells(range, [&](const Index& index, std::uint32_t number, const Vec2& shift_mm, bool owned) {
      const std::size_t first = tiles_.size();
      add_cell(owned ? &piece : nullptr, index, shift_mm);
      for (std::size_t t = first; t < tiles_.size(); ++t) {
        tiles_[t].cell = number;
        tiles_[t].is_output = owned;
      }
    });
  }

  /// Begins a single portion that contains the whole array.
  IndexRange begin_whole() {
    const IndexRange all = sheet_.indices();
    here_.emplace(sheet_, all.lower[0], all.lower[1], true);
    return all;
  }

  /// Returns the tiles of the single portion in the part frame.
  std::vector<Tile> tiles_of_part() {
    for (Tile& tile : tiles_) {
      tile.outline = moved(std::move(tile.outline), here_->origin_mm());
      tile.plane.height_mm -= tile.plane.slope.dot(here_->origin_mm());
      if (tile.centroid_mm) *tile.centroid_mm += here_->origin_mm();
    }
    return std::move(tiles_);
  }

  /// Appends the part of a cell that is inside the borders.
  /// \param piece patch that counts the cell; null if the cell belongs to a neighbouring patch
  void add_cell(Piece* piece, const Index& index, const Vec2& shift_mm) {
    const SheetCell place = here_->sheet_cell(index.number, shift_mm);
    if (here_->is_clear_of_part(place)) return;
    Cell cell = cell_at(index, place);
    const BorderRelation standing = here_->border_relation(place);
    if (piece != nullptr && cell.is_element) {
      piece->full += standing == BorderRelation::inside ? 1 : 0;
      piece->partial += standing == BorderRelation::crossing ? 1 : 0;
    }
    if (standing == BorderRelation::inside) {
      for (CellFacet& facet : cell.facets)
        add_tile(std::move(facet.outline), facet.plane, role_of(cell, facet), facet.centroid_mm);
      return;
    }
    if (cell.is_element && spec_.array.partial_elements == PartialElements::omit) turn_to_land(cell, place);
    for (const CellFacet& facet : cell.facets) {
      const Polygon inner = here_->within(place, facet.outline, here_->block());
      add_tiles(here_->in_element_area(inner), facet.plane, role_of(cell, facet), facet.centroid_mm);
      if (!inner.empty())
        add_tiles(here_->in_outline_margin(inner), placed_plane({}, place.frame), FacetRole::flat_back);
      if (sheet_.is_upright) add_margins(place, facet.outline);
    }
    if (!sheet_.is_upright) add_margins(place, place.outline);
  }

  void add_tile(Polygon outline, const HeightPlane& plane, FacetRole role,
                const std::optional<Vec2>& middle_mm = std::nullopt) {
    if (!outline.empty()) tiles_.push_back({std::move(outline), plane, role, 0, true, middle_mm});
  }

  void add_tiles(std::vector<Polygon> outlines, const HeightPlane& plane, FacetRole role,
                 const std::optional<Vec2>& middle_mm = std::nullopt) {
    for (Polygon& outline : outlines) add_tile(std::move(outline), plane, role, middle_mm);
  }

  /// Adds the land between the block of elements and the border.
  void add_margins(const SheetCell& place, const Polygon& outline) {
    for (const Rectangle& margin : margins(here_->reach(), here_->block()))
      if (!margin.empty())
        add_tiles(here_->in_outline(here_->within(place, outline, margin)), placed_plane({}, place.frame),
                  FacetRole::flat_back);
  }

  void turn_to_land(Cell& cell, const SheetCell& place) const {
    cell.is_element = false;
    if (!sheet_.is_upright) cell.facets = {CellFacet{place.outline, {}, false}};
    for (CellFacet& facet : cell.facets) {
      facet.plane = placed_plane({}, place.frame);
      facet.is_edge = false;
      facet.centroid_mm.reset();
    }
  }

  /// Returns the cell, moved to its position on the substrate.
  Cell cell_at(const Index& index, const SheetCell& place) const {
    if (!sheet_.is_upright) return cell_along_normal(index, place);
    Cell cell = upright_cell(index);
    move_facets(cell, place.shift_mm, place.frame.origin.z());
    return cell;
  }

  Cell upright_cell(const Index& index) const {
    const Cell& cell = sheet_.lattice.cells[index.number];
    if (cell.is_element && planes_ != nullptr) return own_cell(cell, index);
    if (!cell.is_element || !(spec_.random_tilts.sigma_arcmin > 0.0)) return cell;
    const AngleErrors errors = errors_of(spec_, index.i, index.j, index.number);
    return finished_cell(element_in_place_of(cell, spec_.element, errors), spec_);
  }

  /// Returns the element with individual planes, or land if the element is missing.
  Cell own_cell(const Cell& cell, const Index& index) const {
    const Vec2 place = reference_position(spec_, cell);
    const ElementPlanes* const planes = planes_->at(sheet_.at_mm(index.i, index.j) + place);
    if (planes != nullptr && planes->planes.empty()) return flared_land(cell, *planes, place);
    if (planes != nullptr) return finished_cell(cell_with_planes(cell, *planes, place), spec_);
    Cell land = cell;
    land.is_element = false;
    land.facets = {CellFacet{cell.outline, HeightPlane{}, false}};
    return land;
  }

  /// Returns an element that is placed as a rigid body along the substrate's normal. It is cut by the vertical walls
  /// through its corners.
  Cell cell_along_normal(const Index& index, const SheetCell& place) const {
    Cell cell = sheet_.lattice.cells[index.number];
    if (!cell.is_element) {
      turn_to_land(cell, place);
      return cell;
    }
    if (!is_convex(place.outline, sheet_.tolerance_mm)) refuse_bend(place.frame);
    cell = element_in_place_of(cell, spec_.element, errors_of(spec_, index.i, index.j, index.number));
    for (CellFacet& facet : cell.facets) {
      const Vec2& middle = sheet_.reference_points_mm[index.number];
      if (facet.centroid_mm)
        facet.centroid_mm = placed(*facet.centroid_mm - middle, facet.plane.at(*facet.centroid_mm), place.frame);
      facet.plane.height_mm += facet.plane.slope.dot(middle);
      facet.plane = placed_plane(facet.plane, place.frame);
    }
    cell.outline = place.outline;
    cell.facets = upper_envelope_of(cell.outline, std::move(cell.facets));
    return with_edges(cell, spec_);
  }

  [[noreturn]] void refuse_bend(const SubstrateFrame& frame) const {
    const Vec2 at = frame.origin.head<2>() + here_->origin_mm() - sheet_.centre_mm;
    throw InputError(
        fmt::format("the curvature of the substrate is too large for the element at x = {:.6g}, y = {:.6g} mm from the "
                    "centre of the part",
                    at.x(), at.y()));
  }

  /// Checks that the cells cover the part, because cells on a substrate may leave gaps or overlap.
  void check_cover() const {
    constexpr double kAreaRounding = 1e-7;
    const double whole_mm2 = sheet_.outline != nullptr ? sheet_.outline->area_mm2() : sheet_.part_mm.size().prod();
    if (!sheet_.surface || std::abs(covered_mm2_ - whole_mm2) <= kAreaRounding * whole_mm2) return;
    throw InputError(fmt::format(
        "the curvature of the substrate is too large for its elements: their cells cover {:.9g} mm2, but the "
        "part has {:.9g} mm2",
        covered_mm2_, whole_mm2));
  }

  Part& part_;
  const ArraySheet& sheet_;
  const PartSpec& spec_;
  const FacetPlanes* planes_;
  std::map<Key, Piece> known_;
  std::int64_t portions_at_outline_ = 0;  ///< number of portions that the outline of the part crosses
  bool is_one_ = false;                   ///< true if a single portion is the whole array
  std::optional<SheetPortion> here_;      ///< portion that is being built
  std::vector<Tile> tiles_;               ///< tiles of this portion
  double covered_mm2_ = 0.0;
};

/// Adds the chamfer and the mount of a round cube corner to a part.
/// \param apex_mm position of the apex in plan
void add_stops(Part& part, const RoundCube& cube, const Vec2& apex_mm) {
  if (cube.chamfer_mm > 0.0) part.clear_face = polygon_of_circle(apex_mm, cube.diameter_mm - 2.0 * cube.chamfer_mm);
  if (cube.mount_diameter_mm > 0.0)
    part.mount = FaceOpening{polygon_of_circle(apex_mm, cube.mount_diameter_mm), cube.recess_mm};
}

}  // namespace

void add_array(Part& part, const ArraySheet& sheet, const FacetPlanes* planes, const Vec2& origin_mm,
               double elements_per_patch) {
  Tiler(part, sheet, planes).add_all(origin_mm, elements_per_patch);
}

ArrayTiles array_tiles(const PartSpec& spec) {
  const ArraySheet sheet(spec);
  Part part;
  part.spec = spec;
  return Tiler(part, sheet, nullptr).all_tiles();
}

std::vector<Tile> uncut_tiles(const PartSpec& spec, const std::vector<std::uint32_t>& cells) {
  const ArraySheet sheet(spec);
  Part part;
  part.spec = spec;
  return Tiler(part, sheet, nullptr).uncut_tiles(cells);
}

ArrayPlan plan_of_array(const PartSpec& spec) {
  const ArraySheet sheet(spec);
  Part part;
  part.spec = spec;
  return Tiler(part, sheet, nullptr).plan();
}

void add_periods(Part& part, const ArraySheet& sheet) {
  Tiler(part, sheet, nullptr).add_periods();
  part.period_mm = sheet.lattice.period_mm;
  part.periods_beyond = kPeriodsBeyond;
  part.elements_full = sheet.lattice.elements_per_period;
}

void add_single(Part& part, const FacetPlanes* planes, const Vec2& origin_mm) {
  Cell cell = element_cell(part.spec.element, errors_of(part.spec, 0, 0, 0));
  if (planes != nullptr) {
    const Vec2 place = reference_position(part.spec, cell);
    const ElementPlanes* const own = planes->at(place - bounding_box(cell.outline).lower);
    if (own != nullptr && !own->planes.empty()) cell = cell_with_planes(cell, *own, place);
  }
  cell = finished_cell(cell, part.spec);
  if (const auto* const round = std::get_if<RoundCube>(&part.spec.element))
    add_stops(part, *round, origin_mm - bounding_box(cell.outline).lower);
  move_facets(cell, -bounding_box(cell.outline).lower, 0.0);
  std::vector<Tile> tiles;
  for (CellFacet& facet : cell.facets)
    tiles.push_back({std::move(facet.outline), facet.plane, FacetRole::retro_facet, 0, true, facet.centroid_mm});
  const Polygon outline = aperture_outline(part.spec.element);
  part.patches.push_back(build_patch(tiles, bounding_box(outline), part.size_mm));
  part.placements.push_back({0, origin_mm});
  part.outline = moved(outline, origin_mm);
  part.elements_full = 1;
}

}  // namespace retrace::geometry
