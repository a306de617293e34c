#pragma once

// Makes the programs of a plan from its stages: visits, stops, and the division into programs.

#include <vector>

#include "fabrication/chisel/plan/plan.h"
#include "fabrication/chisel/plan/process_facts.h"
#include "fabrication/chisel/plan/stages.h"

namespace retrace::fabrication {

/// Adds programs, stops and machining times to a plan.
/// \param starts start of each subroutine of the plan
/// \param stages_before stages of the job before the stages of the plan. The order of parallel passes alternates from
///     visit to visit and therefore depends on the number of earlier visits.
/// \pre the plan contains elements, poses, stages, subroutines and the safe height
/// \throw InputError if an axis would leave its limits, if the tool cannot reach an element without coming too close to
///     the blank, or if a visit exceeds the tool life or the maximum run time
void make_programs(const Job& job, const Machine& machine, const PlanOptions& options, const ProcessFacts& facts,
                   const std::vector<RoutineStart>& starts, const std::vector<Stage>& stages_before, Plan& plan);

}  // namespace retrace::fabrication
