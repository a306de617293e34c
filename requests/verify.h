#pragma once

// Request for the verification of NC programs.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace retrace {

/// Settings of a verification, as in `retrace verify`.
struct VerificationRequest {
  std::filesystem::path job = {};
  std::vector<std::string> programs = {};
  std::string dialect = "auto";
  std::optional<double> tolerance_nm = {};
  std::string standing = {};
  std::filesystem::path as_machined = {};
  std::map<std::string, std::string> texts = {};  ///< texts of job and programs by file name, used instead of files
};

}  // namespace retrace
