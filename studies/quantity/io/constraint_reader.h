#pragma once

// Reads the constraints of a study file.

#include <string>
#include <vector>

#include "core/error.h"
#include "studies/quantity/constraint.h"
#include "studies/quantity/study.h"

namespace retrace::studies {

/// The tables [[constraint]] of a study; there may be none. \throw InputError, also for one over a part of many cells
std::vector<Constraint> read_constraints(const Study& study);

/// What a constraint of a composition is of, in the order of the words of `constraint.over`.
enum class ConstraintOver { cell, part };
/// Those of a composition that are over one or the other. \throw InputError
std::vector<Constraint> read_constraints(const Study& study, ConstraintOver over);

/// \return the name, if the study has a quantity of that name \throw InputError if it has not
std::string checked_quantity(const Study& study, const std::string& name, const InputLocation& where);

}  // namespace retrace::studies
