#pragma once

// Parts without elements: plane-parallel plates and boxes.

#include "geometry/part/part.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {

/// A box over 0..x and 0..y whose bottom is z = 0, looking outward. \pre sizes and thickness > 0
TriangleMesh box_mesh(const Vec2& size_mm, double thickness_mm);

/// A plate over 0..x and 0..y whose flat back is its only retro facet. \pre sizes and thickness > 0
Part build_plate(const Vec2& size_mm, double thickness_mm);

}  // namespace retrace::geometry
