#pragma once

// What the symmetry of a design makes certain of RRE over the azimuth of the light.

#include <optional>

#include "studies/design/design.h"

namespace retrace::studies {

/// RRE(t, p) = RRE(t, p + period_deg), and RRE(t, mirror_deg + d) = RRE(t, mirror_deg - d).
struct AzimuthSymmetry {
  double period_deg = 360.0;
  double mirror_deg = 0.0;
};

/// Of endless arrays and single elements whose elements are alike and symmetric, in unpolarised light. None where that
/// is not certain: borders, errors of single facets, cants, scratches.
std::optional<AzimuthSymmetry> azimuth_symmetry(const Design& design);

}  // namespace retrace::studies
