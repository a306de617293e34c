#include "studies/compose/io/composition_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ranges>

#include "core/csv.h"
#include "core/json_text.h"
#include "core/number_format.h"
#include "studies/compose/goals.h"
#include "studies/compose/io/error_effects_files.h"
#include "studies/quantity/io/study_json.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

Json cell_json(const Study& study, const FamilyCell& cell) {
  Json json = {{"point", cell.point}};
  for (std::size_t k = 0; k < cell.values.size(); ++k)
    json[study.parameters[k].name] = std::visit([](const auto& v) { return Json(v); }, cell.values[k].shown);
  return json;
}

Json zones_json(const Study& study, const std::vector<Zone>& zones) {
  Json all = Json::array();
  for (const Zone& zone : zones)
    all.push_back({{"area_fraction", zone.area_fraction}, {"cell", cell_json(study, zone.cell)}});
  return all;
}

Json goals_json(const Study& study, const ComposeRequest& request, const PartOfZones& part) {
  Json all = Json::array();
  for (std::size_t k = 0; k < request.goals.size(); ++k) {
    const Quantity& quantity = goal_of(study, request, k);
    Json goal = {{"goal", quantity.name()},
                 {"label", quantity.label()},
                 {"value", part.mixture.goals[k]},
                 {"price", part.mixture.prices.goals[k]}};
    if (const auto limit = quantity.limit()) {
      goal["limit"] = limit->value;
      goal["unit"] = limit->unit;
      goal["cost_of_one_more"] = *cost_of_limit(quantity, part.mixture, k);
    }
    Json given = Json::array();
    for (const Zone& zone : part.zones) given.push_back(contribution_of(zone, k, quantity.limit().has_value()));
    goal["given_by_zones"] = given;
    all.push_back(goal);
  }
  return all;
}

std::string_view proof_word(Proof proof) {
  switch (proof) {
    case Proof::family: return "family";
    case Proof::catalogue: return "catalogue";
    case Proof::none: break;
  }
  return "none";
}

void add_part(const Study& study, const ComposeRequest& request, const Composition& composition, Json& json) {
  const PartOfZones& part = *composition.best;
  json["zones"] = zones_json(study, part.zones);
  json["goal_min"] = part.mixture.min_goal;
  json["merit"] = part.mixture.merit;
  json["goals"] = goals_json(study, request, part);
  Json means = Json::array();
  for (std::size_t k = 0; k < request.part_constraints.size(); ++k)
    means.push_back({{"constraint", request.part_constraints[k].text()},
                     {"value", part.mixture.means[k]},
                     {"price", part.mixture.prices.means[k]}});
  json["constraints_over_part"] = means;
  json["proven_optimal_over"] = proof_word(composition.proof);
  json["bound"] = part.mixture.bound;
  json["search_converged"] = composition.has_converged;
  json["any_number_of_zones"] = composition.unlimited_merit;
  Json by_zones = Json::array();
  for (const PartOfZones& of : composition.by_zones)
    by_zones.push_back({{"max_zones", of.max_zones},
                        {"goal_min", of.mixture.min_goal},
                        {"merit", of.mixture.merit},
                        {"zones", zones_json(study, of.zones)}});
  json["by_number_of_zones"] = by_zones;
  if (composition.errors)
    json["errors_of_angle"] =
        error_effects_json(request, *composition.errors, zones_json(study, robust_zones(composition)));
  if (!request.front) return;
  Json front = Json::array();
  for (const FrontPart& at : composition.front)
    front.push_back(
        {{request.front->quantity, at.mean}, {"goal_min", at.min_goal}, {"zones", zones_json(study, at.zones)}});
  json["front"] = front;
}

}  // namespace

std::string composition_json(const Study& study, const ComposeRequest& request, const Composition& composition,
                             double elapsed_s) {
  Json json = begin_document(study);
  if (composition.best) add_part(study, request, composition, json);
  if (const std::string why = why_not_reached(study, request, composition); !why.empty()) json["not_reached"] = why;
  if (composition.single)
    json["best_of_one_cell"] = {{"goal_min", *std::ranges::min_element(composition.single->mixed.goals)},
                                {"cell", cell_json(study, *composition.single)}};
  json["catalogue"] = composition.catalogue.size();
  json["failed"] = composition.failed;
  json["evaluations"] = composition.evaluations;
  json["seed"] = study.seed;
  json["elapsed_s"] = elapsed_s;
  return result_text("retrace.composition/2", json, {}, composition.complete);
}

std::string composition_csv(const Study& study, const ComposeRequest& request, const Composition& composition) {
  CsvWriter csv;
  for (const char* name : {"goal", "label", "limit", "unit", "value", "price"}) csv.add(name);
  if (!composition.best) {
    csv.row("zone_1");
    return csv.text();
  }
  const PartOfZones& part = *composition.best;
  for (std::size_t z = 0; z + 1 < part.zones.size(); ++z) csv.add(fmt::format("zone_{}", z + 1));
  csv.row(fmt::format("zone_{}", part.zones.size()));
  for (std::size_t k = 0; k < request.goals.size(); ++k) {
    const Quantity& quantity = goal_of(study, request, k);
    const std::optional<QuantityLimit> limit = quantity.limit();
    csv.add_quoted(quantity.name());
    csv.add_quoted(quantity.label());
    csv.add(limit ? std::optional(limit->value) : std::nullopt);
    csv.add_quoted(limit ? limit->unit : "");
    csv.add(part.mixture.goals[k]);
    csv.add(part.mixture.prices.goals[k]);
    for (std::size_t z = 0; z + 1 < part.zones.size(); ++z)
      csv.add(contribution_of(part.zones[z], k, limit.has_value()));
    csv.row(contribution_of(part.zones.back(), k, limit.has_value()));
  }
  return csv.text();
}

namespace {

std::string zones_text(const Study& study, const std::vector<Zone>& zones) {
  std::string text;
  for (std::size_t z = 0; z < zones.size(); ++z)
    text +=
        fmt::format("zone {}  {:6.2f} %  {}\n", z + 1, 100.0 * zones[z].area_fraction, cell_text(study, zones[z].cell));
  return text;
}

std::string goals_text(const Study& study, const ComposeRequest& request, const PartOfZones& part) {
  const std::vector<std::size_t> rows = goals_to_show(request, part.mixture);
  std::string text = fmt::format("{:<28}{:>10}{:>12}", "", "limit", "part");
  for (std::size_t z = 0; z < part.zones.size(); ++z) text += fmt::format("{:>10}", fmt::format("zone {}", z + 1));
  text += "     price\n";
  for (const std::size_t k : rows) {
    const Quantity& quantity = goal_of(study, request, k);
    const auto limit = quantity.limit();
    text += fmt::format("{:<28}{:>10}{:>12}", quantity.label(), limit ? fmt::format("{:g}", limit->value) : "",
                        goal_value_text(part.mixture.goals[k], limit.has_value()) + (limit ? " %" : ""));
    for (const Zone& zone : part.zones)
      text += fmt::format("{:>10}", goal_value_text(contribution_of(zone, k, limit.has_value()), limit.has_value()));
    const double price = part.mixture.prices.goals[k];
    text += is_price(price) ? fmt::format("{:10.3f}\n", price) : std::string("\n");
  }
  return text;
}

/// Returns the dual prices of the part as text.
std::string prices_text(const Study& study, const ComposeRequest& request, const PartOfZones& part) {
  std::string text;
  for (std::size_t k = 0; k < request.goals.size(); ++k) {
    if (!(is_price(part.mixture.prices.goals[k]))) continue;
    const Quantity& quantity = goal_of(study, request, k);
    if (const auto cost = cost_of_limit(quantity, part.mixture, k))
      text +=
          fmt::format("binding: {}; raising its limit by 1 {} lowers the minimum margin by {:.3g} percentage points\n",
                      quantity.label(), quantity.limit()->unit, 100.0 * *cost);
    else
      text += fmt::format("binding: {}; requiring 1 more of it lowers the minimum by {:.3g}\n", quantity.label(),
                          part.mixture.prices.goals[k]);
  }
  for (std::size_t k = 0; k < request.part_constraints.size(); ++k)
    if (is_price(part.mixture.prices.means[k]))
      text +=
          fmt::format("binding: {} as a mean over the part; increasing this limit by 1 changes the merit by {:.3g}\n",
                      request.part_constraints[k].text(), part.mixture.prices.means[k]);
  return text;
}

std::string proof_text(const Composition& composition) {
  const std::size_t cells = composition.catalogue.size();
  if (!composition.complete)
    return fmt::format("best part so far, with the {} cells evaluated before the interruption\n", cells);
  switch (composition.proof) {
    case Proof::family: return fmt::format("optimal: all {} cells of the family were evaluated\n", cells);
    case Proof::catalogue:
      return fmt::format("optimal for the {} evaluated cells; best part found for the continuous family: {}\n", cells,
                         composition.has_converged
                             ? "the last search with dual prices found no cell that improves it"
                             : "the last search with dual prices still found cells that improve it");
    case Proof::none: break;
  }
  return fmt::format(
      "best part found with the {} evaluated cells: the search was stopped early; the optimum is at most {:.6g}\n",
      cells, composition.best->mixture.bound);
}

std::string worth_text(const Study& study, const ComposeRequest& request, const Composition& composition) {
  const bool margins = are_margins(study, request);
  const auto shown = [&](double value) { return goal_value_text(value, margins) + (margins ? " %" : ""); };
  std::string text;
  for (const PartOfZones& of : composition.by_zones)
    text += fmt::format("{}{} zone{}: {}", text.empty() ? "minimum with at most " : ", ", of.max_zones,
                        of.max_zones == 1 ? "" : "s", shown(of.mixture.min_goal));
  text += fmt::format("\n{} with any number of zones\n", shown(composition.unlimited_merit));
  for (const FrontPart& at : composition.front)
    text +=
        fmt::format("Pareto front: {} = {:.6g}, minimum {}\n", request.front->quantity, at.mean, shown(at.min_goal));
  return text;
}

}  // namespace

std::string composition_text(const Study& study, const ComposeRequest& request, const Composition& composition) {
  if (!composition.best)
    return composition.complete ? "no part: " + composition.infeasible_reason + "\n" : std::string();
  const PartOfZones& part = *composition.best;
  std::string text = zones_text(study, part.zones) + "\n" + goals_text(study, request, part) + "\n";
  const bool margins = are_margins(study, request);
  text +=
      fmt::format("minimum of all goals: {}{}\n", goal_value_text(part.mixture.min_goal, margins), margins ? " %" : "");
  if (!request.price.empty()) text += fmt::format("minimum minus the prices: {:.6g}\n", part.mixture.merit);
  text += prices_text(study, request, part) + worth_text(study, request, composition) + proof_text(composition);
  if (composition.errors)
    text +=
        "\n" + error_effects_text(request, *composition.errors, zones_text(study, robust_zones(composition)), margins);
  return text;
}

std::string why_not_reached(const Study& study, const ComposeRequest& request, const Composition& composition) {
  if (!composition.complete) return {};
  if (!composition.best) return composition.infeasible_reason;
  const Mixture& mixture = composition.best->mixture;
  if (!request.min_goal || mixture.min_goal >= *request.min_goal) return {};
  std::string text;
  for (std::size_t k = 0; k < request.goals.size(); ++k)
    if (is_price(mixture.prices.goals[k]))
      text += fmt::format("{}{} ({:.3f})", text.empty() ? "" : ", ", goal_of(study, request, k).label(),
                          mixture.prices.goals[k]);
  return fmt::format(
      "for the best part, the minimum of all goals is {:.6g}, but {} is required. The goals that limit this minimum, "
      "with their weights, are: {}. No mixture of the {} cells has a weighted mean of these goals above {:.6g}",
      mixture.min_goal, shortest(*request.min_goal), text, composition.catalogue.size(), mixture.min_goal);
}

}  // namespace retrace::studies
