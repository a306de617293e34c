#include "studies/compose/io/error_effects_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "studies/compose/goals.h"

namespace retrace::studies {
namespace {

/// Fraction of the random parts that are better than the reported minimum.
constexpr double kReportedPartFraction = 0.95;

double reported_min_goal(const PartYield& yield) {
  const double below = (1.0 - kReportedPartFraction) * static_cast<double>(yield.min_goals.size());
  return yield.min_goals[static_cast<std::size_t>(below)];
}

nlohmann::ordered_json yield_json(const PartYield& yield) {
  nlohmann::ordered_json json = {{"parts", yield.min_goals.size()}};
  if (yield.good) json["good"] = *yield.good;
  json["goal_min_of_95_percent"] = reported_min_goal(yield);
  if (yield.mean_of_worst) json["mean_of_worst"] = *yield.mean_of_worst;
  return json;
}

std::string yield_text(const ComposeRequest& request, const PartYield& yield, bool are_margins) {
  const char* const unit = are_margins ? " %" : "";
  std::string text;
  if (yield.good)
    text += fmt::format("{} of {} parts reach {}{}, ", *yield.good, yield.min_goals.size(),
                        goal_value_text(*request.min_goal, are_margins), unit);
  text += fmt::format("95 % of {} {}{} or more", yield.good ? "them reach" : "parts reach",
                      goal_value_text(reported_min_goal(yield), are_margins), unit);
  if (yield.mean_of_worst)
    text += fmt::format(", the mean of the worst {:g} % is {}{}", 100.0 * *request.errors->worst_fraction,
                        goal_value_text(*yield.mean_of_worst, are_margins), unit);
  return text + "\n";
}

}  // namespace

nlohmann::ordered_json error_effects_json(const ComposeRequest& request, const ErrorEffects& effects,
                                          const nlohmann::ordered_json& for_worst) {
  nlohmann::ordered_json json = {{"cell_sigma_arcmin", request.errors->cell_sigma_arcmin},
                                 {"zone_sigma_arcmin", request.errors->zone_sigma_arcmin},
                                 {"goal_min", *std::ranges::min_element(effects.goals)},
                                 {"goals", effects.goals},
                                 {"slopes_per_arcmin", effects.slopes},
                                 {"yield", yield_json(effects.yield)}};
  if (effects.robust_part) {
    json["worst_fraction"] = *request.errors->worst_fraction;
    json["best_for_worst"] = {{"zones", for_worst}, {"yield", yield_json(effects.robust_part->yield)}};
  }
  json["approximation_error_max"] = effects.approximation_error;
  return json;
}

std::string error_effects_text(const ComposeRequest& request, const ErrorEffects& effects, const std::string& for_worst,
                               bool are_margins) {
  const char* const unit = are_margins ? " %" : "";
  const auto shown = [&](double value) { return goal_value_text(value, are_margins) + unit; };
  std::string text =
      fmt::format("angle errors with a standard deviation of {:g}' from cell to cell: minimum of all goals {}\n",
                  request.errors->cell_sigma_arcmin, shown(*std::ranges::min_element(effects.goals)));
  text += fmt::format("and of {:g}' from zone to zone: {}", request.errors->zone_sigma_arcmin,
                      yield_text(request, effects.yield, are_margins));
  for (std::size_t z = 0; z < effects.slopes.size(); ++z) {
    text += fmt::format("zone {}: changes of the minimum if one of the angles increases by 1':", z + 1);
    for (std::size_t k = 0; k < effects.slopes[z].size(); ++k)
      text += (k == 0 ? " " : ", ") + shown(effects.slopes[z][k]);
    text += "\n";
  }
  if (effects.robust_part)
    text += "best part for the worst random parts: " + yield_text(request, effects.robust_part->yield, are_margins) +
            for_worst;
  return text + fmt::format("error of the polynomial approximation of the goals: at most {} at the computed points\n",
                            shown(effects.approximation_error));
}

}  // namespace retrace::studies
