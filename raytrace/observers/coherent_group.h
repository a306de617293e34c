#pragma once

// Coherent parts of the returned light. Each part consists of plane waves that one cell returns and that leave through
// polygons of the entrance face.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/light/coherent_light.h"
#include "raytrace/observers/polygon_transform.h"
#include "surface_models/facet_form.h"
#include "surface_models/scatter/scatter_event.h"

namespace retrace::raytrace {

/// A surface whose heights shift the phase of light: a facet with a texture or a form, or a curved entrance surface.
/// Light that leaves the entrance face at the point r met the surface at the point constant_mm + slope r. The other
/// data describe the phase shift.
struct FieldHit {
  Vec3 normal = Vec3::UnitZ();  ///< normal of the facet's plane normal . p = offset_mm
  double offset_mm = 0.0;
  Vec3 constant_mm = Vec3::Zero();
  Eigen::Matrix<double, 3, 2> slope = Eigen::Matrix<double, 3, 2>::Zero();
  surface_models::PhaseTexture phase;
  /// The point where the light met the facet, in the frame of the facet's form, is form_constant_mm + form_slope r.
  /// `path_per_height` is the change of the optical path per height of the form; it is 0 for facets without a form.
  Vec2 form_constant_mm = Vec2::Zero();
  Eigen::Matrix2d form_slope = Eigen::Matrix2d::Zero();
  double path_per_height = 0.0;
  /// Form of the facet or of the entrance surface; not null if `path_per_height` is not 0. It must outlive the hit.
  const surface_models::FacetForm* form = nullptr;
};

/// A plane wave through a convex polygon of the entrance face. It is a part of the field that a cell returns.
struct FieldPolygon {
  PolygonTransform transform;
  geometry::Vec2 cosines;  ///< x and y components of its unit direction
  JonesMatrix amplitude;   ///< Jones matrix times the square root of the power density, with the phase at the origin
  double power = 0.0;      ///< power for the polarization of the incident light
  /// Facets with texture or form on the path. `amplitude` and `power` do not include the phase shifts of these facets.
  std::vector<FieldHit> hits;
  double phase_variance = 0.0;  ///< variance of the phase that all textures of `hits` cause
  double mean_factor = 1.0;     ///< factor of the mean amplitude, exp(-phase_variance / 2)
  /// Optical path relative to the first polygon of the group. The phase of `amplitude` contains it.
  double path_mm = 0.0;
  /// Light that leaves at a point r entered the entrance face at entry_mm + entry_slope * r. Both points are relative
  /// to the reference point of the group.
  geometry::Vec2 entry_mm = geometry::Vec2::Zero();
  Eigen::Matrix2d entry_slope = Eigen::Matrix2d::Identity();
};

/// Light that interferes: the light of one cell on paths of nearly equal optical length.
struct CoherentGroup {
  std::vector<FieldPolygon> polygons;
  double copies = 1.0;     ///< number of cells with this field; for resampled light, number of equal beams
  double extent_mm = 0.0;  ///< diameter of a circle about the common centroid that contains all polygons
  /// Number of the replicate of a resampled beam. The powers of such a beam are divided by the number of replicates.
  std::optional<std::uint32_t> replicate = {};
  /// Positions of the reference points of all copies in one period. They are set only if the light of different cells
  /// interferes (FarFieldPolicy::interference).
  std::vector<geometry::Vec2> positions_mm = {};
  /// Optical path of the first polygon's light from the reference point on entry to the reference point on exit.
  double path_mm = 0.0;

  double power() const;           ///< returns the power of all copies
  double specular_power() const;  ///< returns the power of the mean field of all copies
  bool has_form() const;          ///< returns true if forms change the phases of the light
};

}  // namespace retrace::raytrace
