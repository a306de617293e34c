#pragma once

// Facet planes and dihedral edges of the cube corners of a job, including the intended angle errors.

#include <array>
#include <cstddef>

#include "fabrication/job/job.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Cube corner in a flat blank, in the workpiece frame with the origin at its apex. Facet k is between the edges k and
/// (k + 1) % 3. Without angle errors, edge k has the azimuth 120 k - 90 degrees, or 120 k + 90 degrees in a rotated
/// element.
struct CubeCorner {
  double depth_mm = 0.0;  ///< depth of the apex below the blank's face
  /// Unit normals of the facets, pointing out of the material.
  std::array<geometry::Vec3, 3> normals = {geometry::Vec3::Zero(), geometry::Vec3::Zero(), geometry::Vec3::Zero()};
  /// Unit vectors along the dihedral edges, pointing upwards from the apex.
  std::array<geometry::Vec3, 3> edges = {geometry::Vec3::Zero(), geometry::Vec3::Zero(), geometry::Vec3::Zero()};

  /// Returns the intersection point of three planes that are parallel to the facets.
  /// \param facets_mm height of each plane above its facet
  geometry::Vec3 apex_over(const geometry::Vec3& facets_mm) const;
  /// Returns the height, along z, of a layer's apex above the nominal apex, divided by the thickness of the material
  /// that the layer leaves on every facet. It is sqrt(3) without angle errors.
  double layer_rise() const { return apex_over(geometry::Vec3::Ones()).z(); }
  /// Returns the largest deviation from 90 degrees among the angles between facets and the angles between edges.
  double largest_error_deg() const;
};

/// Returns the cube corner of a job or of one of its zones.
/// \param zone index of the zone; 0 without zones
/// \pre the job cuts cube corners
CubeCorner blank_corner(const Job& job, std::size_t zone = 0, bool rotated = false);

/// Returns the cube corner of an element.
/// \pre the element is a cube corner without cant
CubeCorner cube_corner(const geometry::Element& element, const geometry::AngleErrors& errors = {},
                       bool rotated = false);

}  // namespace retrace::fabrication
