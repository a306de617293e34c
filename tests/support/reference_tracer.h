#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/part/closed_boundary.h"
#include "raytrace/light/ledger.h"
#include "raytrace/light/light.h"
#include "raytrace/light/optics.h"

namespace retrace::testing {

struct ReferenceResult {
  raytrace::Ledger mean;
  std::array<double, raytrace::kAccountCount> std_error{};
  std::array<double, 4> stokes{};  ///< of what is retroreflected, as raytrace::Stokes
  std::array<double, 4> stokes_error{};
};

/// Whether light keeps its polarisation, or every interface sends on unpolarised light: the scalar average of the
/// reflectances of s and p, which is wrong.
enum class Polarisation { kept, averaged };

/// An independent engine for small finite parts: plain random rays against every triangle of the closed boundary in
/// double precision, with complex field vectors in space and every branch followed. Shares with the program's tracer
/// nothing but the boundary and the account names. Slow on purpose.
ReferenceResult reference_trace(const geometry::Part& part, const raytrace::Optics& optics,
                                const raytrace::Illumination& illumination, double cone_half_angle_deg,
                                std::uint64_t rays, std::uint64_t seed, Polarisation polarisation = Polarisation::kept);

/// A ray that leaves the part for good, from where it was last.
struct ReferenceExit {
  raytrace::Account account = raytrace::Account::retroreflected;
  Eigen::Vector3d position_mm;
  Eigen::Vector3d direction;
  Eigen::Matrix3cd coherency;  ///< of its field in space; its trace is the power

  double power() const { return coherency.trace().real(); }
  /// Stokes parameters along an axis across the direction, as those of raytrace::Light.
  std::array<double, 4> stokes(const Eigen::Vector3d& axis) const;
};

/// What becomes of one ray from anywhere, all branches to 1e-5 of its power.
struct ReferenceRay {
  bool meets = false;  ///< the part
  raytrace::Ledger ledger;
  std::vector<ReferenceExit> exits;
};

/// By the same engine. \param light of power 1 \param inside it begins in the part
ReferenceRay reference_ray(const geometry::Part& part, const raytrace::Optics& optics, const Eigen::Vector3d& origin_mm,
                           const Eigen::Vector3d& direction, const raytrace::Light& light, bool inside,
                           double cone_half_angle_deg);

}  // namespace retrace::testing
