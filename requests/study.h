#pragma once

// Request for studies that are defined in study files.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace retrace {

/// Settings for carrying out a study, as in `retrace sweep`, `retrace tolerance` and `retrace optimize`.
struct StudyRequest {
  /// Texts KEY=VALUE for keys of designs, [analysis] and [machining].
  std::vector<std::string> overrides = {};
  /// Seed of the random numbers; a whole number >= 0 and <= 4294967295.
  std::uint32_t seed = 1;
  /// SQLite file in which finished points are kept. Default: finished points are not kept.
  std::filesystem::path store = {};
  /// Action if the store exists already: refuse, resume or overwrite.
  std::string if_exists = "refuse";
};

}  // namespace retrace
