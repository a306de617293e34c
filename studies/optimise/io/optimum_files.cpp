#include "studies/optimise/io/optimum_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/csv.h"
#include "core/json_text.h"
#include "design/io/design_document.h"
#include "studies/quantity/io/study_json.h"
#include "studies/quantity/io/study_reader.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

Json variant_json(const Study& study, const Variant& variant) {
  Json json = Json::object();
  for (std::size_t k = 0; k < variant.values.size(); ++k)
    json[study.parameters[k].name] = std::visit([](const auto& v) { return Json(v); }, variant.values[k].shown);
  for (std::size_t k = 0; k < variant.outputs.size(); ++k)
    if (variant.outputs[k].value) json[study.quantities[k]->name()] = *variant.outputs[k].value;
  for (std::size_t k = 0; k < variant.outputs.size(); ++k)
    if (variant.outputs[k].value && variant.outputs[k].std_error > 0.0)
      json[study.quantities[k]->name() + "_std_error"] = variant.outputs[k].std_error;
  if (variant.objective) json["objective"] = *variant.objective;
  if (variant.objective && variant.objective_error > 0.0) json["objective_std_error"] = variant.objective_error;
  return json;
}

/// Returns an evaluated design as JSON. The key `feasible` is true if the design satisfies all constraints.
Json design_json(const Study& study, const Variant& variant) {
  Json json = variant_json(study, variant);
  json["feasible"] = variant.feasible();
  if (variant.failed) json["reason"] = variant.reason;
  return json;
}

std::string value_text(const ParameterValue& value) {
  const double* const number = std::get_if<double>(&value.shown);
  return number != nullptr ? fmt::format("{:.9g}", *number) : std::get<std::string>(value.shown);
}

std::string variant_text(const Study& study, const Variant& variant) {
  std::string text;
  for (std::size_t k = 0; k < variant.values.size(); ++k)
    text += fmt::format("{}{} = {}", k == 0 ? "" : ", ", study.parameters[k].name, value_text(variant.values[k]));
  for (std::size_t k = 0; k < variant.outputs.size(); ++k)
    if (variant.outputs[k].value)
      text +=
          fmt::format("{}{} = {:.6g}", k == 0 ? ": " : ", ", study.quantities[k]->name(), *variant.outputs[k].value);
  return text;
}

Json band_json(const ToleranceBand& band) {
  Json json = {{"key", band.key}, {"nominal", band.nominal}};
  if (band.down) json["down"] = *band.down;
  if (band.up) json["up"] = *band.up;
  return json;
}

}  // namespace

std::string optimum_json(const Study& study, const OptimiseRequest& request, const Optimum& optimum, double elapsed_s) {
  Json json = begin_document(study);
  json["objective"] = Json::object();
  for (const auto& [name, weight] : request.objective.weights) json["objective"][name] = weight;
  json["constraints"] = Json::array();
  for (const Constraint& constraint : request.constraints) json["constraints"].push_back(constraint.text());
  if (optimum.best) json["best"] = variant_json(study, *optimum.best);
  if (optimum.resolution > 0.0) json["resolution"] = optimum.resolution;
  if (!optimum.best && optimum.complete) json["infeasible"] = optimum.infeasible_reason;
  json["pareto"] = Json::array();
  for (const Variant& variant : optimum.front) json["pareto"].push_back(variant_json(study, variant));
  json["rejected"] = Json::array();
  for (const Rejected& rejected : optimum.rejected) {
    Json entry = {{"role", rejected.role}, {"why", rejected.why}};
    entry.update(variant_json(study, rejected.variant));
    json["rejected"].push_back(entry);
  }
  if (optimum.cheaper) json["within_1_percent"] = variant_json(study, *optimum.cheaper);
  json["band_loss"] = request.band_loss;
  json["bands"] = Json::array();
  for (const ToleranceBand& band : optimum.bands) json["bands"].push_back(band_json(band));
  json["designs"] = Json::array();
  for (const Variant& variant : optimum.designs) json["designs"].push_back(design_json(study, variant));
  json["refined_by"] = optimum.method;
  json["evaluations"] = optimum.designs.size();
  json["seed"] = study.seed;
  json["elapsed_s"] = elapsed_s;
  return result_text("retrace.optimum/1", json, {}, optimum.complete);
}

namespace {

void add_values(const Variant& variant, CsvWriter& csv) {
  for (const ParameterValue& value : variant.values)
    if (const double* const number = std::get_if<double>(&value.shown))
      csv.add(*number);
    else
      csv.add_quoted(std::get<std::string>(value.shown));
}

}  // namespace

std::string front_csv(const Study& study, const Optimum& optimum) {
  CsvWriter csv;
  for (const Parameter& parameter : study.parameters) csv.add(parameter.name);
  for (const auto& quantity : study.quantities) csv.add(quantity->name());
  csv.row("objective");
  for (const Variant& variant : optimum.front) {
    add_values(variant, csv);
    for (const compute::StoredOutput& output : variant.outputs) csv.add(output.value);
    csv.row(*variant.objective);
  }
  return csv.text();
}

std::string designs_csv(const Study& study, const Optimum& optimum) {
  CsvWriter csv;
  for (const Parameter& parameter : study.parameters) csv.add(parameter.name);
  for (const auto& quantity : study.quantities) {
    csv.add(quantity->name());
    csv.add(quantity->name() + "_std_error");
  }
  csv.row("objective", "objective_std_error", "feasible", "reason");
  for (const Variant& variant : optimum.designs) {
    add_values(variant, csv);
    for (std::size_t k = 0; k < study.quantities.size(); ++k) {
      const bool has_value = k < variant.outputs.size() && variant.outputs[k].value;
      csv.add(has_value ? variant.outputs[k].value : std::nullopt);
      csv.add(has_value ? std::optional(variant.outputs[k].std_error) : std::nullopt);
    }
    csv.add(variant.objective);
    csv.add(variant.objective ? std::optional(variant.objective_error) : std::nullopt);
    csv.add(variant.feasible() ? 1 : 0);
    csv.add_quoted(variant.reason);
    csv.end_row();
  }
  return csv.text();
}

std::string variant_design_text(const Study& study, const Variant& variant, const std::string& comment) {
  return design::design_text(make_candidate(study, variant.values).design(), comment);
}

std::string short_text(const Study& study, const OptimiseRequest& request, const Variant& variant) {
  const auto& weights = request.objective.weights;
  const std::string name = weights.size() == 1 ? weights.front().first : "objective";
  const double value = weights.size() == 1 ? *variant.objective / weights.front().second : *variant.objective;
  std::string text = fmt::format("{} = {:.5g}", name, value);
  for (std::size_t k = 0; k < variant.values.size(); ++k) {
    const double* const number = std::get_if<double>(&variant.values[k].shown);
    text += fmt::format(
        "{}{} = {}", k == 0 ? " at " : ", ", study.parameters[k].name,
        number != nullptr ? fmt::format("{:.5g}", *number) : std::get<std::string>(variant.values[k].shown));
  }
  return text;
}

std::string optimum_text(const Study& study, const OptimiseRequest& request, const Optimum& optimum) {
  if (!optimum.best)
    return optimum.complete ? "no feasible design: " + optimum.infeasible_reason + "\n" : std::string();
  std::string text = (optimum.complete ? "chosen:  " : "best so far:  ") + variant_text(study, *optimum.best) + "\n";
  if (optimum.resolution > 0.0)
    text += fmt::format("    other designs near it are better by at most {:.2g} (with a confidence of 95 %)\n",
                        optimum.resolution);
  for (const Rejected& rejected : optimum.rejected)
    text += fmt::format("not chosen ({}):  {}\n    {}\n", rejected.role, variant_text(study, rejected.variant),
                        rejected.why);
  if (optimum.cheaper) text += "alternative within 1 %:  " + variant_text(study, *optimum.cheaper) + "\n";
  for (const ToleranceBand& band : optimum.bands) {
    const auto side = [](const std::optional<double>& change) { return change ? fmt::format("{:.4g}", *change) : "-"; };
    text +=
        fmt::format("range for a loss of {:g} % of {}:  {} = {:.9g}  - {}  + {}\n", 100.0 * request.band_loss,
                    request.objective.weights.front().first, band.key, band.nominal, side(band.down), side(band.up));
  }
  text += fmt::format("{} designs evaluated, {} on the Pareto front; refinement: {}\n", optimum.designs.size(),
                      optimum.front.size(), optimum.method);
  return text;
}

}  // namespace retrace::studies
