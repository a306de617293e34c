#include "fabrication/turning/check/machined_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/threads.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::FreeformSurface;

using geometry::Vec3;

/// Returns the number of rays. At half the radius, the distance between rays is about the distance between circles.
std::uint32_t rays_of(int rings) {
  return static_cast<std::uint32_t>(std::max(12L, std::lround(std::numbers::pi * rings)));
}

/// Returns the centre and the intersections of circles and rays, circle by circle, with the heights of the machined
/// surface.
std::vector<Vec3> back_of(const Envelope& envelope, const FreeformSurface& design, const InspectedRegion& region,
                          int rings) {
  const std::uint32_t rays = rays_of(rings);
  const double rim = kRimFeeds * region.feed_mm;
  std::vector<Vec3> vertices(1 + static_cast<std::size_t>(rings) * rays);
  vertices[0] = {0.0, 0.0, design.height_mm(0.0, 0.0)};
  for_each_in_parallel(static_cast<std::size_t>(rings), [&](std::size_t before) {
    const double r = (region.radius_mm - rim) * static_cast<double>(before + 1) / rings;
    for (std::uint32_t ray = 0; ray < rays; ++ray) {
      const double angle = 2.0 * std::numbers::pi * ray / rays;
      const double x = r * std::cos(angle);
      const double y = r * std::sin(angle);
      const auto z = r < rim ? std::optional(design.height_mm(x, y)) : envelope.height_mm(x, y);
      vertices[1 + before * rays + ray] = {x, y, z ? *z : std::numeric_limits<double>::quiet_NaN()};
    }
  });
  for (const Vec3& v : vertices)
    if (!std::isfinite(v.z())) throw InputError("the programs leave a region of the part uncut");
  return vertices;
}

}  // namespace

geometry::BoundaryMesh machined_mesh(const Envelope& envelope, const FreeformSurface& design,
                                     const InspectedRegion& region, int rings, double thickness_mm) {
  const std::uint32_t rays = rays_of(rings);
  geometry::BoundaryMesh mesh;
  mesh.vertices = back_of(envelope, design, region, rings);
  double highest = mesh.vertices.front().z();
  for (const Vec3& v : mesh.vertices) highest = std::max(highest, v.z());
  const auto at = [rays](std::uint32_t ring, std::uint32_t ray) { return 1 + (ring - 1) * rays + ray % rays; };
  // The normals of the back point down.
  for (std::uint32_t ray = 0; ray < rays; ++ray) {
    mesh.triangles.push_back({0, at(1, ray + 1), at(1, ray)});
    for (std::uint32_t ring = 1; ring < static_cast<std::uint32_t>(rings); ++ring) {
      mesh.triangles.push_back({at(ring, ray), at(ring, ray + 1), at(ring + 1, ray)});
      mesh.triangles.push_back({at(ring, ray + 1), at(ring + 1, ray + 1), at(ring + 1, ray)});
    }
  }
  const auto top = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto outermost = static_cast<std::uint32_t>(rings);
  const double level = highest + thickness_mm;
  for (std::uint32_t ray = 0; ray < rays; ++ray) {
    const Vec3& rim = mesh.vertices[at(outermost, ray)];
    mesh.vertices.emplace_back(rim.x(), rim.y(), level);
  }
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.0, 0.0, level);
  for (std::uint32_t ray = 0; ray < rays; ++ray) {
    const std::uint32_t next = top + (ray + 1) % rays;
    mesh.triangles.push_back({at(outermost, ray), at(outermost, ray + 1), next});
    mesh.triangles.push_back({at(outermost, ray), next, top + ray});
    mesh.triangles.push_back({middle, top + ray, next});
  }
  return mesh;
}

}  // namespace retrace::fabrication::turning
