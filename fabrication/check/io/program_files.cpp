#include "fabrication/check/io/program_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/message_text.h"

namespace retrace::fabrication {

NcDialect dialect_of(const std::string& word, std::string_view text, const std::string& file) {
  if (word == "auto") return recognise_dialect(text, file);
  const auto* const found = std::find(std::begin(kNcDialectWords), std::end(kNcDialectWords), word);
  if (found == std::end(kNcDialectWords))
    throw InputError(Field{"dialect"},
                     fmt::format("must be \"auto\", {}, got {}", alternatives(kNcDialectWords), in_quotes(word)));
  return static_cast<NcDialect>(found - std::begin(kNcDialectWords));
}

NcTexts texts_of(const Control& control) {
  return {"", "", control.mist_on, control.mist_off, control.optional_stop, control.stop};
}

ProgramName program_name(const std::string& given) {
  const std::size_t at = given.rfind('@');
  std::error_code ignored;
  if (at == std::string::npos || std::filesystem::exists(given, ignored)) return {given, 0};
  ProgramName name{given.substr(0, at), 0};
  const char* const end = given.data() + given.size();
  const auto [rest, error] = std::from_chars(given.data() + at + 1, end, name.stop_line);
  return error == std::errc() && rest == end && name.stop_line > 0 ? name : ProgramName{given, 0};
}

std::vector<NcProgram> read_programs(const std::vector<std::string>& names, const std::string& dialect,
                                     const NcTexts& texts, const FileTexts& given_texts) {
  std::vector<NcProgram> programs;
  for (const std::string& given : names) {
    const auto [file, stop_line] = program_name(given);
    const std::string text = text_of_file(file, given_texts, kMaxDataBytes);
    NcProgram& program = programs.emplace_back(parse_nc(text, file, dialect_of(dialect, text, file), texts));
    if (stop_line > program.lines)
      throw InputError({file, 0, ""},
                       fmt::format("the program cannot be stopped after line {}, because it has only {} lines",
                                   stop_line, program.lines));
    program.stop_line = stop_line;
  }
  return programs;
}

}  // namespace retrace::fabrication
