#pragma once

// Entrance surfaces for tests: planes, spherical caps and waves.

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "core/error.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::testing {

inline geometry::Entrance entrance_of(geometry::Sag sag, const geometry::Vec3& origin_mm,
                                      double finest_mm = std::numeric_limits<double>::infinity()) {
  return std::make_shared<const geometry::EntranceSurface>(
      geometry::FreeformSurface(std::move(sag), std::nullopt, {}, {}), origin_mm, finest_mm);
}

/// Returns a surface whose height is a formula of x and y.
inline geometry::Entrance formula_entrance(const std::string& height_mm,
                                           double finest_mm = std::numeric_limits<double>::infinity()) {
  geometry::Sag sag;
  sag.formula = parse_formula(height_mm, {"x", "y"}, {});
  return entrance_of(std::move(sag), geometry::Vec3::Zero(), finest_mm);
}

inline geometry::Entrance plane_entrance(double height_mm, double slope_x = 0.0, double slope_y = 0.0) {
  geometry::Sag sag;
  sag.polynomial = geometry::XyPolynomial{1.0, 1, {0.0, slope_y, slope_x}};
  return entrance_of(std::move(sag), {0.0, 0.0, height_mm});
}

/// Returns a spherical cap. Its highest point has the height `top_mm` and is located above `over_mm`.
inline geometry::Entrance sphere_entrance(double radius_mm, double top_mm, const geometry::Vec2& over_mm) {
  geometry::Sag sag;
  sag.asphere.curvature_per_mm = -1.0 / radius_mm;
  return entrance_of(std::move(sag), {over_mm.x(), over_mm.y(), top_mm});
}

/// Returns the surface with the height `height_mm` + a cos(k x) cos(k y), which consists of bumps and hollows.
/// \param finest_mm size of the finest structure that is passed to the surface
inline geometry::Entrance egg_box_entrance(double height_mm, double a, double k, double finest_mm) {
  return formula_entrance(fmt::format("{} + {} * cos({} * x) * cos({} * y)", height_mm, a, k, k), finest_mm);
}
inline geometry::Entrance egg_box_entrance(double height_mm, double a, double k) {
  return egg_box_entrance(height_mm, a, k, 3.14159265358979 / k);
}

/// Returns a surface as a mesh of triangles on a grid over a square.
inline geometry::TriangleMesh meshed(const geometry::EntranceSurface& surface, double size_mm, std::uint32_t cells) {
  geometry::TriangleMesh mesh;
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const geometry::Vec2 p(size_mm * i / cells, size_mm * j / cells);
      mesh.vertices.emplace_back(p.x(), p.y(), surface.at(p).height_mm);
    }
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i;
      mesh.triangles.push_back({a, a + 1, a + cells + 2});
      mesh.triangles.push_back({a, a + cells + 2, a + cells + 1});
    }
  return mesh;
}

}  // namespace retrace::testing
