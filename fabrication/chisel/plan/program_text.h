#pragma once

// Texts of planned programs: names, headers and comments.

#include <string>
#include <string_view>
#include <vector>

#include "fabrication/chisel/plan/plan.h"
#include "fabrication/chisel/plan/process_facts.h"

namespace retrace::fabrication {

/// Replaces every character that at least one dialect does not allow in comments by an underscore.
std::string plain(std::string_view text);

/// Returns the header of a program.
/// \param seconds run time of the program
std::vector<std::string> program_header(const Job& job, const Machine& machine, const PlanOptions& options,
                                        const ProcessFacts& facts, const Plan& plan, double seconds);

/// Returns the comment or message for the operator at the start of a stage.
Item stage_text(const Stage& stage, const CuttingPose& pose);

/// Sets the names of all programs of a plan. If there are several programs, their names and headers contain numbers.
void name_programs(const PlanOptions& options, std::vector<Program>& programs);

}  // namespace retrace::fabrication
