#include "fabrication/read/nc_program.h"

#include "fabrication/read/dialects.h"

namespace retrace::fabrication {

NcProgram parse_nc(std::string_view text, const std::string& file, NcDialect dialect, const NcSpindleTexts& spindle) {
  NcLines lines(text, file);
  switch (dialect) {
    case NcDialect::rs274ngc:
      return parse_rs274ngc(std::move(lines));
    case NcDialect::sinumerik:
      return parse_sinumerik(std::move(lines));
    case NcDialect::fanuc:
      return parse_fanuc(std::move(lines));
    case NcDialect::pmac:
      return parse_pmac(std::move(lines), spindle);
  }
  throw InputError({file, 0, ""}, "no such dialect");
}

NcDialect recognise_dialect(std::string_view text, const std::string& file) {
  NcLines lines(text, file);
  std::string_view line;
  bool has_percent = false;
  while (lines.next(line)) {
    const std::string packed = without_blanks(line);
    if (packed.starts_with("OPENPROG") || packed.starts_with("OPENSUBPROG")) return NcDialect::pmac;
    if (packed == "%") has_percent = true;
    if (packed.starts_with("MSG(") || packed.starts_with("CALLBLOCK") || packed.find("TRAFOOF") != std::string::npos)
      return NcDialect::sinumerik;
    if (packed.size() < 2 || packed[0] != 'O' || packed[1] < '0' || packed[1] > '9') continue;
    const std::size_t behind = packed.find_first_not_of("0123456789", 1);
    const bool is_word = behind != std::string::npos && packed[behind] >= 'A' && packed[behind] <= 'Z';
    return is_word ? NcDialect::rs274ngc : NcDialect::fanuc;
  }
  if (has_percent) return NcDialect::rs274ngc;
  throw InputError(
      {file, 0, ""},
      "no word of rs274ngc (o101 sub), sinumerik (MSG), fanuc (O0001) or pmac (open prog) was found in it");
}

}  // namespace retrace::fabrication
