#pragma once

// Describes commands as data: name, manual text, file formats and options. The command line parser, --help, the manual
// page and shell completion are generated from these descriptions.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.h"

namespace retrace::app {

/// Options that all commands have.
struct CommonOptions {
  std::string json;  ///< file for the JSON document, or "-" for standard output; if empty, no document is written
  std::string out;   ///< output folder or, for some commands, output file; if empty, no files are written
  std::optional<std::uint32_t> threads;
  std::optional<double> memory_gib;  ///< memory budget of beams and elements in GiB; empty: 1 GiB
  std::uint32_t seed = 1;
  std::vector<std::string> overrides;  ///< arguments of --set, each in the form KEY=VALUE
  bool quiet = false;
};

/// List of words, in the order in which they are shown.
using Words = std::vector<std::string>;

/// Condition on one option of the command line.
struct Condition {
  enum class Kind { given, absent, value };

  /// Kind of the condition. `given`: `option` is on the command line. `absent`: it is not. `value`: the value of
  /// `option`, which may be its default, is one of `values`.
  Kind kind = Kind::given;
  std::string option;
  Words values = {};
};
/// Requirement of an option: a list of conditions on other options, of which at least one must hold. If none holds, the
/// option has no effect, and the command ends with an error.
using Need = std::vector<Condition>;

/// Returns the requirement that at least one of `options` is given.
Need any_given(const Words& options);
/// Returns the requirement that `option` is not given.
Need absent(const std::string& option);
/// Returns a requirement as text for help and messages. Examples are "requires --camera or --road", "not allowed
/// together with --lamp" and "requires --engine auto or exact if --cutoff is given".
std::string text_of(const Need& need);

/// Properties of an argument that restrict its value and its combination with other options.
struct Traits {
  /// Function that returns possible values for shell completion. A word that ends with "=", such as a key, is only the
  /// beginning of a value.
  std::function<Words()> words = {};
  /// Extension of allowed files. "" allows any file, and "/" allows folders. No value means that the argument is not a
  /// file.
  std::optional<std::string> files = {};
  std::uint64_t min = 0;                       ///< minimum value of an argument that is a whole number
  std::uint64_t max = std::uint64_t{1} << 36;  ///< maximum value of an argument that is a whole number
  /// True if the argument must be given. A positional argument can also be required by the type of its target variable.
  bool required = false;
  std::string excludes = {};     ///< name of an option that cannot be given together with this option
  std::vector<Need> needs = {};  ///< requirements, which must all be met
};

/// Returns the traits of an argument that is one of a set of words.
/// \param files extension of files that are allowed in addition to the words; if there is no value, files are not
/// allowed
Traits one_of(std::function<Words()> words, std::optional<std::string> files = {});
Traits one_of(Words words, std::optional<std::string> files = {});
/// Returns the traits of an argument that is a file.
/// \param ending extension of the file; "": any file; "/": a folder
Traits files(const std::string& ending);
/// Returns the traits of a whole number from `min` to `max`.
Traits integer(std::uint64_t min, std::uint64_t max = Traits().max);
/// Returns the traits of an option that cannot be given together with `option`.
Traits not_with(const std::string& option);

/// Argument or option of a command.
struct Argument {
  /// Variable that receives the value. Its initial value is the default, which help shows unless it is empty or the
  /// option is required. `std::monostate` is for --help and --version, which print a text and run no command.
  using Target = std::variant<std::monostate, bool*, std::string*, std::optional<std::string>*, Words*, double*,
                              std::optional<double>*, std::uint32_t*, std::optional<std::uint32_t>*, std::uint64_t*,
                              std::optional<std::uint64_t>*>;

  std::string name;  ///< name as shown by help, with a placeholder for the value: "DESIGN", "--quiet", "-o,--out DIR"
  std::string help;
  Target target;
  Traits traits = {};
  std::string shown_default = {};  ///< text of the default in help; if empty, help shows the initial value of `target`
};

/// Returns the names of an option, such as "-o" and "--out". Returns an empty list for a positional argument.
Words option_names(const Argument& argument);
/// Returns the placeholder for the value of an argument, such as "DIR". Returns an empty text for an option without a
/// value.
std::string value_word(const Argument& argument);
/// Returns the default value of an argument as text. Returns an empty text if help does not show a default.
std::string default_of(const Argument& argument);
/// Returns true if the argument may be given several times.
bool may_be_repeated(const Argument& argument);
/// Returns true if a positional argument may be omitted.
bool may_be_missing(const Argument& argument);

/// Arguments of a command, and the function that runs the command after the arguments have received their values.
struct Invocation {
  std::vector<Argument> arguments;
  std::function<ExitCode(const CommonOptions&)> run;
};

/// A command of the program.
struct Command {
  std::string name;
  std::string summary;           ///< short description for lists of commands
  std::string manual = {};       ///< paragraphs, separated by empty lines; text in `backticks` is printed in bold
  Words reads = {};              ///< formats of the input files, such as "retrace.design/1", or their descriptions
  Words writes = {};             ///< formats of the output documents; the format of --json comes first
  std::string refuses_set = {};  ///< message if --set is given; empty: --set is allowed
  std::function<Invocation()> begin = {};
};

/// Returns a function for Command::begin. The function creates an object of class Options and connects its members to
/// the arguments.
/// \param arguments function that returns the arguments; the parser writes their values into the given options
/// \param run function that runs the command and returns the exit code or throws retrace::Error
template <class Options>
std::function<Invocation()> begins(std::vector<Argument> (*arguments)(Options&),
                                   ExitCode (*run)(const Options&, const CommonOptions&)) {
  return [arguments, run] {
    const auto options = std::make_shared<Options>();
    return Invocation{arguments(*options),
                      [options, run](const CommonOptions& common) { return run(*options, common); }};
  };
}

/// Returns a function that returns the words of a constant list.
inline std::function<Words()> words_of(std::span<const std::string_view> set) {
  return [set] { return Words(set.begin(), set.end()); };
}

/// Returns the usage line of a command, such as "retrace rre DESIGN... [options]".
std::string synopsis(const Command& command);

/// Returns the options that all commands have.
std::vector<Argument> common_arguments(CommonOptions& common);

}  // namespace retrace::app
