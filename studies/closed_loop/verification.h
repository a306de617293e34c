#pragma once

// Study of the command `retrace verify`: reads a job and its NC programs, simulates them and compares with the design.

#include <cstddef>
#include <vector>

#include "core/progress.h"
#include "core/warning.h"
#include "fabrication/chisel/check/simulation/error_field.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_program.h"
#include "requests/verify.h"

namespace retrace::studies {

struct VerificationRun {
  VerificationRequest request;
  fabrication::Job job;
  fabrication::Machine machine;
  std::vector<fabrication::NcProgram> programs;  ///< programs of the stages that are already cut, then the given ones
  std::size_t unchecked_programs = 0;            ///< number of programs at the beginning that are not checked
  fabrication::Verification result;
  Warnings warnings;
};

/// Reads the job, its machine and the programs, and simulates the programs.
/// \throw InputError, with file and line, for a file that cannot be read or understood, or at a field of the request
VerificationRun run_verification(const VerificationRequest& request, const Cancellation* cancellation = nullptr);

/// Map of the height errors of the machined surface, for a picture.
struct ErrorMap {
  fabrication::ErrorField field;
  double colour_range_nm = 0.0;  ///< range of the colour scale: heights beyond +- this value are clamped
};

ErrorMap error_map(const VerificationRun& run);

}  // namespace retrace::studies
