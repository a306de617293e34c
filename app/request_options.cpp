#include "app/request_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/overloaded.h"

namespace retrace::app {
namespace {

using requests::Row;

/// Description (row) of a field of a request, and the request to which the field belongs.
struct FieldOfCommand {
  const CommandRequest* of;
  const Row* row;
};

/// Option of a command, and the fields of its requests that the option sets.
struct SharedOption {
  std::string option;
  std::vector<FieldOfCommand> fields;
};

std::vector<SharedOption> options_of(std::span<const CommandRequest> of_command) {
  std::vector<SharedOption> options;
  for (const CommandRequest& of : of_command)
    for (const Row& row : of.request.rows) {
      if (row.spelling.is_no_option) continue;
      const std::string option = requests::option_of(row);
      auto found = std::ranges::find(options, option, &SharedOption::option);
      if (found == options.end()) found = options.insert(options.end(), {option, {}});
      found->fields.push_back({&of, &row});
    }
  return options;
}

/// Returns true if the help text shows the initial value of the field as its default, and not a special text. If the
/// option sets only this field, the command-line parser adds the default to the help text as "=VALUE".
bool has_plain_default(const Row& row) {
  return row.spelling.otherwise.empty() && row.spelling.usual.empty();
}

/// Returns the description of a field for the help text. It includes the unit, unless the name of the option ends with
/// the unit.
std::string meaning_of(const FieldOfCommand& field) {
  const std::string_view unit = schema::unit_of(field.row->name);
  std::string suffix(field.row->name.substr(field.row->name.rfind('_') + 1));
  const bool is_named = unit.empty() || requests::option_of(*field.row).ends_with("-" + suffix);
  const bool is_absent = field.row->spelling.notation == requests::Notation::absent;
  std::string text = (is_absent ? "do not " : "") + std::string(field.row->meaning);
  if (!is_named) text.insert(std::min(text.find(';'), text.size()), fmt::format(", in {}", unit));
  return text;
}

/// Returns the name of a request in help texts, such as "camera". Returns an empty text if the command has only one
/// request.
std::string mode_text(const CommandRequest& of) {
  return of.mode.empty() ? of.label : of.mode.substr(2);
}

/// Returns the help text of an option. If the command has several requests, each description begins with the names of
/// the requests to which it applies, such as "camera, road: DESCRIPTION".
std::string help_of(const SharedOption& option) {
  struct Part {
    std::string text;
    Words modes;
  };
  std::vector<Part> parts;
  for (const FieldOfCommand& field : option.fields) {
    const bool is_flag = std::holds_alternative<schema::Flag>(field.row->kind);
    const std::string otherwise = is_flag ? "" : requests::default_text(field.of->request, *field.row);
    const bool is_shown_by_parser = option.fields.size() == 1 && has_plain_default(*field.row);
    const std::string text =
        meaning_of(field) + (otherwise.empty() || is_shown_by_parser ? "" : fmt::format(" [{}]", otherwise));
    auto same = std::ranges::find(parts, text, &Part::text);
    if (same == parts.end()) same = parts.insert(parts.end(), {text, {}});
    same->modes.push_back(mode_text(*field.of));
  }
  Words texts;
  for (const Part& part : parts)
    texts.push_back(part.modes.front().empty() ? part.text
                                               : fmt::format("{}: {}", fmt::join(part.modes, ", "), part.text));
  return fmt::format("{}", fmt::join(texts, "; "));
}

Words words_of_list(std::span<const std::string_view> words) {
  return {words.begin(), words.end()};
}

/// Returns the traits of an option with the possible values of its field. Shell completion uses these values.
Traits traits_of(const schema::Kind& kind) {
  return std::visit(Overloaded{[](const schema::Word& word) { return one_of(words_of_list(word.words)); },
                               [](const schema::File&) { return files(""); },
                               [](const schema::WordOrFile& either) {
                                 return one_of(words_of_list(either.words), std::string(either.ending));
                               },
                               [](const auto&) { return Traits(); }},
                    kind);
}

Condition condition_of(const requests::Request& request, const schema::Condition& condition) {
  using Is = schema::Condition::Is;
  const Row* const row = requests::row_of(request, condition.key);
  const std::string option = row != nullptr ? requests::option_of(*row) : "--" + std::string(condition.key);
  if (condition.is == Is::given) return {Condition::Kind::given, option};
  if (condition.is == Is::absent) return {Condition::Kind::absent, option};
  return {Condition::Kind::value, option, words_of_list(condition.words)};
}

/// Returns the conditions under which an option is allowed. If options such as "--camera" select the request of the
/// command, a request to which `option` belongs must be selected. The conditions of its fields are added only if they
/// are the same for all fields.
std::vector<Need> needs_of(const SharedOption& option) {
  std::vector<Need> needs;
  Words modes;
  for (const FieldOfCommand& field : option.fields)
    if (!field.of->mode.empty()) modes.push_back(field.of->mode);
  if (!modes.empty()) needs.push_back(any_given(modes));
  const FieldOfCommand& first = option.fields.front();
  const auto has_same_needs = [&](const FieldOfCommand& field) {
    return field.row->needs.data() == first.row->needs.data();
  };
  if (!std::ranges::all_of(option.fields, has_same_needs)) return needs;
  for (const requests::Need& need : first.row->needs) {
    Need of_option;
    for (const schema::Condition& condition : need) of_option.push_back(condition_of(first.of->request, condition));
    needs.push_back(std::move(of_option));
  }
  return needs;
}

/// Returns the placeholder for the value of an option in the help text. If the fields of the option have different
/// placeholders, these are joined, such as "N|CxR".
std::string placeholder(const SharedOption& option) {
  Words values;
  for (const FieldOfCommand& field : option.fields)
    if (const std::string value(field.row->spelling.value); std::ranges::count(values, value) == 0)
      values.push_back(value);
  return fmt::format("{}", fmt::join(values, "|"));
}

Argument argument_of(const SharedOption& option, FieldTexts& texts) {
  const FieldOfCommand& first = option.fields.front();
  Argument argument{option.option, help_of(option), {}, traits_of(first.row->kind)};
  argument.traits.needs = needs_of(option);
  argument.traits.required = first.row->is_required;
  if (std::holds_alternative<schema::Flag>(first.row->kind)) {
    argument.target = &texts.flags[option.option];
    return argument;
  }
  argument.name += " " + placeholder(option);
  argument.target = &texts.values[option.option];
  if (option.fields.size() == 1 && has_plain_default(*first.row))
    argument.shown_default = requests::default_text(first.of->request, *first.row);
  return argument;
}

}  // namespace

std::vector<Argument> field_arguments(std::span<const CommandRequest> of_command, FieldTexts& texts) {
  std::vector<Argument> arguments;
  for (const SharedOption& option : options_of(of_command)) arguments.push_back(argument_of(option, texts));
  return arguments;
}

void set_fields(const requests::Request& request, void* object, const FieldTexts& texts, const CommonOptions& common) {
  for (const Row& row : request.rows) {
    if (row.name == "seed") requests::set(row, object, static_cast<double>(common.seed));
    const std::string option = requests::option_of(row);
    if (const auto flag = texts.flags.find(option); flag != texts.flags.end() && flag->second)
      requests::set(row, object, row.spelling.notation != requests::Notation::absent);
    if (const auto text = texts.values.find(option); text != texts.values.end() && text->second)
      requests::set_text(row, object, *text->second);
  }
}

}  // namespace retrace::app
