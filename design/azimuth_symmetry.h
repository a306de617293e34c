#pragma once

// Symmetries of RRE (the retroreflective efficiency) with respect to the azimuth of the light. They follow from the
// symmetry of a design.

#include <optional>

#include "design/design.h"

namespace retrace::design {

/// Symmetry of RRE over incidence t and azimuth p: RRE(t, p) = RRE(t, p + period_deg), and RRE(t, mirror_deg + d) =
/// RRE(t, mirror_deg - d).
struct AzimuthSymmetry {
  double period_deg = 360.0;
  double mirror_deg = 0.0;
};

/// Returns the symmetry of infinite arrays and single elements in unpolarised light, if all elements are equal and
/// symmetric. Returns nothing if the symmetry is not certain, because of borders, errors of single facets, cants or
/// scratches.
std::optional<AzimuthSymmetry> azimuth_symmetry(const Design& design);

}  // namespace retrace::design
