#pragma once

// Limits of the tool and the machine that an optimization and a composition respect by default.

#include <vector>

#include "studies/quantity/constraint.h"
#include "studies/quantity/study.h"

namespace retrace::studies {

/// Returns the limits that follow from the table [machining] of a study. They concern the quantities `tool_fit_mm`,
/// `machine_travel_mm` and `edge_life_margin_mm`. The list is empty if the study ignores these limits, or if its first
/// design is not an array of prisms.
std::vector<Constraint> machining_limits(const Study& study);

/// Adds the limits that the table [machining] implies to the constraints of a study. A constraint of the study on the
/// same quantity replaces a limit.
void add_machining_limits(const Study& study, std::vector<Constraint>& constraints);

/// Returns a study that also computes the quantities of its machining limits. Quantities that the study already has are
/// not added.
Study with_machining_limits(Study study);

}  // namespace retrace::studies
