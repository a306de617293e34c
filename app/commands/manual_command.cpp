#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/output.h"
#include "core/version.h"

namespace retrace::app {
namespace {

/// Converts a text to roff. Text in backticks becomes bold, and an empty line begins a paragraph.
std::string roff(const std::string& text) {
  std::string all;
  bool is_bold = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '`') {
      is_bold = !is_bold;
      all += is_bold ? "\\fB" : "\\fR";
    } else if (text.compare(k, 2, "\n\n") == 0) {
      all += "\n.PP";
    } else if ((text[k] == '.' || text[k] == '\'') && (k == 0 || text[k - 1] == '\n')) {
      all += std::string("\\&") + text[k];
    } else {
      all += text[k] == '-' ? "\\-" : text[k] == '\\' ? "\\e" : std::string(1, text[k]);
    }
  }
  return all;
}

/// Returns the roff text of an argument with its help, its default and its allowed words.
std::string item(const Argument& argument) {
  Words names = option_names(argument);
  for (std::string& name : names) name = "\\fB" + roff(name) + "\\fR";
  std::string head = fmt::format("{}", fmt::join(names, ", "));
  if (!value_word(argument).empty())
    head += (head.empty() ? "" : " ") + fmt::format("\\fI{}\\fR", roff(value_word(argument)));
  std::string text = argument.help;
  if (const std::string value = default_of(argument); !value.empty()) text += "; `" + value + "` by default";
  const Words words = argument.traits.words ? argument.traits.words() : Words{};
  if (!words.empty() && !words.front().ends_with('.'))
    text += fmt::format(". {}: {}", argument.traits.files ? "Known names" : "Words", fmt::join(words, ", "));
  return fmt::format(".TP\n{}\n{}.\n", head, roff(text));
}

std::string items(const std::vector<Argument>& arguments) {
  std::string text;
  for (const Argument& argument : arguments) text += item(argument);
  return text;
}

std::string section(const Command& command) {
  std::string text = fmt::format(".SS \"{}\"\n{}\n", roff(synopsis(command)), roff(command.manual));
  if (!command.reads.empty())
    text += fmt::format(".PP\nReads: {}.\n", roff(fmt::format("{}", fmt::join(command.reads, ", "))));
  if (!command.writes.empty())
    text += fmt::format(".PP\nWrites: {}.\n", roff(fmt::format("{}", fmt::join(command.writes, ", "))));
  return text + items(command.begin().arguments);
}

constexpr const char* kHead = R"(.TH RETRACE 1 "" "retrace {version}" "User Commands"
.SH NAME
retrace \- computes the light that a retroreflector array returns, from its design file
.SH SYNOPSIS
.B retrace
.I COMMAND
.RI [ argument " ...]"
.RI [ options ]
.SH DESCRIPTION
.B retrace
traces light through arrays of right triangular prisms and cube corners and
computes how much of it returns to the source. It also plans the fabrication
of these arrays and verifies NC programs.
A DESIGN is a TOML file, or \- for standard input.
Lengths are in mm, angles in degrees.
Without
.B \-\-out
and
.B \-\-json
a table goes to standard output, and nothing is written.
.SH OPTIONS OF EVERY COMMAND
They can be given before or after the command word.
)";

constexpr const char* kTail = R"(.SH ENVIRONMENT
.TP
.B RETRACE_DATA_DIR
Folder of shipped data, in place of
.I share/retrace
next to the program's
.I bin
folder.
.TP
.B RETRACE_MPI_SILENCE_S
Seconds without a response after which an MPI rank is considered lost;
the default is 15.
.SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
The answer is no (such as no feasible design or a missed limit), a verdict is
undetermined, or every point of a sweep failed.
.TP
.B 2
Wrong usage, or an input that cannot be opened, read or understood; nothing was written.
.TP
.B 3
An output cannot be written, memory is not sufficient, or a budget is exceeded.
.TP
.B 130
Interrupted; the written files are valid and contain "complete": false.
If the computation does not stop within one second, no results are written.
.SH EXAMPLES
Write a design, inspect it, and compute its curve:
.PP
.nf
    retrace init rtp \-o prism.toml
    retrace inspect prism.toml
    retrace rre prism.toml \-\-incidence=\-40:40:auto \-o result
.fi
.PP
The same prism in polycarbonate, as JSON on standard output:
.PP
.nf
    retrace rre prism.toml \-\-set body.material=PC \-\-json \-
.fi
.SH SEE ALSO
The documents installed with retrace:
.IR commands.md ,
.IR commands/*.md ,
.I design_file.md
and
.IR CONVENTIONS.md .
)";

std::string manual_page() {
  CommonOptions common;
  std::string text =
      fmt::format(kHead, fmt::arg("version", kVersion)) + items(common_arguments(common)) + ".SH COMMANDS\n";
  for (const Command& command : commands()) text += section(command);
  return text + kTail;
}

/// Returns a requirement as a JSON list of conditions, at least one of which must hold.
nlohmann::ordered_json json_of(const Need& need) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Condition& condition : need) {
    nlohmann::ordered_json one = {{"option", condition.option}};
    if (condition.kind == Condition::Kind::value)
      one["values"] = condition.values;
    else
      one["given"] = condition.kind == Condition::Kind::given;
    all.push_back(std::move(one));
  }
  return all;
}

nlohmann::ordered_json json_of(const Argument& argument) {
  nlohmann::ordered_json json = {
      {"names", option_names(argument)}, {"value", value_word(argument)}, {"help", argument.help}};
  if (const std::string value = default_of(argument); !value.empty()) json["default"] = value;
  if (argument.traits.words) json["words"] = argument.traits.words();
  if (argument.traits.files) json["files"] = *argument.traits.files;
  if (argument.traits.required) json["required"] = true;
  for (const Need& need : argument.traits.needs) json["needs"].push_back(json_of(need));
  return json;
}

nlohmann::ordered_json json_of(const std::vector<Argument>& arguments) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Argument& argument : arguments) all.push_back(json_of(argument));
  return all;
}

nlohmann::ordered_json json_of_commands() {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Command& command : commands())
    all.push_back({{"name", command.name},
                   {"summary", command.summary},
                   {"synopsis", synopsis(command)},
                   {"reads", command.reads},
                   {"writes", command.writes},
                   {"arguments", json_of(command.begin().arguments)}});
  return all;
}

struct ManualOptions {};

std::vector<Argument> arguments(ManualOptions&) {
  return {};
}

ExitCode run(const ManualOptions&, const CommonOptions& common) {
  CommonOptions every;
  return write_text(common, "retrace.manual/1",
                    {{"arguments", json_of(common_arguments(every))}, {"commands", json_of_commands()}}, manual_page());
}

}  // namespace

Command manual_command() {
  return {.name = "manual",
          .summary = "the manual page, and all commands and options as data",
          .manual =
              "Prints this page, for `man -l`. `--json` writes every command with its arguments, their allowed words, "
              "and the formats that it reads and writes.",
          .writes = {"retrace.manual/1"},
          .refuses_set = "not allowed with manual, which reads no design",
          .begin = begins<ManualOptions>(arguments, run)};
}

}  // namespace retrace::app
