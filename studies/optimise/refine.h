#pragma once

// Refines a design by local optimization. Only refine.cpp uses NLopt.

#include "studies/optimise/evaluator.h"

namespace retrace::studies {

/// Limits of a refinement without derivatives.
struct RefineLimits {
  int max_evaluations = 60;
  double first_step = 0.02;  ///< first step, as a fraction of each interval
};

/// Improves the continuous values of a feasible design within bounds and constraints. It uses exact derivatives of the
/// objective if they are available (SLSQP), otherwise no derivatives (COBYLA). The evaluator stores all evaluated
/// designs.
/// \return true if derivatives were used
bool refine(const Study& study, const OptimiseRequest& request, Evaluator& evaluator, const Variant& from,
            const RefineLimits& limits = {});

/// Returns the position of a value in its interval as a fraction from 0 to 1.
double fraction_of(const Interval& interval, double value);

}  // namespace retrace::studies
