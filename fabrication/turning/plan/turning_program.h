#pragma once

// Converts a turning path to a program that is independent of dialects.

#include <string>
#include <vector>

#include "fabrication/program/program.h"
#include "fabrication/turning/plan/cubic_path.h"
#include "fabrication/turning/plan/path.h"

namespace retrace::fabrication::turning {

/// Returns a self-contained program for a path, with positions rounded to whole nanometres and 1e-7 degrees. If there
/// is a fast tool servo, Z contains only the motion of the slide.
/// \param name file name without extension
/// \param header lines of text for the operator, ASCII without brackets
Program turning_program(const std::vector<Pass>& passes, const PathOptions& options, const std::string& name,
                        const std::vector<std::string>& header);

/// Returns a self-contained program for a spiral of cubic moves.
Program turning_program(const CubicPath& cubics, const PathOptions& options, const std::string& name,
                        const std::vector<std::string>& header);

}  // namespace retrace::fabrication::turning
