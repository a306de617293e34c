#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/part/closed_boundary.h"
#include "raytrace/light/ledger.h"
#include "raytrace/light/light.h"
#include "raytrace/light/optics.h"

// Slow reference tracer, which is independent of the tracers of the program.

namespace retrace::testing {

struct ReferenceResult {
  raytrace::Ledger mean;
  std::array<double, raytrace::kAccountCount> std_error{};
  std::array<double, 4> stokes{};  ///< Stokes parameters of the retroreflected light, like raytrace::Stokes
  std::array<double, 4> stokes_error{};
};

/// Treatment of polarisation: light keeps its polarisation, or it is unpolarised after every interface. The second
/// option averages the reflectances of s and p, which is wrong; tests show the difference.
enum class Polarisation { kept, averaged };

/// Traces light with an independent engine for small finite parts. It traces plain random rays against all triangles of
/// the closed boundary in double precision, with complex field vectors in space, and follows every branch. It shares
/// only the boundary and the names of the accounts (energy terms) with the tracers of the program. It is slow on
/// purpose.
ReferenceResult reference_trace(const geometry::Part& part, const raytrace::Optics& optics,
                                const raytrace::Illumination& illumination, double cone_half_angle_deg,
                                std::uint64_t rays, std::uint64_t seed, Polarisation polarisation = Polarisation::kept);

/// A ray that leaves the part and does not return, at its last point on the part.
struct ReferenceExit {
  raytrace::Account account = raytrace::Account::retroreflected;
  Eigen::Vector3d position_mm;
  Eigen::Vector3d direction;
  Eigen::Matrix3cd coherency;  ///< coherency matrix of the field in space; its trace is the power

  double power() const { return coherency.trace().real(); }
  /// Returns the Stokes parameters, like those of raytrace::Light.
  /// \param axis reference axis, perpendicular to the direction of the ray
  std::array<double, 4> stokes(const Eigen::Vector3d& axis) const;
};

/// Result for one ray from any position. All branches down to 1e-5 of its power are followed.
struct ReferenceRay {
  bool meets = false;  ///< true if the ray meets the part
  raytrace::Ledger ledger;
  std::vector<ReferenceExit> exits;
};

/// Traces one ray with the engine of reference_trace().
/// \param light polarisation of the ray, with power 1
/// \param inside true if the ray begins inside the part
ReferenceRay reference_ray(const geometry::Part& part, const raytrace::Optics& optics, const Eigen::Vector3d& origin_mm,
                           const Eigen::Vector3d& direction, const raytrace::Light& light, bool inside,
                           double cone_half_angle_deg);

}  // namespace retrace::testing
