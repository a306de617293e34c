#pragma once

// Cubes of an array that are illuminated from one direction, and the sum of their returned light in any direction.

#include <span>
#include <vector>

#include "core/progress.h"
#include "raytrace/light/return_frame.h"
#include "studies/ranging/array_response.h"
#include "studies/ranging/cube_array.h"
#include "studies/ranging/cube_corner.h"

namespace retrace::studies {

/// Cubes of an array. All cubes have the same design, except for the errors of their dihedral angles.
struct CubeSet {
  std::vector<ArrayCube> cubes;
  std::vector<CubeCorner> variants;          ///< designs with different errors of the dihedral angles
  std::vector<std::size_t> variant_of_cube;  ///< index into `variants`, for each cube
};

/// Returns the frame of directions around the direction to the source. Its axes are defined in
/// docs/theory/polarisation.md. If the source is on the x axis, +y replaces +x in this definition.
raytrace::ReturnFrame return_frame_of(const geometry::Vec3& to_source);

/// Illuminated cubes at one wavelength, and their fields. If light reaches several cubes from equivalent directions in
/// their own frames, these cubes share a field.
class LitCubes {
 public:
  /// Traces the light. If the computation is cancelled, the result has no cubes.
  /// \param to_source unit vector in the frame of the array
  /// \param wavelength index into CubeCorner::indices()
  LitCubes(const CubeSet& set, const geometry::Vec3& to_source, std::size_t wavelength, const Cancellation* cancel);

  std::size_t count() const { return lit_.size(); }
  /// Returns the number of traces. Each trace belongs to one direction and one design.
  std::size_t traced() const { return fields_.size(); }
  const raytrace::ReturnFrame& frame() const { return frame_; }
  /// Returns the width of the finest details, or infinity if no light returns.
  double detail_rad() const;
  /// Returns the largest angle between the direction to the source and a returned beam, without diffraction.
  double deflection_rad() const;
  /// Returns the diffracted fraction of the light that is incident on all cubes.
  double diffracted_power() const;
  double undiffracted_power() const;
  /// Returns the cosines of the angles of incidence of all lit cubes.
  std::vector<double> cosines() const;

  /// Returns the Stokes parameters of the light of all cubes without interference, in m2.
  /// \param angles_rad directions as angles to the right and up from the direction to the source
  std::vector<raytrace::Stokes> stokes(std::span<const geometry::Vec2> angles_rad, const raytrace::Stokes& sent,
                                       const Cancellation* cancel) const;
  /// Returns the light of each lit cube towards one receiver.
  std::vector<CubeEcho> echoes(const geometry::Vec2& angles_rad, const raytrace::Stokes& sent) const;

 private:
  struct Lit {
    std::size_t cube = 0;
    std::size_t field = 0;  ///< index into fields_
    /// Rotation from the frame of the array to the frame of the traced cube. It may include a reflection.
    Eigen::Matrix3d traced_from_array = Eigen::Matrix3d::Identity();
    Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();  ///< maps the axes of the array to the axes of the traced light
    double range_mm = 0.0;
  };
  /// Cubes with the same field and the same orientation.
  struct EqualCubes {
    std::size_t lit = 0;  ///< index of the first of them in lit_
    double count = 1.0;
  };
  struct Traced {
    std::size_t variant = 0;
    geometry::Vec3 to_source;
    CubeField field;
  };
  void find_equal_cubes();
  /// Returns the mean of a fraction of power over the light that is incident on all cubes.
  double mean_of(double (CubeField::*fraction)() const) const;
  std::vector<DirectionField> fields_of(const Lit& lit, std::span<const geometry::Vec3> directions) const;

  raytrace::ReturnFrame frame_;
  std::vector<Lit> lit_;
  std::vector<EqualCubes> equal_cubes_;
  std::vector<Traced> fields_;
};

}  // namespace retrace::studies
