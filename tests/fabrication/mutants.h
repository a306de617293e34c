#pragma once

// Makes all small changes of a program's text: lines are removed, duplicated, exchanged or inserted, and every number
// is changed.

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace retrace::fabrication::test {

struct Mutant {
  std::string what;
  std::string text;
};

inline std::vector<std::string> lines_of_text(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

inline std::string text_of_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// A change of the number that follows a letter.
struct NumberChange {
  char letter = 'X';
  double factor = 1.0;
  double shift = 0.0;
};

/// Returns all changed versions of a program.
/// \param inserted lines that are inserted before each line
inline std::vector<Mutant> mutants_of(const std::string& text, const std::vector<NumberChange>& changes,
                                      const std::vector<std::string>& inserted) {
  const std::vector<std::string> lines = lines_of_text(text);
  std::vector<Mutant> mutants;
  const auto add = [&](const std::string& what, std::size_t line, const std::vector<std::string>& changed) {
    if (changed != lines)
      mutants.push_back({fmt::format("{} of line {}: {}", what, line + 1, lines[line]), text_of_lines(changed)});
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<std::string> changed = lines;
    changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(i));
    add("deletion", i, changed);
    changed = lines;
    changed.insert(changed.begin() + static_cast<std::ptrdiff_t>(i), lines[i]);
    add("duplication", i, changed);
    if (i + 1 < lines.size()) {
      changed = lines;
      std::swap(changed[i], changed[i + 1]);
      add("exchange", i, changed);
    }
    for (const std::string& line : inserted) {
      changed = lines;
      changed.insert(changed.begin() + static_cast<std::ptrdiff_t>(i), line);
      add("insertion of " + line + " before", i, changed);
    }
    if (lines[i].starts_with('(')) continue;
    for (const NumberChange& change : changes) {
      const std::size_t at = lines[i].find(std::string(" ") + change.letter);
      if (at == std::string::npos) continue;
      const char* const from = lines[i].c_str() + at + 2;
      char* end = nullptr;
      const double value = std::strtod(from, &end);
      if (end == from) continue;
      changed = lines;
      changed[i] =
          lines[i].substr(0, at + 2) + fmt::format("{:.7f}", value * change.factor + change.shift) + std::string(end);
      add(fmt::format("{} x {} + {}", change.letter, change.factor, change.shift), i, changed);
    }
  }
  return mutants;
}

/// Move of a program that is read by a simple independent reader. The reader supports the few words of programs for
/// lathes and planing mills: RS274/NGC without subroutines. It shares no code with fabrication/read/, so that test
/// rules are independent of the readers that they test.
struct PlainMove {
  bool is_rapid = true;
  bool is_timed = false;                ///< true if G93 is active
  bool is_stop = true;                  ///< true if exact stop (G61) is active
  double feed = 0.0;                    ///< feed word as written
  double at[4] = {0.0, 0.0, 0.0, 0.0};  ///< positions of X, Y, Z and C after the move
  double from[4] = {0.0, 0.0, 0.0, 0.0};
  bool known[4] = {false, false, false, false};  ///< true for axes whose position was known before the move
  bool named[4] = {false, false, false, false};
  bool is_spindle_on = false;
  double rpm = 0.0;
};

struct PlainProgram {
  std::vector<PlainMove> moves;
  bool ends = false;          ///< true if the program ends with M2 and %
  bool is_prepared = true;    ///< true if all settings are made before the first move
  bool stops_spindle = true;  ///< true if the program stops the spindle before the first move
  bool is_odd = false;        ///< true if the program contains a word that this reader does not support
  bool spindle_is_left_on = false;
};

inline PlainProgram plain_program(const std::string& text) {
  PlainProgram program;
  PlainMove now;
  bool is_rapid = false;
  bool has_mode = false;
  bool is_absolute = true;
  double unit = 1.0;
  int percents = 0;
  unsigned said = 0;
  bool has_ended = false;
  for (const std::string& line : lines_of_text(text)) {
    if (line == "%") {
      ++percents;
      continue;
    }
    if (line.starts_with('(') || has_ended) continue;
    std::istringstream words(line);
    bool moves = false;
    double to[4] = {0.0, 0.0, 0.0, 0.0};
    std::fill(std::begin(now.named), std::end(now.named), false);
    for (std::string word; words >> word;) {
      const char letter = word[0];
      const double value = std::atof(word.c_str() + 1);
      const std::size_t axis = std::string_view("XYZC").find(letter);
      if (axis != std::string_view::npos) {
        to[axis] = value;
        now.named[axis] = moves = true;
      } else if (letter == 'F') {
        now.feed = value;
      } else if (letter == 'S') {
        now.rpm = value;
      } else if (letter == 'M') {
        if (value == 3 || value == 4) now.is_spindle_on = true;
        if (value == 5) now.is_spindle_on = false;
        if (value == 5) said |= 16U;
        if (value == 2) has_ended = true;
      } else if (letter == 'G') {
        if (value == 0 || value == 1) {
          is_rapid = value == 0;
          has_mode = true;
        }
        if (value == 20) unit = 25.4;
        if (value == 21) unit = 1.0;
        if (value == 90) is_absolute = true;
        if (value == 91) is_absolute = false;
        if (value == 93) now.is_timed = true;
        if (value == 94) now.is_timed = false;
        if (value == 61 || value == 61.1) now.is_stop = true;
        if (value == 64) now.is_stop = false;
        if (value == 90) said |= 1U;
        if (value == 94) said |= 2U;
        if (value == 61 || value == 61.1) said |= 4U;
        if (value == 40) said |= 8U;
      } else if (letter != 'P' && letter != 'Q') {
        program.is_odd = true;
      }
    }
    if (!moves) continue;
    if (!has_mode) program.is_odd = true;
    if ((said & 15U) != 15U) program.is_prepared = false;
    if ((said & 16U) == 0U) program.stops_spindle = false;
    now.is_rapid = is_rapid;
    std::copy(std::begin(now.at), std::end(now.at), std::begin(now.from));
    const PlainMove before = now;
    for (std::size_t axis = 0; axis < 4; ++axis) {
      if (!now.named[axis]) continue;
      const double scale = axis < 3 ? unit : 1.0;
      now.at[axis] = to[axis] * scale + (is_absolute ? 0.0 : now.at[axis]);
      if (!is_absolute && !before.known[axis]) program.is_odd = true;
    }
    program.moves.push_back(now);
    for (std::size_t axis = 0; axis < 4; ++axis) now.known[axis] = now.known[axis] || now.named[axis];
  }
  program.ends = has_ended && percents >= 2;
  program.spindle_is_left_on = now.is_spindle_on;
  return program;
}

}  // namespace retrace::fabrication::test
