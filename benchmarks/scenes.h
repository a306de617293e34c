#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/faces/surface_ray.h"

namespace retrace::benchmarks {

/// A part and the point of its plane that rays are relative to.
struct Scene {
  std::string name;
  geometry::Part part;
  geometry::Vec2 centre_mm = geometry::Vec2::Zero();
};

/// A brick array of `n` x `n` prisms of 0.5 mm under a 0.5 mm plate.
Scene brick_scene(int n);

/// The three element kinds as endless arrays, cubes of edge 1 mm under a 1 mm plate.
std::vector<Scene> endless_scenes();

/// Rays that fall on the surface side by side, row after row, 10 degrees off the normal.
std::vector<raytrace::SurfaceRay> coherent_rays(const Scene& scene, std::size_t count);

/// Rays inside the part from facets all over the surface in random directions.
std::vector<raytrace::SurfaceRay> incoherent_rays(const Scene& scene, std::size_t count);

}  // namespace retrace::benchmarks
