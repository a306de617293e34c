#pragma once

// Splits a height map into waviness and roughness with the linear areal Gaussian filter of ISO 16610-61. ISO 16610-21
// is used for profiles. The weighting function is
//   s(x, y) = exp(-pi (x^2 + y^2) / (a^2 L^2)) / (a^2 L^2),  a = sqrt(ln 2 / pi).
// A wave whose length is the cut-off L keeps half of its amplitude.

#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// Returns the fraction of the amplitude of waves with `frequency_per_um` that passes the filter: exp(-pi (a L f)^2) =
/// 2^-(L f)^2.
double gaussian_transmission(double frequency_per_um, double cutoff_um);

/// Half width of the sampled weighting function, in multiples of the cut-off. The neglected weight is below 1e-7.
inline constexpr double kGaussianReach = 1.0;

struct Split {
  HeightMap waviness;   ///< long waves, which pass the filter
  HeightMap roughness;  ///< the map minus its waviness
};

/// Splits a map at the cut-off. At borders and around missing points, the weights of the measured points are scaled to
/// the sum 1 (normalised convolution; ISO 16610-61, 4.3.3). A constant therefore passes unchanged everywhere. Within
/// half a cut-off of a border, the fraction of a wave's amplitude that passes the filter differs from that in the
/// interior. Missing points stay missing.
/// \pre cutoff_um > 0
Split gaussian_split(const HeightMap& map, double cutoff_um);

}  // namespace retrace::surface_models
