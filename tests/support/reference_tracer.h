#pragma once

#include <array>
#include <cstdint>

#include "geometry/part/closed_boundary.h"
#include "raytrace/light/ledger.h"
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

}  // namespace retrace::testing
