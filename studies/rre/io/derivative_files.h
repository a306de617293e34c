#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "studies/rre/rre.h"

namespace retrace::studies {

/// An object by parameter with `value` and `error`, or why the derivative is left out as `left_out`.
nlohmann::ordered_json derivatives_json(const std::vector<RreDerivative>& derivatives);

/// A table for a terminal: the change of RRE, as a fraction, per unit of each parameter. Empty if none was asked for.
std::string derivative_table(const RreResult& result);

}  // namespace retrace::studies
