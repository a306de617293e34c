#pragma once

// Documents and tables of `retrace verify`.

#include <string>

#include "studies/closed_loop/verification.h"

namespace retrace::studies {

/// The document `retrace.verification/1`.
std::string verification_json(const VerificationRun& run, double elapsed_s);

/// A short table for people.
std::string verification_table(const VerificationRun& run);

}  // namespace retrace::studies
