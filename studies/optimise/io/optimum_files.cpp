#include "studies/optimise/io/optimum_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/csv.h"
#include "core/json_text.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

Json variant_json(const Study& study, const Variant& variant) {
  Json json = Json::object();
  for (std::size_t k = 0; k < variant.values.size(); ++k)
    json[study.parameters[k].name] = std::visit([](const auto& v) { return Json(v); }, variant.values[k].shown);
  for (std::size_t k = 0; k < variant.outputs.size(); ++k)
    if (variant.outputs[k].value) json[study.quantities[k]->name()] = *variant.outputs[k].value;
  if (variant.objective) json["objective"] = *variant.objective;
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
  Json json = {{"study", study.source}};
  if (!study.title.empty()) json["title"] = study.title;
  json["objective"] = Json::object();
  for (const auto& [name, weight] : request.objective.weights) json["objective"][name] = weight;
  json["constraints"] = Json::array();
  for (const Constraint& constraint : request.constraints) json["constraints"].push_back(constraint.text());
  if (optimum.best) json["best"] = variant_json(study, *optimum.best);
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
  json["refined_by"] = optimum.method;
  json["evaluations"] = optimum.evaluations;
  json["seed"] = study.seed;
  json["elapsed_s"] = elapsed_s;
  return result_text("retrace.optimum/1", json, {}, optimum.complete);
}

std::string front_csv(const Study& study, const Optimum& optimum) {
  CsvWriter csv;
  for (const Parameter& parameter : study.parameters) csv.add(parameter.name);
  for (const auto& quantity : study.quantities) csv.add(quantity->name());
  csv.row("objective");
  for (const Variant& variant : optimum.front) {
    for (const ParameterValue& value : variant.values)
      if (const double* const number = std::get_if<double>(&value.shown))
        csv.add(*number);
      else
        csv.add_quoted(std::get<std::string>(value.shown));
    for (const compute::StoredOutput& output : variant.outputs) csv.add(output.value);
    csv.row(*variant.objective);
  }
  return csv.text();
}

std::string optimum_text(const Study& study, const OptimiseRequest& request, const Optimum& optimum) {
  if (!optimum.best)
    return optimum.complete ? "no feasible design: " + optimum.infeasible_reason + "\n" : std::string();
  std::string text = "chosen:  " + variant_text(study, *optimum.best) + "\n";
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
  text += fmt::format("{} designs evaluated, {} on the Pareto front; refinement: {}\n", optimum.evaluations,
                      optimum.front.size(), optimum.method);
  return text;
}

}  // namespace retrace::studies
