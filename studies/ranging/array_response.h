#pragma once

// Distribution of the range over the cubes of an array. Computes the response to a pulse, and single shots in which the
// fields of the cubes interfere.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "raytrace/light/stokes.h"
#include "studies/ranging/cube_field.h"

namespace retrace::studies {

/// Light that one cube of an array returns towards the receiver.
struct CubeEcho {
  std::size_t cube = 0;   ///< index of the cube
  double range_mm = 0.0;  ///< one-way range, relative to the origin of the array
  double cross_section_m2 = 0.0;
  /// Fields of the coherent groups, along the axes of the source in the frame of the array.
  DirectionField field = {};
};

/// Centroid and spread of the ranges of all cubes, weighted with their cross sections.
struct RangeDistribution {
  double cross_section_m2 = 0.0;  ///< sum over all cubes
  double centroid_mm = 0.0;       ///< mean range relative to the origin; negative if nearer than the origin
  double rms_mm = 0.0;            ///< standard deviation of the ranges
  double nearest_mm = 0.0;        ///< range of the nearest cube that returns light
  double farthest_mm = 0.0;

  /// Returns true if at least one cube returns light, so that the ranges are defined.
  bool has_light() const { return cross_section_m2 > 0.0; }
};
RangeDistribution distribution_of(const std::vector<CubeEcho>& echoes);

/// Returns the standard deviation of a Gaussian pulse, in mm of one-way range.
/// \param pulse_ps full width at half maximum of the power
double pulse_sigma_mm(double pulse_ps);

/// Response of an array to a pulse, averaged over shots: cross section per mm of one-way range.
struct PulseResponse {
  std::vector<double> range_mm;
  std::vector<double> per_mm;  ///< in m2 per mm; its integral is the cross section of the array
};
PulseResponse response_of(const std::vector<CubeEcho>& echoes, double pulse_ps);

/// Cross section and centroid of the received power for one shot. Both include the interference between cubes.
struct Shot {
  double cross_section_m2 = 0.0;
  double centroid_mm = 0.0;
};
/// Settings of single shots.
struct ShotSettings {
  std::size_t count = 0;
  raytrace::Stokes sent = raytrace::kUnpolarised;
  std::optional<double> pulse_ps;  ///< empty: continuous light, with which all cubes interfere
  std::uint32_t seed = 1;
};
/// Simulates single shots. In each shot, every cube has an independent random phase. The strongest coherent groups of
/// all cubes interfere as far as their pulses overlap. The power of all other groups is added. Returns fewer shots if
/// the computation was cancelled.
std::vector<Shot> simulated_shots(const std::vector<CubeEcho>& echoes, const ShotSettings& settings,
                                  const Cancellation* cancel);

/// Decomposes light into two fully polarised states whose incoherent sum is the given light. Each state is given by its
/// amplitudes along the axes of the source. Their squares add up to the power of the state.
std::array<Eigen::Vector2cd, 2> pure_states(const raytrace::Stokes& sent);

}  // namespace retrace::studies
