#include "geometry/check/boundary_check.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

namespace retrace::geometry {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

namespace {

bool passes_edges_both_ways(const BoundaryMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      balance[{low, high}] += t[k] == low ? 1 : -1;
    }
  return std::all_of(balance.begin(), balance.end(), [](const auto& entry) { return entry.second == 0; });
}

using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

/// Returns a point near a self-intersection: the centroid of the smallest triangle that intersects another triangle.
Vec3 crossing_of(const Surface& surface) {
  std::vector<std::pair<Surface::Face_index, Surface::Face_index>> pairs;
  pmp::self_intersections(surface, std::back_inserter(pairs));
  Vec3 place = Vec3::Zero();
  double least = INFINITY;
  for (const auto& pair : pairs)
    for (const Surface::Face_index face : {pair.first, pair.second}) {
      Vec3 sum = Vec3::Zero();
      for (const auto v : CGAL::vertices_around_face(surface.halfedge(face), surface))
        sum += Vec3(surface.point(v).x(), surface.point(v).y(), surface.point(v).z());
      const double area = pmp::face_area(face, surface);
      if (area >= least) continue;
      least = area;
      place = sum / 3.0;
    }
  return place;
}

}  // namespace

BoundaryReport check_boundary(const BoundaryMesh& mesh) {
  // Vertices that belong to no triangle are omitted, because CGAL 5.5 fails on them.
  constexpr std::size_t unused = SIZE_MAX;
  std::vector<std::size_t> number(mesh.vertices.size(), unused);
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
  polygons.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    polygons.emplace_back();
    for (const std::uint32_t v : t) {
      if (number[v] == unused) {
        number[v] = points.size();
        points.emplace_back(mesh.vertices[v].x(), mesh.vertices[v].y(), mesh.vertices[v].z());
      }
      polygons.back().push_back(number[v]);
    }
  }

  BoundaryReport report;
  report.is_closed = passes_edges_both_ways(mesh);
  report.is_manifold = pmp::is_polygon_soup_a_polygon_mesh(polygons);
  if (!report.is_manifold) return report;
  Surface surface;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, surface);
  report.self_intersects = pmp::does_self_intersect(surface);
  if (report.self_intersects) report.crossing_mm = crossing_of(surface);
  if (!report.is_closed || report.self_intersects) return report;
  report.bounds_a_volume = pmp::does_bound_a_volume(surface);
  report.volume_mm3 = pmp::volume(surface);
  return report;
}

}  // namespace retrace::geometry
