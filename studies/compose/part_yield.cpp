#include "studies/compose/part_yield.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <compare>
#include <limits>
#include <set>
#include <utility>

#include "compute/sampling/unit_samples.h"

namespace retrace::studies {
namespace {

/// A goal of a random part.
struct PartGoal {
  std::size_t part = 0;  ///< index of the part
  std::size_t goal = 0;  ///< index of the goal

  auto operator<=>(const PartGoal&) const = default;
};

/// Returns the value of a goal of a random part, which is the mean of its zones' values weighted by area.
double value_of(const std::vector<std::vector<double>>& zones, const std::vector<double>& shares, std::size_t goal) {
  double value = 0.0;
  for (std::size_t z = 0; z < zones.size(); ++z) value += shares[z] * zones[z][goal];
  return value;
}

/// Returns the index of the minimum goal of a random part.
std::size_t worst_goal(const std::vector<std::vector<double>>& zones, const std::vector<double>& shares) {
  std::size_t worst = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t goal = 0; goal < zones.front().size(); ++goal)
    if (const double value = value_of(zones, shares, goal); value < least) {
      least = value;
      worst = goal;
    }
  return worst;
}

/// Returns the linear programme of best_fractions(). Its variables (columns) are the fractions of the area, the value
/// below which a part is among the worst, and the shortfall of each part below this value.
compute::LinearProgramme yield_programme(const RandomParts& parts, double worst_fraction, const compute::Bounds& bounds,
                                         const std::set<PartGoal>& rows) {
  compute::LinearProgramme programme;
  const std::size_t zones = parts.front().size();
  std::vector<compute::LinearProgramme::Term> whole;
  for (std::size_t z = 0; z < zones; ++z) whole.emplace_back(programme.add_column(bounds, 0.0), 1.0);
  const std::size_t threshold = programme.add_column({}, 1.0);
  const double weight = -1.0 / (worst_fraction * static_cast<double>(parts.size()));
  const std::size_t first = threshold + 1;
  for (std::size_t part = 0; part < parts.size(); ++part) programme.add_column({.lower = 0.0}, weight);
  programme.add_row({1.0, 1.0}, whole);
  for (const auto& [part, goal] : rows) {
    std::vector<compute::LinearProgramme::Term> terms = {{threshold, -1.0}, {first + part, 1.0}};
    for (std::size_t z = 0; z < zones; ++z) terms.emplace_back(z, parts[part][z][goal]);
    programme.add_row({.lower = 0.0}, std::move(terms));
  }
  return programme;
}

}  // namespace

RandomParts random_parts(const std::vector<ErrorResponse>& responses, double sigma_arcmin, std::size_t parts,
                         std::uint32_t seed) {
  std::size_t angles = 0;
  for (const ErrorResponse& response : responses) angles += response.angles();
  const compute::UnitSamples samples(compute::UnitSamples::Kind::sobol, std::max<std::size_t>(1, angles), parts, seed);
  const boost::math::normal_distribution<double> normal;
  RandomParts drawn;
  for (std::size_t part = 0; part < parts; ++part) {
    const std::vector<double> unit = samples.at(part);
    auto next = unit.begin();
    std::vector<std::vector<double>>& zones = drawn.emplace_back();
    for (const ErrorResponse& response : responses) {
      std::vector<double> errors;
      for (std::size_t k = 0; k < response.angles(); ++k)
        errors.push_back(sigma_arcmin * boost::math::quantile(normal, *next++));
      zones.push_back(response.at(errors));
    }
  }
  return drawn;
}

std::vector<double> min_goals_of(const RandomParts& parts, const std::vector<double>& fractions) {
  std::vector<double> leasts;
  for (const auto& zones : parts) leasts.push_back(value_of(zones, fractions, worst_goal(zones, fractions)));
  return leasts;
}

double mean_of_worst(std::vector<double> values, double fraction) {
  std::ranges::sort(values);
  const double count = fraction * static_cast<double>(values.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < values.size() && static_cast<double>(k) < count; ++k)
    sum += values[k] * std::min(1.0, count - static_cast<double>(k));
  return sum / count;
}

std::optional<std::vector<double>> best_fractions(const RandomParts& parts, double worst_fraction,
                                                  const compute::Bounds& bounds, const Cancellation* cancel) {
  const std::size_t zones = parts.front().size();
  std::vector<double> shares(zones, 1.0 / static_cast<double>(zones));
  std::set<PartGoal> rows;
  for (std::size_t part = 0; part < parts.size(); ++part) rows.insert({part, worst_goal(parts[part], shares)});
  // Rows that the current solution violates are added until there are none. The solution then satisfies all rows,
  // including those that were never added.
  for (;;) {
    const compute::LinearOptimum optimum = solve(yield_programme(parts, worst_fraction, bounds, rows), cancel);
    if (optimum.kind != compute::LinearOptimum::Kind::optimal) return std::nullopt;
    shares.assign(optimum.values.begin(), optimum.values.begin() + static_cast<std::ptrdiff_t>(zones));
    const std::size_t before = rows.size();
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const std::size_t goal = worst_goal(parts[part], shares);
      const double missed =
          optimum.values[zones] - optimum.values[zones + 1 + part] - value_of(parts[part], shares, goal);
      if (missed > 1e-9 * (1.0 + std::abs(optimum.objective))) rows.insert({part, goal});
    }
    if (rows.size() == before) return shares;
  }
}

RandomParts parts_of(const RandomParts& parts, const std::vector<std::size_t>& zones) {
  RandomParts of_zones;
  for (const auto& part : parts) {
    auto& made = of_zones.emplace_back();
    for (const std::size_t zone : zones) made.push_back(part[zone]);
  }
  return of_zones;
}

std::optional<CellFractions> best_set(const RandomParts& parts, double worst_fraction, std::size_t max_zones,
                                      const compute::Bounds& bounds, const Cancellation* cancel) {
  const std::size_t cells = parts.front().size();
  std::optional<CellFractions> best;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t set = 1; set < std::size_t{1} << cells; ++set) {
    std::vector<std::size_t> members;
    for (std::size_t cell = 0; cell < cells; ++cell)
      if ((set >> cell & 1U) != 0) members.push_back(cell);
    if (members.size() > max_zones) continue;
    if (is_cancelled(cancel)) return std::nullopt;
    const RandomParts of_set = parts_of(parts, members);
    const auto shares = best_fractions(of_set, worst_fraction, bounds, cancel);
    if (!shares) continue;
    const double mean = mean_of_worst(min_goals_of(of_set, *shares), worst_fraction);
    if (mean <= most) continue;
    most = mean;
    best.emplace();
    for (std::size_t k = 0; k < members.size(); ++k)
      if ((*shares)[k] > 0.0) best->emplace_back(members[k], (*shares)[k]);
  }
  if (best) std::ranges::stable_sort(*best, [](const auto& a, const auto& b) { return a.second > b.second; });
  return best;
}

}  // namespace retrace::studies
