#include "raytrace/cells/column_faces.h"

#include <algorithm>
#include <span>

namespace retrace::raytrace {
namespace {

Vec3 lifted(const Vec2& normal) {
  return {normal.x(), normal.y(), 0.0};
}

}  // namespace

ColumnFaces::ColumnFaces(const CellArray& array) {
  for (const CellArray::Column& from : array.columns()) {
    Column& column = columns_.emplace_back();
    column.role = from.facets.front().role;
    for (const CellArray::Facet& facet : from.facets) {
      column.facets.push_back({facet.normal, facet.offset_mm});
      column.frames.emplace_back();
      if (facet.centroid_mm) column.frames.back() = FacetFrame(facet.normal, facet.offset_mm, *facet.centroid_mm);
      column.heights.push_back({facet.height.slope.x(), facet.height.slope.y(), facet.height.height_mm});
    }
    for (const CellArray::Edge& edge : from.edges) column.borders.push_back({lifted(edge.normal), edge.offset_mm});
  }
  for (std::size_t k = 0; k < columns_.size(); ++k)
    for (const bool inside : {false, true})
      columns_[k].sides[inside ? 1 : 0] = side_of_column(array.columns()[k], inside);
}

/// Returns the borders and the neighbours of a column for rays inside the part, or for rays below its surface.
ColumnFaces::Side ColumnFaces::side_of_column(const CellArray::Column& column, bool inside) const {
  Side side;
  std::vector<Exit> behind_intervals;
  for (std::size_t k = 0; k < column.edges.size(); ++k) {
    const CellArray::Edge& edge = column.edges[k];
    const auto exit_to = [&](const CellArray::Neighbour& neighbour, lanes::Label crossing) {
      const Vec3 out = lifted(edge.normal);
      return Exit{crossing, std::nullopt, neighbour.column, neighbour.shift_mm, inside ? out : Vec3(-out)};
    };
    if (edge.neighbours.size() == 1 && edge.neighbours[0].is_flush) {
      side.exits.push_back(exit_to(edge.neighbours[0], lanes::label_of(lanes::Hit::border, k)));
      continue;
    }
    lanes::Border& border = side.borders.emplace_back();
    border.index = k;
    border.first_interval = behind_intervals.size();
    border.along = {edge.along.x(), edge.along.y(), 0.0};
    border.inside = inside;
    for (const CellArray::Neighbour& neighbour : edge.neighbours) {
      border.limits.push_back(neighbour.until_mm);
      border.intervals.push_back({neighbour.is_flush, neighbour.shift_mm, columns_[neighbour.column].heights});
      const std::size_t interval = behind_intervals.size();
      Exit exit = exit_to(neighbour, lanes::label_of(lanes::Hit::crossing, interval));
      if (!neighbour.is_flush) exit.wall = lanes::label_of(lanes::Hit::wall, interval);
      behind_intervals.push_back(exit);
    }
    border.limits.pop_back();
  }
  side.exits.insert(side.exits.end(), behind_intervals.begin(), behind_intervals.end());
  return side;
}

double ColumnFaces::advance(const LightSetup& setup, RayBatch& batch) const {
  const Column& column = columns_[batch.stream.column];
  const lanes::Rays rays = batch.rays.rays();
  const lanes::FaceHits met = batch.hits.face_hits();
  double absorbed = 0.0;
  if (batch.stream.inside()) {
    absorbed = lanes::advance_inside(rays, batch.rays.size(), column.facets, setup.top_mm, column.borders,
                                     setup.optics.absorption_per_mm, met);
  } else {
    std::span<const lanes::Plane> facets;
    if (batch.stream.location == RayLocation::below) facets = column.facets;
    lanes::advance_outside(rays, batch.rays.size(), facets, setup.depth_mm, column.borders, met);
  }
  for (const lanes::Border& border : side_of(batch.stream).borders)
    lanes::refine(rays, batch.rays.size(), border, met.labels);
  return absorbed;
}

std::size_t ColumnFaces::facet_of(std::uint32_t column, const Vec3& normal) const {
  const std::vector<lanes::Plane>& facets = columns_[column].facets;
  const auto difference = [&](const lanes::Plane& facet) { return (facet.normal - normal).squaredNorm(); };
  return static_cast<std::size_t>(std::ranges::min_element(facets, {}, difference) - facets.begin());
}

}  // namespace retrace::raytrace
