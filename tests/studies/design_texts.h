#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/error.h"
#include "design/io/design_reader.h"
#include "tests/support/refusals.h"

namespace retrace::studies {

/// Lines of a valid design, so that tests can refer to line numbers.
inline const std::vector<std::string> kLines = {
    "[element]",                 // 1
    "kind = \"rtp\"",            // 2
    "base_mm = 0.5",             // 3
    "width_mm = 0.5",            // 4
    "[array]",                   // 5
    "arrangement = \"offset\"",  // 6
    "x_length_mm = 10",          // 7
    "y_length_mm = 10",          // 8
    "[body]",                    // 9
    "thickness_mm = 2.0",        // 10
};

inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// Returns the valid design with line `number` (from 1) replaced. The number 11 appends a line.
inline std::string with_line(std::size_t number, const std::string& line) {
  std::vector<std::string> lines = kLines;
  lines.resize(std::max(lines.size(), number));
  lines[number - 1] = line;
  return joined(lines);
}

/// Returns the place of the error when `text` is read, or an empty text if there is no error.
inline std::string complaint(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return refusal_of([&] { design::parse_design(text, "d.toml", overrides); });
}

/// Returns the place of the error when the valid design is read with overrides of the form `key=value`.
inline std::string set_complaint(const std::vector<std::string>& overrides) {
  return complaint(joined(kLines), overrides);
}

inline design::Design set(const std::vector<std::string>& overrides) {
  return design::parse_design(joined(kLines), "d.toml", overrides);
}

/// Returns a design with elements of one kind.
/// \param element, array lines of the tables [element] and [array], separated by "; "
inline std::string design_of(std::string element, std::string array) {
  const auto in_lines = [](std::string text) {
    for (std::size_t at; (at = text.find("; ")) != std::string::npos;) text.replace(at, 2, 1, '\n');
    return text + "\n";
  };
  return "[element]\n" + in_lines(element) + "[array]\n" + in_lines(array) + "[body]\nthickness_mm = 1\n";
}

inline const std::string kHexagonal = "kind = \"hexagonal_icc\"; aperture_mm = 2";
inline const std::string kTriangular = "kind = \"triangular_icc\"; aperture_mm = 2";
inline const std::string kRtp = "kind = \"rtp\"; base_mm = 1; width_mm = 1";

}  // namespace retrace::studies
