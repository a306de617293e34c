#pragma once

// Reads the constraints of a study file.

#include <string>
#include <vector>

#include "core/error.h"
#include "studies/quantity/constraint.h"
#include "studies/quantity/study.h"

namespace retrace::studies {

/// Reads the tables [[constraint]] of a study; there may be none.
/// \throw InputError for invalid keys, and for `over = "part"`, which only compositions (parts with several kinds of
/// cells) allow
std::vector<Constraint> read_constraints(const Study& study);

/// Object to which a constraint of a composition (part with several kinds of cells) applies. The order is that of the
/// words of the key `constraint.over`.
enum class ConstraintOver { cell, part };
/// Reads the constraints of a composition that apply to cells or to the part.
/// \throw InputError for invalid keys
std::vector<Constraint> read_constraints(const Study& study, ConstraintOver over);

/// Checks that the study has a quantity with this name. The name of a quantity is by default its kind. If the kind has
/// a former word, both words are allowed as the name.
/// \return name of the quantity, which is `name` or the other word of this kind
/// \throw InputError if there is no such quantity
std::string checked_quantity(const Study& study, const std::string& name, const InputLocation& where);

}  // namespace retrace::studies
