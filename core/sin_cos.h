#pragma once

// Sine and cosine that are exact at multiples of 15 degrees, for computing directions and rotations.

#include "core/angle.h"

namespace retrace {

struct SinCos {
  double sin = 0.0;
  double cos = 1.0;
};

/// Returns the sine and the cosine of an angle. At multiples of 15 degrees, both are the doubles nearest to the exact
/// values. For example, the sine of 180 degrees is exactly 0, whereas std::sin returns 1.2e-16. An angle is regarded as
/// a multiple of 15 degrees if it differs from such a multiple only by the rounding errors of a conversion to radians
/// and back.
SinCos sin_cos(Angle angle);

/// Returns the sine and the cosine of an angle in degrees.
inline SinCos sin_cos_deg(double deg) {
  return sin_cos(Angle::from_deg(deg));
}

}  // namespace retrace
