#include "studies/ranging/array_response.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "core/angle.h"
#include "core/random.h"
#include "core/threads.h"
#include "studies/ranging/aberration.h"

namespace retrace::studies {
namespace {

// One-way range that corresponds to 1 ps of round-trip time, which is half of the distance that light travels in 1 ps.
constexpr double kOneWayMmPerPs = 0.5 * kLightMmPerPs;
// Margin of the response in front of the first cube and behind the last cube, in standard deviations of the pulse.
constexpr double kResponseMargin = 5.0;
// Distance between neighbouring points of the response, in standard deviations of the pulse.
constexpr double kResponseStep = 0.2;
// Maximum number of points of a response. It limits the size of the result for short pulses.
constexpr double kMaxResponsePoints = 4000.0;
constexpr std::uint32_t kPhaseStream = 66;

/// Complex amplitudes of the light that a cube returns along the two axes of the source. The unit is m; the squared
/// norm is a cross section.
using Amplitude = Eigen::Vector2cd;

/// Returned light of all cubes. The strongest coherent group of each cube interferes with other cubes, and all
/// remaining groups only add power.
struct Emitters {
  /// strongest coherent group of each cube, for both states of pure_states()
  std::vector<std::array<Amplitude, 2>> amplitudes;
  std::vector<double> range_mm;
  double other_m2 = 0.0;      ///< cross section of all remaining coherent groups
  double other_moment = 0.0;  ///< sum of cross section times range over the remaining groups
};

double power_of(const std::array<Amplitude, 2>& amplitudes) {
  return amplitudes[0].squaredNorm() + amplitudes[1].squaredNorm();
}

Emitters emitters_of(const std::vector<CubeEcho>& echoes, const raytrace::Stokes& sent) {
  const std::array<Amplitude, 2> states = pure_states(sent);
  Emitters all;
  for (const CubeEcho& echo : echoes) {
    std::array<Amplitude, 2> strongest = {Amplitude::Zero(), Amplitude::Zero()};
    double sum = 0.0;
    for (const raytrace::JonesMatrix& jones : echo.field) {
      const std::array<Amplitude, 2> one = {jones * states[0], jones * states[1]};
      sum += power_of(one);
      if (power_of(one) > power_of(strongest)) strongest = one;
    }
    all.amplitudes.push_back(strongest);
    all.range_mm.push_back(echo.range_mm);
    const double other = std::max(0.0, sum - power_of(strongest));
    all.other_m2 += other;
    all.other_moment += other * echo.range_mm;
  }
  return all;
}

std::vector<std::complex<double>> random_phases(std::size_t count, std::uint32_t seed, std::size_t shot) {
  std::vector<std::complex<double>> phases;
  for (std::size_t k = 0; k < count; ++k) {
    const auto words =
        philox({seed, kPhaseStream}, static_cast<std::uint32_t>(shot), static_cast<std::uint32_t>(k / 4));
    phases.push_back(std::polar(1.0, kTwoPi * unit_interval(words[k % 4])));
  }
  return phases;
}

/// Returns the overlap of the fields of two pulses. It is 1 if both pulses arrive at the same time, and decreases to 0
/// with the difference of their ranges.
/// \param sigma_mm standard deviation of the pulse power, in mm of one-way range
double overlap(double range_difference_mm, double sigma_mm) {
  return std::exp(-range_difference_mm * range_difference_mm / (8.0 * sigma_mm * sigma_mm));
}

/// Returns one simulated measurement (shot) with continuous light. Continuous light has no arrival time. The range of
/// the shot is therefore the centroid of the ranges of all cubes, weighted by their cross sections.
Shot continuous_shot(const Emitters& all, const std::vector<std::complex<double>>& phases, double centroid_mm) {
  std::array<Amplitude, 2> sums = {Amplitude::Zero(), Amplitude::Zero()};
  for (std::size_t k = 0; k < all.amplitudes.size(); ++k)
    for (std::size_t state = 0; state < 2; ++state) sums[state] += phases[k] * all.amplitudes[k][state];
  return {power_of(sums) + all.other_m2, centroid_mm};
}

Shot pulsed_shot(const Emitters& all, const std::vector<std::complex<double>>& phases,
                 const Eigen::ArrayXXd& overlaps) {
  double power = all.other_m2;
  double moment = all.other_moment;
  for (std::size_t j = 0; j < all.amplitudes.size(); ++j)
    for (std::size_t k = 0; k <= j; ++k) {
      const double share = overlaps(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k));
      if (share == 0.0) continue;
      std::complex<double> product = 0.0;
      for (std::size_t state = 0; state < 2; ++state) product += all.amplitudes[k][state].dot(all.amplitudes[j][state]);
      const double both = (j == k ? 1.0 : 2.0) * share * (product * phases[j] * std::conj(phases[k])).real();
      power += both;
      moment += 0.5 * both * (all.range_mm[j] + all.range_mm[k]);
    }
  return {power, power > 0.0 ? moment / power : 0.0};
}

}  // namespace

std::array<Eigen::Vector2cd, 2> pure_states(const raytrace::Stokes& sent) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2cd> solver(raytrace::coherency_of_source(sent));
  std::array<Eigen::Vector2cd, 2> states;
  for (int k = 0; k < 2; ++k)
    states[static_cast<std::size_t>(k)] =
        std::sqrt(std::max(0.0, solver.eigenvalues()[k])) * solver.eigenvectors().col(k);
  return states;
}

RangeDistribution distribution_of(const std::vector<CubeEcho>& echoes) {
  RangeDistribution all;
  all.nearest_mm = std::numeric_limits<double>::infinity();
  all.farthest_mm = -all.nearest_mm;
  double moment = 0.0;
  for (const CubeEcho& echo : echoes) {
    all.cross_section_m2 += echo.cross_section_m2;
    moment += echo.cross_section_m2 * echo.range_mm;
    if (!(echo.cross_section_m2 > 0.0)) continue;
    all.nearest_mm = std::min(all.nearest_mm, echo.range_mm);
    all.farthest_mm = std::max(all.farthest_mm, echo.range_mm);
  }
  if (!(all.cross_section_m2 > 0.0)) return {};
  all.centroid_mm = moment / all.cross_section_m2;
  double squares = 0.0;
  for (const CubeEcho& echo : echoes) squares += echo.cross_section_m2 * std::pow(echo.range_mm - all.centroid_mm, 2.0);
  all.rms_mm = std::sqrt(squares / all.cross_section_m2);
  return all;
}

double pulse_sigma_mm(double pulse_ps) {
  return kOneWayMmPerPs * pulse_ps / (2.0 * std::sqrt(2.0 * std::numbers::ln2));
}

PulseResponse response_of(const std::vector<CubeEcho>& echoes, double pulse_ps) {
  PulseResponse response;
  const RangeDistribution all = distribution_of(echoes);
  if (!(all.cross_section_m2 > 0.0)) return response;
  const double sigma = pulse_sigma_mm(pulse_ps);
  const double low = all.nearest_mm - kResponseMargin * sigma;
  const double length = all.farthest_mm + kResponseMargin * sigma - low;
  const double steps = std::min(std::ceil(length / (kResponseStep * sigma)), kMaxResponsePoints);
  for (int k = 0; k <= static_cast<int>(steps); ++k) {
    const double range = low + length * k / steps;
    double sum = 0.0;
    for (const CubeEcho& echo : echoes)
      sum += echo.cross_section_m2 * std::exp(-0.5 * std::pow((range - echo.range_mm) / sigma, 2.0));
    response.range_mm.push_back(range);
    response.per_mm.push_back(sum / (sigma * std::sqrt(kTwoPi)));
  }
  return response;
}

std::vector<Shot> simulated_shots(const std::vector<CubeEcho>& echoes, const ShotSettings& settings,
                                  const Cancellation* cancel) {
  const Emitters all = emitters_of(echoes, settings.sent);
  const auto count = static_cast<Eigen::Index>(all.amplitudes.size());
  Eigen::ArrayXXd overlaps;
  if (settings.pulse_ps) {
    const double sigma = pulse_sigma_mm(*settings.pulse_ps);
    overlaps.resize(count, count);
    for (Eigen::Index j = 0; j < count; ++j)
      for (Eigen::Index k = 0; k < count; ++k)
        overlaps(j, k) =
            overlap(all.range_mm[static_cast<std::size_t>(j)] - all.range_mm[static_cast<std::size_t>(k)], sigma);
  }
  const double centroid_mm = distribution_of(echoes).centroid_mm;
  std::vector<Shot> shots(settings.count);
  for_each_in_parallel(settings.count, [&](std::size_t shot) {
    if (is_cancelled(cancel)) return;
    const std::vector<std::complex<double>> phases = random_phases(all.amplitudes.size(), settings.seed, shot);
    shots[shot] = settings.pulse_ps ? pulsed_shot(all, phases, overlaps) : continuous_shot(all, phases, centroid_mm);
  });
  if (is_cancelled(cancel)) shots.clear();
  return shots;
}

}  // namespace retrace::studies
