#pragma once

// The closed forms that `retrace validate` holds the tracer to, under the names of tests.

#include "studies/validation/closed_forms.h"

namespace retrace::testing {

using studies::closed_forms::cos_inner;
using studies::closed_forms::edge_cosines;
using studies::closed_forms::hexagonal_share;
using studies::closed_forms::honeycomb_rre;
using studies::closed_forms::kDeg;
using studies::closed_forms::triangular_rre;
using studies::closed_forms::triangular_share;

}  // namespace retrace::testing
