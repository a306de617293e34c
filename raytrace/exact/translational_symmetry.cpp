#include "raytrace/exact/translational_symmetry.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/elements/lattice.h"
#include "geometry/point_lookup.h"

namespace retrace::raytrace {
namespace {

using geometry::Part, geometry::PatchCell, geometry::PatchFacet, geometry::Placement, geometry::Rectangle,
    geometry::SurfacePatch;

// Relative tolerance of comparisons. Corners are equal if they agree within this fraction of the element size. Normals
// are equal if they agree within this value.
constexpr double kSameCorner = 1e-9;
// Minimum number of periods along at least one axis. In smaller arrays, each element is traced separately.
constexpr double kFewestPeriods = 2.0;
// Maximum number of array periods after which rows or columns may repeat. If rows or columns differ, they may repeat
// only after several periods. Longer repetitions are not searched.
constexpr int kMaxRepeatPeriods = 12;

Vec2 origin_of(const PatchCell& cell) {
  return cell.lower.head<2>();
}

bool is_same(const SurfacePatch& a, const PatchFacet& facet_a, const Vec2& origin_a, const SurfacePatch& b,
             const PatchFacet& facet_b, const Vec2& origin_b, double near_mm) {
  if (facet_a.role != facet_b.role || facet_a.corner_count != facet_b.corner_count) return false;
  if ((facet_a.normal - facet_b.normal).cwiseAbs().maxCoeff() > kSameCorner) return false;
  if (facet_a.centroid_mm.has_value() != facet_b.centroid_mm.has_value()) return false;
  const Vec2 by = origin_b - origin_a;
  if (facet_a.centroid_mm && (*facet_a.centroid_mm + by - *facet_b.centroid_mm).cwiseAbs().maxCoeff() > near_mm)
    return false;
  const Vec3 shift(by.x(), by.y(), 0.0);
  for (std::uint32_t c = 0; c < facet_a.corner_count; ++c) {
    const Vec3& p = a.vertices[a.corners[facet_a.first_corner + c]];
    const Vec3& q = b.vertices[b.corners[facet_b.first_corner + c]];
    if ((p + shift - q).cwiseAbs().maxCoeff() > near_mm) return false;
  }
  return true;
}

bool is_same(const SurfacePatch& a, const PatchCell& cell_a, const SurfacePatch& b, const PatchCell& cell_b,
             double near_mm) {
  if (cell_a.facet_count != cell_b.facet_count) return false;
  for (std::uint32_t f = 0; f < cell_a.facet_count; ++f)
    if (!is_same(a, a.facets[cell_a.first_facet + f], origin_of(cell_a), b, b.facets[cell_b.first_facet + f],
                 origin_of(cell_b), near_mm))
      return false;
  return true;
}

/// Returns true if the outline is a rectangle with sides along the x and y axes.
bool is_rectangle(const geometry::Polygon& outline, double near_mm) {
  const Rectangle box = geometry::bounding_box(outline);
  const auto is_corner = [&](const Vec2& p) {
    return (p - box.lower).cwiseAbs().cwiseMin((p - box.upper).cwiseAbs()).maxCoeff() <= near_mm;
  };
  return outline.size() == 4 && std::all_of(outline.begin(), outline.end(), is_corner);
}

/// Returns the area of a cell's projection along z.
double plan_area(const SurfacePatch& patch, const PatchCell& cell) {
  double area_mm2 = 0.0;
  for (std::uint32_t f = 0; f < cell.facet_count; ++f) {
    const PatchFacet& facet = patch.facets[cell.first_facet + f];
    geometry::Polygon outline;
    for (std::uint32_t c = 0; c < facet.corner_count; ++c)
      outline.push_back(patch.vertices[patch.corners[facet.first_corner + c]].head<2>());
    area_mm2 += std::abs(geometry::area(outline));
  }
  return area_mm2;
}

/// Returns a region with the smallest multiples of the given periods for which the cells repeat. Multiples are needed
/// if rows or columns differ. If no multiples are found, the returned region does not repeat.
PeriodicRegion repeating(const geometry::Polygon& outline, const std::array<Vec2, 2>& periods_mm,
                         const std::vector<PlacedCell>& cells, double near_mm) {
  for (int all = 1; all <= kMaxRepeatPeriods; ++all)
    for (const int along : {1, all}) {
      const std::array<Vec2, 2> longer = {along * periods_mm[0], (all / along) * periods_mm[1]};
      PeriodicRegion region(outline, longer, cells, near_mm);
      if (region.is_periodic()) return region;
    }
  return PeriodicRegion(outline, periods_mm, cells, near_mm);
}

Vec3 in_plan(const Vec2& p) {
  return {p.x(), p.y(), 0.0};
}

}  // namespace

std::optional<TranslationalSymmetry> TranslationalSymmetry::of(const Part& part, const Vec2& centre_mm) {
  TranslationalSymmetry equal;
  equal.part_ = &part;
  equal.near_mm_ = kSameCorner * part.size_mm;
  if (part.period_mm) {
    equal.period_mm_ = *part.period_mm;
    equal.find_shapes(part);
    equal.find_shift_within_period(part);
    return equal;
  }
  if (!part.lattice_regions.empty()) {
    equal.find_shapes(part);
    equal.find_regions(part, centre_mm);
    if (std::none_of(equal.regions_.begin(), equal.regions_.end(),
                     [](const PeriodicRegion& region) { return region.is_periodic(); }))
      return std::nullopt;
    return equal;
  }
  if (!part.lattice_region_mm || !is_rectangle(part.outline, equal.near_mm_)) return std::nullopt;
  equal.period_mm_ = geometry::make_lattice(part.spec, true).period_mm;
  if ((part.lattice_region_mm->size().cwiseQuotient(equal.period_mm_).array() < kFewestPeriods).all())
    return std::nullopt;
  equal.find_shapes(part);
  equal.find_region(part, centre_mm);
  if ((equal.region_mm_.size().cwiseQuotient(equal.period_mm_).array() < kFewestPeriods).all()) return std::nullopt;
  return equal;
}

void TranslationalSymmetry::find_shapes(const Part& part) {
  struct First {
    const SurfacePatch* patch;
    const PatchCell* cell;
  };
  std::map<std::uint32_t, std::vector<First>> firsts;  // first cell of each shape, by the number of facets
  for (const SurfacePatch& patch : part.patches) {
    std::vector<Shape>& shapes = shapes_.emplace_back();
    for (const PatchCell& cell : patch.cells) {
      std::vector<First>& known = firsts[cell.facet_count];
      auto first = std::find_if(known.begin(), known.end(), [&](const First& other) {
        return is_same(*other.patch, *other.cell, patch, cell, near_mm_);
      });
      if (first == known.end()) first = known.insert(known.end(), {&patch, &cell});
      shapes.push_back({part.element_id(*first->patch, *first->cell), origin_of(cell) - origin_of(*first->cell)});
    }
  }
}

CellInstance TranslationalSymmetry::instance_of(const SurfacePatch& patch, const PatchCell& cell,
                                                const Vec2& offset_mm) const {
  const Shape& shape = shapes_[static_cast<std::size_t>(&patch - part_->patches.data())]
                              [static_cast<std::size_t>(&cell - patch.cells.data())];
  return {shape.id, offset_mm + shape.shift_mm};
}

/// Finds the rectangle in which shifts by one period map cells to identical cells. If a cell has no identical cell one
/// period away, the rectangle is reduced on the side that is nearer to the cell.
void TranslationalSymmetry::find_region(const Part& part, const Vec2& centre_mm) {
  geometry::PointLookup<std::uint64_t> cells(near_mm_);
  const auto visit_all = [&](const auto& visit) {
    for (const Placement& placement : part.placements)
      for (const PatchCell& cell : part.patches[placement.patch].cells)
        visit(cell, placement.offset_mm - centre_mm,
              instance_of(part.patches[placement.patch], cell, placement.offset_mm - centre_mm));
  };
  visit_all([&](const PatchCell&, const Vec2&, const CellInstance& place) {
    cells.insert(in_plan(place.offset_mm), place.id);
  });
  const auto is_there = [&](const CellInstance& place, const Vec2& by) {
    bool found = false;
    cells.visit(in_plan(place.offset_mm + by), [&](std::uint64_t id) { found = found || id == place.id; });
    return found;
  };
  region_mm_ = geometry::moved(geometry::bounding_box(part.outline), -centre_mm);
  const Vec2 middle = region_mm_.centre();
  visit_all([&](const PatchCell& cell, const Vec2& offset, const CellInstance& place) {
    for (const Eigen::Index axis : {0, 1}) {
      const Vec2 step = Vec2::Unit(axis) * period_mm_[axis];
      const double low = cell.lower[axis] + offset[axis];
      const double high = cell.upper[axis] + offset[axis];
      const bool is_low = low + high < 2.0 * middle[axis];
      const auto bound = [&](double above, double below) {
        if (is_low)
          region_mm_.lower[axis] = std::max(region_mm_.lower[axis], above);
        else
          region_mm_.upper[axis] = std::min(region_mm_.upper[axis], below);
      };
      if (!is_there(place, step)) bound(high, low + step[axis]);
      if (!is_there(place, -step)) bound(high - step[axis], low);
    }
  });
}

void TranslationalSymmetry::find_regions(const Part& part, const Vec2& centre_mm) {
  std::vector<PlacedCell> cells;
  for (const Placement& placement : part.placements) {
    const SurfacePatch& patch = part.patches[placement.patch];
    const Vec2 offset = placement.offset_mm - centre_mm;
    for (const PatchCell& cell : patch.cells)
      cells.push_back({{cell.lower.head<2>() + offset, cell.upper.head<2>() + offset},
                       instance_of(patch, cell, offset),
                       plan_area(patch, cell)});
  }
  for (const geometry::LatticeRegion& region : part.lattice_regions)
    regions_.push_back(repeating(geometry::moved(region.outline, -centre_mm), region.periods_mm, cells, near_mm_));
}

/// Searches for a shift by half a period, along one or both axes, that maps an infinite part to itself. Honeycombs,
/// brick rows and checkered arrays have such a shift.
void TranslationalSymmetry::find_shift_within_period(const Part& part) {
  const SurfacePatch& patch = part.patches.front();
  geometry::PointLookup<std::uint64_t> cells(near_mm_);
  for (const PatchCell& cell : patch.cells) {
    const CellInstance place = instance_of(patch, cell, Vec2::Zero());
    cells.insert(in_plan(place.offset_mm), place.id);
  }
  const auto side = static_cast<std::size_t>(2 * part.periods_beyond + 1);
  const std::size_t each = patch.cells.size() / (side * side);
  const std::size_t first = (side * side / 2) * each;
  const auto repeats_by = [&](const Vec2& by) {
    for (std::size_t k = first; k < first + each; ++k) {
      const CellInstance place = instance_of(patch, patch.cells[k], Vec2::Zero());
      bool found = false;
      cells.visit(in_plan(place.offset_mm + by), [&](std::uint64_t id) { found = found || id == place.id; });
      if (!found) return false;
    }
    return true;
  };
  for (const Vec2& share : {Vec2(0.5, 0.5), Vec2(0.0, 0.5), Vec2(0.5, 0.0)}) {
    const Vec2 by = share.cwiseProduct(period_mm_);
    if (!within_period_mm_ && repeats_by(by)) within_period_mm_ = by;
  }
}

bool TranslationalSymmetry::is_within(const Rectangle& sweep, const Vec2& by, Eigen::Index axis) const {
  return sweep.lower[axis] + by[axis] >= region_mm_.lower[axis] - near_mm_ &&
         sweep.upper[axis] + by[axis] <= region_mm_.upper[axis] + near_mm_;
}

std::vector<InstanceOffsets> TranslationalSymmetry::divided(const InstanceOffsets& places, const Rectangle& sweep,
                                                            std::uint32_t region) const {
  if (!regions_.empty()) return regions_[region].divided(places, sweep);
  const auto meets_inner_cells = [&](const Vec2& by) { return is_within(sweep, by, 0) && is_within(sweep, by, 1); };
  if (part_->period_mm || std::all_of(places.begin(), places.end(), meets_inner_cells)) return {};
  std::vector<InstanceOffsets> groups = {places};
  for (const Eigen::Index axis : {0, 1}) {
    std::vector<InstanceOffsets> finer;
    for (const InstanceOffsets& group : groups) {
      InstanceOffsets inside;
      std::map<double, InstanceOffsets> beside;  // positions outside the region, by their displacement along the axis
      for (const Vec2& by : group) (is_within(sweep, by, axis) ? inside : beside[by[axis]]).push_back(by);
      if (!inside.empty()) finer.push_back(std::move(inside));
      for (auto& [at, own] : beside) finer.push_back(std::move(own));
    }
    groups = std::move(finer);
  }
  return groups;
}

}  // namespace retrace::raytrace
