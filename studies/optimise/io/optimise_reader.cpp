#include "studies/optimise/io/optimise_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/message_text.h"
#include "core/number_format.h"
#include "core/toml_file.h"
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
Objective read_objective(TomlTable& table, const Study& study) {
  const bool most = table.has("maximize");
  if (most == table.has("minimize"))
    table.fail("maximize", "either maximize or minimize is required: a quantity or a table of weights");
  const std::string_view key = most ? "maximize" : "minimize";
  const double sign = most ? 1.0 : -1.0;
  Objective objective;
  if (table.shape_of(key) != TomlTable::Shape::table) {
    objective.weights = {{checked_quantity(study, table.text(key).value_or(""), table.where(key)), sign}};
    return objective;
  }
  TomlTable weights = table.table(key);
  for (const std::string& name : weights.sorted_names())
    objective.weights.emplace_back(checked_quantity(study, name, weights.where(name)),
                                   sign * weights.required_number(name));
  if (objective.weights.empty()) table.fail(key, "must name at least one quantity");
  return objective;
}

std::vector<FrontAxis> read_front(TomlTable& table, const Study& study, const Objective& objective) {
  constexpr std::string_view words[] = {"most", "least"};
  std::vector<FrontAxis> front;
  if (!table.has("front")) {
    for (const auto& [name, weight] : objective.weights) front.push_back({name, weight >= 0.0});
    return front;
  }
  if (table.shape_of("front") != TomlTable::Shape::table)
    table.fail("front",
               "must be a table such as {rre = \"most\", machining_time_h = \"least\"}, got " + table.shown("front"));
  TomlTable axes = table.table("front");
  for (const std::string& name : axes.sorted_names())
    front.push_back({checked_quantity(study, name, axes.where(name)), axes.required_choice(name, words) == 0});
  return front;
}

std::vector<std::string> read_band_keys(TomlTable& table, const Study& study) {
  constexpr std::string_view key = "bands_of";
  std::vector<std::string> allowed(kBandKeys.begin(), kBandKeys.end());
  for (const Parameter& parameter : study.parameters)
    for (const std::string& each : parameter.keys) allowed.push_back(each);
  const auto items = table.items(key);
  if (!items && table.has(key)) table.fail(key, "must be a list of keys, got " + table.shown(key));
  std::vector<std::string> keys;
  for (const TomlItem& item : items.value_or(std::vector<TomlItem>())) {
    const std::string given = item.text.value_or("");
    if (std::find(allowed.begin(), allowed.end(), given) == allowed.end())
      table.fail(key, fmt::format("must be of {} or a parameter of the study, got {}", fmt::join(kBandKeys, ", "),
                                  item.shown));
    keys.push_back(given);
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
  TomlTable document = parse_toml(study.text, study.source, kShortTomlBytes);
  if (document.shape_of("optimize") != TomlTable::Shape::table)
    throw InputError({study.source, 0, "optimize"}, "missing, must be a table that says what to maximize");
  check_parameters(study);
  TomlTable table = document.table("optimize");
  OptimiseRequest request;
  request.objective = read_objective(table, study);
  request.front = read_front(table, study, request.objective);
  const double scan = table.number("scan", {.low = 3.0, .high = 100'000.0}).value_or(65.0);
  if (scan != std::floor(scan)) table.fail("scan", fmt::format("must be a whole number, got {}", shortest(scan)));
  request.scan = static_cast<std::size_t>(scan);
  request.bands_of = read_band_keys(table, study);
  constexpr double percent = 100.0;
  request.band_loss =
      table.number("band_loss_percent", {.low = 0.0, .low_included = false, .high = 100.0}).value_or(1.0) / percent;
  table.finish();
  request.constraints = read_constraints(study);
  return request;
}

}  // namespace retrace::studies
