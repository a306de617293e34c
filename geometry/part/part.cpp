#include "geometry/part/part.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/error.h"
#include "geometry/elements/facet_planes.h"
#include "geometry/elements/lattice.h"
#include "geometry/elements/part_pieces.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/part/substrate_part.h"
#include "geometry/part/welded_part.h"

namespace retrace::geometry {
namespace {

constexpr double kAllInOnePatch = 1e18;
// An infinite array is a patch of this many periods round the central one: rays seldom have to be brought back.
constexpr int kPeriodsBeyond = 2;
/// What of the plane the part and the array fill, and which elements count.
struct Layout {
  Lattice lattice;
  Vec2 anchor = Vec2::Zero();  ///< where the lattice's origin lies
  Rectangle extent;            ///< of the part
  Rectangle block;             ///< of the array; the rest of the extent is flat land
  PartialElements partial = PartialElements::cut;
  double tolerance_mm = 0.0;
  PartSpec spec;
  const FacetPlanes* planes = nullptr;  ///< of elements that have their own

  /// Whether no element is like another.
  bool elements_differ() const { return spec.random_tilts.sigma_arcmin > 0.0 || planes != nullptr; }
};

/// A bound of the array that meets the part's up to the tolerance is the part's.
void snap(double& extent_bound, double block_bound, double scale) {
  if (std::abs(extent_bound - block_bound) <= 2.0 * kWholeTolerance * scale) extent_bound = block_bound;
}

Layout finite_layout(const PartSpec& spec, double size_mm) {
  Layout layout;
  layout.partial = spec.array.partial_elements;
  layout.tolerance_mm = kWholeTolerance * size_mm;
  const Vec2 length(spec.array.x_length_mm, spec.array.y_length_mm);
  const Vec2 margin(spec.array.x_offset_mm, spec.array.y_offset_mm);
  layout.extent = {Vec2::Zero(), length};
  if (const auto* rtp = std::get_if<RtpElement>(&spec.element)) {
    const PrismBlock block = prism_block(spec.array, *rtp);
    if (block.counts.columns < 1 || block.counts.rows < 1) throw InputError("the array is smaller than one element");
    layout.block = block.filled;
    layout.anchor = layout.block.lower;
    layout.lattice = make_lattice(spec, block.counts.rows > 1);
  } else {
    layout.block = {margin, length - margin};
    layout.anchor = 0.5 * length;
    layout.lattice = make_lattice(spec, false);
  }
  for (const Eigen::Index axis : {0, 1}) {
    snap(layout.extent.lower[axis], layout.block.lower[axis], length[axis]);
    snap(layout.extent.upper[axis], layout.block.upper[axis], length[axis]);
  }
  return layout;
}

/// Appends what the borders leave of one cell moved by `shift`.
void add_cell(std::vector<Tile>& tiles, const Layout& layout, const Rectangle& extent, const Rectangle& block,
              const Cell& cell, const Vec2& shift, std::uint32_t number, bool owned) {
  const bool whole = contains(block, moved(cell.outline, shift), layout.tolerance_mm);
  const bool omitted = !whole && cell.is_element && layout.partial == PartialElements::omit;
  for (std::size_t k = 0; k < cell.facets.size(); ++k) {
    const Polygon outline = moved(cell.facets[k].outline, shift);
    Tile tile;
    tile.cell = number;
    tile.owned = owned;
    if (!omitted) {
      tile.plane = cell.facets[k].plane;
      tile.plane.height_mm -= tile.plane.slope.dot(shift);
    }
    if (omitted || !(cell.is_element || cell.facets[k].is_edge)) tile.role = FacetRole::flat_back;
    tile.outline = whole ? outline : clip(outline, block, layout.tolerance_mm);
    if (!tile.outline.empty()) tiles.push_back(tile);
    if (whole) continue;
    tile.role = FacetRole::flat_back;
    tile.plane = HeightPlane{};
    for (const Rectangle& margin : margins(extent, block)) {
      tile.outline = clip(outline, margin, layout.tolerance_mm);
      if (!tile.outline.empty()) tiles.push_back(tile);
    }
  }
}

/// The element of the lattice with its own planes, or land where there is none.
Cell own_cell(const Layout& layout, const Cell& cell, std::int64_t i, std::int64_t j) {
  const Vec2 index(static_cast<double>(i), static_cast<double>(j));
  const Vec2 place = place_of(layout.spec, cell);
  const ElementPlanes* const planes =
      layout.planes->at(layout.anchor + index.cwiseProduct(layout.lattice.period_mm) + place);
  if (planes != nullptr && planes->planes.empty()) return flared_land(cell, *planes, place);
  if (planes != nullptr) return finished_cell(cell_with_planes(cell, *planes, place), layout.spec);
  Cell land = cell;
  land.is_element = false;
  land.facets = {CellFacet{cell.outline, HeightPlane{}, false}};
  return land;
}

/// Whether an element of the layout, moved by `shift`, is there.
bool has_planes(const Layout& layout, const Cell& cell, const Vec2& shift) {
  const ElementPlanes* const planes = layout.planes->at(place_of(layout.spec, cell) + shift);
  return planes != nullptr && !planes->planes.empty();
}

/// The tiles of a range of the lattice and of one more cell all round, local to the range's lower corner.
std::vector<Tile> tiles_of(const Layout& layout, const IndexRange& range, const Rectangle& extent,
                           const Rectangle& block) {
  std::vector<Tile> tiles;
  std::uint32_t number = 0;
  for (std::int64_t j = range.lower[1] - 1; j <= range.upper[1]; ++j) {
    for (std::int64_t i = range.lower[0] - 1; i <= range.upper[0]; ++i) {
      const bool owned = i >= range.lower[0] && i < range.upper[0] && j >= range.lower[1] && j < range.upper[1];
      const Vec2 index(static_cast<double>(i - range.lower[0]), static_cast<double>(j - range.lower[1]));
      const Vec2 shift = index.cwiseProduct(layout.lattice.period_mm);
      for (std::uint32_t c = 0; c < layout.lattice.cells.size(); ++c) {
        const Cell& cell = layout.lattice.cells[c];
        if (cell.is_element && layout.planes != nullptr)
          add_cell(tiles, layout, extent, block, own_cell(layout, cell, i, j), shift, number++, owned);
        else if (cell.is_element && layout.spec.random_tilts.sigma_arcmin > 0.0)
          add_cell(tiles, layout, extent, block,
                   finished_cell(element_in_place_of(cell, layout.spec.element, errors_of(layout.spec, i, j, c)),
                                 layout.spec),
                   shift, number++, owned);
        else
          add_cell(tiles, layout, extent, block, cell, shift, number++, owned);
      }
    }
  }
  return tiles;
}

bool any_owned(const std::vector<Tile>& tiles) {
  return std::any_of(tiles.begin(), tiles.end(), [](const Tile& t) { return t.owned; });
}

Rectangle relative_to(const Rectangle& r, const Vec2& corner) {
  return {r.lower - corner, r.upper - corner};
}

/// Tells pieces of the array apart by where the borders cross them. Borders beyond the neighbourhood do not matter.
using PieceKey = std::array<std::int64_t, 10>;

PieceKey piece_key(const Layout& layout, const Rectangle& extent, const Rectangle& block, const IndexRange& range) {
  const double quantum = 1e-7 * layout.lattice.period_mm.minCoeff();
  const Vec2 reach = 2.0 * layout.lattice.period_mm;
  PieceKey key{};
  std::size_t k = 0;
  for (const Eigen::Index axis : {0, 1}) {
    const auto a = static_cast<std::size_t>(axis);
    const double upper = static_cast<double>(range.upper[a] - range.lower[a]) * layout.lattice.period_mm[axis];
    for (const double bound : {extent.lower[axis], extent.upper[axis], block.lower[axis], block.upper[axis]})
      key[k++] = std::llround(std::clamp(bound, -reach[axis], upper + reach[axis]) / quantum);
    key[k++] = range.upper[a] - range.lower[a];
  }
  return key;
}

void add_surface(Part& part, const Layout& layout, const Vec2& origin, double elements_per_patch) {
  const IndexRange all = indices_over(layout.lattice, layout.extent, layout.anchor);
  const double periods = std::max(1.0, elements_per_patch / std::max(1, layout.lattice.elements_per_period));
  const Vec2 span = layout.extent.size().cwiseQuotient(layout.lattice.period_mm);
  const bool one_patch = span.x() * span.y() <= periods;
  const auto block_side = static_cast<std::int64_t>(std::max(1.0, std::floor(std::sqrt(periods))));
  std::array<std::int64_t, 2> step{};
  for (const std::size_t k : {0U, 1U}) step[k] = one_patch ? all.upper[k] - all.lower[k] : block_side;

  std::map<PieceKey, std::uint32_t> known;
  for (std::int64_t j = all.lower[1]; j < all.upper[1]; j += step[1]) {
    for (std::int64_t i = all.lower[0]; i < all.upper[0]; i += step[0]) {
      const IndexRange range{{i, j}, {std::min(i + step[0], all.upper[0]), std::min(j + step[1], all.upper[1])}};
      const Vec2 corner =
          layout.anchor + Vec2(static_cast<double>(i), static_cast<double>(j)).cwiseProduct(layout.lattice.period_mm);
      const Rectangle extent = relative_to(layout.extent, corner);
      const Rectangle block = relative_to(layout.block, corner);
      if (layout.elements_differ()) known.clear();  // no piece is like another
      const auto [it, is_new] = known.try_emplace(piece_key(layout, extent, block, range), 0U);
      if (is_new) {
        const std::vector<Tile> tiles = tiles_of(layout, range, extent, block);
        it->second = any_owned(tiles) ? static_cast<std::uint32_t>(part.patches.size()) : UINT32_MAX;
        if (it->second != UINT32_MAX) part.patches.push_back(build_patch(tiles, block, part.size_mm));
      }
      if (it->second != UINT32_MAX) part.placements.push_back({it->second, origin + corner});
    }
  }
}

/// Where the surface is nowhere cut off or left out.
void find_lattice_region(Part& part, const Layout& layout, const Vec2& origin) {
  if (layout.elements_differ()) return;
  Rectangle region{layout.block.lower + origin, layout.block.upper + origin};
  if (layout.partial == PartialElements::omit)
    for (const Cell& cell : layout.lattice.cells) {
      const Vec2 size = bounding_box(cell.outline).size();
      region.lower = region.lower.cwiseMax(layout.block.lower + origin + size);
      region.upper = region.upper.cwiseMin(layout.block.upper + origin - size);
    }
  if (region.empty()) return;
  part.lattice_region_mm = region;
  part.lattice_anchor_mm = layout.anchor + origin;
}

void count_elements(Part& part, const Layout& layout) {
  const IndexRange all = indices_over(layout.lattice, layout.extent, layout.anchor);
  for (std::int64_t j = all.lower[1]; j < all.upper[1]; ++j) {
    for (std::int64_t i = all.lower[0]; i < all.upper[0]; ++i) {
      const Vec2 shift =
          layout.anchor + Vec2(static_cast<double>(i), static_cast<double>(j)).cwiseProduct(layout.lattice.period_mm);
      for (const Cell& cell : layout.lattice.cells) {
        if (!cell.is_element) continue;
        const Polygon outline = moved(cell.outline, shift);
        if (layout.planes != nullptr && !has_planes(layout, cell, shift)) continue;
        if (contains(layout.block, outline, layout.tolerance_mm))
          ++part.elements_full;
        else if (area(clip(outline, layout.block, layout.tolerance_mm)) > 0.0)
          ++part.elements_partial;
      }
    }
  }
}

void build_single(Part& part, const Vec2& origin, const FacetPlanes* planes) {
  const Polygon outline = aperture_outline(part.spec.element);
  const bool is_random = part.spec.random_tilts.sigma_arcmin > 0.0;
  const AngleErrors errors = is_random ? errors_of(part.spec, 0, 0, 0) : part.spec.angle_errors;
  Cell sharp = element_cell(part.spec.element, errors);
  if (planes != nullptr) {
    const Vec2 place = place_of(part.spec, sharp);
    const ElementPlanes* const own = planes->at(place - bounding_box(sharp.outline).lower);
    if (own != nullptr && !own->planes.empty()) sharp = cell_with_planes(sharp, *own, place);
  }
  const Cell cell = finished_cell(sharp, part.spec);
  const Vec2 shift = -bounding_box(cell.outline).lower;
  std::vector<Tile> tiles;
  for (std::size_t k = 0; k < cell.facets.size(); ++k) {
    Tile tile;
    tile.outline = moved(cell.facets[k].outline, shift);
    tile.plane = cell.facets[k].plane;
    tile.plane.height_mm -= tile.plane.slope.dot(shift);
    tiles.push_back(std::move(tile));
  }
  part.patches.push_back(build_patch(tiles, bounding_box(outline), part.size_mm));
  part.placements.push_back({0, origin});
  part.outline = moved(outline, origin);
  part.elements_full = 1;
}

void build_infinite(Part& part) {
  Layout layout;
  layout.lattice = make_lattice(part.spec, true);
  layout.tolerance_mm = kWholeTolerance * part.size_mm;
  const Vec2 far = 1e3 * layout.lattice.period_mm;
  layout.extent = layout.block = {-far, far};
  const IndexRange range{{-kPeriodsBeyond, -kPeriodsBeyond}, {kPeriodsBeyond + 1, kPeriodsBeyond + 1}};
  const Vec2 corner = -static_cast<double>(kPeriodsBeyond) * layout.lattice.period_mm;
  part.patches.push_back(build_patch(tiles_of(layout, range, layout.extent, layout.block), layout.block, part.size_mm));
  part.placements.push_back({0, corner});
  part.period_mm = layout.lattice.period_mm;
  part.periods_beyond = kPeriodsBeyond;
  part.elements_full = layout.lattice.elements_per_period;
}

double element_size(const Element& element) {
  return bounding_box(aperture_outline(element)).size().minCoeff();
}

/// Where the back surface lies if elements are not the nominal ones.
void measure_layer(Part& part) {
  double lowest = 0.0;
  double highest = 0.0;
  for (const SurfacePatch& patch : part.patches)
    for (const Vec3& vertex : patch.vertices) {
      lowest = std::min(lowest, vertex.z());
      highest = std::max(highest, vertex.z());
    }
  part.element_depth_mm = -lowest;
  part.top_mm = highest;
}

/// The same on a base, where patches stand at different heights.
void measure_layer_on_substrate(Part& part) {
  std::vector<std::array<double, 2>> of_patch;
  for (const SurfacePatch& patch : part.patches) {
    std::array<double, 2> range{INFINITY, -INFINITY};
    for (const PatchCell& cell : patch.cells)
      range = {std::min(range[0], cell.lower.z()), std::max(range[1], cell.upper.z())};
    of_patch.push_back(range);
  }
  double lowest = 0.0;
  double highest = 0.0;
  for (const Placement& placement : part.placements) {
    lowest = std::min(lowest, of_patch[placement.patch][0] + placement.height_mm);
    highest = std::max(highest, of_patch[placement.patch][1] + placement.height_mm);
  }
  constexpr double rounding = 1e-12;
  part.element_depth_mm = -lowest;
  part.top_mm = highest > rounding * part.element_depth_mm ? highest : 0.0;
}

void measure(Part& part) {
  for (const Placement& placement : part.placements)
    for (const PatchFacet& facet : part.patches[placement.patch].facets)
      if (facet.role == FacetRole::retro_facet)
        part.retro_facet_area_mm2 += facet_area(part.patches[placement.patch], facet);
  if (part.period_mm) {
    const double periods = std::pow(2.0 * part.periods_beyond + 1.0, 2.0);
    part.entrance_area_mm2 = part.period_mm->prod();
    part.retro_facet_area_mm2 /= periods;
  } else {
    part.entrance_area_mm2 = area(part.outline);
  }
}

}  // namespace

double facet_area(const SurfacePatch& patch, const PatchFacet& facet) {
  const auto corner = [&](std::uint32_t k) { return patch.vertices[patch.corners[facet.first_corner + k]]; };
  Vec3 twice = Vec3::Zero();
  for (std::uint32_t k = 1; k + 1 < facet.corner_count; ++k)
    twice += (corner(k) - corner(0)).cross(corner(k + 1) - corner(0));
  return 0.5 * twice.norm();
}

namespace {

Part build(const PartSpec& spec, const Vec2& origin_mm, const FacetPlanes* planes, double elements_per_patch) {
  Part part;
  part.spec = spec;
  part.thickness_mm = spec.thickness_mm;
  part.element_depth_mm = element_depth_mm(spec.element, spec.angle_errors);
  part.top_mm = element_top_mm(spec.element, spec.angle_errors);
  part.size_mm = element_size(spec.element);
  if (spec.array.arrangement == Arrangement::single) {
    build_single(part, origin_mm, planes);
  } else if (spec.array.extent == Extent::infinite) {
    build_infinite(part);
  } else if (spec.substrate) {
    part.outline = moved(to_polygon({Vec2::Zero(), {spec.array.x_length_mm, spec.array.y_length_mm}}), origin_mm);
    add_surface_on_substrate(part, origin_mm, elements_per_patch);
    if (part.elements_full < 1) throw InputError("the array is smaller than one element");
  } else {
    Layout layout = finite_layout(spec, part.size_mm);
    layout.spec = spec;
    layout.planes = planes;
    part.outline = moved(to_polygon(layout.extent), origin_mm);
    add_surface(part, layout, origin_mm, elements_per_patch);
    find_lattice_region(part, layout, origin_mm);
    count_elements(part, layout);
    if (part.elements_full < 1) throw InputError("the array is smaller than one element");
  }
  if (spec.substrate && spec.array.arrangement != Arrangement::single && spec.array.extent == Extent::finite)
    measure_layer_on_substrate(part);
  else if (planes != nullptr || spec.random_tilts.sigma_arcmin > 0.0 || !spec.edges.is_sharp() ||
           !spec.scratches.empty())
    measure_layer(part);
  if (part.thickness_mm <= part.top_mm)
    throw InputError(
        fmt::format("body.thickness_mm must be above {} mm, the highest rim, got {}", part.top_mm, part.thickness_mm));
  measure(part);
  return part;
}

}  // namespace

Part build_part(const PartSpec& spec, const Vec2& origin_mm) {
  return build(spec, origin_mm, nullptr, kElementsPerPatch);
}

Part build_part(const PartSpec& spec, const FacetPlanes& planes) {
  Part part = build(spec, Vec2::Zero(), &planes, kElementsPerPatch);
  const auto given = static_cast<std::int64_t>(planes.element_count());
  if (part.elements_full != given)
    throw InputError(
        fmt::format("{} of the {} elements are no whole elements of the array", given - part.elements_full, given));
  return part;
}

Part build_welded_part(const PartSpec& spec) {
  return build(spec, Vec2::Zero(), nullptr, kAllInOnePatch);
}

}  // namespace retrace::geometry
