#pragma once

// Writes the JSON document and the table of `retrace verify`.

#include <string>

#include "studies/closed_loop/verification.h"

namespace retrace::studies {

/// Returns the document `retrace.verification/2`.
std::string verification_json(const VerificationRun& run, double elapsed_s);

/// Returns a short table for the terminal.
std::string verification_table(const VerificationRun& run);

}  // namespace retrace::studies
