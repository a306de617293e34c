#pragma once

// A small software renderer: a triangle mesh, shaded, with its edges, by a depth buffer.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/part/closed_boundary.h"
#include "report/canvas.h"

namespace retrace::report {

/// How a mesh is looked at: along parallel lines, from afar.
struct ViewDirection {
  geometry::Vec3 from = geometry::Vec3::UnitZ();  ///< unit, from the mesh to the eye
  geometry::Vec3 up = geometry::Vec3::UnitY();    ///< not along it
};

/// A picture by a depth buffer.
struct ShadedView {
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<Colour> colours;  ///< row by row from above
  double mm_per_pixel = 1.0;
  double covered = 0.0;  ///< pixels that show the mesh; parts of pixels count
};

/// The mesh in ambient light and that of a lamp beside the eye, its edges drawn over it, on a background. Every pixel
/// is the mean of nine points. \pre columns and rows from 1 to 8192, a triangle
ShadedView shaded_view(const geometry::BoundaryMesh& mesh, const std::vector<std::array<std::uint32_t, 2>>& edges,
                       const ViewDirection& direction, std::size_t columns, std::size_t rows);

}  // namespace retrace::report
