#include "fabrication/machine/control.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace retrace::fabrication {
namespace {

constexpr std::size_t kLongestLine = 200;

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

/// Whether a line of a Power PMAC's program moves axes, waits, or opens, ends and leads elsewhere: its first word says
/// so, or a letter of an axis with a number.
bool is_statement(std::string_view text) {
  static constexpr std::array<std::string_view, 26> kStatements = {
      "OPEN",   "CLOSE", "ABS",     "INC",  "RAPID",  "LINEAR", "CIRCLE1", "CIRCLE2", "PVT",
      "SPLINE", "DWELL", "DELAY",   "FRAX", "NORMAL", "TM",     "TA",      "TS",      "F",
      "RETURN", "CALL",  "CALLSUB", "GOTO", "GOSUB",  "STOP",   "HOME",    "COORD"};
  std::string word;
  bool is_first = true;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : ' ';
    if (is_letter(c)) {
      word += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      continue;
    }
    if (word.empty()) continue;
    if (is_first && std::find(kStatements.begin(), kStatements.end(), word) != kStatements.end()) return true;
    const std::size_t next = text.find_first_not_of(' ', i);
    const bool takes_value =
        next != std::string_view::npos && std::string_view("-+.(0123456789").find(text[next]) != std::string_view::npos;
    if (word.size() == 1 && std::string_view("ABCUVWXYZ").find(word) != std::string_view::npos && takes_value)
      return true;
    is_first = false;
    word.clear();
  }
  return false;
}

}  // namespace

std::string unfit_line(std::string_view text) {
  const bool is_plain = std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (text.empty() || text.size() > kLongestLine || !is_plain || text.front() == ' ' || text.back() == ' ' ||
      text.find("//") != std::string_view::npos)
    return fmt::format(
        "must be one line of 1 to {} printable ASCII characters, without // and without blanks at its ends",
        kLongestLine);
  return is_statement(text) ? "must not move axes, wait, or lead out of the program" : "";
}

}  // namespace retrace::fabrication
