#include "studies/compose/io/compose_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/message_text.h"
#include "core/number_format.h"
#include "studies/compose/cell_errors.h"
#include "studies/quantity/io/constraint_reader.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/quantity/machining_limits.h"
#include "studies/quantity/study_names.h"

namespace retrace::studies {
namespace {

using schema::Document;

/// Returns the quantities with a name: the quantity `name` itself, or all quantities `name.*`.
std::vector<std::string> quantities_of(const Study& study, const std::string& name) {
  std::vector<std::string> found;
  for (const auto& quantity : study.quantities)
    if (quantity->name() == name || quantity->name().starts_with(name + ".")) found.push_back(quantity->name());
  if (found.empty()) found.push_back(checked_quantity(study, name, study.document->where("compose.maximize")));
  return found;
}

/// Checks that the quantity adds up: its value for a mixture of cells must be the area-weighted mean of its values for
/// the cells.
/// \return name of the quantity, as returned by checked_quantity()
std::string checked_mean(const Study& study, const std::string& given, const InputLocation& where) {
  const std::string name = checked_quantity(study, given, where);
  if (!quantity_named(study, name)->is_additive())
    throw InputError(where,
                     fmt::format("{} is the minimum of several values, which cannot be averaged over zones: make each "
                                 "value a quantity with points = \"each_reading\" or over_directions = \"each\"",
                                 in_quotes(name)));
  return name;
}

std::vector<std::string> read_goals(const Document& document, const Study& study) {
  std::vector<std::string> goals;
  for (const std::string& name : document.texts("compose.maximize"))
    for (std::string& goal : quantities_of(study, name)) {
      if (std::ranges::count(goals, goal) > 0)
        document.fail("compose.maximize", fmt::format("must contain each quantity only once, got {} twice", goal));
      checked_mean(study, goal, document.where("compose.maximize"));
      goals.push_back(std::move(goal));
    }
  return goals;
}

bool are_all_margins(const Study& study, const std::vector<std::string>& goals) {
  return std::ranges::all_of(study.quantities, [&](const auto& quantity) {
    return quantity->limit().has_value() || std::ranges::count(goals, quantity->name()) == 0;
  });
}

void check_fractions(const Document& document, const ComposeRequest& request) {
  if (request.min_area_fraction > request.max_area_fraction)
    document.fail("compose.min_area_fraction",
                  fmt::format("must be <= max_area_fraction ({}), got {}", shortest(request.max_area_fraction),
                              shortest(request.min_area_fraction)));
  if (request.max_zones && static_cast<double>(*request.max_zones) * request.max_area_fraction < 1.0 - 1e-12)
    document.fail(
        "compose.max_area_fraction",
        fmt::format(
            "must be >= 1 / max_zones (max_zones = {}), because otherwise the zones cannot fill the part, got {}",
            *request.max_zones, shortest(request.max_area_fraction)));
}

void check_parameters(const Study& study) {
  for (const Parameter& parameter : study.parameters)
    if (parameter.distribution)
      throw InputError(parameter.location,
                       "a distribution is not allowed in a composition: give values, or from and to");
}

/// Returns the constraints on cells, and the constraints that follow from the tool and the machine of the study. A
/// constraint on the mean over the part does not replace a limit, because each cell must be machined.
std::vector<Constraint> cell_constraints_of(const Study& study) {
  std::vector<Constraint> constraints = read_constraints(study, ConstraintOver::cell);
  add_machining_limits(study, constraints);
  return constraints;
}

/// Checks that each cell has only one kind of element. Cells that cannot be made are accepted here; the search reports
/// them as failed points.
void check_cells(const Study& study) {
  std::optional<Candidate> cell;
  try {
    cell = make_candidate(study, example_values(study));
  } catch (const InputError&) {
    return;
  }
  design::require_supported(cell->design(), {.what = "retrace compose", .wet_backs = true});
}

/// Reads the standard deviations of angle errors. Returns nothing if the study has none.
/// \throw InputError if cells have no angles between facets
std::optional<ErrorSpread> read_errors(const Document& document, const Study& study) {
  const auto cells = document.number_if("compose.cell_sigma_arcmin");
  const auto zones = document.number_if("compose.zone_sigma_arcmin");
  const char* const key = zones ? "compose.zone_sigma_arcmin" : "compose.cell_sigma_arcmin";
  if (!cells && !zones) {
    if (document.has("compose.worst_fraction"))
      document.fail("compose.worst_fraction",
                    "requires compose.cell_sigma_arcmin or compose.zone_sigma_arcmin, because all parts are equal "
                    "without angle errors");
    return std::nullopt;
  }
  if (angles_of(study, example_values(study)) == 0)
    document.fail(key, "not allowed, because the cells have no angles between facets");
  ErrorSpread spread{cells.value_or(0.0), zones.value_or(0.0), {}, document.number_if("compose.worst_fraction")};
  spread.parts = static_cast<std::size_t>(document.number("compose.parts"));
  return spread;
}

}  // namespace

ComposeRequest read_compose(const Study& study) {
  const Document& document = *study.document;
  if (!document.has("compose")) document.fail("compose", "is missing; it must be a table with the key maximize");
  check_parameters(study);
  check_cells(study);
  ComposeRequest request;
  request.goals = read_goals(document, study);
  request.cell_constraints = cell_constraints_of(study);
  request.part_constraints = read_constraints(study, ConstraintOver::part);
  for (const Constraint& constraint : request.part_constraints)
    checked_mean(study, constraint.quantity, document.where("constraint"));
  request.min_goal = document.number_if("compose.min_goal");
  if (!request.min_goal && are_all_margins(study, request.goals)) request.min_goal = 0.0;
  request.min_area_fraction = document.number("compose.min_area_fraction");
  request.max_area_fraction = document.number("compose.max_area_fraction");
  if (const auto most = document.number_if("compose.max_zones")) request.max_zones = static_cast<std::size_t>(*most);
  if (const auto step = document.number_if("compose.area_fraction_step")) {
    const double steps = 1.0 / *step;
    if (std::abs(steps - std::round(steps)) > 1e-9 * steps)
      document.fail(
          "compose.area_fraction_step",
          fmt::format("must divide the whole area into equal steps, such as 0.01 or 0.05, got {}", shortest(*step)));
    request.area_steps = static_cast<std::size_t>(std::llround(steps));
  }
  check_fractions(document, request);
  if (document.has("compose.price"))
    for (const auto& [name, price] : document.named("compose.price"))
      request.price.emplace_back(checked_mean(study, name, document.where("compose.price." + name)),
                                 std::get<double>(price));
  if (document.has("compose.front")) {
    if (document.named("compose.front").size() != 1)
      document.fail("compose.front", "must contain exactly one quantity");
    const auto& [name, sense] = *document.named("compose.front").begin();
    request.front = FrontAxis{checked_mean(study, name, document.where("compose.front." + name)),
                              std::get<std::string>(sense) == "max"};
  }
  request.scan = static_cast<std::size_t>(document.number("compose.scan"));
  request.rounds = static_cast<std::size_t>(document.number("compose.rounds"));
  request.starts = static_cast<std::size_t>(document.number("compose.starts"));
  request.evaluations_per_start = static_cast<int>(document.number("compose.evaluations_per_start"));
  request.errors = read_errors(document, study);
  return request;
}

}  // namespace retrace::studies
