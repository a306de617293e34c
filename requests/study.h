#pragma once

// Request for studies that are defined in study files.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace retrace {

/// Settings for carrying out a study, as in `retrace sweep`, `retrace tolerance` and `retrace optimize`.
struct StudyRequest {
  std::vector<std::string> overrides = {};
  std::uint32_t seed = 1;
  std::filesystem::path store = {};
  std::string if_exists = "refuse";
};

}  // namespace retrace
