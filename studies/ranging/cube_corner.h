#pragma once

// Single cube corner, prepared for ranging. Computes its far field for any direction and wavelength, its symmetries,
// and the optical path to its apex.

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "core/warning.h"
#include "design/design.h"
#include "studies/ranging/cube_field.h"

namespace retrace::studies {

/// Returns the range correction of a cube corner. It is the increase of the measured one-way range because light
/// travels through the body to the apex. The reference point is on the entrance face, in front of the apex.
/// \param depth_mm distance of the apex from the entrance face
/// \param index refractive index at the wavelength of the light
/// \param group_index group index at this wavelength
/// \param sine sine of the angle of incidence
double range_correction_mm(double depth_mm, double index, double group_index, double sine);

/// Returns L sqrt(n_g^2 - sin^2 i), an approximation of range_correction_mm() that is common in satellite ranging. It
/// is exact at normal incidence, and for any incidence if the body has no dispersion.
double usual_range_correction_mm(double depth_mm, double group_index, double sine);

/// Optical data of the body at one wavelength.
struct CubeIndex {
  double wavelength_nm = 0.0;
  double index = 1.0;        ///< relative to the air around the part
  double group_index = 1.0;  ///< n - w dn/dw
};

/// Direction of light that a symmetry of the cube maps to another direction.
struct EquivalentLight {
  geometry::Vec3 to_source = geometry::Vec3::UnitZ();
  /// Orthogonal matrix that maps the other direction to `to_source`. It also maps results for the other direction to
  /// results for `to_source`. Its determinant may be -1.
  Eigen::Matrix3d map = Eigen::Matrix3d::Identity();
};

/// Single cube corner that is traced at several wavelengths.
class CubeCorner {
 public:
  /// \param wavelengths_nm wavelengths in vacuum, ascending; if empty, the wavelengths of the design
  /// \param entrance_reflections true: reflections at the entrance face are included
  /// \throw InputError if the design is not a single cube corner with a plane entrance face and smooth facets
  CubeCorner(design::Design design, const std::vector<double>& wavelengths_nm, bool entrance_reflections);

  const design::Design& design() const;
  const std::vector<CubeIndex>& indices() const;
  const Warnings& warnings() const;
  /// Returns the distance of the apex from the entrance face.
  double depth_mm() const;
  /// Returns the area of the entrance face.
  double entrance_mm2() const;

  /// Traces the light of one wavelength. Returns an empty field if the run was cancelled or no light returns.
  /// \param to_source unit vector in the part frame, with z > 0
  /// \param wavelength index into indices()
  CubeField field(const geometry::Vec3& to_source, std::size_t wavelength, const Cancellation* cancel) const;

  /// Returns the representative of a direction. All directions that a symmetry of the cube maps to each other have the
  /// same representative.
  EquivalentLight representative(const geometry::Vec3& to_source) const;

 private:
  struct Prepared;
  std::shared_ptr<const Prepared> prepared_;
};

}  // namespace retrace::studies
