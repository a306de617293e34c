#include "app/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/requirement_text.h"
#include "core/schema/reader.h"
#include "design/io/design_format.h"

namespace retrace::app {

std::span<const Command> commands() {
  static const std::vector<Command> all = {
      rre_command(),       inspect_command(), photometry_command(), roughness_command(), metrology_command(),
      sweep_command(),     job_command(),     fabricate_command(),  optimize_command(),  compose_command(),
      tolerance_command(), verify_command(),  calibrate_command(),  correct_command(),   forces_command(),
      turn_command(),      plane_command(),   image_command(),      ranging_command(),   rays_command(),
      export_command(),    report_command(),  explore_command(),    validate_command(),  init_command(),
      list_command(),      schema_command(),  manual_command(),     completion_command()};
  return all;
}

Traits one_of(std::function<Words()> words, std::optional<std::string> files) {
  return {.words = std::move(words), .files = std::move(files)};
}

Traits one_of(Words words, std::optional<std::string> files) {
  return one_of([words = std::move(words)] { return words; }, std::move(files));
}

Traits files(const std::string& ending) {
  return {.files = ending};
}

Traits integer(std::uint64_t min, std::uint64_t max) {
  return {.min = min, .max = max};
}

Traits not_with(const std::string& option) {
  return {.excludes = option};
}

Need any_given(const Words& options) {
  Need need;
  for (const std::string& option : options) need.push_back({Condition::Kind::given, option});
  return need;
}

Need absent(const std::string& option) {
  return {{Condition::Kind::absent, option}};
}

std::string text_of(const Need& need) {
  Words required;
  Words excluded;
  for (const Condition& condition : need) {
    if (condition.kind == Condition::Kind::absent)
      excluded.push_back(condition.option);
    else if (condition.kind == Condition::Kind::given)
      required.push_back(condition.option);
    else
      required.push_back(fmt::format("{} {}", condition.option, fmt::join(condition.values, " or ")));
  }
  return requirement_text(required, excluded);
}

Words option_names(const Argument& argument) {
  Words names;
  if (!argument.name.starts_with('-')) return names;
  const std::string all = argument.name.substr(0, argument.name.find(' '));
  for (std::size_t at = 0; at <= all.size(); at = all.find(',', at) + 1) {
    names.push_back(all.substr(at, all.find(',', at) - at));
    if (all.find(',', at) == std::string::npos) break;
  }
  return names;
}

std::string value_word(const Argument& argument) {
  if (!argument.name.starts_with('-')) return argument.name;
  const std::size_t space = argument.name.find(' ');
  return space == std::string::npos ? "" : argument.name.substr(space + 1);
}

std::string default_of(const Argument& argument) {
  if (!argument.shown_default.empty()) return argument.shown_default;
  const auto text = [](auto target) -> std::string {
    using Target = decltype(target);
    if constexpr (std::is_same_v<Target, std::string*>) return *target;
    if constexpr (std::is_same_v<Target, double*> || std::is_same_v<Target, std::uint32_t*> ||
                  std::is_same_v<Target, std::uint64_t*>)
      return fmt::format("{}", *target);
    return "";
  };
  return argument.traits.required ? "" : std::visit(text, argument.target);
}

bool may_be_repeated(const Argument& argument) {
  return std::holds_alternative<Words*>(argument.target);
}

bool may_be_missing(const Argument& argument) {
  return std::holds_alternative<std::optional<std::string>*>(argument.target);
}

std::string synopsis(const Command& command) {
  std::string text = "retrace " + command.name;
  for (const Argument& argument : command.begin().arguments)
    if (!argument.name.starts_with('-'))
      text += fmt::format(fmt::runtime(may_be_missing(argument)    ? " [{}]"
                                       : may_be_repeated(argument) ? " {}..."
                                                                   : " {}"),
                          argument.name);
  return text + " [options]";
}

std::vector<Argument> common_arguments(CommonOptions& common) {
  const auto keys = [] {
    Words words = schema::keys_of(design::design_format());
    for (std::string& word : words) word += '=';
    return words;
  };
  return {
      {"--json FILE", "write the result as JSON to FILE, or to standard output if FILE is -", &common.json,
       files(".json")},
      {"-o,--out DIR",
       "write the result's files to folder DIR; with init, job, export and validate, DIR is the file to write",
       &common.out, files("/")},
      {"--threads N", "number of threads [all cores that the process may use]", &common.threads, integer(1, 4096)},
      {"--memory-gib G", "memory budget of beams and elements in GiB; see Memory in docs/commands.md [1]",
       &common.memory_gib},
      {"--seed S", "seed of the random numbers", &common.seed, integer(0, std::numeric_limits<std::uint32_t>::max())},
      {"--set KEY=VALUE", "override a key of the design, such as element.base_mm=0.4; KEY= unsets the key",
       &common.overrides, one_of(keys)},
      {"--quiet", "print no progress bar, no note about long runs, no table and no warnings", &common.quiet},
      {"--version", "show the version and exit", {}},
      {"-h,--help", "show this help and exit", {}}};
}

}  // namespace retrace::app
