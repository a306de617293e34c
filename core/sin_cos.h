#pragma once

// Sines and cosines of angles, from which directions and rotations are computed.

#include "core/angle.h"

namespace retrace {

struct SinCos {
  double sin = 0.0;
  double cos = 1.0;
};

/// Returns the sine and the cosine of an angle. At multiples of 15 degrees, both are the doubles nearest to the exact
/// values. A direction along a coordinate axis therefore has components of exactly 0 along the other axes. An angle
/// counts as a multiple of 15 degrees if it differs from this multiple by at most the rounding error of a conversion
/// between degrees and radians.
SinCos sin_cos(Angle angle);

/// Returns the sine and the cosine of an angle in degrees.
inline SinCos sin_cos_deg(double deg) {
  return sin_cos(Angle::from_deg(deg));
}

}  // namespace retrace
