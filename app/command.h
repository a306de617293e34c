#pragma once

// A command as data: name, manual text, formats that it reads and writes, and its options. The command line, --help,
// the manual page and shell completion are all made from these entries.

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.h"

namespace retrace::app {

/// Options that every command has.
struct CommonOptions {
  std::string json;  ///< file for the JSON document; "-" is standard output; empty: none
  std::string out;   ///< output folder; empty: none
  std::optional<std::uint32_t> threads;
  std::optional<double> memory_gib;  ///< memory budget for beams and elements in GiB; empty: 1
  std::uint32_t seed = 1;
  std::vector<std::string> overrides;  ///< --set key=value
  bool quiet = false;
};

/// Words, in the order to list them.
using Words = std::vector<std::string>;

/// A condition on another option of the command line.
struct Condition {
  enum class Kind { given, absent, value };

  /// Kind of the condition: the option is given, is absent, or has one of `values`, given or by default.
  Kind kind = Kind::given;
  std::string option;
  Words values = {};
};
/// A requirement of an option. At least one of its conditions must hold, otherwise the option has no effect and is
/// refused.
using Need = std::vector<Condition>;

/// Returns the requirement that at least one of the options is given.
Need any_given(const Words& options);
/// Returns the requirement that the option is absent.
Need absent(const std::string& option);
/// Returns a requirement as text, such as "--camera or --road", "no --lamp" or "--engine auto or exact".
std::string text_of(const Need& need);

/// What an argument is beside its name, its help and its place.
struct Traits {
  std::function<Words()> words = {};            ///< that it may be, for completion; what ends with "=" goes on
  std::optional<std::string> files = {};        ///< ending of files that it may be; "": any file; "/": folders
  std::uint64_t least = 0;                      ///< of a whole number
  std::uint64_t most = std::uint64_t{1} << 36;  ///< of a whole number
  bool required = false;                        ///< of an option; what has a place is, unless it is a std::optional
  std::string excludes = {};                    ///< the option that it cannot go with
  std::vector<Need> needs = {};                 ///< requirements that must all be met for the option to have an effect
};

/// Traits of what is one of a set of words. \param files ending of files that it may be as well; none: it is no file
Traits one_of(std::function<Words()> words, std::optional<std::string> files = {});
Traits one_of(Words words, std::optional<std::string> files = {});
/// Traits of a file with that ending; "": any; "/": a folder.
Traits files(const std::string& ending);
/// Traits of a whole number.
Traits whole(std::uint64_t least, std::uint64_t most = Traits().most);
/// Traits of what cannot go with another option.
Traits not_with(const std::string& option);

/// An argument or option: what the command line, --help, the manual and completion know of it.
struct Argument {
  /// Where it goes. What is there before is the default that help shows, unless it is empty or the option required.
  /// `std::monostate` is what is answered in place of running a command.
  using Target = std::variant<std::monostate, bool*, std::string*, std::optional<std::string>*, Words*, double*,
                              std::optional<double>*, std::uint32_t*, std::optional<std::uint32_t>*, std::uint64_t*,
                              std::optional<std::uint64_t>*>;

  std::string name;  ///< as help shows it, with what stands for its value: "DESIGN", "--quiet", "-o,--out DIR"
  std::string help;
  Target target;
  Traits traits = {};
};

/// The names of an option, such as "-o" and "--out"; none of what has a place.
Words option_names(const Argument& argument);
/// What stands for the value, such as "DIR"; empty of what takes none.
std::string value_word(const Argument& argument);
/// The value that is there before the command line is read, as text; empty: none that is to be shown.
std::string default_of(const Argument& argument);
/// Whether it may be given more than once.
bool may_be_repeated(const Argument& argument);
/// Of what has a place: whether it can be left out.
bool may_be_missing(const Argument& argument);

/// A command that is about to be read: its arguments, and what runs it when they have their values.
struct Invocation {
  std::vector<Argument> arguments;
  std::function<ExitCode(const CommonOptions&)> run;
};

/// A command of the program.
struct Command {
  std::string name;
  std::string summary;           ///< a clause for lists of commands
  std::string manual = {};       ///< paragraphs with an empty line between; what stands in `backticks` is set in bold
  Words reads = {};              ///< formats of the files it reads that have a name and number, or what they are
  Words writes = {};             ///< formats of the documents it writes, that of --json first
  std::string refuses_set = {};  ///< why --set is refused; empty: it is taken
  std::function<Invocation()> begin = {};
};

/// Command::begin of a command with options of its own. \param run returns the exit code or throws retrace::Error
template <class Options>
std::function<Invocation()> begins(std::vector<Argument> (*arguments)(Options&),
                                   ExitCode (*run)(const Options&, const CommonOptions&)) {
  return [arguments, run] {
    const auto options = std::make_shared<Options>();
    return Invocation{arguments(*options),
                      [options, run](const CommonOptions& common) { return run(*options, common); }};
  };
}

/// Of a closed set of words that the code has.
inline std::function<Words()> words_of(std::span<const std::string_view> set) {
  return [set] { return Words(set.begin(), set.end()); };
}

/// How a command is called: "retrace rre DESIGN... [options]".
std::string synopsis(const Command& command);

/// The options of every command.
std::vector<Argument> common_arguments(CommonOptions& common);

}  // namespace retrace::app
