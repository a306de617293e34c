#pragma once

// Writes a turning path as a neutral program of machine words.

#include <string>
#include <vector>

#include "fabrication/program/program.h"
#include "fabrication/turning/plan/cubic_path.h"
#include "fabrication/turning/plan/path.h"

namespace retrace::fabrication::turning {

/// The path as a program that runs alone, positions rounded to whole nanometres and 1e-7 degrees. Of a fast tool servo
/// the program has the slide's share of Z.
/// \param name of the file, without its ending \param header lines for people, ASCII without brackets
Program turning_program(const std::vector<Pass>& passes, const PathOptions& options, const std::string& name,
                        const std::vector<std::string>& header);

/// The same of a spiral by cubics.
Program turning_program(const CubicPath& cubics, const PathOptions& options, const std::string& name,
                        const std::vector<std::string>& header);

}  // namespace retrace::fabrication::turning
