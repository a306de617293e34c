#include "raytrace/cells/cell_array.h"
#include "geometry/elements/lattice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace retrace::raytrace {

using geometry::Vec2, geometry::Vec3;

namespace {

// Number of periods on each side, in x and y, in which the neighbours of a cell are searched. A cell extends less than
// one period beyond the period that it belongs to.
constexpr int kReach = 2;
// Maximum number of cells per period. The time to find the neighbours increases as the square of this number.
constexpr std::size_t kMaxCells = 500;

CellArray::Facet facet_of(const geometry::CellFacet& facet, geometry::FacetRole role) {
  const geometry::HeightPlane& plane = facet.plane;
  const double length = std::sqrt(1.0 + plane.slope.squaredNorm());
  return {Vec3(plane.slope.x(), plane.slope.y(), -1.0) / length, -plane.height_mm / length, plane, role,
          facet.centroid_mm};
}

CellArray::Column column_of(const geometry::Cell& cell) {
  CellArray::Column column;
  for (const geometry::CellFacet& facet : cell.facets) {
    const bool is_retro = cell.is_element || facet.is_edge;  // rounded rims extend over the flat land next to them
    column.facets.push_back(
        facet_of(facet, is_retro ? geometry::FacetRole::retro_facet : geometry::FacetRole::flat_back));
  }
  for (std::size_t k = 0; k < cell.outline.size(); ++k) {
    const Vec2& from = cell.outline[k];
    const Vec2 along = (cell.outline[(k + 1) % cell.outline.size()] - from).normalized();
    const Vec2 normal(along.y(), -along.x());
    column.edges.push_back({normal, normal.dot(from), along, {}});
  }
  return column;
}

/// Returns true if the surface is the upper envelope of all planes: it is the maximum of their heights everywhere.
bool is_upper_envelope(const geometry::Cell& cell, const CellArray::Column& column, double tolerance_mm) {
  for (const geometry::CellFacet& facet : cell.facets)
    for (const Vec2& corner : facet.outline)
      if (column.height(corner) > facet.plane.at(corner) + tolerance_mm) return false;
  return true;
}

/// Divides cells into smaller cells such that, over each smaller cell, the surface is the upper envelope of the planes
/// of all facets. If this does not hold for a cell, for example because its rims are rounded, the cell is divided into
/// its facets.
std::vector<geometry::Cell> convex_cells(const std::vector<geometry::Cell>& cells, double tolerance_mm) {
  std::vector<geometry::Cell> convex;
  for (const geometry::Cell& cell : cells) {
    if (is_upper_envelope(cell, column_of(cell), tolerance_mm)) {
      convex.push_back(cell);
      continue;
    }
    for (const geometry::CellFacet& facet : cell.facets) {
      geometry::Cell part = cell;
      part.outline = facet.outline;
      part.facets = {facet};
      convex.push_back(part);
    }
  }
  return convex;
}

template <class Visit>
void for_each_shift(const Vec2& period_mm, const Visit& visit) {
  for (int j = -kReach; j <= kReach; ++j)
    for (int i = -kReach; i <= kReach; ++i) visit(Vec2(i * period_mm.x(), j * period_mm.y()));
}

/// Returns true if two surfaces have the same height along the line from `a` to `b`. Along this line, both heights are
/// piecewise linear. It is therefore sufficient to compare them at the ends of the line and at the corners of facets on
/// the line.
bool is_level(const geometry::Cell& cell, const CellArray::Column& here, const CellArray::Column& there,
              const geometry::Cell& other, const Vec2& shift, const Vec2& a, const Vec2& b, double tolerance_mm) {
  const Vec2 along = (b - a).normalized();
  const Vec2 normal(along.y(), -along.x());
  const double length = (b - a).norm();
  std::vector<Vec2> samples = {a, b};
  const auto add = [&](const Vec2& p) {
    const double s = along.dot(p - a);
    if (std::abs(normal.dot(p - a)) <= tolerance_mm && s > 0.0 && s < length) samples.push_back(p);
  };
  for (const auto& facet : cell.facets)
    for (const Vec2& p : facet.outline) add(p);
  for (const auto& facet : other.facets)
    for (const Vec2& p : facet.outline) add(p - shift);
  return std::all_of(samples.begin(), samples.end(),
                     [&](const Vec2& p) { return std::abs(here.height(p) - there.height(p + shift)) <= tolerance_mm; });
}

}  // namespace

double CellArray::Column::height(const Vec2& p) const {
  double highest = facets.front().height.at(p);
  for (const Facet& facet : facets) highest = std::max(highest, facet.height.at(p));
  return highest;
}

std::optional<CellArray> CellArray::make(const geometry::Part& part) {
  if (!part.period_mm && !part.lattice_region_mm) return std::nullopt;
  geometry::Lattice lattice = geometry::make_lattice(part.spec, true);
  // All facets of a column have the same role.
  const auto has_flats = [](const geometry::Cell& cell) {
    return std::any_of(cell.facets.begin(), cell.facets.end(),
                       [](const geometry::CellFacet& facet) { return facet.is_flat; });
  };
  if (lattice.cells.size() > kMaxCells || std::any_of(lattice.cells.begin(), lattice.cells.end(), has_flats))
    return std::nullopt;
  const double tolerance_mm = 1e-9 * lattice.period_mm.maxCoeff();
  const std::size_t cells = lattice.cells.size();
  lattice.cells = convex_cells(lattice.cells, tolerance_mm);
  // Rounded rims of cube corners cause many small columns, and rays would cross them slowly.
  if (lattice.cells.size() > cells && !std::holds_alternative<geometry::RtpElement>(part.spec.element))
    return std::nullopt;
  CellArray array;
  array.period_mm_ = lattice.period_mm;
  if (!part.period_mm) {
    array.inner_ = InnerRegion{*part.lattice_region_mm, part.lattice_anchor_mm};
    for (const geometry::Cell& cell : lattice.cells) {
      // The margin is so wide that it contains the columns at the border of the region and the columns next to them.
      const Vec2 margin = 2.0 * geometry::bounding_box(cell.outline).size();
      array.inner_->where_mm.lower =
          array.inner_->where_mm.lower.cwiseMax(Vec2(part.lattice_region_mm->lower + margin));
      array.inner_->where_mm.upper =
          array.inner_->where_mm.upper.cwiseMin(Vec2(part.lattice_region_mm->upper - margin));
    }
    if (array.inner_->where_mm.empty()) return std::nullopt;
  }
  for (const geometry::Cell& cell : lattice.cells) array.columns_.push_back(column_of(cell));
  array.find_neighbours(lattice, tolerance_mm);
  array.find_fragments(lattice, tolerance_mm);
  return array;
}

void CellArray::find_neighbours(const geometry::Lattice& lattice, double tolerance_mm) {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const geometry::Polygon& outline = lattice.cells[c].outline;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      Edge& edge = columns_[c].edges[k];
      const double from = edge.along.dot(outline[k]);
      const double to = edge.along.dot(outline[(k + 1) % outline.size()]);
      const auto consider = [&](std::uint32_t other, const Vec2& stands_at) {
        const geometry::Polygon& theirs = lattice.cells[other].outline;
        for (std::size_t m = 0; m < theirs.size(); ++m) {
          const Vec2 a = theirs[m] + stands_at;
          const Vec2 b = theirs[(m + 1) % theirs.size()] + stands_at;
          const bool is_opposite = std::abs(edge.normal.dot(a) - edge.offset_mm) <= tolerance_mm &&
                                   std::abs(edge.normal.dot(b) - edge.offset_mm) <= tolerance_mm &&
                                   edge.along.dot(b - a) < 0.0;
          const double first = std::max(from, edge.along.dot(b));
          const double last = std::min(to, edge.along.dot(a));
          if (!is_opposite || last - first <= tolerance_mm) continue;
          const Vec2 substrate = edge.offset_mm * edge.normal;
          edge.neighbours.push_back(
              {other, -stands_at, last,
               is_level(lattice.cells[c], columns_[c], columns_[other], lattice.cells[other], -stands_at,
                        substrate + first * edge.along, substrate + last * edge.along, tolerance_mm)});
        }
      };
      for (std::uint32_t other = 0; other < columns_.size(); ++other)
        for_each_shift(period_mm_, [&](const Vec2& shift) { consider(other, shift); });
      std::sort(edge.neighbours.begin(), edge.neighbours.end(),
                [](const Neighbour& a, const Neighbour& b) { return a.until_mm < b.until_mm; });
    }
  }
}

void CellArray::find_fragments(const geometry::Lattice& lattice, double tolerance_mm) {
  const geometry::Rectangle period{Vec2::Zero(), period_mm_};
  for (std::uint32_t c = 0; c < columns_.size(); ++c)
    for_each_shift(period_mm_, [&](const Vec2& shift) {
      geometry::Polygon moved = lattice.cells[c].outline;
      for (Vec2& p : moved) p += shift;
      if (!geometry::clip(moved, period, tolerance_mm).empty()) fragments_.push_back({c, -shift});
    });
}

}  // namespace retrace::raytrace
