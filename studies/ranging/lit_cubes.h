#pragma once

// Cubes of an array that are illuminated from one direction, and the light that they return together in any direction.

#include <span>
#include <vector>

#include "core/progress.h"
#include "raytrace/light/return_frame.h"
#include "studies/ranging/array_response.h"
#include "studies/ranging/cube_array.h"
#include "studies/ranging/cube_corner.h"

namespace retrace::studies {

/// Cubes of an array. All cubes have the same design, but the errors of their dihedral angles may differ.
struct CubeSet {
  std::vector<ArrayCube> cubes;
  std::vector<CubeCorner> variants;          ///< design with each different set of dihedral angle errors
  std::vector<std::size_t> variant_of_cube;  ///< index into `variants` for each cube
};

/// Returns the axes for angles to the right and up from the direction to the source (docs/theory/polarisation.md). If
/// the source is on the x axis, the reference axis is +y instead of +x.
raytrace::ReturnFrame return_frame_of(const geometry::Vec3& to_source);

/// Illuminated cubes of an array at one wavelength, and the fields that they return. Several cubes share one field if
/// their directions of light are equivalent in the part frames of the cubes.
class LitCubes {
 public:
  /// Traces the light. If the computation is cancelled, the object contains no cubes.
  /// \param to_source unit vector in the frame of the array
  /// \param wavelength index into CubeCorner::indices()
  LitCubes(const CubeSet& set, const geometry::Vec3& to_source, std::size_t wavelength, const Cancellation* cancel);

  std::size_t count() const { return lit_.size(); }
  /// Returns the number of traces. Each different design and direction of light in the part frame is traced one time.
  std::size_t traced() const { return fields_.size(); }
  const raytrace::ReturnFrame& frame() const { return frame_; }
  /// Returns the angular width of the finest details of the far field, or infinity if no light returns.
  double detail_rad() const;
  /// Returns the largest angle between the direction to the source and the direction of a returned beam. Diffraction is
  /// ignored.
  double deflection_rad() const;
  /// Returns the power whose diffraction is included, as a fraction of the power that is incident on all cubes.
  double diffracted_power() const;
  double undiffracted_power() const;
  /// Returns the cosine of the angle of incidence for each illuminated cube.
  std::vector<double> cosines() const;

  /// Returns the Stokes parameters of the light of all cubes in several directions, in m2. Interference between cubes
  /// is ignored.
  /// \param angles_rad angles to the right and up from the direction to the source
  std::vector<raytrace::Stokes> stokes(std::span<const geometry::Vec2> angles_rad, const raytrace::Stokes& sent,
                                       const Cancellation* cancel) const;
  /// Returns the light that each illuminated cube returns towards one receiver.
  std::vector<CubeEcho> echoes(const geometry::Vec2& angles_rad, const raytrace::Stokes& sent) const;

 private:
  struct Lit {
    std::size_t cube = 0;
    std::size_t field = 0;  ///< index into `fields_`
    /// Maps the frame of the array to the part frame in which `field` was traced. It is a rotation, or a rotation and a
    /// reflection.
    Eigen::Matrix3d traced_from_array = Eigen::Matrix3d::Identity();
    /// maps components along the axes of the array to components along the axes of the traced light
    Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();
    double range_mm = 0.0;
  };
  /// Illuminated cubes whose returned light is equal, because their field and their orientation are equal.
  struct EqualCubes {
    std::size_t lit = 0;  ///< index of the first of these cubes in `lit_`
    double count = 1.0;
  };
  struct Traced {
    std::size_t variant = 0;
    geometry::Vec3 to_source;
    CubeField field;
  };
  void find_equal_cubes();
  /// Returns the mean of a fraction of power, such as CubeField::diffracted_power(), over the light that is incident on
  /// all cubes.
  double mean_of(double (CubeField::*fraction)() const) const;
  std::vector<DirectionField> fields_of(const Lit& lit, std::span<const geometry::Vec3> directions) const;

  raytrace::ReturnFrame frame_;
  std::vector<Lit> lit_;
  std::vector<EqualCubes> equal_cubes_;
  std::vector<Traced> fields_;
};

}  // namespace retrace::studies
