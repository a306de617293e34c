#pragma once

// Documents and tables of `retrace forces`.

#include <string>

#include "studies/forces/forces_study.h"

namespace retrace::studies {

/// Returns the document `retrace.forces/1`.
std::string forces_json(const ForcesResult& result);

/// Returns the force profile as CSV with the columns time_s, phase, engaged_mm, fx_n, fy_n and fz_n. Between the lines,
/// the profile is linear.
std::string forces_csv(const ForcesResult& result);

/// Returns a short table for the terminal.
std::string forces_table(const ForcesResult& result);

}  // namespace retrace::studies
