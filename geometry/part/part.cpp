#include "geometry/part/part.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "geometry/elements/array_sheet.h"
#include "geometry/elements/facet_planes.h"
#include "geometry/elements/lattice.h"
#include "geometry/part/tiling.h"
#include "geometry/part/welded_part.h"
#include "geometry/part/zones.h"

namespace retrace::geometry {
namespace {

/// Maximum number of elements of an array whose surface is a single patch. The surface of a larger array consists of
/// patches with at most this number of elements, which are placed several times.
constexpr double kElementsPerPatch = 2048.0;
constexpr double kAllInOnePatch = 1e18;

/// Sets Part::lattice_region_mm, the region in which no element is cut or omitted.
void find_lattice_region(Part& part, const ArraySheet& sheet, const Vec2& origin_mm) {
  Rectangle region = moved(sheet.block_mm, origin_mm);
  if (part.spec.array.partial_elements == PartialElements::omit)
    for (const Cell& cell : sheet.lattice.cells) {
      const Vec2 size = bounding_box(cell.outline).size();
      region.lower = region.lower.cwiseMax(sheet.block_mm.lower + origin_mm + size);
      region.upper = region.upper.cwiseMin(sheet.block_mm.upper + origin_mm - size);
    }
  if (region.empty()) return;
  part.lattice_region_mm = region;
  part.lattice_anchor_mm = sheet.anchor_mm + origin_mm;
}

void add_surface(Part& part, const FacetPlanes* planes, const Vec2& origin_mm, double elements_per_patch) {
  if (part.spec.array.arrangement == Arrangement::single) return add_single(part, planes, origin_mm);
  const ArraySheet sheet(part.spec);
  if (part.spec.array.extent == Extent::infinite) return add_periods(part, sheet);
  part.outline = moved(sheet.outline != nullptr ? sheet.outline->hull : to_polygon(sheet.part_mm), origin_mm);
  if (sheet.outline != nullptr && !sheet.outline->is_convex())
    for (const Polygon& piece : sheet.outline->whole.pieces) part.entrance_pieces.push_back(moved(piece, origin_mm));
  add_array(part, sheet, planes, origin_mm, elements_per_patch);
  if (part.elements_full < 1) throw InputError("the array is smaller than one element");
  if (part.spec.substrate || planes != nullptr || part.spec.random_tilts.sigma_arcmin > 0.0) return;
  if (!sheet.lattice.repeats) return;
  if (sheet.outline == nullptr) return find_lattice_region(part, sheet, origin_mm);
  const Vec2 period_mm = make_lattice(part.spec, true).period_mm;
  for (const Polygon& piece : sheet.outline->whole.pieces)
    part.lattice_regions.push_back({moved(piece, origin_mm), {Vec2(period_mm.x(), 0.0), Vec2(0.0, period_mm.y())}});
}

/// Returns true if the back surface has the nominal heights.
bool is_nominal(const PartSpec& spec, const FacetPlanes* planes) {
  return planes == nullptr && !spec.substrate && !std::holds_alternative<RuledCells>(spec.element) &&
         !(spec.random_tilts.sigma_arcmin > 0.0) && spec.edges.is_sharp() && spec.scratches.empty();
}

/// Returns the lowest and highest height of a patch. On a substrate, the heights of the cells are used instead of those
/// of all vertices, because the border walls have vertices at z = 0. Sides of the plate are ignored.
/// \param has_open_sides true if some facets of the patch are sides of the plate, which occurs at notches and holes
std::array<double, 2> heights_of(const SurfacePatch& patch, bool on_substrate, bool has_open_sides) {
  std::array<double, 2> range{INFINITY, -INFINITY};
  const auto add = [&](double z) { range = {std::min(range[0], z), std::max(range[1], z)}; };
  if (has_open_sides) {
    for (const PatchFacet& facet : patch.facets)
      for (std::uint32_t k = 0; k < facet.corner_count && facet.role != FacetRole::side; ++k)
        add(patch.vertices[patch.corners[facet.first_corner + k]].z());
    return range;
  }
  if (!on_substrate)
    for (const Vec3& vertex : patch.vertices) add(vertex.z());
  for (const PatchCell& cell : patch.cells) {
    add(cell.lower.z());
    add(cell.upper.z());
  }
  return range;
}

/// Sets the range of heights of the back surface if elements are not the nominal elements on z = 0.
void measure_layer(Part& part) {
  constexpr double kRounding = 1e-12;
  std::vector<std::array<double, 2>> of_patch;
  for (const SurfacePatch& patch : part.patches)
    of_patch.push_back(heights_of(patch, part.spec.substrate.has_value(), !part.entrance_pieces.empty()));
  double lowest = 0.0;
  double highest = 0.0;
  for (const Placement& placement : part.placements) {
    lowest = std::min(lowest, of_patch[placement.patch][0] + placement.height_mm);
    highest = std::max(highest, of_patch[placement.patch][1] + placement.height_mm);
  }
  part.element_depth_mm = -lowest;
  part.top_mm = part.spec.substrate && highest <= kRounding * part.element_depth_mm ? 0.0 : highest;
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
    part.entrance_area_mm2 = part.spec.array.outline ? part.spec.array.outline->area_mm2() : area(part.outline);
  }
}

}  // namespace

std::vector<Polygon> entrance_polygons(const Part& part) {
  return part.entrance_pieces.empty() ? std::vector<Polygon>{part.outline} : part.entrance_pieces;
}

double facet_area(const SurfacePatch& patch, const PatchFacet& facet) {
  const auto corner = [&](std::uint32_t k) { return patch.vertices[patch.corners[facet.first_corner + k]]; };
  Vec3 twice = Vec3::Zero();
  for (std::uint32_t k = 1; k + 1 < facet.corner_count; ++k)
    twice += (corner(k) - corner(0)).cross(corner(k + 1) - corner(0));
  return 0.5 * twice.norm();
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

namespace {

void check_plate(const Part& part) {
  if (part.thickness_mm <= part.top_mm)
    throw InputError(fmt::format("body.thickness_mm must be greater than {} mm, the height of the highest rim, got {}",
                                 part.top_mm, part.thickness_mm));
}

Part build(const PartSpec& spec, const Vec2& origin_mm, const FacetPlanes* planes, double elements_per_patch) {
  Part part;
  part.spec = spec;
  part.thickness_mm = spec.thickness_mm;
  part.element_depth_mm = element_depth_mm(spec.element, spec.angle_errors);
  part.top_mm = element_top_mm(spec.element, spec.angle_errors);
  part.size_mm = bounding_box(aperture_outline(spec.element)).size().minCoeff();
  add_surface(part, planes, origin_mm, elements_per_patch);
  if (!is_nominal(spec, planes)) measure_layer(part);
  check_plate(part);
  measure(part);
  if (!part.entrance_pieces.empty()) part.top_mm = part.thickness_mm;
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
        fmt::format("{} of the {} elements are not whole elements of the array", given - part.elements_full, given));
  return part;
}

Part build_part(const ZonedSpec& spec) {
  Part part;
  part.thickness_mm = spec.thickness_mm;
  add_zones(part, spec);
  measure_layer(part);
  check_plate(part);
  measure(part);
  if (!part.entrance_pieces.empty()) part.top_mm = part.thickness_mm;
  return part;
}

Part build_welded_part(const PartSpec& spec) {
  return build(spec, Vec2::Zero(), nullptr, kAllInOnePatch);
}

}  // namespace retrace::geometry
