#pragma once

// Planes of the facets and dihedral edges of the cube corners of a job, with errors of angle.

#include <array>
#include <cstddef>

#include "fabrication/job/job.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// A cube corner in a flat blank, in the workpiece frame with the origin at its apex. Without errors, edge k has the
/// azimuth 120 k - 90 degrees (rotated: 120 k + 90). Facet k is between edges k and k + 1.
struct CubeCorner {
  double depth_mm = 0.0;  ///< depth of the apex below the blank's face
  /// Unit normals of the facets, pointing out of the material.
  std::array<geometry::Vec3, 3> normals = {geometry::Vec3::Zero(), geometry::Vec3::Zero(), geometry::Vec3::Zero()};
  /// Unit vectors along the dihedral edges, upwards.
  std::array<geometry::Vec3, 3> edges = {geometry::Vec3::Zero(), geometry::Vec3::Zero(), geometry::Vec3::Zero()};

  /// Returns the intersection of the three planes that are parallel to the facets at the given heights above them.
  geometry::Vec3 apex_over(const geometry::Vec3& facets_mm) const;
  /// Returns the height of the apex of a layer that leaves 1 mm on all facets, per mm: sqrt(3) without errors.
  double layer_rise() const { return apex_over(geometry::Vec3::Ones()).z(); }
  /// Returns the largest difference between 90 degrees and an angle between two facets or two edges.
  double largest_error_deg() const;
};

/// Returns the cube corner of a job or of one of its zones.
/// \param zone index of the zone; 0 without zones
/// \pre the job cuts cube corners
CubeCorner blank_corner(const Job& job, std::size_t zone = 0, bool rotated = false);

/// Returns the cube corner of an element. \pre the element is a cube corner without cant
CubeCorner cube_corner(const geometry::Element& element, const geometry::AngleErrors& errors = {},
                       bool rotated = false);

}  // namespace retrace::fabrication
