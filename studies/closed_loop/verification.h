#pragma once

// The study behind `retrace verify`: reads a job with its NC programs and carries them out against the design.

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

/// What to verify.
struct VerificationRequest {
  std::string job;                     ///< file
  std::vector<std::string> programs;   ///< as fabrication::program_name() takes them, in the order in which they run
  std::string dialect = "auto";        ///< a word of fabrication::kNcDialectWords, or told from the text
  std::optional<double> tolerance_nm;  ///< of facet planes; without one fabrication::usual_tolerance_nm()
  std::string standing;  ///< stage before which all was cut by the job's own program; empty: the blank stands
  FileTexts texts = {};  ///< of job and programs that are given in place of being read
};

struct VerificationRun {
  VerificationRequest request;
  fabrication::Job job;
  fabrication::Machine machine;
  std::vector<fabrication::NcProgram> programs;  ///< as they were read, behind what made what stands
  std::size_t standing = 0;                      ///< so many of the programs made it, and are not judged
  fabrication::Verification result;
  Warnings warnings;
};

/// Reads the job, its machine and the programs, and carries the programs out.
/// \throw InputError for a file that cannot be read or understood, with its line
VerificationRun run_verification(const VerificationRequest& request, const Cancellation* cancellation = nullptr);

/// What the programs leave against the design, for a picture.
struct ErrorMap {
  fabrication::ErrorField field;
  double shown_nm = 0.0;  ///< heights beyond +- this are drawn as this
};

ErrorMap error_map(const VerificationRun& run);

}  // namespace retrace::studies
