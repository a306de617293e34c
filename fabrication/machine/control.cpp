#include "fabrication/machine/control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>

namespace retrace::fabrication {
namespace {

constexpr std::size_t kLongestLine = 200;

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

/// First words of lines that move axes, set modes, wait, or open, end and lead elsewhere.
constexpr std::string_view kStatements[] = {
    // Power PMAC
    "OPEN", "CLOSE", "ABS", "INC", "RAPID", "LINEAR", "CIRCLE1", "CIRCLE2", "PVT", "SPLINE", "DWELL", "DELAY", "FRAX",
    "NORMAL", "TM", "TA", "TS", "F", "RETURN", "CALL", "CALLSUB", "GOTO", "GOSUB", "STOP", "HOME", "COORD",
    // Aerotech A3200
    "ABSOLUTE", "INCREMENTAL", "METRIC", "ENGLISH", "MINUTES", "SECONDS", "VELOCITY", "WAIT", "DFS", "ENDDFS",
    "FARCALL", "PROGRAM", "END", "CW", "CCW", "BEZIER", "POSOFFSET",
    // Automation1
    "FUNCTION", "MOVELINEAR", "MOVERAPID", "MOVEABSOLUTE", "MOVEINCREMENTAL", "MOVECW", "MOVECCW", "MOVEPT", "MOVEPVT",
    "POSITIONOFFSETSET", "POSITIONOFFSETCLEAR", "CORNERROUNDINGON", "VELOCITYBLENDINGON", "VELOCITYBLENDINGOFF",
    "SETUPTASKTARGETMODE", "SETUPTASKDISTANCEUNITS", "SETUPTASKTIMEUNITS", "SETUPTASKWAITMODE",
    "SETUPCOORDINATEDSPEED"};

/// Whether a line moves axes, sets modes, waits, or opens, ends and leads elsewhere: its first word says so, or a
/// letter of an axis, or G, with a number.
bool is_statement(std::string_view text) {
  std::string word;
  bool is_first = true;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : ' ';
    if (is_letter(c)) {
      word += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      continue;
    }
    if (word.empty()) continue;
    if (is_first && std::find(std::begin(kStatements), std::end(kStatements), word) != std::end(kStatements))
      return true;
    const std::size_t next = text.find_first_not_of(' ', i);
    const bool takes_value =
        next != std::string_view::npos && std::string_view("-+.(0123456789").find(text[next]) != std::string_view::npos;
    if (word.size() == 1 && std::string_view("ABCGUVWXYZ").find(word) != std::string_view::npos && takes_value)
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
