#pragma once

// Cube corners as a job cuts them: the planes of their facets and the dihedral edges, errors of angle included.

#include <array>
#include <cstddef>

#include "fabrication/job/job.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// A cube corner in a flat blank, in the workpiece frame, from its apex. Edge k lies at 120 k - 90 degrees but for
/// errors (rotated: at 120 k + 90), facet k between edges k and k + 1.
struct CubeCorner {
  double depth_mm = 0.0;  ///< of the apex below the blank's face
  /// Of the facets, out of the material, of length 1.
  std::array<geometry::Vec3, 3> normals = {geometry::Vec3::Zero(), geometry::Vec3::Zero(), geometry::Vec3::Zero()};
  /// Upwards, of length 1.
  std::array<geometry::Vec3, 3> edges = {geometry::Vec3::Zero(), geometry::Vec3::Zero(), geometry::Vec3::Zero()};

  /// Where the planes meet that lie so far over the facets, along their normals.
  geometry::Vec3 apex_over(const geometry::Vec3& facets_mm) const;
  /// How far the apex of a layer that leaves 1 mm on all facets lies over this one: sqrt(3) without errors.
  double layer_rise() const { return apex_over(geometry::Vec3::Ones()).z(); }
  /// By how much an angle between two facets, or between two edges, misses 90 degrees at most.
  double largest_error_deg() const;
};

/// \param zone of the job; 0 without zones \pre the job cuts cube corners
CubeCorner blank_corner(const Job& job, std::size_t zone = 0, bool rotated = false);

/// The same of an element as it is. \pre it is a cube corner, without cant
CubeCorner cube_corner(const geometry::Element& element, const geometry::AngleErrors& errors = {},
                       bool rotated = false);

}  // namespace retrace::fabrication
