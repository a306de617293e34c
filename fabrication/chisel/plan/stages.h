#pragma once

// Determines the sequence of a plan: which facet is cut in which pose by which subroutine.

#include <vector>

#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Start point of a subroutine, relative to the centre of the root or to the apex, and the extent of its moves.
struct RoutineStart {
  LinearPosition start = LinearPosition::Zero();
  MoveExtent extent;
};

/// Adds the poses, subroutines and stages of a job to a plan, in the order of cutting. Elements with different
/// orientations on a substrate have separate poses and stages.
/// \pre the plan contains the elements and the number of cuts
/// \return the start of each subroutine
/// \throw InputError naming element, tilt and limit if the machine cannot reach an element
std::vector<RoutineStart> add_stages(const Job& job, const Machine& machine, Plan& plan);

}  // namespace retrace::fabrication
