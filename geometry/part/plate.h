#pragma once

// Parts without elements: plane-parallel plates and boxes.

#include "geometry/part/part.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {

/// Returns a box over 0..x and 0..y whose bottom is at z = 0, oriented outward.
/// \pre sizes and thickness > 0
TriangleMesh box_mesh(const Vec2& size_mm, double thickness_mm);

/// Returns a plate over 0..x and 0..y. Its flat back is its only retro facet.
/// \pre sizes and thickness > 0
Part build_plate(const Vec2& size_mm, double thickness_mm);

}  // namespace retrace::geometry
