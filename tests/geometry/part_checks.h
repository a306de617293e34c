#pragma once

#include <gtest/gtest.h>

#include "geometry/check/boundary_check.h"
#include "geometry/part/part.h"

namespace retrace::geometry {

/// Returns the volume of the material below z = 0 minus the volume of the space above z = 0 that the back surface cuts
/// out of the plate.
inline double volume_below(const Part& part) {
  double below = 0.0;
  for (const SurfacePatch& patch : part.patches) {
    for (const auto& t : patch.triangles) {
      const Vec3& a = patch.vertices[t[0]];
      const Vec2 ab = (patch.vertices[t[1]] - a).head<2>();
      const Vec2 ac = (patch.vertices[t[2]] - a).head<2>();
      // The triangles are counter-clockwise as seen from below, and therefore clockwise in plan.
      const double plan_area = 0.5 * (ab.y() * ac.x() - ab.x() * ac.y());
      below -= plan_area * (a.z() + patch.vertices[t[1]].z() + patch.vertices[t[2]].z()) / 3.0;
    }
  }
  return below;
}

/// Expects that the boundary of a finite part with a single patch is closed and encloses the volume that follows from
/// its back surface.
inline void expect_valid(const PartSpec& spec) {
  const Part part = build_part(spec);
  const BoundaryReport report = check_boundary(closed_boundary(part));
  EXPECT_TRUE(report.is_manifold);
  EXPECT_TRUE(report.is_closed);
  EXPECT_FALSE(report.self_intersects);
  EXPECT_TRUE(report.bounds_a_volume);
  EXPECT_NEAR(report.volume_mm3, part.entrance_area_mm2 * part.thickness_mm + volume_below(part), 1e-9);
}

}  // namespace retrace::geometry
