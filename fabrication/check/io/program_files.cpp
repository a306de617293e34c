#include "fabrication/check/io/program_files.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/message_text.h"

namespace retrace::fabrication {

NcDialect dialect_of(const std::string& word, std::string_view text, const std::string& file) {
  if (word == "auto") return recognise_dialect(text, file);
  const auto* const found = std::find(std::begin(kNcDialectWords), std::end(kNcDialectWords), word);
  if (found == std::end(kNcDialectWords))
    throw InputError({"", 0, "--dialect"},
                     fmt::format("must be \"auto\", {}, got {}", alternatives(kNcDialectWords), in_quotes(word)));
  return static_cast<NcDialect>(found - std::begin(kNcDialectWords));
}

std::vector<NcProgram> read_programs(const std::vector<std::string>& files, const std::string& dialect,
                                     const NcTexts& texts) {
  std::vector<NcProgram> programs;
  for (const std::string& file : files) {
    const std::string text = read_file(file, kMostDataBytes);
    programs.push_back(parse_nc(text, file, dialect_of(dialect, text, file), texts));
  }
  return programs;
}

}  // namespace retrace::fabrication
