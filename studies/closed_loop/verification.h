#pragma once

// Study of the command `retrace verify`: reads a job and its NC programs, simulates them and compares with the design.

#include <optional>
#include <string>
#include <vector>

#include "core/file_texts.h"
#include "core/progress.h"
#include "core/warning.h"
#include "fabrication/chisel/check/simulation/error_field.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_program.h"

namespace retrace::studies {

/// Input of a verification.
struct VerificationRequest {
  std::string job;                     ///< job file
  std::vector<std::string> programs;   ///< names as for fabrication::program_name(), in the order of execution
  std::string dialect = "auto";        ///< name in fabrication::kNcDialectWords; "auto": recognised from the text
  std::optional<double> tolerance_nm;  ///< tolerance for facet planes; fabrication::usual_tolerance_nm() if empty
  /// Name of a stage, which is one step of machining with its own program, such as roughing. All stages before it count
  /// as already cut by the programs of the job. If the name is empty, the blank is uncut.
  std::string standing;
  FileTexts texts = {};  ///< contents of files that are used instead of reading these files
};

struct VerificationRun {
  VerificationRequest request;
  fabrication::Job job;
  fabrication::Machine machine;
  std::vector<fabrication::NcProgram> programs;  ///< programs of the stages that are already cut, then the given ones
  std::size_t standing = 0;                      ///< number of programs at the beginning that are not checked
  fabrication::Verification result;
  Warnings warnings;
};

/// Reads the job, its machine and the programs, and simulates the programs.
/// \throw InputError, with file and line, for a file that cannot be read or understood
VerificationRun run_verification(const VerificationRequest& request, const Cancellation* cancellation = nullptr);

/// Map of the height errors of the machined surface, for a picture.
struct ErrorMap {
  fabrication::ErrorField field;
  double shown_nm = 0.0;  ///< range of the colour scale: heights beyond +- this value are clamped
};

ErrorMap error_map(const VerificationRun& run);

}  // namespace retrace::studies
