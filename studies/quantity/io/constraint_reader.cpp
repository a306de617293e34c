#include "studies/quantity/io/constraint_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/message_text.h"
#include "core/number_format.h"
#include "core/toml_file.h"

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
  const std::string_view meant = closest(name, names);
  throw InputError(where,
                   fmt::format("must be a quantity of the study ({}), got {}{}", alternatives(names), in_quotes(name),
                               meant.empty() ? "" : fmt::format("; did you mean {}?", in_quotes(meant))));
}

std::vector<Constraint> read_constraints(const Study& study) {
  TomlTable document = parse_toml(study.text, study.source, kShortTomlBytes);
  std::vector<Constraint> constraints;
  for (TomlTable& table : document.tables("constraint", "one or more tables [[constraint]]")) {
    Constraint constraint;
    const std::optional<std::string> name = table.text("quantity");
    if (!name) table.fail("quantity", "missing, must be a quantity of the study");
    constraint.quantity = checked_quantity(study, *name, table.where("quantity"));
    constraint.least = table.number("min");
    constraint.most = table.number("max");
    if (!constraint.least && !constraint.most) table.fail("max", "missing: a constraint has min, max or both");
    if (constraint.least && constraint.most && *constraint.least > *constraint.most)
      table.fail("max",
                 fmt::format("must be >= min ({}), got {}", shortest(*constraint.least), shortest(*constraint.most)));
    table.finish();
    constraints.push_back(constraint);
  }
  return constraints;
}

}  // namespace retrace::studies
