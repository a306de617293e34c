#pragma once

// A small software renderer, which draws a shaded triangle mesh with its edges by means of a depth buffer.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/part/closed_boundary.h"
#include "report/canvas.h"

namespace retrace::report {

/// Direction of view on a mesh, in parallel projection.
struct ViewDirection {
  geometry::Vec3 from = geometry::Vec3::UnitZ();  ///< unit vector from the mesh to the eye
  geometry::Vec3 up = geometry::Vec3::UnitY();    ///< vector that points up in the picture; not parallel to `from`
};

/// Picture of a mesh.
struct ShadedView {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<Colour> colours;  ///< colours of the pixels, row by row from the top
  double mm_per_pixel = 1.0;
  double covered = 0.0;  ///< number of pixels that show the mesh, including fractions of pixels
};

/// Draws a mesh and its edges on a background. The light comes from the surroundings and from a lamp next to the eye.
/// Every pixel is the mean of nine sample points.
/// \pre columns and rows are from 1 to 8192, and the mesh has at least one triangle
ShadedView shaded_view(const geometry::BoundaryMesh& mesh, const std::vector<std::array<std::uint32_t, 2>>& edges,
                       const ViewDirection& direction, std::size_t columns, std::size_t rows);

}  // namespace retrace::report
