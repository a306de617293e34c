#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <utility>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::testing {

/// An entrance surface from functions.
class FormulaEntrance : public geometry::EntranceSurface {
 public:
  using Function = std::function<Place(double, double)>;
  explicit FormulaEntrance(Function place, double finest_mm = std::numeric_limits<double>::infinity())
      : place_(std::move(place)), finest_mm_(finest_mm) {}
  Place at(const geometry::Vec2& p) const override { return place_(p.x(), p.y()); }
  double finest_mm() const override { return finest_mm_; }

 private:
  Function place_;
  double finest_mm_;
};

inline geometry::Entrance entrance_of(FormulaEntrance::Function place,
                                      double finest_mm = std::numeric_limits<double>::infinity()) {
  return std::make_shared<const FormulaEntrance>(std::move(place), finest_mm);
}

inline geometry::Entrance plane_entrance(double height_mm, double slope_x = 0.0, double slope_y = 0.0) {
  return entrance_of([=](double x, double y) {
    return geometry::EntranceSurface::Place{height_mm + slope_x * x + slope_y * y, {slope_x, slope_y}};
  });
}

/// A cap of a sphere whose highest place, of height `top_mm`, lies over a point.
inline geometry::Entrance sphere_entrance(double radius_mm, double top_mm, const geometry::Vec2& over_mm) {
  return entrance_of([=](double x, double y) {
    const double u = x - over_mm.x();
    const double v = y - over_mm.y();
    const double w = std::sqrt(radius_mm * radius_mm - u * u - v * v);
    return geometry::EntranceSurface::Place{top_mm - radius_mm + w, {-u / w, -v / w}};
  });
}

/// Bumps and hollows: a cos(k x) cos(k y) about a height.
inline geometry::Entrance egg_box_entrance(double height_mm, double a, double k) {
  return entrance_of(
      [=](double x, double y) {
        return geometry::EntranceSurface::Place{
            height_mm + a * std::cos(k * x) * std::cos(k * y),
            {-a * k * std::sin(k * x) * std::cos(k * y), -a * k * std::cos(k * x) * std::sin(k * y)}};
      },
      3.14159265358979 / k);
}

/// A surface as triangles on a grid over a square.
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
