#pragma once

#include <string>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/faces/surface_ray.h"

namespace retrace::benchmarks {

/// A part, and the point in its plane that is the origin of ray positions.
struct Scene {
  std::string name;
  geometry::Part part;
  geometry::Vec2 centre_mm = geometry::Vec2::Zero();
};

/// Returns a brick array of `n` x `n` prisms of 0.5 mm under a 0.5 mm plate.
Scene brick_scene(int n);

/// Returns infinite arrays of the three element kinds. The cubes have an edge of 1 mm; the plate has a thickness of 1
/// mm.
std::vector<Scene> infinite_scenes();

/// Returns rays that hit the surface in order, row by row, at 10 degrees from the normal.
std::vector<raytrace::SurfaceRay> coherent_rays(const Scene& scene, std::size_t count);

/// Returns rays inside the part that begin on facets all over the surface and have random directions.
std::vector<raytrace::SurfaceRay> incoherent_rays(const Scene& scene, std::size_t count);

}  // namespace retrace::benchmarks
