#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "app/commands.h"
#include "app/output.h"
#include "core/message_text.h"

namespace retrace::app {
namespace {

std::string replaced(std::string text, char what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, 1, by);
  return text;
}

std::string names_of_commands() {
  Words names;
  for (const Command& command : commands()) names.push_back(command.name);
  return fmt::format("{}", fmt::join(names, " "));
}

Words known_words(const Argument& argument) {
  return argument.traits.words ? argument.traits.words() : Words{};
}

std::string bash_value(const std::string& pattern, const Argument& argument) {
  std::string settings;
  if (const Words words = known_words(argument); !words.empty())
    settings += fmt::format(" words='{}'", fmt::join(words, " "));
  if (argument.traits.files) settings += fmt::format(" files='{}'", *argument.traits.files);
  return fmt::format("    {}){} ;;\n", pattern, settings);
}

/// Returns the cases of a bash `case` statement for the arguments of a command.
/// \param command name of the command, or "*" for the arguments that all commands have
std::string bash_values(const std::string& command, const std::vector<Argument>& arguments) {
  std::string cases;
  int place = 0;
  for (const Argument& argument : arguments) {
    if (value_word(argument).empty()) continue;
    const Words names = option_names(argument);
    if (names.empty())
      cases += bash_value(fmt::format("\"{} @\"{}", command, may_be_repeated(argument) ? "*" : std::to_string(++place)),
                          argument);
    for (const std::string& name : names)
      cases += bash_value(command == "*" ? fmt::format("*\" {}\"", name) : fmt::format("\"{} {}\"", command, name),
                          argument);
  }
  return cases;
}

std::string options_of(const std::vector<Argument>& arguments) {
  std::string text;
  for (const Argument& argument : arguments)
    for (const std::string& name : option_names(argument)) text += " " + name;
  return text;
}

constexpr const char* kBash = R"(# shellcheck shell=bash
# Completion of retrace for bash, as `retrace completion bash` writes it. Source it, or install it as
# share/bash-completion/completions/retrace.

# _retrace_value COMMAND ARGUMENT - sets what may stand there: words, and files with an ending, "/" for folders. Fails
# for what takes no value.
_retrace_value() {{
  words='' files=none
  case "$1 $2" in
{values}    *) return 1 ;;
  esac
}}

# _retrace_options COMMAND - sets words to its options.
_retrace_options() {{
  words='{common}' files=none
  case $1 in
{options}  esac
}}

# _retrace_reply WORD - words, files and folders that begin as WORD does.
_retrace_reply() {{
  local path
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$1")
  [[ $words != *= ]] || compopt -o nospace 2>/dev/null
  [[ $files != none ]] || return 0
  compopt -o filenames 2>/dev/null
  while IFS= read -r path; do
    [[ ! -d $path && ($files == / || $path != *"$files") ]] || COMPREPLY+=("$path")
  done < <(compgen -f -- "$1")
}}

_retrace() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} command='' place=1 i words files
  COMPREPLY=()
  # Bash splits at "=": "--engine=au" comes as three words.
  if [[ $word == '=' ]]; then
    word=''
  elif [[ $previous == '=' ]] && ((COMP_CWORD >= 2)); then
    previous=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  # The command is the first word that is neither an option nor an option's value; then places count from 1.
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case ${{COMP_WORDS[i]}} in
      =) ;;
      -?*)
        if _retrace_value "$command" "${{COMP_WORDS[i]}}"; then
          i=$((i + 1))
          [[ ${{COMP_WORDS[i]}} != '=' ]] || i=$((i + 1))
        fi
        ;;
      *)
        if [[ -z $command ]]; then command=${{COMP_WORDS[i]}}; else place=$((place + 1)); fi
        ;;
    esac
  done
  if [[ $previous == -?* ]] && _retrace_value "$command" "$previous"; then
    :
  elif [[ $word == -* ]]; then
    _retrace_options "$command"
  elif [[ -z $command ]]; then
    words='{commands}' files=none
  else
    _retrace_value "$command" "@$place" || return 0
  fi
  _retrace_reply "$word"
}}

complete -F _retrace retrace
)";

std::string bash_script() {
  CommonOptions unused;
  const std::vector<Argument> common = common_arguments(unused);
  std::string values = bash_values("*", common);
  std::string options;
  for (const Command& command : commands()) {
    const Invocation invocation = command.begin();
    values += bash_values(command.name, invocation.arguments);
    if (const std::string own = options_of(invocation.arguments); !own.empty())
      options += fmt::format("    {}) words+='{}' ;;\n", command.name, own);
  }
  return fmt::format(kBash, fmt::arg("values", values), fmt::arg("common", options_of(common).substr(1)),
                     fmt::arg("options", options), fmt::arg("commands", names_of_commands()));
}

std::string single_quoted(const std::string& text) {
  return "'" + replaced(text, '\'', "'\\''") + "'";
}

/// Returns the action of zsh for the completion of an argument's value.
std::string zsh_action(const Argument& argument) {
  const auto& ending = argument.traits.files;
  const std::string files = !ending           ? ""
                            : *ending == "/"  ? "_files -/"
                            : ending->empty() ? "_files"
                                              : fmt::format("_files -g \"*{}\"", *ending);
  const Words words = known_words(argument);
  if (words.empty()) return files.empty() ? " " : files;
  const bool goes_on = words.front().ends_with('=');
  return fmt::format("{{compadd {}-- {}{}}}", goes_on ? "-S \"\" " : "", fmt::join(words, " "),
                     files.empty() ? "" : "; " + files);
}

/// Returns the specification of an argument for the zsh function _arguments.
std::string zsh_argument(const Argument& argument, int& place) {
  const std::string value = value_word(argument);
  const Words names = option_names(argument);
  const std::string message = value.empty() ? "" : fmt::format(":{}:{}", value, zsh_action(argument));
  if (names.empty()) {
    const std::string where =
        may_be_repeated(argument) ? "*" : std::to_string(++place) + (may_be_missing(argument) ? ":" : "");
    return single_quoted(where + message);
  }
  const std::string help = replaced(replaced(replaced(argument.help, '[', "\\["), ']', "\\]"), ':', "\\:");
  const std::string sign = value.empty() ? "" : "=";
  const std::string what = fmt::format("[{}]{}", help, message);
  if (names.size() == 1) return single_quoted((may_be_repeated(argument) ? "*" : "") + names[0] + sign + what);
  return fmt::format("'({0} {1})'{{{0},{1}{2}}}{3}", names[0], names[1], sign, single_quoted(what));
}

std::string zsh_arguments(const std::vector<Argument>& arguments, const std::string& indent) {
  std::string text;
  int place = 0;
  for (const Argument& argument : arguments) text += indent + zsh_argument(argument, place);
  return text;
}

constexpr const char* kZsh = R"(#compdef retrace
# Completion of retrace for zsh, as `retrace completion zsh` writes it. Source it, or install it as
# share/zsh/site-functions/_retrace.

_retrace() {{
  local curcontext=$curcontext state line
  typeset -A opt_args
  local -a common commands
  common=({common}
  )
  commands=({commands}
  )
  _arguments -C $common '1:command:->command' '*::argument:->argument'
  case $state in
    command) _describe command commands ;;
    argument)
      case $words[1] in
{arguments}      esac
      ;;
  esac
}}

if [[ $funcstack[1] == _retrace ]]; then _retrace "$@"; else compdef _retrace retrace; fi
)";

std::string zsh_script() {
  CommonOptions unused;
  std::string all;
  std::string arguments;
  for (const Command& command : commands()) {
    all += "\n    " + single_quoted(command.name + ":" + replaced(command.summary, ':', "\\:"));
    arguments += fmt::format("        {}) _arguments $common{} ;;\n", command.name,
                             zsh_arguments(command.begin().arguments, " \\\n          "));
  }
  return fmt::format(kZsh, fmt::arg("common", zsh_arguments(common_arguments(unused), "\n    ")),
                     fmt::arg("commands", all), fmt::arg("arguments", arguments));
}

/// Returns the fish `complete` lines of an argument.
/// \param condition condition in fish syntax under which the lines apply; if empty, they always apply
std::string fish_argument(const std::string& condition, const Argument& argument) {
  const auto quoted = [](const std::string& text) {
    return "'" + replaced(replaced(text, '\\', "\\\\"), '\'', "\\'") + "'";
  };
  std::string line = "complete -c retrace" + (condition.empty() ? "" : " -n " + quoted(condition));
  for (const std::string& name : option_names(argument))
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  const auto& ending = argument.traits.files;
  Words words = known_words(argument);
  if (ending && *ending == "/")
    words.emplace_back("(__fish_complete_directories)");
  else if (ending && !ending->empty())
    words.push_back(fmt::format("(__fish_complete_suffix {})", *ending));
  const std::string values = fmt::format("{}", fmt::join(words, " "));
  const bool is_option = !option_names(argument).empty();
  if (ending && ending->empty())
    line += is_option ? " -r -F" : " -F";
  else if (is_option && !value_word(argument).empty())
    line += " -x";
  if (!values.empty()) line += " -a " + quoted(values);
  return line + (is_option ? " -d " + quoted(argument.help) : "") + "\n";
}

constexpr const char* kFish =
    R"(# Completion of retrace for fish, as `retrace completion fish` writes it. Source it, or install it as
# share/fish/vendor_completions.d/retrace.fish.

# The command word, if it is there: the first that is neither an option nor an option's value.
function __retrace_command
    set -l is_value 0
    for word in (commandline -opc)[2..]
        if test $is_value = 1
            set is_value 0
        else if contains -- $word {valued}
            set is_value 1
        else if not string match -q -- '-*' $word
            echo $word
            return
        end
    end
end

function __retrace_is
    set -l command (__retrace_command)
    test "$command" = "$argv[1]"
end

complete -c retrace -f
)";

std::string fish_script() {
  CommonOptions unused;
  std::string lines;
  std::string valued;
  for (const Argument& argument : common_arguments(unused)) {
    lines += fish_argument("", argument);
    if (!value_word(argument).empty()) valued += options_of({argument});
  }
  for (const Command& command : commands()) {
    lines += fish_argument("__retrace_is ''", {"", "", {}, one_of(Words{command.name})});
    lines.insert(lines.size() - 1, " -d '" + replaced(command.summary, '\'', "\\'") + "'");
    for (const Argument& argument : command.begin().arguments)
      lines += fish_argument("__retrace_is " + command.name, argument);
  }
  return fmt::format(kFish, fmt::arg("valued", valued.substr(1))) + lines;
}

constexpr std::array<std::pair<std::string_view, std::string (*)()>, 3> kShells = {
    {{"bash", bash_script}, {"zsh", zsh_script}, {"fish", fish_script}}};

struct CompletionOptions {
  std::string shell;
};

std::vector<Argument> arguments(CompletionOptions& options) {
  Words shells;
  for (const auto& [name, script] : kShells) shells.emplace_back(name);
  return {{"SHELL", "bash, zsh or fish", &options.shell, one_of(shells)}};
}

ExitCode run(const CompletionOptions& options, const CommonOptions& common) {
  for (const auto& [name, script] : kShells)
    if (name == options.shell) return write_text(common, "retrace.completion/1", {{"shell", options.shell}}, script());
  throw InputError(fmt::format("completion: must be bash, zsh or fish, got {}", in_quotes(options.shell)));
}

}  // namespace

Command completion_command() {
  return {.name = "completion",
          .summary = "completion of commands, options and values for a shell",
          .manual =
              "Prints a script that completes commands, options, file names and other values in `bash`, `zsh` or "
              "`fish`. To use it: `source <(retrace completion bash)`.",
          .writes = {"retrace.completion/1"},
          .refuses_set = "not allowed with completion, which reads no design",
          .begin = begins<CompletionOptions>(arguments, run)};
}

}  // namespace retrace::app
