#pragma once

// Makes the closed forms of `retrace validate` available in the namespace of the tests.

#include "studies/validation/closed_forms.h"

namespace retrace::testing {

using studies::closed_forms::cos_inner;
using studies::closed_forms::edge_cosines;
using studies::closed_forms::hexagonal_fraction;
using studies::closed_forms::honeycomb_rre;
using studies::closed_forms::kDeg;
using studies::closed_forms::triangular_fraction;
using studies::closed_forms::triangular_rre;

}  // namespace retrace::testing
