#pragma once

// Far field of the light that one cube corner returns, in the form of complex Jones matrices. The fields of several
// cubes can be added with or without interference, and for any polarisation of the incident light.

#include <complex>
#include <span>
#include <vector>

#include "raytrace/light/coherent_light.h"
#include "raytrace/light/stokes.h"
#include "raytrace/observers/far_field.h"
#include "raytrace/observers/field_lanes.h"

namespace retrace::studies {

/// Jones matrices of the light that returns in one direction, one matrix for each coherent group of the far field. The
/// unit is m: for incident light of unit power, the squared modulus of the returned field is a cross section in m2.
/// Rows and columns refer to the axes of the source (docs/theory/polarisation.md, "Axes in files").
using DirectionField = std::vector<raytrace::JonesMatrix>;

/// Returns the Stokes parameters of the returned light, in m2. `incident` contains the Stokes parameters of the
/// incident light. Both refer to the axes of the source.
raytrace::Stokes returned_stokes(const raytrace::JonesMatrix& jones, const raytrace::Stokes& incident);
/// Returns the Stokes parameters of the returned light, as the sum over all coherent groups.
raytrace::Stokes returned_stokes(const DirectionField& field, const raytrace::Stokes& incident);

/// Far field of one cube corner for one direction of incidence and one wavelength, including diffraction. A squared
/// field is the cross section 4 pi R_I, where R_I is the intensity divided by the irradiance perpendicular to the beam.
class CubeField {
 public:
  CubeField() = default;
  /// \param beam_mm2 cross-sectional area of the light that is incident on the entrance face
  CubeField(const raytrace::FarField& field, double wavelength_nm, double beam_mm2);

  /// Returns the fields in the given directions.
  /// \param directions unit vectors in the part frame
  std::vector<DirectionField> at(std::span<const geometry::Vec3> directions) const;

  bool empty() const { return groups_.empty(); }
  /// Returns the angular width of the finest details of the far field, in rad, or infinity if no light returns.
  double detail_rad() const { return detail_rad_; }
  /// Returns the largest angle between the direction to the source and the direction of a returned beam. Diffraction
  /// and weak beams are ignored.
  /// \param to_source unit vector in the part frame
  double deflection_rad(const geometry::Vec3& to_source) const;
  /// Returns the power of all returned beams whose diffraction is included, as a fraction of the incident power.
  double diffracted_power() const { return diffracted_power_; }
  /// Returns the power of beams that return near the source but are too weak for a computation of their diffraction. It
  /// is a fraction of the incident power.
  double undiffracted_power() const { return undiffracted_power_; }
  /// Returns the cross-sectional area of the incident light in mm2, perpendicular to its direction.
  double beam_mm2() const { return beam_mm2_; }

 private:
  /// Plane wave that leaves through a polygon of the entrance face.
  struct Wave {
    raytrace::field_lanes::Outline outline;
    geometry::Vec2 cosines;
    raytrace::JonesMatrix amplitude;
    double power = 0.0;  ///< power of the wave, as a fraction of the incident power
  };

  std::vector<std::vector<Wave>> groups_;
  double wavelength_mm_ = 0.0;
  double beam_mm2_ = 0.0;
  double detail_rad_ = 0.0;
  double diffracted_power_ = 0.0;
  double undiffracted_power_ = 0.0;
};

}  // namespace retrace::studies
