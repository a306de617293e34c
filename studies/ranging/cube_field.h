#pragma once

// Far field of the light that one cube corner returns, as complex Jones matrices. The fields of several cubes can be
// added with or without interference. The polarisation of the incident light can be chosen after the computation.

#include <complex>
#include <span>
#include <vector>

#include "raytrace/light/coherent_light.h"
#include "raytrace/light/stokes.h"
#include "raytrace/observers/far_field.h"
#include "raytrace/observers/field_lanes.h"

namespace retrace::studies {

/// Jones matrices of light that returns in one direction, one matrix for each coherent group of a CubeField. The unit
/// is m. If the incident light has unit power, the squared modulus of the returned field is the cross section in m2.
/// Rows and columns refer to the axes of the source (docs/theory/polarisation.md, "Axes in files").
using DirectionField = std::vector<raytrace::JonesMatrix>;

/// Returns the Stokes parameters of the returned light for incident light with the Stokes parameters `incident`. Both
/// sets of parameters refer to the axes of the source.
raytrace::Stokes returned_stokes(const raytrace::JonesMatrix& jones, const raytrace::Stokes& incident);
/// Returns the sum of the Stokes parameters of all coherent groups.
raytrace::Stokes returned_stokes(const DirectionField& field, const raytrace::Stokes& incident);

/// Diffracted far field of one cube corner for one direction of incidence and one wavelength. Squared fields are cross
/// sections 4 pi R_I, where R_I is the intensity divided by the irradiance perpendicular to the beam.
class CubeField {
 public:
  CubeField() = default;
  /// \param beam_mm2 area of the incident beam, perpendicular to its direction
  CubeField(const raytrace::FarField& field, double wavelength_nm, double beam_mm2);

  /// Returns the fields in several directions.
  /// \param directions unit vectors in the part frame
  std::vector<DirectionField> at(std::span<const geometry::Vec3> directions) const;

  bool empty() const { return groups_.empty(); }
  /// Returns the angular width of the finest details, in rad, or infinity if there is no light.
  double detail_rad() const { return detail_rad_; }
  /// Returns the largest angle between the direction to the source and a returned beam, without diffraction. Weak beams
  /// are ignored.
  /// \param to_source unit vector in the part frame
  double deflection_rad(const geometry::Vec3& to_source) const;
  /// Returns the fraction of the incident power that is diffracted.
  double diffracted_power() const { return diffracted_power_; }
  /// Returns the fraction of the incident power in beams that return near the source but are too weak to be diffracted.
  double undiffracted_power() const { return undiffracted_power_; }
  /// Returns the area of the incident beam in mm2, perpendicular to its direction.
  double beam_mm2() const { return beam_mm2_; }

 private:
  /// Plane wave through a polygon of the entrance face.
  struct Wave {
    raytrace::field_lanes::Outline outline;
    geometry::Vec2 cosines;
    raytrace::JonesMatrix amplitude;
    double power = 0.0;  ///< fraction of the incident power
  };

  std::vector<std::vector<Wave>> groups_;
  double wavelength_mm_ = 0.0;
  double beam_mm2_ = 0.0;
  double detail_rad_ = 0.0;
  double diffracted_power_ = 0.0;
  double undiffracted_power_ = 0.0;
};

}  // namespace retrace::studies
