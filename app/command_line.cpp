#include "app/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <optional>
#include <regex>

#include "app/commands.h"
#include "app/output.h"
#include "core/leading_number.h"
#include "core/memory_budget.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/requirement_text.h"
#include "core/text.h"
#include "core/version.h"
#include "requests/row.h"

namespace retrace::app {
namespace {

const std::string kVersionText = std::string("retrace ") + kVersion;

/// Returns a check for decimal whole numbers from `low` to `high`. Leading zeros are refused, because CLI11 would read
/// 010 as an octal number.
CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
  const auto check = [low, high](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number =
        error == std::errc{} && end == text.data() + text.size() && (text.size() == 1 || text.front() != '0');
    if (is_number && value >= low && value <= high) return {};
    return fmt::format("must be a whole number from {} to {}, got {}", low, high, printable(text));
  };
  return {check, "", "WHOLE"};
}

CLI::Validator real_number() {
  const auto check = [](const std::string& text) -> std::string {
    const std::optional<LeadingNumber> number = leading_number(text);
    if (number && number->length == text.size()) return {};
    return fmt::format("must be a number, got {}", printable(text));
  };
  return {check, "", "REAL"};
}

/// Returns a check that refuses empty file names. An empty name usually comes from an unset shell variable.
CLI::Validator not_empty() {
  return {[](const std::string& text) { return text.empty() ? "must not be empty" : ""; }, "", "NAME"};
}

/// Adds the check of the value to an option, depending on the type of the value.
template <class Value>
void add_check(CLI::Option& option, const Traits& traits) {
  if constexpr (std::is_same_v<Value, double> || std::is_same_v<Value, std::optional<double>>)
    option.check(real_number());
  else if constexpr (std::is_integral_v<Value> || std::is_same_v<Value, std::optional<std::uint32_t>> ||
                     std::is_same_v<Value, std::optional<std::uint64_t>>)
    option.check(whole_number(traits.min, traits.max));
  else if (traits.files)
    option.check(not_empty());
}

/// Returns true if the help text of the argument begins with the options of which one is required, such as
/// "camera, road: TEXT" for --camera and --road.
bool is_at_start(const Need& need, const Argument& argument) {
  Words modes;
  for (const Condition& condition : need)
    if (condition.kind == Condition::Kind::given) modes.push_back(condition.option.substr(2));
  return modes.size() == need.size() && argument.help.starts_with(fmt::format("{}: ", fmt::join(modes, ", ")));
}

/// Returns the help text of an argument, followed by its requirements.
std::string help_of(const Argument& argument) {
  Words needs;
  for (const Need& need : argument.traits.needs)
    if (!is_at_start(need, argument)) needs.push_back(text_of(need));
  return needs.empty() ? argument.help : fmt::format("{} ({})", argument.help, fmt::join(needs, "; "));
}

template <class Value>
void add_value(CLI::App& app, const Argument& argument, Value& value) {
  const bool has_place = option_names(argument).empty();
  CLI::Option& option = *app.add_option(argument.name.substr(0, argument.name.find(' ')), value, help_of(argument));
  if (!has_place) option.type_name(value_word(argument));
  if (may_be_repeated(argument) && !has_place) option.take_all()->allow_extra_args(false);
  add_check<Value>(option, argument.traits);
  if (!argument.shown_default.empty())
    option.default_str(argument.shown_default);
  else if (!default_of(argument).empty())
    option.capture_default_str();
  option.required(argument.traits.required || (has_place && !may_be_missing(argument)));
}

void add(CLI::App& app, const Argument& argument) {
  const auto add_one = [&](auto value) {
    if constexpr (std::is_same_v<decltype(value), std::monostate>)
      argument.name == "--version" ? app.set_version_flag("--version", kVersionText, argument.help)
                                   : app.set_help_flag(argument.name, argument.help);
    else if constexpr (std::is_same_v<decltype(value), bool*>)
      app.add_flag(argument.name, *value, help_of(argument));
    else
      add_value(app, argument, *value);
  };
  std::visit(add_one, argument.target);
}

void add(CLI::App& app, const std::vector<Argument>& arguments) {
  for (const Argument& argument : arguments) add(app, argument);
  for (const Argument& argument : arguments) {
    const std::string& excludes = argument.traits.excludes;
    if (!excludes.empty()) app.get_option(option_names(argument).back())->excludes(app.get_option(excludes));
  }
}

/// Values of the options after the command line has been parsed.
class GivenOptions {
 public:
  /// \param command parser of the command; the options that all commands have belong to its parent parser
  /// \param arguments arguments of the command, without the options of all commands
  GivenOptions(const CLI::App& command, const std::vector<Argument>& arguments)
      : command_(command), arguments_(arguments) {}

  bool is_given(const std::string& name) const { return option(name).count() > 0; }

  /// Returns the value of an option as given on the command line. If the option is not given, returns its default, or
  /// an empty text if it has none.
  std::string value(const std::string& name) const {
    if (is_given(name)) return option(name).results().back();
    for (const Argument& argument : arguments_)
      if (std::ranges::count(option_names(argument), name) > 0) return default_of(argument);
    return "";
  }

  bool holds(const Condition& condition) const {
    switch (condition.kind) {
      case Condition::Kind::given: return is_given(condition.option);
      case Condition::Kind::absent: return !is_given(condition.option);
      case Condition::Kind::value: return std::ranges::count(condition.values, value(condition.option)) > 0;
    }
    return false;
  }

 private:
  const CLI::Option& option(const std::string& name) const {
    const CLI::Option* const own = command_.get_option_no_throw(name);
    return own != nullptr ? *own : *command_.get_parent()->get_option(name);
  }

  const CLI::App& command_;
  const std::vector<Argument>& arguments_;
};

/// Checks the requirements of all options that are given. If a requirement refers to the value of another option and
/// that value is unknown, such as a misspelled engine, the requirement is skipped. The command reports the unknown
/// value itself.
/// \throw InputError if a requirement is not met, because the option would have no effect
void check_needs(const GivenOptions& options, const std::vector<Argument>& arguments) {
  const auto has_unknown_value = [&](const Condition& condition) {
    if (condition.kind != Condition::Kind::value) return false;
    const auto found = std::ranges::find_if(arguments, [&](const Argument& argument) {
      return std::ranges::count(option_names(argument), condition.option) > 0;
    });
    return std::ranges::count(found->traits.words(), options.value(condition.option)) == 0;
  };
  for (const Argument& argument : arguments) {
    if (argument.traits.needs.empty() || !options.is_given(option_names(argument).back())) continue;
    for (const Need& need : argument.traits.needs) {
      const auto holds = [&](const Condition& condition) {
        return options.holds(condition) || has_unknown_value(condition);
      };
      if (std::ranges::any_of(need, holds)) continue;
      const Condition& first = need.front();
      const bool is_of_value = first.kind == Condition::Kind::value;
      throw InputError({"", 0, option_names(argument).back()},
                       text_of(need) + (is_of_value ? ", got " + printable(options.value(first.option)) : ""));
    }
  }
}

/// Returns the names of the commands as "a, b and c".
std::string names_of(std::span<const Command> all) {
  Words names;
  for (const Command& command : all) names.push_back(command.name);
  return in_words(names, "and");
}

/// Returns the error message for the first unknown option of a command line, or nothing if there is none. The message
/// names the most similar option of the command, if there is one.
std::optional<std::string> unknown_option(const CLI::App& app) {
  const std::vector<std::string> unknown = app.remaining(true);
  const auto word = std::ranges::find_if(unknown, [](const std::string& text) { return text.starts_with('-'); });
  if (word == unknown.end()) return std::nullopt;
  std::vector<std::string> options;
  const auto add_options_of = [&](const CLI::App& of) {
    for (const CLI::Option* const option : of.get_options())
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  };
  add_options_of(app);
  for (const CLI::App* const command : app.get_subcommands()) add_options_of(*command);
  const std::vector<std::string_view> names(options.begin(), options.end());
  const std::string_view similar = closest_match(std::string_view(*word).substr(0, word->find('=')), names);
  return "unknown option " + printable(*word) + (similar.empty() ? "" : fmt::format(", did you mean {}?", similar));
}

/// Returns the error message for a command line with words that the command does not know, or an empty text if there
/// are none.
std::string unknown_word(const CLI::App& app) {
  if (const auto option = unknown_option(app)) return *option;
  const std::vector<std::string> unknown = app.remaining(true);
  if (unknown.empty()) return {};
  const std::string_view what = app.get_subcommands().empty() ? "command" : "argument";
  return fmt::format("unknown {} {}", what, printable(unknown.front()));
}

/// Returns the error message for a command line in which the command or a required argument is missing. If the command
/// line contains an unknown option or command, the message names this word.
/// \param otherwise message if the command line contains no unknown word
std::string missing(const CLI::App& app, const std::string& otherwise) {
  if (const auto option = unknown_option(app)) return *option;
  if (!app.get_subcommands().empty()) return otherwise;
  const std::string unknown = unknown_word(app);
  return (unknown.empty() ? "a command is required" : unknown) + "; the commands are " + names_of(commands());
}

/// Returns an error message of CLI11 as one line, in which long words are shortened.
std::string one_line(const std::string& text) {
  std::string line;
  for (const std::string_view word : words_in(text)) line += (line.empty() ? "" : " ") + printable(word);
  return line;
}

/// Returns the message of an error of CLI11 as one line, in the words of the other messages.
std::string message_of(const CLI::ParseError& error) {
  const std::string line = one_line(error.what());
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr)
    return std::regex_replace(line, std::regex(" excludes "), ": not allowed together with ");
  return std::regex_replace(line, std::regex(": [0-9]+ required (\\S+) missing$"), ": requires a value $1");
}

/// Sets the memory budget of the process if --memory-gib is given.
/// \throw InputError if the value is out of range
void set_memory_budget(const CommonOptions& common) {
  constexpr double kMinGiB = 0.01, kMaxGiB = 65536.0;
  if (!common.memory_gib) return;
  if (!(*common.memory_gib >= kMinGiB && *common.memory_gib <= kMaxGiB))
    throw InputError({"", 0, "--memory-gib"}, fmt::format("must be a number from {} to {}, got {}", shortest(kMinGiB),
                                                          shortest(kMaxGiB), shortest(*common.memory_gib)));
  set_memory_budget_bytes(static_cast<std::uint64_t>(*common.memory_gib * 0x1p30));
}

/// Replaces the options of former versions by the current ones, with a warning for each.
std::vector<std::string> with_current_options(int argc, const char* const* argv) {
  std::vector<std::string> words(argv, argv + argc);
  for (const requests::Request* const request : requests::all_requests())
    for (const requests::Row& row : request->rows) {
      const std::string former = requests::former_option_of(row);
      if (former.empty()) continue;
      for (std::string& word : words) {
        if (word != former && !word.starts_with(former + "=")) continue;
        word.replace(0, former.size(), requests::option_of(row));
        print_to_stderr(fmt::format("warning: {} is the former name of {}", former, requests::option_of(row)));
      }
    }
  return words;
}

/// Parses the command line. Prints the help or the version if it is requested.
/// \return true if a command is to be run
/// \throw InputError
bool parse(CLI::App& app, int argc, const char* const* argv) {
  const std::vector<std::string> words = with_current_options(argc, argv);
  std::vector<const char*> pointers;
  for (const std::string& word : words) pointers.push_back(word.c_str());
  try {
    app.parse(argc, pointers.data());
  } catch (const CLI::CallForHelp&) {
    print(app.help());
    return false;
  } catch (const CLI::CallForVersion&) {
    print(kVersionText + "\n");
    return false;
  } catch (const CLI::RequiredError& error) {
    throw InputError(missing(app, one_line(error.what())) + "; see retrace --help");
  } catch (const CLI::ExtrasError&) {
    throw InputError(unknown_word(app) + "; see retrace --help");
  } catch (const CLI::ParseError& error) {
    throw InputError(message_of(error) + "; see retrace --help");
  }
  return true;
}

}  // namespace

std::function<ExitCode()> read_command_line(int argc, const char* const* argv) {
  CLI::App app("retrace: computes the light that a retroreflector array returns, from its design file", "retrace");
  app.require_subcommand(1);
  app.fallthrough();
  app.get_formatter()->column_width(34);
  const auto common = std::make_shared<CommonOptions>();
  add(app, common_arguments(*common));
  std::vector<Invocation> invocations;
  for (const Command& command : commands()) {
    CLI::App* const sub = app.add_subcommand(command.name, command.summary);
    invocations.push_back(command.begin());
    add(*sub, invocations.back().arguments);
    sub->fallthrough();
    sub->footer(
        "Options of every command, before or after it: --json FILE, -o/--out DIR, --threads N [all cores],\n"
        "--memory-gib G [1], --seed S [1], --set KEY=VALUE (repeatable), --quiet, --version, --help");
  }
  if (!parse(app, argc, argv)) return {};
  for (std::size_t k = 0; k < invocations.size(); ++k) {
    const Command& command = commands()[k];
    if (!app.got_subcommand(command.name)) continue;
    check_needs({*app.get_subcommand(command.name), invocations[k].arguments}, invocations[k].arguments);
    if (!command.refuses_set.empty() && !common->overrides.empty())
      throw InputError({"", 0, "--set"}, command.refuses_set);
    return [common, run = invocations[k].run] {
      set_memory_budget(*common);
      return run(*common);
    };
  }
  return {};
}

}  // namespace retrace::app
