#include "studies/quantity/machining_limits.h"

#include <algorithm>
#include <string>
#include <utility>

#include "studies/quantity/io/study_reader.h"

namespace retrace::studies {
namespace {

/// Returns true if a parameter of the study sets the key, or if the study file gives it.
bool is_given(const Study& study, const std::string& key) {
  return study.document->has(key) || std::ranges::any_of(study.parameters, [&](const Parameter& parameter) {
           return std::ranges::count(parameter.keys, key) > 0;
         });
}

bool has_prisms(const Study& study) {
  try {
    const design::Design design = make_candidate(study, example_values(study)).design();
    return design.elements() != nullptr && std::holds_alternative<geometry::RtpElement>(design.part().element);
  } catch (const InputError&) {
    return false;  // the study reports an invalid design when it computes the design
  }
}

}  // namespace

std::vector<Constraint> machining_limits(const Study& study) {
  std::vector<Constraint> limits;
  if (study.document->text("machining.limits") == "ignore") return limits;
  const auto add = [&](const char* quantity) { limits.push_back({quantity, 0.0, {}}); };
  if (is_given(study, "machining.tool_width_mm")) add("tool_fit_mm");
  const bool has_machine = is_given(study, "machining.machine");
  if (has_machine) add("machine_travel_mm");
  if (has_machine && is_given(study, "machining.edge_life_mm")) add("edge_life_margin_mm");
  if (!limits.empty() && !has_prisms(study)) limits.clear();
  return limits;
}

Study with_machining_limits(Study study) {
  constexpr std::pair<const char*, PlainQuantity> kinds[] = {
      {"tool_fit_mm", PlainQuantity::tool_fit_mm},
      {"machine_travel_mm", PlainQuantity::machine_travel_mm},
      {"edge_life_margin_mm", PlainQuantity::edge_life_margin_mm}};
  for (const Constraint& limit : machining_limits(study)) {
    if (std::ranges::any_of(study.quantities, [&](const auto& each) { return each->name() == limit.quantity; }))
      continue;
    for (const auto& [name, kind] : kinds)
      if (limit.quantity == name) study.quantities.push_back(make_plain(name, kind));
  }
  return study;
}

}  // namespace retrace::studies
