#pragma once

// Splits a height map into waviness and roughness by the linear areal Gaussian filter of ISO 16610-61 (ISO 16610-21 for
// a profile), with the weighting function
//   s(x, y) = exp(-pi (x^2 + y^2) / (a^2 L^2)) / (a^2 L^2),  a = sqrt(ln 2 / pi),
// which passes half of the amplitude of waves as long as the cut-off L.

#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// Which share of the amplitude of waves of `frequency_per_um` passes: exp(-pi (a L f)^2) = 2^-(L f)^2.
double gaussian_transmission(double frequency_per_um, double cutoff_um);

/// Where the sampled weighting function is cut, in cut-offs to each side: what is left out is below 1e-7.
inline constexpr double kGaussianReach = 1.0;

struct Split {
  HeightMap waviness;   ///< the long waves: what passes the filter
  HeightMap roughness;  ///< the map less its waviness
};

/// Splits a map at the cut-off. At borders and around missing points the weights of what is measured are scaled to the
/// sum of 1 (ISO 16610-61, 4.3.3: normalised convolution), so a constant passes unchanged everywhere; within half a
/// cut-off of a border waves pass with other shares than inside. Missing points stay missing.
/// \pre cutoff_um > 0
Split gaussian_split(const HeightMap& map, double cutoff_um);

}  // namespace retrace::surface_models
