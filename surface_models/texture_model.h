#pragma once

// Converts a measured map to the four texture parameters of a design's table [surface]: roughness and its correlation
// length, waviness and its period.

#include <optional>

#include "surface_models/gaussian_filter.h"

namespace retrace::surface_models {

/// Model of a surface as two independent textures: roughness with Gaussian autocorrelation, Sq^2 exp(-(distance /
/// length)^2), and waviness with one period. The table [surface] of a design file describes this model.
struct TextureModel {
  /// Rms height. It is 0 if the waviness that the filter leaves in the roughness map explains the variance of this map.
  double roughness_sq_nm = 0.0;
  /// Distance at which the autocorrelation is 1/e. Not set if it does not fall to 1/e within a cut-off or if the
  /// roughness is 0.
  std::optional<double> correlation_length_um;
  /// Rms height. It is 0 if the roughness that the filter leaves in the waviness map explains the variance of this map.
  double waviness_sq_nm = 0.0;
  std::optional<double> waviness_length_um;  ///< period: 2 pi Sq over the rms slope; not set without waviness
};

/// Returns the model of a map that was levelled (its form was subtracted) and split at `cutoff_um`. The filter leaves
/// long roughness in the waviness and some waviness in the roughness. For this model, both fractions are known in
/// closed form and are corrected. The result therefore does not depend on the cut-off, in contrast to Sq of the two
/// maps (docs/theory/metrology.md).
TextureModel texture_model(const Split& split, double cutoff_um);

}  // namespace retrace::surface_models
