#include "studies/compose/composition_errors.h"

#include <algorithm>
#include <cmath>

#include "compute/sampling/unit_samples.h"
#include "studies/compose/cell_errors.h"
#include "studies/compose/error_response.h"
#include "studies/compose/part_yield.h"
#include "studies/optimise/evaluator.h"

namespace retrace::studies {
namespace {

/// Step of second differences, in standard deviations. With this step, the mean over a Gaussian distribution is exact
/// for polynomials up to the fifth degree.
const double kStepOfSpread = std::sqrt(3.0);
/// Minimum step, in minutes of arc, used if the errors have no spread.
constexpr double kMinStepArcmin = 0.1;
/// Number of random sets of errors per zone at which the polynomials are compared with computed goals.
constexpr std::size_t kChecked = 2;
/// Maximum number of cells that are candidates for the composition optimized for the worst random parts. The number is
/// small because all sets of candidates are tried.
constexpr std::size_t kMaxCells = 8;

/// Returns the largest angle error, in minutes of arc, for which goals are computed.
double step_of(const ErrorSpread& spread) {
  return std::max(kMinStepArcmin, kStepOfSpread * std::max(spread.cell_sigma_arcmin, spread.zone_sigma_arcmin));
}

/// Returns random angle errors between minus and plus `step_arcmin`.
std::vector<std::vector<double>> errors_to_check(std::size_t angles, double step_arcmin, std::uint32_t seed) {
  const compute::UnitSamples samples(compute::UnitSamples::Kind::sobol, angles, kChecked, seed);
  std::vector<std::vector<double>> errors;
  for (std::size_t k = 0; k < kChecked; ++k) {
    errors.push_back(samples.at(k));
    for (double& error : errors.back()) error = step_arcmin * (2.0 * error - 1.0);
  }
  return errors;
}

/// Response of a cell's goals to angle errors, and its largest deviation from computed goals.
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

/// Returns the candidate cells for the composition that is optimized for the worst random parts. The cells of the best
/// part come first. The cells of the best parts with other numbers of zones follow.
std::vector<FamilyCell> cells_for_worst(const Composition& composition) {
  std::vector<FamilyCell> cells;
  const auto take = [&](const PartOfZones& part) {
    for (const Zone& zone : part.zones)
      if (cells.size() < kMaxCells &&
          std::ranges::none_of(cells, [&](const FamilyCell& cell) { return cell.point == zone.cell.point; }))
        cells.push_back(zone.cell);
  };
  take(*composition.best);
  std::for_each(composition.by_zones.rbegin(), composition.by_zones.rend(), take);
  return cells;
}

/// Returns the goals of the part with errors from cell to cell only. Errors from zone to zone are 0.
std::vector<double> mean_goals(const std::vector<ErrorResponse>& responses, const std::vector<double>& shares) {
  std::vector<double> goals;
  for (std::size_t z = 0; z < responses.size(); ++z) {
    const std::vector<double> of_zone = responses[z].at(std::vector<double>(responses[z].angles(), 0.0));
    goals.resize(of_zone.size(), 0.0);
    for (std::size_t g = 0; g < goals.size(); ++g) goals[g] += shares[z] * of_zone[g];
  }
  return goals;
}

/// Returns the derivatives of the minimum goal with respect to the angle errors. The goals are weighted by their dual
/// prices, because the areas of the zones are re-optimized.
std::vector<std::vector<double>> slopes_of(const std::vector<ErrorResponse>& responses, const PartOfZones& part) {
  std::vector<std::vector<double>> slopes;
  for (std::size_t z = 0; z < responses.size(); ++z) {
    slopes.emplace_back(responses[z].angles(), 0.0);
    for (std::size_t angle = 0; angle < responses[z].angles(); ++angle)
      for (std::size_t g = 0; g < part.mixture.goals.size(); ++g)
        slopes[z][angle] += part.zones[z].area_fraction * part.mixture.prices.goals[g] * responses[z].slope(angle, g);
  }
  return slopes;
}

PartYield yield_of(const RandomParts& parts, const ComposeRequest& request, const std::vector<double>& shares) {
  PartYield yield;
  yield.min_goals = min_goals_of(parts, shares);
  std::ranges::sort(yield.min_goals);
  if (request.min_goal)
    yield.good = static_cast<std::size_t>(
        std::ranges::count_if(yield.min_goals, [&](double least) { return least >= *request.min_goal; }));
  if (request.errors->worst_fraction)
    yield.mean_of_worst = mean_of_worst(yield.min_goals, *request.errors->worst_fraction);
  return yield;
}

}  // namespace

ErrorEffects effects_of_errors(const Study& study, const ComposeRequest& request, const Composition& composition,
                               OptimiseObserver* observer, const Cancellation* cancel) {
  const ErrorSpread& spread = *request.errors;
  const PartOfZones& part = *composition.best;
  ErrorEffects effects;
  std::vector<ErrorResponse> responses;
  const auto respond = [&](const FamilyCell& cell) {
    const CheckedResponse made = response_of(study, request, cell, cancel);
    responses.push_back(made.response.spread(spread.cell_sigma_arcmin));
    if (observer != nullptr) observer->at(responses.size());
    return made.missed_by;
  };
  std::vector<double> shares;
  for (const Zone& zone : part.zones) {
    effects.approximation_error += zone.area_fraction * respond(zone.cell);
    shares.push_back(zone.area_fraction);
  }
  effects.goals = mean_goals(responses, shares);
  effects.slopes = slopes_of(responses, part);
  effects.yield =
      yield_of(random_parts(responses, spread.zone_sigma_arcmin, spread.parts, study.seed), request, shares);
  if (!spread.worst_fraction) return effects;
  const std::vector<FamilyCell> cells = cells_for_worst(composition);
  for (std::size_t k = part.zones.size(); k < cells.size(); ++k) respond(cells[k]);
  const RandomParts parts = random_parts(responses, spread.zone_sigma_arcmin, spread.parts, study.seed);
  const auto set = best_set(parts, *spread.worst_fraction, request.max_zones.value_or(cells.size()),
                            {request.min_area_fraction, request.max_area_fraction}, cancel);
  if (!set) throw Interrupted{};
  RobustPart& for_worst = effects.robust_part.emplace();
  std::vector<std::size_t> members;
  std::vector<double> of_members;
  for (const auto& [cell, share] : *set) {
    for_worst.zones.push_back({cells[cell], share});
    members.push_back(cell);
    of_members.push_back(share);
  }
  for_worst.yield = yield_of(parts_of(parts, members), request, of_members);
  return effects;
}

}  // namespace retrace::studies
