#pragma once

// Output documents and tables of `retrace turn`, and of `retrace verify` for turned parts.

#include <string>

#include "studies/turning/turn.h"

namespace retrace::studies {

/// Returns the document `retrace.turning/2`.
std::string turning_json(const TurningResult& result);

/// Returns the tool path with the motion of Z as CSV. The points are thinned out to at most 50,000 rows. The columns
/// are `time_s,x_mm,y_mm,z_mm,c_deg,servo_mm,z_speed_mm_per_s,z_acceleration_mm_per_s2,z_jerk_mm_per_s3`.
std::string turning_path_csv(const TurningResult& result);

/// Returns the profiles across the cuts as CSV with the columns `x_mm,y_mm,scallop_nm,predicted_nm,valley_nm`.
std::string turning_cusps_csv(const TurningResult& result);

/// Returns the result as a table for the terminal.
std::string turning_table(const TurningResult& result);

/// Returns the document `retrace.verification/2` of a turned part (docs/commands/verify.md).
std::string verification_json(const TurningVerification& run, double elapsed_s);
std::string verification_table(const TurningVerification& run);

}  // namespace retrace::studies
