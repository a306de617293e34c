#include "studies/optimise/important_parameters.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "studies/optimise/local_model.h"
#include "studies/optimise/refine.h"

namespace retrace::studies {
namespace {

/// Returns the fraction of the variance of the objective that a quadratic function of a single parameter explains.
double explained_variance(const Study& study, const Optimum& optimum, std::size_t parameter) {
  std::vector<FittedValue> values;
  double low = 0.0;
  double high = 0.0;
  double mean = 0.0;
  for (const Variant& variant : optimum.designs) {
    if (!variant.objective) continue;
    const double at = std::get<double>(variant.values[parameter].shown);
    low = values.empty() ? at : std::min(low, at);
    high = values.empty() ? at : std::max(high, at);
    values.push_back({{at}, {*variant.objective, 0.0}});
    mean += *variant.objective;
  }
  if (values.empty() || !(high > low)) return 0.0;
  mean /= static_cast<double>(values.size());
  const bool is_logarithmic = study.parameters[parameter].interval && study.parameters[parameter].interval->logarithmic;
  const Interval seen{low, high, is_logarithmic};
  for (FittedValue& value : values) value.at[0] = fraction_of(seen, value.at[0]);
  const LocalModel model({{0.5}, 0.5}, values);
  double all = 0.0;
  double remaining = 0.0;
  for (const FittedValue& value : values) {
    all += std::pow(value.estimate.value - mean, 2);
    remaining += std::pow(value.estimate.value - model.at(value.at), 2);
  }
  return all > 0.0 ? 1.0 - remaining / all : 0.0;
}

}  // namespace

std::vector<std::size_t> important_parameters(const Study& study, const Optimum& optimum) {
  std::vector<std::pair<double, std::size_t>> ranked;
  std::size_t continuous = 0;
  for (std::size_t k = 0; k < study.parameters.size(); ++k) {
    const Parameter& parameter = study.parameters[k];
    const auto is_number = [](const ParameterValue& value) { return std::holds_alternative<double>(value.shown); };
    if (!std::ranges::all_of(parameter.values, is_number)) continue;
    continuous += parameter.interval ? 1U : 0U;
    ranked.emplace_back(explained_variance(study, optimum, k), k);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [&](const auto& a, const auto& b) {
    const bool a_is_continuous = study.parameters[a.second].interval.has_value();
    const bool b_is_continuous = study.parameters[b.second].interval.has_value();
    if (a_is_continuous != b_is_continuous) return a_is_continuous;
    return a.first > b.first;
  });
  if (ranked.size() > (continuous > 1 ? 2U : 1U)) ranked.resize(continuous > 1 ? 2U : 1U);
  std::vector<std::size_t> parameters;
  for (const auto& each : ranked) parameters.push_back(each.second);
  return parameters;
}

}  // namespace retrace::studies
