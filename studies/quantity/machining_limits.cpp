#include "studies/quantity/machining_limits.h"

#include <algorithm>
#include <string>
#include <utility>

#include "studies/quantity/io/study_reader.h"
#include "studies/quantity/study_names.h"

namespace retrace::studies {
namespace {

/// Returns true if the study file gives a key, or if a parameter of the study varies it.
bool is_given(const Study& study, const std::string& key) {
  return study.document->has(key) || std::ranges::any_of(study.parameters, [&](const Parameter& parameter) {
           return std::ranges::count(parameter.keys, key) > 0;
         });
}

/// Limit of the tool or the machine. The quantity must be at least 0.
struct MachiningLimit {
  const char* quantity;
  PlainQuantity kind;
  const char* key;  ///< key that must be given for the limit to apply
  bool needs_machine;
};
constexpr MachiningLimit kLimits[] = {
    {"tool_fit_mm", PlainQuantity::tool_fit_mm, "machining.tool_width_mm", false},
    {"machine_travel_mm", PlainQuantity::machine_travel_mm, "machining.machine", true},
    {"edge_life_margin_mm", PlainQuantity::edge_life_margin_mm, "machining.edge_life_mm", true}};

/// Returns true if the study takes the limits of the tool and the machine into account. Its first design must be an
/// array of prisms.
bool respects_limits(const Study& study) {
  try {
    const Candidate candidate = make_candidate(study, example_values(study));
    const design::Design& design = candidate.design();
    return candidate.machining().has_limits && design.elements() != nullptr &&
           std::holds_alternative<geometry::RtpElement>(design.part().element);
  } catch (const InputError&) {
    return false;  // an invalid design is reported when it is evaluated
  }
}

}  // namespace

std::vector<Constraint> machining_limits(const Study& study) {
  std::vector<Constraint> limits;
  const bool has_machine = is_given(study, "machining.machine");
  for (const MachiningLimit& limit : kLimits)
    if (is_given(study, limit.key) && (has_machine || !limit.needs_machine))
      limits.push_back({limit.quantity, 0.0, {}});
  if (!limits.empty() && !respects_limits(study)) limits.clear();
  return limits;
}

void add_machining_limits(const Study& study, std::vector<Constraint>& constraints) {
  const std::vector<Constraint> given = constraints;
  for (const Constraint& limit : machining_limits(study)) {
    const auto is_same = [&](const Constraint& constraint) { return constraint.quantity == limit.quantity; };
    if (quantity_named(study, limit.quantity) != nullptr && std::ranges::none_of(given, is_same))
      constraints.push_back(limit);
  }
}

Study with_machining_limits(Study study) {
  for (const Constraint& limit : machining_limits(study)) {
    if (quantity_named(study, limit.quantity) != nullptr) continue;
    for (const MachiningLimit& each : kLimits)
      if (limit.quantity == each.quantity) study.quantities.push_back(make_plain(each.quantity, each.kind));
  }
  return study;
}

}  // namespace retrace::studies
