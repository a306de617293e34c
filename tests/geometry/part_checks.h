#pragma once

#include <gtest/gtest.h>

#include "geometry/check/boundary_check.h"
#include "geometry/part/part.h"

namespace retrace::geometry {

/// What lies below z = 0 less what of the plate the surface takes above it.
inline double volume_below(const Part& part) {
  double below = 0.0;
  for (const SurfacePatch& patch : part.patches) {
    for (const auto& t : patch.triangles) {
      const Vec3& a = patch.vertices[t[0]];
      const Vec2 ab = (patch.vertices[t[1]] - a).head<2>();
      const Vec2 ac = (patch.vertices[t[2]] - a).head<2>();
      // Clockwise in plan, as it is seen from below.
      const double plan_area = 0.5 * (ab.y() * ac.x() - ab.x() * ac.y());
      below -= plan_area * (a.z() + patch.vertices[t[1]].z() + patch.vertices[t[2]].z()) / 3.0;
    }
  }
  return below;
}

/// The boundary of a finite part of one patch is closed and holds the volume that its surface encloses.
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
