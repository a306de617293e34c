#include "geometry/part/substrate_part.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "core/error.h"
#include "geometry/elements/edges.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/lattice.h"
#include "geometry/elements/part_pieces.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/plane_polygon.h"

namespace retrace::geometry {
namespace {

// Where a substrate repeats along one axis alone, patches are kept short along the other.
constexpr double kElementsPerColumnPatch = 256.0;
// Of an area: how much the cells of a part may miss it by rounding.
constexpr double kAreaRounding = 1e-7;

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// What two convex polygons have in common; empty if it is no wider than the tolerance.
Polygon common(Polygon polygon, const Polygon& other, double tolerance_mm) {
  for (std::size_t k = 0; k < other.size() && !polygon.empty(); ++k) {
    const Vec2 along = (other[(k + 1) % other.size()] - other[k]).normalized();
    const HeightPlane inward{-cross(along, other[k]), {-along.y(), along.x()}};
    polygon = where_higher(polygon, inward, HeightPlane{});
  }
  if (!polygon.empty() && area(polygon) <= tolerance_mm * bounding_box(polygon).size().norm()) polygon.clear();
  return polygon;
}

bool is_convex(const Polygon& polygon, double tolerance_mm) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[(k + 1) % polygon.size()] - polygon[k];
    const Vec2 b = polygon[(k + 2) % polygon.size()] - polygon[(k + 1) % polygon.size()];
    if (cross(a, b) < -tolerance_mm * (a.norm() + b.norm())) return false;
  }
  return true;
}

/// A plane of an element, told in its own frame, as it stands in the part.
HeightPlane placed_plane(const HeightPlane& own, const SubstrateFrame& frame) {
  const Vec3 normal = own.slope.x() * frame.along_u + own.slope.y() * frame.along_v - frame.normal;
  const Vec3 point = frame.origin + own.height_mm * frame.normal;
  HeightPlane plane;
  plane.slope = -normal.head<2>() / normal.z();
  plane.height_mm = point.z() - plane.slope.dot(point.head<2>());
  return plane;
}

/// A cell of the lattice where it stands, from the middle of the part; heights are the substrate's own.
struct PlacedCell {
  Polygon arc_outline;
  Polygon outline;
  std::vector<CellFacet> facets;
  HeightPlane land;  ///< in its place where it is left out
  bool is_element = false;
};

struct Count {
  std::int64_t full = 0;
  std::int64_t partial = 0;
  double area_mm2 = 0.0;  ///< of all tiles in plan
};

class Builder {
 public:
  Builder(Part& part, const Vec2& origin_mm)
      : part_(part),
        spec_(part.spec),
        half_mm_(0.5 * Vec2(spec_.array.x_length_mm, spec_.array.y_length_mm)),
        middle_mm_(origin_mm + half_mm_),
        extent_{-half_mm_, half_mm_},
        surface_(substrate_surface_of(spec_)),
        top_mm_(measure_substrate(surface_, half_mm_).highest_mm),
        tolerance_mm_(std::max(kWholeTolerance * part.size_mm, 2.0 * kWholeTolerance * half_mm_.maxCoeff())) {
    lay_out();
  }

  void build(double elements_per_patch) {
    const IndexRange all = indices_over(lattice_, arc_extent_, anchor_);
    const std::array<std::int64_t, 2> step = patch_size(all, elements_per_patch);
    const bool is_one = step[0] >= all.upper[0] - all.lower[0] && step[1] >= all.upper[1] - all.lower[1];
    for (std::int64_t j = all.lower[1]; j < all.upper[1]; j += step[1])
      for (std::int64_t i = all.lower[0]; i < all.upper[0]; i += step[0])
        add_piece({{i, j}, {std::min(i + step[0], all.upper[0]), std::min(j + step[1], all.upper[1])}}, is_one);
    const double covered = total_.area_mm2;
    const double whole = extent_.size().prod();
    if (!(std::abs(covered - whole) <= kAreaRounding * whole))
      throw InputError(fmt::format("the base bends too much for its elements: their cells cover {:.9g} of {:.9g} mm2",
                                   covered, whole));
    part_.elements_full = total_.full;
    part_.elements_partial = total_.partial;
  }

 private:
  /// Where patches have their origin: the substrate at their first cell's corner.
  struct Corner {
    Vec2 plan = Vec2::Zero();
    double height_mm = 0.0;
  };
  struct Piece {
    std::uint32_t patch = UINT32_MAX;  ///< of nothing that is within the part: none
    Count count;
  };
  using Key = std::array<std::int64_t, 12>;

  void lay_out() {
    const auto* rtp = std::get_if<RtpElement>(&spec_.element);
    arc_extent_ = arcs_of_border();
    if (rtp == nullptr) {
      lattice_ = make_lattice(spec_, false);
      const Vec2 endless = 10.0 * arc_extent_.size();
      block_ = {arc_extent_.lower - endless, arc_extent_.upper + endless};
      return;
    }
    // As a flat array that is as large as the substrate is, rolled out.
    const Rectangle reach = surface_.arc_reach();
    ArrayLayout sheet = spec_.array;
    sheet.x_length_mm = reach.size().x();
    sheet.y_length_mm = reach.size().y();
    const PrismBlock block = prism_block(sheet, *rtp);
    if (block.counts.columns < 1 || block.counts.rows < 1) throw InputError("the array is smaller than one element");
    block_ = {reach.lower + block.filled.lower, reach.lower + block.filled.upper};
    anchor_ = block_.lower;
    lattice_ = make_lattice(spec_, block.counts.rows > 1);
  }

  /// Round the arc coordinates of the part, with an element's room to spare.
  Rectangle arcs_of_border() const {
    constexpr int kSteps = 128;
    Rectangle box{surface_.arc_of(-half_mm_), surface_.arc_of(-half_mm_)};
    for (int k = 0; k <= kSteps; ++k) {
      const double along = 2.0 * k / kSteps - 1.0;
      for (const double side : {-1.0, 1.0})
        for (const Vec2& p : {Vec2(along, side), Vec2(side, along)}) {
          const Vec2 arc = surface_.arc_of(half_mm_.cwiseProduct(p));
          box.lower = box.lower.cwiseMin(arc);
          box.upper = box.upper.cwiseMax(arc);
        }
    }
    const Vec2 room = Vec2::Constant(1.5 * width_across_mm(spec_.element));
    return {box.lower - room, box.upper + room};
  }

  std::array<std::int64_t, 2> patch_size(const IndexRange& all, double elements_per_patch) const {
    const double columns = static_cast<double>(all.upper[0] - all.lower[0]);
    const double rows = static_cast<double>(all.upper[1] - all.lower[1]);
    const double each = std::max(1, lattice_.elements_per_period);
    if (columns * rows * each <= elements_per_patch) return {all.upper[0] - all.lower[0], all.upper[1] - all.lower[1]};
    const bool repeats_once = surface_.repeats_along_u() != surface_.repeats_along_v();
    const double periods = std::max(
        1.0, (repeats_once ? std::min(kElementsPerColumnPatch, elements_per_patch) : elements_per_patch) / each);
    const auto side = static_cast<std::int64_t>(std::max(1.0, std::floor(std::sqrt(periods))));
    return {side, side};
  }

  Vec2 shift_of(std::int64_t i, std::int64_t j) const {
    return anchor_ + Vec2(static_cast<double>(i), static_cast<double>(j)).cwiseProduct(lattice_.period_mm);
  }

  Corner corner_of(const IndexRange& range) const {
    const Vec2 plan = surface_.plan_of(shift_of(range.lower[0], range.lower[1]));
    return {plan, surface_.at(plan).value};
  }

  /// Tells pieces apart by what the substrate does there and by where borders cross them.
  Key key_of(const IndexRange& range, const Corner& corner) const {
    const double quantum = 1e-7 * lattice_.period_mm.minCoeff();
    const Vec2 room = lattice_.period_mm;
    const Vec2 low = shift_of(range.lower[0], range.lower[1]) - 2.0 * room;
    const Vec2 high = shift_of(range.upper[0], range.upper[1]) + 2.0 * room;
    Rectangle plan{corner.plan, corner.plan};
    for (const Vec2& arc : {low, high, Vec2(low.x(), high.y()), Vec2(high.x(), low.y())}) {
      plan.lower = plan.lower.cwiseMin(surface_.plan_of(arc));
      plan.upper = plan.upper.cwiseMax(surface_.plan_of(arc));
    }
    Key key{};
    std::size_t k = 0;
    for (const Eigen::Index axis : {0, 1}) {
      const auto a = static_cast<std::size_t>(axis);
      const double first = shift_of(range.lower[0], range.lower[1])[axis];
      for (const double bound : {extent_.lower[axis], extent_.upper[axis]})
        key[k++] = std::llround((std::clamp(bound, plan.lower[axis], plan.upper[axis]) - corner.plan[axis]) / quantum);
      for (const double bound : {block_.lower[axis], block_.upper[axis]})
        key[k++] = std::llround((std::clamp(bound, low[axis], high[axis]) - first) / quantum);
      key[k++] = range.upper[a] - range.lower[a];
      const bool repeats = axis == 0 ? surface_.repeats_along_u() : surface_.repeats_along_v();
      key[k++] = repeats ? 0 : range.lower[a];
    }
    return key;
  }

  void add_piece(const IndexRange& range, bool is_one) {
    const Corner corner = is_one ? Corner{Vec2::Zero(), top_mm_} : corner_of(range);
    if (spec_.random_tilts.sigma_arcmin > 0.0) known_.clear();  // no piece is like another
    const auto [it, is_new] = known_.try_emplace(key_of(range, corner));
    Piece& piece = it->second;
    if (is_new) {
      const std::vector<Tile> tiles = tiles_of(range, corner, piece.count);
      if (std::any_of(tiles.begin(), tiles.end(), [](const Tile& t) { return t.owned; })) {
        piece.patch = static_cast<std::uint32_t>(part_.patches.size());
        part_.patches.push_back(build_patch(tiles, block_in_plan(corner), part_.size_mm));
      }
    }
    if (piece.patch == UINT32_MAX) return;
    part_.placements.push_back({piece.patch, middle_mm_ + corner.plan, corner.height_mm - top_mm_});
    total_.full += piece.count.full;
    total_.partial += piece.count.partial;
    total_.area_mm2 += piece.count.area_mm2;
  }

  /// Walls on its border are the array's.
  Rectangle block_in_plan(const Corner& corner) const {
    Rectangle box = extent_;
    if (std::holds_alternative<RtpElement>(spec_.element)) {
      box = {surface_.plan_of(block_.lower), surface_.plan_of(block_.upper)};
      box = {box.lower.cwiseMax(extent_.lower), box.upper.cwiseMin(extent_.upper)};
    }
    return {box.lower - corner.plan, box.upper - corner.plan};
  }

  std::vector<Tile> tiles_of(const IndexRange& range, const Corner& corner, Count& count) const {
    std::vector<Tile> tiles;
    std::uint32_t number = 0;
    for (std::int64_t j = range.lower[1] - 1; j <= range.upper[1]; ++j)
      for (std::int64_t i = range.lower[0] - 1; i <= range.upper[0]; ++i) {
        const bool owned = i >= range.lower[0] && i < range.upper[0] && j >= range.lower[1] && j < range.upper[1];
        for (std::uint32_t c = 0; c < lattice_.cells.size(); ++c) {
          const std::size_t first = tiles.size();
          const PlacedCell cell = place(i, j, c);
          if (!is_beyond(cell.outline)) add_cell(tiles, cell, owned ? &count : nullptr);
          for (std::size_t t = first; t < tiles.size(); ++t) settle(tiles[t], corner, number, owned);
          ++number;
        }
      }
    for (const Tile& tile : tiles)
      if (tile.owned) count.area_mm2 += area(tile.outline);
    return tiles;
  }

  /// Into the coordinates of its patch.
  static void settle(Tile& tile, const Corner& corner, std::uint32_t number, bool owned) {
    tile.cell = number;
    tile.owned = owned;
    tile.outline = moved(tile.outline, -corner.plan);
    tile.plane.height_mm += tile.plane.slope.dot(corner.plan) - corner.height_mm;
  }

  /// How far a corner of a cell lies from the substrate: rims of full cubes are not level.
  double rim_height(const Cell& nominal, const Vec2& p) const {
    double height = -part_.element_depth_mm;
    for (const CellFacet& facet : nominal.facets) height = std::max(height, facet.plane.at(p));
    return std::abs(height) < 1e-12 * part_.size_mm ? 0.0 : height;
  }

  Vec2 plan_of_rim(const Vec2& arc, double height_mm) const {
    Vec2 plan = surface_.plan_of(arc);
    if (height_mm != 0.0) plan += height_mm * surface_.normal_at(plan).head<2>();
    return plan;
  }

  Polygon plan_of(const Polygon& arcs) const {
    Polygon plan;
    for (const Vec2& p : arcs) plan.push_back(surface_.plan_of(p));
    return plan;
  }

  PlacedCell place(std::int64_t i, std::int64_t j, std::uint32_t c) const {
    const Cell& cell = lattice_.cells[c];
    const Vec2 shift = shift_of(i, j);
    const bool is_cube = !std::holds_alternative<RtpElement>(spec_.element);
    const Vec2 middle = cell.is_element && is_cube ? cell.at_mm : middle_of(cell.outline);
    const SubstrateFrame frame = surface_.frame_at(shift + middle);
    PlacedCell placed;
    placed.is_element = cell.is_element;
    placed.arc_outline = moved(cell.outline, shift);
    placed.land = placed_plane(HeightPlane{}, frame);
    const bool is_random = cell.is_element && spec_.random_tilts.sigma_arcmin > 0.0;
    const AngleErrors errors = is_random ? errors_of(spec_, i, j, c) : spec_.angle_errors;
    if (surface_.is_upright())
      place_upright(placed, is_random ? with_edges(element_in_place_of(cell, spec_.element, errors), spec_) : cell,
                    shift, frame.origin.z());
    else
      place_normal(placed, cell, errors, shift, middle, frame);
    return placed;
  }

  static void place_upright(PlacedCell& placed, const Cell& cell, const Vec2& shift, double height_mm) {
    placed.outline = placed.arc_outline;
    placed.facets = cell.facets;
    for (CellFacet& facet : placed.facets) {
      facet.outline = moved(facet.outline, shift);
      facet.plane.height_mm += height_mm - facet.plane.slope.dot(shift);
    }
  }

  /// The element as a rigid body along the substrate's normal, cut by the vertical walls over its corners.
  void place_normal(PlacedCell& placed, const Cell& cell, const AngleErrors& errors, const Vec2& shift,
                    const Vec2& middle, const SubstrateFrame& frame) const {
    if (!cell.is_element) {
      placed.outline = plan_of(placed.arc_outline);
      placed.facets = {CellFacet{placed.outline, placed.land, false}};
      return;
    }
    const Cell nominal = element_in_place_of(cell, upright_element(), AngleErrors{});
    for (const Vec2& p : cell.outline) placed.outline.push_back(plan_of_rim(p + shift, rim_height(nominal, p)));
    if (is_beyond(placed.outline)) return;
    if (!is_convex(placed.outline, tolerance_mm_))
      throw InputError(
          fmt::format("the base bends too much for the element at x = {:.6g}, y = {:.6g} mm from the "
                      "middle of the part",
                      frame.origin.x(), frame.origin.y()));
    Cell placed_cell = element_in_place_of(cell, spec_.element, errors);
    for (CellFacet& facet : placed_cell.facets) {
      facet.plane.height_mm += facet.plane.slope.dot(middle);
      facet.plane = placed_plane(facet.plane, frame);
    }
    placed_cell.outline = placed.outline;
    cut_by_each_other(placed_cell);
    placed.facets = with_edges(placed_cell, spec_).facets;
  }

  bool is_beyond(const Polygon& outline) const {
    const Rectangle box = bounding_box(outline);
    return (box.lower.array() > extent_.upper.array()).any() || (box.upper.array() < extent_.lower.array()).any();
  }

  /// Each facet stands where its plane is the highest.
  static void cut_by_each_other(Cell& cell) {
    for (CellFacet& facet : cell.facets) {
      facet.outline = cell.outline;
      for (const CellFacet& other : cell.facets)
        if (&other != &facet && !facet.outline.empty())
          facet.outline = where_higher(facet.outline, facet.plane, other.plane);
    }
  }

  Element upright_element() const {
    Element element = spec_.element;
    if (auto* cube = std::get_if<HexagonalCube>(&element)) cube->cant = {};
    if (auto* cube = std::get_if<TriangularCube>(&element)) cube->cant = {};
    return element;
  }

  /// Appends what the borders leave of a cell. \param count gets what it is; null: it belongs to a neighbour
  void add_cell(std::vector<Tile>& tiles, const PlacedCell& cell, Count* count) const {
    const double sliver_mm = 1e-9 * part_.size_mm;
    const bool in_block = contains(block_, cell.arc_outline, sliver_mm);
    const bool whole = in_block && contains(extent_, cell.outline, tolerance_mm_);
    const Polygon inner = in_block ? cell.outline : plan_of(clip(cell.arc_outline, block_, sliver_mm));
    if (count != nullptr && cell.is_element) {
      if (whole)
        ++count->full;
      else if (!inner.empty() && !clip(inner, extent_, tolerance_mm_).empty())
        ++count->partial;
    }
    if (!whole && cell.is_element && spec_.array.partial_elements == PartialElements::omit) {
      add_tile(tiles, cell.outline, cell.land, FacetRole::flat_back);
      return;
    }
    for (const CellFacet& facet : cell.facets) {
      const bool is_retro = cell.is_element || facet.is_edge;
      if (!facet.outline.empty() && !inner.empty())
        add_tile(tiles, in_block ? facet.outline : common(facet.outline, inner, sliver_mm), facet.plane,
                 is_retro ? FacetRole::retro_facet : FacetRole::flat_back);
    }
    if (in_block) return;
    for (const Rectangle& margin : margins(arc_extent_, block_)) {
      const Polygon arcs = clip(cell.arc_outline, margin, sliver_mm);
      if (!arcs.empty()) add_tile(tiles, plan_of(arcs), cell.land, FacetRole::flat_back);
    }
  }

  void add_tile(std::vector<Tile>& tiles, const Polygon& outline, const HeightPlane& plane, FacetRole role) const {
    if (outline.empty()) return;
    Tile tile;
    tile.outline = contains(extent_, outline, 0.0) ? outline : clip(outline, extent_, tolerance_mm_);
    tile.plane = plane;
    tile.role = role;
    if (!tile.outline.empty()) tiles.push_back(std::move(tile));
  }

  Part& part_;
  const PartSpec& spec_;
  Vec2 half_mm_;
  Vec2 middle_mm_;  ///< of the part, in its own coordinates
  Rectangle extent_;
  SubstrateSurface surface_;
  double top_mm_;  ///< height of the substrate that is z = 0
  double tolerance_mm_;
  Lattice lattice_;
  Vec2 anchor_ = Vec2::Zero();
  Rectangle block_;       ///< of the array, in arc coordinates
  Rectangle arc_extent_;  ///< round the part, likewise
  std::map<Key, Piece> known_;
  Count total_;
};

}  // namespace

void add_surface_on_substrate(Part& part, const Vec2& origin_mm, double elements_per_patch) {
  Builder(part, origin_mm).build(elements_per_patch);
}

InnerWalls inner_walls(const Part& part, const Vec3& towards) {
  InnerWalls walls;
  for (const Placement& placement : part.placements) {
    const SurfacePatch& patch = part.patches[placement.patch];
    for (const PatchFacet& facet : patch.facets) {
      if (facet.role != FacetRole::inner_wall) continue;
      const double area = facet_area(patch, facet);
      walls.area_mm2 += area;
      walls.projected_mm2 += area * std::abs(facet.normal.dot(towards));
      for (std::uint32_t a = 0; a < facet.corner_count; ++a)
        for (std::uint32_t b = 0; b < a; ++b) {
          const Vec3 rise = patch.vertices[patch.corners[facet.first_corner + a]] -
                            patch.vertices[patch.corners[facet.first_corner + b]];
          if (rise.head<2>().norm() <= 1e-9 * part.size_mm)
            walls.highest_mm = std::max(walls.highest_mm, std::abs(rise.z()));
        }
    }
  }
  return walls;
}

}  // namespace retrace::geometry
