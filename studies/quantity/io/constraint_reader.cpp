#include "studies/quantity/io/constraint_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/message_text.h"
#include "core/number_format.h"
#include "studies/quantity/io/study_format.h"

namespace retrace::studies {
namespace {

std::vector<std::string_view> names_of(const Study& study) {
  std::vector<std::string_view> names;
  for (const auto& quantity : study.quantities) names.push_back(quantity->name());
  return names;
}

}  // namespace

std::string checked_quantity(const Study& study, const std::string& name, const InputLocation& where) {
  const std::vector<std::string_view> names = names_of(study);
  if (std::find(names.begin(), names.end(), name) != names.end()) return name;
  for (const std::string_view each : names)
    if (current_kind(each) == current_kind(name)) return std::string(each);
  const std::string_view meant = closest_match(name, names);
  throw InputError(where,
                   fmt::format("must be a quantity of the study ({}), got {}{}", alternatives(names), in_quotes(name),
                               meant.empty() ? "" : fmt::format("; did you mean {}?", in_quotes(meant))));
}

namespace {

Constraint read_constraint(const Study& study, const std::string& at) {
  const schema::Document& document = *study.document;
  Constraint constraint;
  constraint.quantity = checked_quantity(study, document.text(at + ".quantity"), document.where(at + ".quantity"));
  constraint.min = document.number_if(at + ".min");
  constraint.max = document.number_if(at + ".max");
  if (!constraint.min && !constraint.max)
    document.fail(at + ".max", "is missing: a constraint requires min, max or both");
  if (constraint.min && constraint.max && *constraint.min > *constraint.max)
    document.fail(at + ".max",
                  fmt::format("must be >= min ({}), got {}", shortest(*constraint.min), shortest(*constraint.max)));
  return constraint;
}

}  // namespace

std::vector<Constraint> read_constraints(const Study& study) {
  std::vector<Constraint> constraints;
  for (std::size_t k = 0; k < study.document->count("constraint"); ++k) {
    const std::string at = schema::path_of_entry("constraint", k);
    if (study.document->choice<ConstraintOver>(at + ".over") == ConstraintOver::part)
      study.document->fail(at + ".over", "\"part\" is only allowed for retrace compose, whose parts have many cells");
    constraints.push_back(read_constraint(study, at));
  }
  return constraints;
}

std::vector<Constraint> read_constraints(const Study& study, ConstraintOver over) {
  std::vector<Constraint> constraints;
  for (std::size_t k = 0; k < study.document->count("constraint"); ++k) {
    const std::string at = schema::path_of_entry("constraint", k);
    const Constraint constraint = read_constraint(study, at);
    if (study.document->choice<ConstraintOver>(at + ".over") == over) constraints.push_back(constraint);
  }
  return constraints;
}

}  // namespace retrace::studies
