#include "geometry/part/chosen_elements.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/overloaded.h"
#include "core/random.h"
#include "geometry/centroid.h"
#include "geometry/direction.h"
#include "geometry/elements/facet_planes.h"

namespace retrace::geometry {
namespace {

bool is_wall(const PatchFacet& facet) {
  return facet.role == FacetRole::inner_wall || facet.role == FacetRole::border_wall;
}

/// Returns the (x, y) centroid of a cell in projection along z, without its vertical walls. If the projected area is 0,
/// returns the centre of the cell's bounding box.
Vec2 middle_in_plan(const SurfacePatch& patch, const PatchCell& cell) {
  Vec2 sum = Vec2::Zero();
  double area_mm2 = 0.0;
  for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f) {
    const PatchFacet& facet = patch.facets[f];
    if (is_wall(facet)) continue;
    Polygon plan;
    for (std::uint32_t k = 0; k < facet.corner_count; ++k)
      plan.push_back(patch.vertices[patch.corners[facet.first_corner + k]].head<2>());
    const double of_facet_mm2 = std::abs(area(plan));
    if (!(of_facet_mm2 > 0.0)) continue;
    sum += of_facet_mm2 * centroid(plan);
    area_mm2 += of_facet_mm2;
  }
  return area_mm2 > 0.0 ? Vec2(sum / area_mm2) : Vec2(0.5 * (cell.lower + cell.upper).head<2>());
}

/// Returns a point next to a wall, projected to (x, y): the wall's centroid, moved by `by_mm` along the outward normal.
/// If the wall separates two cells, a positive `by_mm` gives a point in the shallower cell, and a negative `by_mm` a
/// point in the deeper cell.
Vec2 beyond_wall(const SurfacePatch& patch, const PatchFacet& wall, double by_mm) {
  const std::span<const std::uint32_t> ring(&patch.corners[wall.first_corner], wall.corner_count);
  return (ring_centroid(patch.vertices, ring) + by_mm * wall.normal).head<2>();
}

bool has_retro_facet(const SurfacePatch& patch, const PatchCell& cell) {
  for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f)
    if (patch.facets[f].role == FacetRole::retro_facet) return true;
  return false;
}

}  // namespace

ChosenElements::ChosenElements(const Part& part, const ElementChoice& choice)
    : choice_(choice),
      spec_(part.spec),
      sheet_(spec_),
      part_mm_(bounding_box(part.outline)),
      inwards_(Vec2::Constant(1e-6 * part.size_mm)) {
  std::vector<std::vector<Vec2>> middles;  // by patch
  for (const SurfacePatch& patch : part.patches) {
    auto& of_patch = middles.emplace_back();
    for (const PatchCell& cell : patch.cells) of_patch.push_back(middle_in_plan(patch, cell));
  }
  bool all = true, none = true;
  for (const Placement& placement : part.placements) {
    const SurfacePatch& patch = part.patches[placement.patch];
    const std::size_t first = facets_.size();
    first_of_placement_.push_back(first);
    facets_.resize(first + patch.facets.size());
    for (std::size_t c = 0; c < patch.cells.size(); ++c) {
      const PatchCell& cell = patch.cells[c];
      if (cell.first_of_element) {
        choose_open_side(patch, placement.offset_mm, cell, first);
        continue;
      }
      const Vec2 place_mm = placement.offset_mm + middles[placement.patch][c];
      const LatticeElement element = element_at(place_mm);
      const bool chosen = is_chosen(element, place_mm);
      std::fill_n(facets_.begin() + static_cast<std::ptrdiff_t>(first + cell.first_facet), cell.facet_count, chosen);
      (chosen ? none : all) = false;
      for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f) {
        if (!is_wall(patch.facets[f])) continue;
        const Vec2 behind = placement.offset_mm + beyond_wall(patch, patch.facets[f], inwards_.x());
        facets_[first + f] = is_chosen(element_at(behind), behind);
      }
      if (!element.is_within || !has_retro_facet(patch, cell)) continue;
      ++of_all_;
      if (chosen) ++count_;
    }
  }
  // The regions by which elements can be chosen are convex. If all corners of the outline are chosen, the walls between
  // them are therefore chosen, too.
  const auto wall_is_chosen = [&](const Vec2& corner) { return is_chosen({}, corner); };
  const auto* const by_chance = std::get_if<RandomFraction>(&choice_);
  contains_all_ = all && (by_chance ? by_chance->fraction >= 1.0 : std::ranges::all_of(part.outline, wall_is_chosen));
  is_empty_ = none;
}

void ChosenElements::choose_open_side(const SurfacePatch& patch, const Vec2& offset_mm, const PatchCell& cell,
                                      std::size_t first) {
  for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f) {
    const Vec2 inside = offset_mm + beyond_wall(patch, patch.facets[f], -inwards_.x());
    facets_[first + f] = is_chosen(element_at(inside), inside);
  }
}

ChosenElements::LatticeElement ChosenElements::element_at(const Vec2& position_mm) const {
  const Vec2 from_anchor = position_mm - sheet_.anchor_mm;
  const Vec2 period = sheet_.lattice.period_mm;
  const auto index = [&](Eigen::Index axis) {
    return static_cast<std::int64_t>(std::floor(from_anchor[axis] / period[axis]));
  };
  LatticeElement nearest;
  double least_mm2 = INFINITY;
  for (std::int64_t j = index(1) - 1; j <= index(1) + 1; ++j)
    for (std::int64_t i = index(0) - 1; i <= index(0) + 1; ++i) {
      const Vec2 origin = sheet_.at_mm(i, j);
      for (std::uint32_t k = 0; k < sheet_.lattice.cells.size(); ++k) {
        const Cell& cell = sheet_.lattice.cells[k];
        if (!cell.is_element) continue;
        const LatticeElement here{i, j, k, contains(cell.outline, position_mm - origin),
                                  origin + reference_position(spec_, cell)};
        if (here.is_within) return here;
        const double mm2 = (here.centre_mm - position_mm).squaredNorm();
        if (!(mm2 < least_mm2)) continue;
        least_mm2 = mm2;
        nearest = here;
      }
    }
  return nearest;
}

bool ChosenElements::is_chosen(const LatticeElement& element, const Vec2& position_mm) const {
  constexpr std::uint32_t kChoiceStream = 4;
  const Vec2 at =
      element.is_within ? Vec2(element.centre_mm.cwiseMax(part_mm_.lower).cwiseMin(part_mm_.upper)) : position_mm;
  return std::visit(Overloaded{[&](const RandomFraction& random) {
                                 const auto words =
                                     philox({random.seed, kChoiceStream}, static_cast<std::uint32_t>(element.i),
                                            static_cast<std::uint32_t>(element.j), element.number);
                                 return unit_interval(words[0]) < random.fraction;
                               },
                               [&](const Rectangle& r) {
                                 return (at.array() >= r.lower.array()).all() && (at.array() <= r.upper.array()).all();
                               },
                               [&](const Disc& disc) { return (at - disc.centre_mm).norm() <= disc.radius_mm; },
                               [&](const HalfPlane& half) {
                                 const Vec2 towards = direction_at(Angle::from_deg(half.azimuth_deg));
                                 return (at - half.through_mm).dot(towards) >= 0.0;
                               }},
                    choice_);
}

bool ChosenElements::has_wall_at(const Vec2& position_mm) const {
  // The point is moved slightly inward, because the lattice also has elements beyond the border. A point exactly on the
  // border could belong to one of them.
  const Vec2 within = position_mm.cwiseMax(part_mm_.lower + inwards_).cwiseMin(part_mm_.upper - inwards_);
  return is_chosen(element_at(within), within);
}

}  // namespace retrace::geometry
