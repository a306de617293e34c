#include "studies/compose/goals.h"
#include "studies/quantity/study_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace retrace::studies {
namespace {

constexpr double kNoPrice = 1e-9;

/// Formats the value of a parameter. A value that equals an end of the interval except for rounding errors is shown as
/// this end.
std::string value_text(const Parameter& parameter, const ParameterValue& value) {
  const double* const number = std::get_if<double>(&value.shown);
  if (number == nullptr) return std::get<std::string>(value.shown);
  if (!parameter.interval) return fmt::format("{:.6g}", *number);
  const auto is_near = [&](double end) {
    return std::abs(*number - end) < 1e-9 * (parameter.interval->to - parameter.interval->from);
  };
  for (const double end : {parameter.interval->from, parameter.interval->to})
    if (is_near(end)) return fmt::format("{:.6g}", end);
  return fmt::format("{:.4g}", *number);
}

}  // namespace

const Quantity& goal_of(const Study& study, const ComposeRequest& request, std::size_t goal) {
  return *quantity_named(study, request.goals[goal]);
}

bool are_margins(const Study& study, const ComposeRequest& request) {
  for (std::size_t k = 0; k < request.goals.size(); ++k)
    if (!goal_of(study, request, k).limit()) return false;
  return true;
}

double contribution_of(const Zone& zone, std::size_t goal, bool is_margin) {
  return zone.area_fraction * (zone.cell.mixed.goals[goal] + (is_margin ? 1.0 : 0.0));
}

bool is_price(double price) {
  return std::abs(price) > kNoPrice;
}

/// The margin of a goal with the value R is R / limit - 1. Its derivative with respect to the limit is therefore -(1 +
/// margin) / limit.
std::optional<double> cost_of_limit(const Quantity& quantity, const Mixture& mixture, std::size_t goal) {
  const std::optional<QuantityLimit> limit = quantity.limit();
  if (!limit) return std::nullopt;
  return mixture.prices.goals[goal] * (1.0 + mixture.goals[goal]) / limit->value;
}

std::vector<std::size_t> goals_to_show(const ComposeRequest& request, const Mixture& mixture) {
  std::vector<std::size_t> shown;
  const auto stem = [&](std::size_t goal) { return request.goals[goal].substr(0, request.goals[goal].rfind('.')); };
  for (std::size_t goal = 0; goal < request.goals.size(); ++goal) {
    const bool is_reading = std::ranges::count(request.goals[goal], '.') > 1;
    if (!is_reading || shown.empty() || stem(shown.back()) != stem(goal))
      shown.push_back(goal);
    else if (mixture.goals[goal] < mixture.goals[shown.back()])
      shown.back() = goal;
  }
  return shown;
}

std::string goal_value_text(double value, bool is_margin) {
  return is_margin ? fmt::format("{:.1f}", 100.0 * value) : fmt::format("{:.5g}", value);
}

std::string cell_text(const Study& study, const FamilyCell& cell) {
  std::string text;
  for (std::size_t k = 0; k < cell.values.size(); ++k)
    text += fmt::format("{}{} = {}", k == 0 ? "" : ", ", study.parameters[k].name,
                        value_text(study.parameters[k], cell.values[k]));
  return text;
}

}  // namespace retrace::studies
