#pragma once

// Arguments of several commands: design, job and part files, machines and dialects, and the options --resume and
// --overwrite for a store that already exists.

#include <string>
#include <vector>

#include "app/command.h"
#include "compute/store/store.h"
#include "studies/rre/rre.h"

namespace retrace::app {

/// Returns the argument DESIGN, a design file.
Argument design_argument(std::string& design);
/// Returns the argument JOB, a fabrication job file.
Argument job_argument(std::string& job, const std::string& help = "job file");
/// Returns the argument PART, the file of a turned or planed part.
Argument part_argument(std::string& part);
/// Returns the option --dialect, which selects the dialect of NC programs.
Argument dialect_argument(std::string& dialect);
/// Returns the traits of an argument whose value is the name of a shipped machine or a machine file.
Traits machine_traits();
/// Options of commands that save their points in a store (an SQLite file).
struct StudyOptions {
  std::string study;
  bool resume = false;
  bool overwrite = false;
};

/// Returns the argument STUDY and the options --resume and --overwrite.
std::vector<Argument> study_arguments(StudyOptions& options);

/// Returns the action to take if the store already exists: resume it, overwrite it, or refuse to run.
compute::IfExists if_exists_of(const StudyOptions& options);

}  // namespace retrace::app
