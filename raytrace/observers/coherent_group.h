#pragma once

// What of the returned light interferes: the plane waves through polygons that one cell sends back.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/light/coherent_light.h"
#include "raytrace/observers/polygon_transform.h"
#include "surface_models/scatter/scatter_event.h"

namespace retrace::raytrace {

/// A facet with a texture or a form on the way of light that leaves the entrance face at a place r: where it was met,
/// constant_mm + slope r, and what the heights there did to its phase.
struct FieldHit {
  Vec3 normal = Vec3::UnitZ();  ///< of the facet's plane normal . p = offset_mm
  double offset_mm = 0.0;
  Vec3 constant_mm = Vec3::Zero();
  Eigen::Matrix<double, 3, 2> slope = Eigen::Matrix<double, 3, 2>::Zero();
  surface_models::PhaseTexture phase;
  /// The same place in the frame of the facet's form, and by how much a height there lengthens the way; 0: no form.
  Vec2 form_constant_mm = Vec2::Zero();
  Eigen::Matrix2d form_slope = Eigen::Matrix2d::Zero();
  double path_per_height = 0.0;
};

/// A plane wave through a convex polygon of the entrance face: part of the field that a cell sends back.
struct FieldPolygon {
  PolygonTransform transform;
  geometry::Vec2 cosines;  ///< of its direction along x and y
  JonesMatrix amplitude;   ///< times the square root of the density of power, with the phase at the origin
  double power = 0.0;      ///< for the polarisation of the incident light
  /// Textured and formed facets on its way. Amplitude and power are those before their phases.
  std::vector<FieldHit> hits;
  double phase_variance = 0.0;  ///< that they make
  double mean_factor = 1.0;     ///< on the amplitude, by averaging over their phases
};

/// All that interferes: the light of one cell by paths of about the same length.
struct CoherentGroup {
  std::vector<FieldPolygon> polygons;
  double copies = 1.0;     ///< cells that send back the same, or of resampled light what comes back by the same way
  double extent_mm = 0.0;  ///< diameter of the circle round all polygons, about their common middle
  std::optional<std::uint32_t> replicate = {};  ///< of a resampled beam; its power is then over their number

  double power() const;           ///< of all copies
  double specular_power() const;  ///< of it what the mean field carries
};

}  // namespace retrace::raytrace
