#pragma once

// Distribution of the ranges of the cubes of an array, response to a pulse, and single shots in which the light of the
// cubes interferes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "raytrace/light/stokes.h"
#include "studies/ranging/cube_field.h"

namespace retrace::studies {

/// Light that one cube of an array returns towards the receiver. The name follows the radar term echo.
struct CubeEcho {
  std::size_t cube = 0;   ///< index of the cube in the array
  double range_mm = 0.0;  ///< one-way range relative to the origin of the array; negative if the cube is nearer
  double cross_section_m2 = 0.0;
  /// Field of each coherent group, along the axes of the source in the frame of the array.
  DirectionField field = {};
};

/// Centroid and spread of the ranges of all cubes. Each cube is weighted with its cross section.
struct RangeDistribution {
  double cross_section_m2 = 0.0;  ///< sum of the cross sections of all cubes
  /// mean range relative to the origin of the array; negative if nearer than the origin
  double centroid_mm = 0.0;
  double rms_mm = 0.0;      ///< standard deviation of the ranges
  double nearest_mm = 0.0;  ///< smallest range of the cubes that return light
  double farthest_mm = 0.0;

  /// Returns true if at least one cube returns light. Otherwise, the ranges are undefined.
  bool has_light() const { return cross_section_m2 > 0.0; }
};
RangeDistribution distribution_of(const std::vector<CubeEcho>& echoes);

/// Returns the standard deviation of the power of a Gaussian pulse, in mm of one-way range.
/// \param pulse_ps full width at half maximum of the pulse power, in ps
double pulse_sigma_mm(double pulse_ps);

/// Response of an array to a pulse, averaged over many shots. It gives the cross section per mm of one-way range.
struct PulseResponse {
  std::vector<double> range_mm;
  /// cross section per mm of range, in m2 per mm; its integral is the cross section of the array
  std::vector<double> per_mm;
};
PulseResponse response_of(const std::vector<CubeEcho>& echoes, double pulse_ps);

/// Cross section and centroid of the power that is received in one shot. Both include the interference between cubes.
struct Shot {
  double cross_section_m2 = 0.0;
  double centroid_mm = 0.0;
};
/// Settings of simulated_shots().
struct ShotSettings {
  std::size_t count = 0;
  raytrace::Stokes sent = raytrace::kUnpolarised;
  /// full width at half maximum; empty: continuous light, for which all cubes interfere
  std::optional<double> pulse_ps;
  std::uint32_t seed = 1;
};
/// Simulates single shots. In each shot, every cube has an independent random phase. The strongest coherent groups of
/// all cubes interfere, and their interference is weighted with the overlap of their pulses. The power of all remaining
/// groups is added. If the computation is cancelled, the result contains fewer shots.
std::vector<Shot> simulated_shots(const std::vector<CubeEcho>& echoes, const ShotSettings& settings,
                                  const Cancellation* cancel);

/// Decomposes light into two fully polarised states whose incoherent sum is the given light. Each state consists of its
/// two amplitudes along the axes of the source, whose squares add up to its power.
std::array<Eigen::Vector2cd, 2> pure_states(const raytrace::Stokes& sent);

}  // namespace retrace::studies
