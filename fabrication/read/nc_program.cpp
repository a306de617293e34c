#include "fabrication/read/nc_program.h"

#include <algorithm>
#include <array>

#include "core/text.h"
#include "fabrication/read/dialects.h"

namespace retrace::fabrication {
namespace {

/// Readers of the dialects, in the order of the enumerators.
constexpr std::array kReaders = {parse_rs274ngc, parse_sinumerik, parse_fanuc,
                                 parse_pmac,     parse_a3200,     parse_automation1};

}  // namespace

double half_decimal(std::uint8_t decimals) {
  constexpr auto halves = [] {
    std::array<double, 21> values{0.5};
    for (std::size_t k = 1; k < values.size(); ++k) values[k] = values[k - 1] / 10.0;
    return values;
  }();
  return halves[std::min<std::size_t>(decimals, halves.size() - 1)];
}

NcProgram parse_nc(std::string_view text, const std::string& file, NcDialect dialect, const NcTexts& texts) {
  NcLines lines(text, file);
  return kReaders[static_cast<std::size_t>(dialect)](std::move(lines), texts);
}

NcDialect recognise_dialect(std::string_view text, const std::string& file) {
  NcLines lines(text, file);
  std::string_view line;
  bool has_percent = false;
  while (lines.next(line)) {
    const std::string packed = without_blanks(line);
    if (packed.starts_with("OPENPROG") || packed.starts_with("OPENSUBPROG")) return NcDialect::pmac;
    if (packed.starts_with("WAITMODE") || packed == "ENDPROGRAM" || packed == "VELOCITYON" || packed == "VELOCITYOFF")
      return NcDialect::a3200;
    if (trimmed(line) == "program" || packed.starts_with("SETUPTASK")) return NcDialect::automation1;
    if (packed == "%") has_percent = true;
    if (packed.starts_with("MSG(") || packed.starts_with("CALLBLOCK") || packed.find("TRAFOOF") != std::string::npos)
      return NcDialect::sinumerik;
    if (packed.size() < 2 || packed[0] != 'O' || packed[1] < '0' || packed[1] > '9') continue;
    const std::size_t behind = packed.find_first_not_of("0123456789", 1);
    const bool is_word = behind != std::string::npos && packed[behind] >= 'A' && packed[behind] <= 'Z';
    return is_word ? NcDialect::rs274ngc : NcDialect::fanuc;
  }
  if (has_percent) return NcDialect::rs274ngc;
  throw InputError({file, 0, ""},
                   "the dialect is unknown, because the file contains no word of rs274ngc (o101 sub), sinumerik (MSG), "
                   "fanuc (O0001), pmac (open prog), a3200 (END PROGRAM) or automation1 (program)");
}

}  // namespace retrace::fabrication
