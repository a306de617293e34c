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
  /// Job file. Required.
  std::filesystem::path job = {};
  /// NC programs, in the order in which they run; FILE@LINE: the program was stopped after this line. Required.
  std::vector<std::string> programs = {};
  /// Dialect of the programs: rs274ngc, sinumerik, fanuc, pmac, a3200, automation1, or auto: recognised from the text.
  std::string dialect = "auto";
  /// Maximum deviation of the facet planes of a job from the design, in nm; > 0. Default: 10, or the deviation that the
  /// increments of a Fanuc control cause if it is larger.
  std::optional<double> tolerance_nm = {};
  /// Name of the next stage of a job, such as finishing-1-facet-1: all stages before it have been cut. Default: the
  /// blank is uncut.
  std::string next_stage = {};
  /// Output file for the design of the machined part. Default: none.
  std::filesystem::path as_machined = {};
  std::map<std::string, std::string> texts = {};  ///< texts of job and programs by file name, used instead of files
};

}  // namespace retrace
