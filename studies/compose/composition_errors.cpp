#include "studies/compose/composition_errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "studies/compose/cell_errors.h"
#include "studies/compose/error_response.h"
#include "studies/compose/part_yield.h"
#include "studies/optimise/evaluator.h"
#include "studies/sweep/sampling.h"

namespace retrace::studies {
namespace {

/// A step, in standard deviations, at which second differences have the mean over a Gaussian right to the fifth degree.
const double kStepOfSpread = std::sqrt(3.0);
/// A step where there is no spread, in minutes of arc.
constexpr double kLeastStep = 0.1;
/// Sets of errors, of each zone, at which the polynomials are held against goals that are computed.
constexpr std::size_t kChecked = 2;

/// The largest error that is looked at.
double step_of(const ErrorSpread& spread) {
  return std::max(kLeastStep, kStepOfSpread * std::max(spread.cell_sigma_arcmin, spread.zone_sigma_arcmin));
}

/// Errors of up to a step.
std::vector<std::vector<double>> errors_to_check(std::size_t angles, double step_arcmin, std::uint32_t seed) {
  const UnitSamples samples(UnitSamples::Kind::sobol, angles, kChecked, seed);
  std::vector<std::vector<double>> errors;
  for (std::size_t k = 0; k < kChecked; ++k) {
    errors.push_back(samples.at(k));
    for (double& error : errors.back()) error = step_arcmin * (2.0 * error - 1.0);
  }
  return errors;
}

/// A response, and by how much it misses goals that are computed.
struct CheckedResponse {
  ErrorResponse response;
  double missed_by = 0.0;
};

CheckedResponse response_of(const Study& study, const ComposeRequest& request, const FamilyCell& cell,
                            const Cancellation* cancel) {
  const double step_arcmin = step_of(*request.errors);
  const std::size_t angles = angles_of(study, cell.values);
  std::vector<std::vector<double>> errors = ErrorResponse::errors_to_compute(angles, step_arcmin);
  const std::vector<std::vector<double>> checks = errors_to_check(angles, step_arcmin, study.seed);
  errors.insert(errors.end(), checks.begin(), checks.end());
  std::vector<std::vector<double>> goals = goals_with_errors(study, request, cell, errors, cancel);
  const std::vector<std::vector<double>> checked(goals.end() - std::ssize(checks), goals.end());
  goals.resize(goals.size() - checks.size());
  CheckedResponse made{{angles, step_arcmin, goals}};
  for (std::size_t k = 0; k < checks.size(); ++k) {
    const std::vector<double> told = made.response.at(checks[k]);
    for (std::size_t g = 0; g < told.size(); ++g)
      made.missed_by = std::max(made.missed_by, std::abs(told[g] - checked[k][g]));
  }
  return made;
}

/// Goals of the part with what spreads from cell to cell.
std::vector<double> mean_goals(const std::vector<ErrorResponse>& responses, const std::vector<double>& shares) {
  std::vector<double> goals;
  for (std::size_t z = 0; z < responses.size(); ++z) {
    const std::vector<double> of_zone = responses[z].at(std::vector<double>(responses[z].angles(), 0.0));
    goals.resize(of_zone.size(), 0.0);
    for (std::size_t g = 0; g < goals.size(); ++g) goals[g] += shares[z] * of_zone[g];
  }
  return goals;
}

/// By the prices of the goals: what remains when the shares follow.
std::vector<std::vector<double>> slopes_of(const std::vector<ErrorResponse>& responses, const PartOfZones& part) {
  std::vector<std::vector<double>> slopes;
  for (std::size_t z = 0; z < responses.size(); ++z) {
    slopes.emplace_back(responses[z].angles(), 0.0);
    for (std::size_t angle = 0; angle < responses[z].angles(); ++angle)
      for (std::size_t g = 0; g < part.mixture.goals.size(); ++g)
        slopes[z][angle] += part.zones[z].share * part.mixture.prices.goals[g] * responses[z].slope(angle, g);
  }
  return slopes;
}

PartYield yield_of(const DrawnParts& parts, const ComposeRequest& request, const std::vector<double>& shares) {
  PartYield yield;
  yield.leasts = leasts_of(parts, shares);
  std::ranges::sort(yield.leasts);
  if (request.least_goal)
    yield.good = static_cast<std::size_t>(
        std::ranges::count_if(yield.leasts, [&](double least) { return least >= *request.least_goal; }));
  if (request.errors->worst_share) yield.mean_of_worst = mean_of_worst(yield.leasts, *request.errors->worst_share);
  return yield;
}

}  // namespace

ErrorEffects effects_of_errors(const Study& study, const ComposeRequest& request, const PartOfZones& part,
                               OptimiseObserver* observer, const Cancellation* cancel) {
  const ErrorSpread& spread = *request.errors;
  ErrorEffects effects;
  std::vector<ErrorResponse> responses;
  std::vector<double> shares;
  for (const Zone& zone : part.zones) {
    const CheckedResponse made = response_of(study, request, zone.cell, cancel);
    responses.push_back(made.response.spread(spread.cell_sigma_arcmin));
    effects.missed_by += zone.share * made.missed_by;
    shares.push_back(zone.share);
    if (observer != nullptr) observer->at(responses.size());
  }
  effects.goals = mean_goals(responses, shares);
  effects.slopes = slopes_of(responses, part);
  const DrawnParts parts = drawn_parts(responses, spread.zone_sigma_arcmin, spread.parts, study.seed);
  effects.yield = yield_of(parts, request, shares);
  if (!spread.worst_share) return effects;
  const auto for_worst = best_shares(parts, *spread.worst_share, {request.least_share, request.most_share}, cancel);
  if (!for_worst) throw Interrupted{};
  effects.for_worst = SharesForWorst{*for_worst, yield_of(parts, request, *for_worst)};
  return effects;
}

}  // namespace retrace::studies
