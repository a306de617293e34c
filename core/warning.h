#pragma once

// Warnings: doubts about a result that the user should know.

#include <string>
#include <string_view>
#include <vector>

namespace retrace {

/// Doubt about a result. The text is for people and may change between versions; programs and tests read the
/// identifier.
struct Warning {
  std::string_view id;  ///< such as "index_extrapolated"; refers to a text that lives as long as the program
  std::string text;     ///< one line

  bool operator==(const Warning&) const = default;
};

using Warnings = std::vector<Warning>;

/// Returns the texts without the identifiers.
inline std::vector<std::string> texts_of(const Warnings& warnings) {
  std::vector<std::string> texts;
  for (const Warning& warning : warnings) texts.push_back(warning.text);
  return texts;
}

}  // namespace retrace
