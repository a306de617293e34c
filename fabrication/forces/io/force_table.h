#pragma once

// Reads the table of measured cutting forces that the force model is calibrated on.

#include <string>
#include <string_view>
#include <vector>

#include "fabrication/forces/forces.h"

namespace retrace::fabrication {

/// The shipped measurements (data/cutting_forces.csv). \throw InputError
std::vector<MeasuredForce> shipped_forces();

/// Reads a table of that form; lines that are empty or begin with # are skipped. \throw InputError naming file and line
std::vector<MeasuredForce> parse_forces(std::string_view text, const std::string& source_name);

}  // namespace retrace::fabrication
