#pragma once

// Documents and tables of `retrace forces`.

#include <string>

#include "studies/forces/forces_study.h"

namespace retrace::studies {

/// The document `retrace.forces/1`.
std::string forces_json(const ForcesResult& result);

/// time_s,phase,engaged_mm,fx_n,fy_n,fz_n: corners of the profile, straight between.
std::string forces_csv(const ForcesResult& result);

/// A short table for people.
std::string forces_table(const ForcesResult& result);

}  // namespace retrace::studies
