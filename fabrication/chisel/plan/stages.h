#pragma once

// The sequence of a plan: which facet is cut in which pose by which routine.

#include <vector>

#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Where a routine starts, relative to the root's middle or the apex, and how far it reaches.
struct RoutineStart {
  Place start = Place::Zero();
  Reach reach;
};

/// Adds poses, routines and stages of a job to a plan that knows its elements and counts of cuts: what is cut in which
/// order, without positions. Elements that stand differently on a base have poses and stages of their own.
/// \return of each subroutine \throw InputError naming element, tilt and limit for one that the machine cannot reach
std::vector<RoutineStart> add_stages(const Job& job, const Machine& machine, Plan& plan);

}  // namespace retrace::fabrication
