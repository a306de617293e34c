#include "studies/optimise/io/optimise_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/message_text.h"
#include "core/schema/reader.h"
#include "design/io/design_format.h"
#include "studies/quantity/io/constraint_reader.h"
#include "studies/quantity/io/point_texts.h"
#include "studies/quantity/machining_limits.h"

namespace retrace::studies {
namespace {

using schema::Document;

/// Reads the objective: a quantity, or weights of several quantities.
Objective read_objective(const Document& document, const Study& study) {
  const bool most = document.has("optimize.maximize");
  const std::string key = most ? "optimize.maximize" : "optimize.minimize";
  const double sign = most ? 1.0 : -1.0;
  if (!std::holds_alternative<schema::Named>(document.value(key)))
    return {{{checked_quantity(study, document.text(key), document.where(key)), sign}}};
  Objective objective;
  for (const auto& [name, weight] : document.named(key))
    objective.weights.emplace_back(checked_quantity(study, name, document.where(key + "." + name)),
                                   sign * std::get<double>(weight));
  return objective;
}

std::vector<FrontAxis> read_front_axes(const Document& document, const Study& study, const Objective& objective) {
  const std::string key = "optimize.front";
  std::vector<FrontAxis> front;
  if (!document.has(key)) {
    for (const auto& [name, weight] : objective.weights) front.push_back({name, weight >= 0.0});
    return front;
  }
  for (const auto& [name, sense] : document.named(key))
    front.push_back(
        {checked_quantity(study, name, document.where(key + "." + name)), std::get<std::string>(sense) == "max"});
  return front;
}

std::vector<std::string> read_band_keys(const Document& document, const Study& study) {
  constexpr std::string_view list = "optimize.bands_of";
  if (!document.has(list)) return {};
  std::vector<std::string> keys = document.texts(list);
  for (std::string& key : keys) {
    key = current_key(key);
    const bool is_varied = std::ranges::any_of(
        study.parameters, [&](const Parameter& parameter) { return std::ranges::count(parameter.keys, key) > 0; });
    if (!is_varied && !schema::is_number_key(design::design_format(), key))
      document.fail(
          list,
          fmt::format("must be keys of a design with numbers as values, or keys of parameters of the study, got {}",
                      in_quotes(key)));
  }
  return keys;
}

/// Returns the constraints of the study, and the constraints that follow from its tool and its machine.
std::vector<Constraint> constraints_of(const Study& study) {
  std::vector<Constraint> constraints = read_constraints(study);
  add_machining_limits(study, constraints);
  return constraints;
}

void check_parameters(const Study& study) {
  for (const Parameter& parameter : study.parameters)
    if (parameter.distribution)
      throw InputError(parameter.location,
                       "a distribution is not allowed in an optimization: give values, or from and to");
}

}  // namespace

OptimiseRequest read_optimise(const Study& study) {
  const Document& document = *study.document;
  if (!document.has("optimize"))
    document.fail("optimize", "is missing; it must be a table with the key maximize or minimize");
  check_parameters(study);
  OptimiseRequest request;
  request.objective = read_objective(document, study);
  request.front = read_front_axes(document, study, request.objective);
  request.scan = static_cast<std::size_t>(document.number("optimize.scan"));
  request.band_keys = read_band_keys(document, study);
  constexpr double percent = 100.0;
  request.band_loss = document.number("optimize.band_loss_percent") / percent;
  request.is_rounded = document.text("optimize.rounding") == "drawing";
  request.constraints = constraints_of(study);
  return request;
}

}  // namespace retrace::studies
