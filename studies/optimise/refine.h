#pragma once

// Refines a candidate by local optimisation. NLopt stays behind this file.

#include "studies/optimise/evaluator.h"

namespace retrace::studies {

/// How far a refinement without slopes goes.
struct RefineLimits {
  int most_looks = 60;
  double first_step = 0.02;  ///< as a share of each interval
};

/// Moves the continuous values of a feasible design to a better one within bounds and constraints: by exact slopes of
/// the objective where it has them (SLSQP), else without any (COBYLA). What it looks at is seen by the evaluator.
/// \return whether slopes served
bool refine(const Study& study, const OptimiseRequest& request, Evaluator& evaluator, const Variant& from,
            const RefineLimits& limits = {});

/// Share 0..1 of a value's way through its interval.
double share_of(const Interval& interval, double value);

}  // namespace retrace::studies
