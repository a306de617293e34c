#pragma once

// Limits of the tool and the machine that optimizations take into account by default.

#include <vector>

#include "studies/quantity/constraint.h"
#include "studies/quantity/study.h"

namespace retrace::studies {

/// Returns the limits that follow from the table [machining] of a study. They concern the quantities `tool_fit_mm`,
/// `machine_travel_mm` and `edge_life_margin_mm`. The list is empty if the study ignores these limits, or if its first
/// design is not an array of prisms.
std::vector<Constraint> machining_limits(const Study& study);

/// Adds the quantities of all machining limits to a study, unless the study already contains them.
Study with_machining_limits(Study study);

}  // namespace retrace::studies
