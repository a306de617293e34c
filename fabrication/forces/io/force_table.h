#pragma once

// Reads the table of measured cutting forces with which the force model is calibrated.

#include <string>
#include <string_view>
#include <vector>

#include "fabrication/forces/forces.h"

namespace retrace::fabrication {

/// Returns the shipped measurements (data/cutting_forces.csv).
/// \throw InputError if the table is invalid
std::vector<MeasuredForce> shipped_forces();

/// Reads a table of measured forces. Empty lines and lines that begin with # are skipped.
/// \throw InputError naming file and line
std::vector<MeasuredForce> parse_forces(std::string_view text, const std::string& source_name);

}  // namespace retrace::fabrication
