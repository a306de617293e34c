#include "raytrace/sampling/replicate_means.h"

#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

/// Half-width, in standard deviations, of the interval that contains 95 % of a normal distribution.
constexpr double kNormal95 = 1.959964;

ConeResult cone_result(const std::vector<Tally>& replicates, double rays, double half_angle_deg, std::size_t cone) {
  const auto count = static_cast<double>(replicates.size());
  ConeResult result;
  result.half_angle_deg = half_angle_deg;
  std::vector<double> rre;
  for (const Tally& tally : replicates) {
    const Ledger ledger = tally.ledger(cone);
    rre.push_back(ledger[Account::retroreflected] / rays);
    result.stokes += 1.0 / (rays * count) * tally.retroreflected(cone);
    for (std::size_t k = 0; k < kAccountCount; ++k) result.ledger.power[k] += ledger.power[k] / rays / count;
  }
  result.rre = result.ledger[Account::retroreflected];
  result.stokes.i = result.rre;  // both are the same power; they may differ by rounding
  double squares = 0.0;
  for (const double r : rre) squares += (r - result.rre) * (r - result.rre);
  result.spread = std::sqrt(squares / (count - 1.0) / count);
  // Values below this limit are caused by rounding.
  if (result.spread < 1e-15) result.spread = 0.0;
  result.std_error = result.spread;
  return result;
}

/// Computes the means and standard errors of the scores.
void add_score(const std::vector<Tally>& replicates, double rays, MonteCarloResult& result) {
  const auto count = static_cast<double>(replicates.size());
  const std::size_t size = replicates.front().score.size();
  result.score.assign(size, 0.0);
  result.score_error.assign(size, 0.0);
  for (std::size_t k = 0; k < size; ++k) {
    for (const Tally& tally : replicates) result.score[k] += tally.score[k] / rays / count;
    double squares = 0.0;
    for (const Tally& tally : replicates) {
      const double off = tally.score[k] / rays - result.score[k];
      squares += off * off;
    }
    result.score_error[k] = std::sqrt(squares / (count - 1.0) / count);
  }
}

}  // namespace

MonteCarloResult result_of(const std::vector<Tally>& replicates, std::uint32_t rays_per_replicate,
                           const std::vector<double>& cones_deg) {
  MonteCarloResult result;
  result.rays = std::uint64_t{rays_per_replicate} * replicates.size();
  for (const Tally& tally : replicates) {
    result.segments += tally.segments;
    result.misses += tally.misses;
  }
  for (std::size_t cone = 0; cone < cones_deg.size(); ++cone)
    result.cones.push_back(cone_result(replicates, rays_per_replicate, cones_deg[cone], cone));
  add_score(replicates, rays_per_replicate, result);
  return result;
}

double with_unsampled_paths(double spread, double rays, double largest) {
  constexpr double kRuleOfThree = 3.0;
  return std::hypot(spread, kRuleOfThree / kNormal95 * largest / rays);
}

double student_factor(std::size_t replicates) {
  // Quantile of Student's t distribution (Abramowitz and Stegun, 26.7.5) divided by the normal quantile z.
  constexpr double z2 = kNormal95 * kNormal95;
  const double nu = static_cast<double>(replicates - 1);
  const double first = (z2 + 1.0) / 4.0;
  const double second = ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0;
  const double third = (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0;
  const double fourth = ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92160.0;
  return 1.0 + (first + (second + (third + fourth / nu) / nu) / nu) / nu;
}

double largest_error(const MonteCarloResult& result) {
  double largest = 0.0;
  for (const ConeResult& cone : result.cones) largest = std::max(largest, cone.std_error);
  return largest;
}

}  // namespace retrace::raytrace
