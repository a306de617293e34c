#pragma once

// Reads the constraints of a study file.

#include <string>
#include <vector>

#include "core/error.h"
#include "studies/quantity/constraint.h"
#include "studies/quantity/study.h"

namespace retrace::studies {

/// The tables [[constraint]] of a study; there may be none. \throw InputError
std::vector<Constraint> read_constraints(const Study& study);

/// \return the name, if the study has a quantity of that name \throw InputError if it has not
std::string checked_quantity(const Study& study, const std::string& name, const InputLocation& where);

}  // namespace retrace::studies
