#pragma once

// Documents and tables of `retrace turn`, and of `retrace verify` of turned parts.

#include <string>

#include "studies/turning/turn.h"

namespace retrace::studies {

/// The document `retrace.turning/1`.
std::string turning_json(const TurningResult& result);

/// The path with Z's motion, thinned out to at most 50,000 rows:
/// `time_s,x_mm,y_mm,z_mm,c_deg,servo_mm,z_speed_mm_per_s,z_acceleration_mm_per_s2,z_jerk_mm_per_s3`.
std::string turning_path_csv(const TurningResult& result);

/// The profiles across the cuts: `x_mm,y_mm,scallop_nm,predicted_nm,valley_nm`.
std::string turning_cusps_csv(const TurningResult& result);

/// What people read on the terminal.
std::string turning_table(const TurningResult& result);

/// The document `retrace.verification/1` of a turned part (docs/commands.md).
std::string verification_json(const TurningVerification& run, double elapsed_s);
std::string verification_table(const TurningVerification& run);

}  // namespace retrace::studies
