#include "studies/tolerance/io/tolerance_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "studies/quantity/io/study_json.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPercentPerFraction = 100.0;

Json estimate_json(const compute::IntervalEstimate& estimate) {
  return {{"value", estimate.value}, {"low", estimate.low}, {"high", estimate.high}};
}

Json quantity_json(const Study& study, const QuantityTolerance& quantity) {
  Json json = {{"quantity", quantity.quantity}};
  if (quantity.nominal) json["nominal"] = *quantity.nominal;
  json["parts"] = quantity.parts;
  json["without_value"] = quantity.missing_parts;
  if (quantity.spread) {
    const compute::Spread& spread = *quantity.spread;
    json["mean"] = estimate_json(spread.mean_interval);
    json["standard_deviation"] = spread.deviation;
    json["min"] = spread.min;
    json["max"] = spread.max;
  }
  json["percentiles"] = Json::array();
  for (const auto& [share, value] : quantity.percentiles)
    json["percentiles"].push_back({{"percent", kPercentPerFraction * share}, {"value", value}});
  if (quantity.noise) json["noise"] = *quantity.noise;
  json["index_rows"] = quantity.rows;
  json["indices"] = Json::array();
  for (std::size_t k = 0; k < quantity.indices.size(); ++k)
    json["indices"].push_back({{"parameter", study.parameters[k].name},
                               {"first_order", estimate_json(quantity.indices[k].first_order)},
                               {"total", estimate_json(quantity.indices[k].total)}});
  return json;
}

const char* sampling_name(compute::UnitSamples::Kind kind) {
  switch (kind) {
    case compute::UnitSamples::Kind::sobol: return "sobol";
    case compute::UnitSamples::Kind::latin_hypercube: return "latin_hypercube";
    case compute::UnitSamples::Kind::monte_carlo: break;
  }
  return "monte_carlo";
}

std::string percent_text(const compute::IntervalEstimate& share, double confidence) {
  return fmt::format("{:.2f} % ({:g} % confidence: {:.2f} to {:.2f} %)", kPercentPerFraction * share.value,
                     kPercentPerFraction * confidence, kPercentPerFraction * share.low,
                     kPercentPerFraction * share.high);
}

/// Returns the indices of the parameters in descending order of their total Sobol index.
std::vector<std::size_t> by_contribution(const std::vector<compute::SobolIndex>& indices) {
  std::vector<std::size_t> order(indices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return indices[a].total.value > indices[b].total.value; });
  return order;
}

/// Returns a mean and its uncertainty, which is half the width of its confidence interval, as text. The uncertainty
/// determines the number of digits.
std::string mean_text(double mean, const compute::IntervalEstimate& interval) {
  const double half = 0.5 * (interval.high - interval.low);
  if (!(half > 0.0)) return fmt::format("{:.6g}", mean);
  const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(half))), 0, 9);
  return fmt::format("{} +- {}", fixed(mean, digits), fixed(half, digits));
}

std::string quantity_text(const Study& study, const QuantityTolerance& quantity) {
  std::string text = quantity.quantity + ":";
  if (quantity.nominal) text += fmt::format("  nominal {:.6g}", *quantity.nominal);
  if (quantity.spread)
    text += fmt::format("  mean {}  standard deviation {:.3g}  range {:.6g} to {:.6g}",
                        mean_text(quantity.spread->mean, quantity.spread->mean_interval), quantity.spread->deviation,
                        quantity.spread->min, quantity.spread->max);
  text += "\n";
  if (!quantity.percentiles.empty()) {
    text += " ";
    for (const auto& [share, value] : quantity.percentiles)
      text += fmt::format("  {:g} %: {:.6g}", kPercentPerFraction * share, value);
    text += "\n";
  }
  for (const std::size_t k : by_contribution(quantity.indices)) {
    const compute::SobolIndex& index = quantity.indices[k];
    text += fmt::format(
        "    {:<36} first-order index {:6.3f} ({:.3f} to {:.3f})   total index {:6.3f} ({:.3f} to {:.3f})\n",
        printable(study.parameters[k].name, 36), index.first_order.value, index.first_order.low, index.first_order.high,
        index.total.value, index.total.low, index.total.high);
  }
  return text;
}

}  // namespace

std::string tolerance_json(const SweepResult& swept, const ToleranceRequest& request, const ToleranceResult& result) {
  const Study& study = swept.sweep.study();
  Json json = begin_document(study);
  json["parameters"] = Json::array();
  for (const Parameter& parameter : study.parameters) json["parameters"].push_back(parameter.name);
  json["sampling"] = sampling_name(request.sampling);
  json["samples"] = request.samples;
  json["confidence"] = request.confidence;
  json["points_in_all"] = swept.sweep.size();
  json["parts"] = result.parts;
  json["failed"] = result.failed;
  if (result.yield) json["yield"] = estimate_json(*result.yield);
  if (request.min_yield) json["min_yield"] = *request.min_yield;
  if (request.min_yield) json["verdict"] = result.is_enough ? "pass" : "fail";
  json["limits"] = Json::array();
  for (const LimitYield& limit : result.limits)
    json["limits"].push_back({{"limit", limit.text}, {"yield", estimate_json(limit.yield)}});
  json["quantities"] = Json::array();
  for (const QuantityTolerance& quantity : result.quantities)
    json["quantities"].push_back(quantity_json(study, quantity));
  json["seed"] = study.seed;
  json["elapsed_s"] = swept.elapsed_s;
  return result_text("retrace.tolerance/2", json, swept.warnings, swept.complete);
}

std::string tolerance_text(const Study& study, const ToleranceRequest& request, const ToleranceResult& result) {
  std::string text;
  for (const QuantityTolerance& quantity : result.quantities) text += quantity_text(study, quantity);
  for (const LimitYield& limit : result.limits)
    text += fmt::format("{}:  {}\n", limit.text, percent_text(limit.yield, request.confidence));
  if (result.yield) text += fmt::format("yield:  {}\n", percent_text(*result.yield, request.confidence));
  text += fmt::format("{} parts, {} could not be computed\n", result.parts, result.failed);
  return text;
}

std::string so_far_text(const ToleranceResult& result, const ToleranceRequest& request) {
  std::string text = fmt::format("so far, {} parts", result.parts);
  if (result.yield) return text + fmt::format(": yield {}", percent_text(*result.yield, request.confidence));
  if (result.quantities.empty() || !result.quantities.front().spread) return text;
  const QuantityTolerance& first = result.quantities.front();
  return text + fmt::format(": {} has the mean {:.5g} and the standard deviation {:.2g}", first.quantity,
                            first.spread->mean, first.spread->deviation);
}

}  // namespace retrace::studies
