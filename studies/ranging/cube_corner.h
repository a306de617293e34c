#pragma once

// Single cube corner, prepared for ranging: its far field for any direction and wavelength, its symmetries, and its
// range correction.

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

/// Returns the range correction of a cube corner. It is the measured one-way range minus the one-way range of the
/// reference point. The reference point is on the entrance face, in front of the apex.
/// \param depth_mm distance of the apex from the entrance face
/// \param index refractive index at the wavelength of the light
/// \param group_index group index at the wavelength of the light
/// \param sine sine of the angle of incidence
double range_correction_mm(double depth_mm, double index, double group_index, double sine);

/// Returns L sqrt(n_g^2 - sin^2 i), the approximation of range_correction_mm() that is usual in satellite ranging. It
/// is exact at normal incidence. Without dispersion, it is exact at any incidence.
double usual_range_correction_mm(double depth_mm, double group_index, double sine);

/// Optical data of the body at one wavelength.
struct CubeIndex {
  double wavelength_nm = 0.0;
  double index = 1.0;        ///< refractive index relative to the air around the part
  double group_index = 1.0;  ///< group index n - w dn/dw, where w is the vacuum wavelength
};

/// Direction of light that is equivalent to a given direction, because a symmetry of the cube maps one direction to the
/// other.
struct EquivalentLight {
  geometry::Vec3 to_source = geometry::Vec3::UnitZ();
  /// Orthogonal matrix that maps the given direction to `to_source`, and the returned light to the equivalent returned
  /// light. Its determinant is -1 if the symmetry is a reflection.
  Eigen::Matrix3d map = Eigen::Matrix3d::Identity();
};

/// Single cube corner, prepared for several wavelengths.
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

  /// Traces light of one wavelength. Returns an empty field if the computation is cancelled or if no light returns.
  /// \param to_source unit vector in the part frame, with z > 0
  /// \param wavelength index into indices()
  CubeField field(const geometry::Vec3& to_source, std::size_t wavelength, const Cancellation* cancel) const;

  /// Returns the representative of a direction. All directions that are equivalent under a symmetry of the cube have
  /// the same representative, so their light is traced only one time.
  EquivalentLight representative(const geometry::Vec3& to_source) const;

 private:
  struct Prepared;
  std::shared_ptr<const Prepared> prepared_;
};

}  // namespace retrace::studies
