#pragma once

// Intersection of rays with a smooth entrance surface z(x, y). It uses a grid of cells with bounds on height and
// curvature. Within a cell, the steps along the ray cannot miss the surface.

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "raytrace/faces/entrance_face.h"

namespace retrace::raytrace {

/// An entrance surface z(x, y) in double precision. A grid stores bounds of height and curvature for each cell. Within
/// a cell, each step along a ray is so short that the curvature cannot bring the ray across the surface. The steps
/// converge to the intersection like Newton's method (docs/theory/fronts.md).
class HeightField : public EntranceFace {
 public:
  HeightField(std::shared_ptr<const geometry::EntranceSurface> surface, const geometry::Polygon& outline,
              const Vec2& centre_mm);

  std::optional<EntranceHit> first_hit(const SurfaceRay& ray) const override;

 private:
  struct Cell {
    double low_mm = 0.0;
    double high_mm = 0.0;
    double curvature_per_mm = 0.0;  ///< upper bound of the second derivatives
  };
  struct Search;
  struct Walk;

  geometry::EntranceSurface::SurfaceSample at(double x_mm, double y_mm) const {
    return surface_->at({x_mm + x0_, y_mm + y0_});
  }
  void make_cells(const geometry::Polygon& outline, int cells);
  /// \param places points at the four corners of a cell, first along x and then along y, and one point inside
  Cell cell_between(const std::array<const geometry::EntranceSurface::SurfaceSample*, 5>& places) const;
  void widen_curvatures();
  std::optional<std::array<double, 2>> span_of(const SurfaceRay& ray, double room_mm) const;
  const Cell& cell(int i, int j) const {
    return cells_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)];
  }

  std::shared_ptr<const geometry::EntranceSurface> surface_;
  double x0_ = 0.0;  ///< position of the centre in the part's frame
  double y0_ = 0.0;
  Vec2 lower_ = Vec2::Zero();  ///< lower corner of the grid, relative to the centre
  Vec2 cell_mm_ = Vec2::Ones();
  int columns_ = 0;
  int rows_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace retrace::raytrace
