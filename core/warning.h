#pragma once

// Warnings: reasons to doubt a result, which are reported to the user.

#include <string>
#include <string_view>
#include <vector>

namespace retrace {

/// Reason to doubt a result. The text is for people and may change between versions. Programs and tests use the
/// identifier.
struct Warning {
  std::string_view id;  ///< such as "index_extrapolated"; refers to a text that lives as long as the program
  std::string text;     ///< one line

  bool operator==(const Warning&) const = default;
};

using Warnings = std::vector<Warning>;

/// Appends `more` to `warnings`.
inline void append(Warnings& warnings, const Warnings& more) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

/// Returns the texts without the identifiers.
inline std::vector<std::string> texts_of(const Warnings& warnings) {
  std::vector<std::string> texts;
  for (const Warning& warning : warnings) texts.push_back(warning.text);
  return texts;
}

}  // namespace retrace
