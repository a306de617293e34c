#include "studies/optimise/io/optimise_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/io/toml_node.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "studies/design/design_keys.h"
#include "studies/design/table_reader.h"
#include "studies/quantity/io/constraint_reader.h"

namespace retrace::studies {
namespace {

/// Keys that a tolerance band can be asked for, beside the parameters of the study.
constexpr std::array<std::string_view, 10> kBandKeys = {"surface.dihedral_error_arcmin",
                                                        "surface.root_radius_um",
                                                        "surface.root_chamfer_um",
                                                        "surface.rim_radius_um",
                                                        "surface.roughness_sq_nm",
                                                        "body.thickness_mm",
                                                        "body.refractive_index",
                                                        "element.apex_angle_deg",
                                                        "element.base_mm",
                                                        "element.width_mm"};

/// `key = "rre"` or `key = {rre = 1, machining_time_h = -0.001}`
Objective read_objective(const DesignDocument& document, TableReader& table, const Study& study) {
  const bool most = table.has("maximize");
  if (most == table.has("minimize"))
    table.fail("maximize", "either maximize or minimize is required: a quantity or a table of weights");
  const std::string_view key = most ? "maximize" : "minimize";
  const double sign = most ? 1.0 : -1.0;
  const toml::node& node = *table.node(key);
  Objective objective;
  if (const toml::table* const weights = node.as_table()) {
    TableReader reader(document, fmt::format("optimize.{}", key), *weights);
    for (auto&& [name, weight] : *weights)
      objective.weights.emplace_back(checked_quantity(study, std::string(name.str()), reader.where(name.str())),
                                     sign * reader.required_number(name.str(), Range{}));
    if (objective.weights.empty()) table.fail(key, "must name at least one quantity");
    return objective;
  }
  objective.weights = {{checked_quantity(study, table.text(key).value_or(""), table.where(key)), sign}};
  return objective;
}

std::vector<FrontAxis> read_front(const DesignDocument& document, TableReader& table, const Study& study,
                                  const Objective& objective) {
  std::vector<FrontAxis> front;
  const toml::node* const node = table.node("front");
  if (node == nullptr) {
    for (const auto& [name, weight] : objective.weights) front.push_back({name, weight >= 0.0});
    return front;
  }
  if (!node->is_table())
    table.fail("front", "must be a table such as {rre = \"most\", machining_time_h = \"least\"}, got " + shown(*node));
  constexpr std::array choices = {Choice<bool>{"most", true}, Choice<bool>{"least", false}};
  TableReader reader(document, "optimize.front", *node->as_table());
  for (auto&& [name, value] : *node->as_table()) {
    const std::string quantity = checked_quantity(study, std::string(name.str()), reader.where(name.str()));
    front.push_back({quantity, reader.required_choice(name.str(), std::span<const Choice<bool>>(choices))});
  }
  return front;
}

std::vector<std::string> read_band_keys(const DesignDocument& document, TableReader& table, const Study& study) {
  std::vector<std::string> allowed(kBandKeys.begin(), kBandKeys.end());
  std::vector<std::string> keys;
  for (const Parameter& parameter : study.parameters)
    for (const std::string& key : parameter.keys) allowed.push_back(key);
  const toml::node* const node = table.node("bands_of");
  if (node == nullptr) return keys;
  const toml::array* const list = node->as_array();
  if (list == nullptr) table.fail("bands_of", "must be a list of keys, got " + shown(*node));
  for (const toml::node& entry : *list) {
    const std::string key = entry.value<std::string>().value_or("");
    if (std::find(allowed.begin(), allowed.end(), key) == allowed.end())
      throw InputError(
          document.location(entry, "optimize.bands_of"),
          fmt::format("must be of {} or a parameter of the study, got {}", fmt::join(kBandKeys, ", "), shown(entry)));
    keys.push_back(key);
  }
  return keys;
}

void check_parameters(const Study& study) {
  for (const Parameter& parameter : study.parameters)
    if (parameter.distribution)
      throw InputError(parameter.location, "a distribution is nothing to choose from: give values, or from and to");
}

}  // namespace

OptimiseRequest read_optimise(const Study& study) {
  const DesignDocument document(study.text, study.source, {});
  const toml::node* const node = document.root().get("optimize");
  if (node == nullptr || !node->is_table())
    throw InputError({study.source, 0, "optimize"}, "missing, must be a table that says what to maximize");
  check_parameters(study);
  TableReader table(document, "optimize");
  OptimiseRequest request;
  request.objective = read_objective(document, table, study);
  request.front = read_front(document, table, study, request.objective);
  const double scan = table.number("scan", {.low = 3.0, .high = 100'000.0}).value_or(65.0);
  if (scan != std::floor(scan)) table.fail("scan", fmt::format("must be a whole number, got {}", shortest(scan)));
  request.scan = static_cast<std::size_t>(scan);
  request.bands_of = read_band_keys(document, table, study);
  constexpr double percent = 100.0;
  request.band_loss =
      table.number("band_loss_percent", {.low = 0.0, .low_included = false, .high = 100.0}).value_or(1.0) / percent;
  table.finish();
  request.constraints = read_constraints(study);
  return request;
}

}  // namespace retrace::studies
