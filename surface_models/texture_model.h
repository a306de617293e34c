#pragma once

// From a measured map to the four numbers of a design's [surface]: roughness with its correlation length, waviness with
// its period.

#include <optional>

#include "surface_models/gaussian_filter.h"
#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// A surface as two independent textures: roughness with Gaussian autocorrelation, Sq^2 exp(-(distance / length)^2),
/// and waviness with one period. This is what the table [surface] of a design file describes.
struct TextureModel {
  double roughness_sq_nm = 0.0;  ///< 0 if no more is there than the filter leaves of the waviness
  /// 1/e of the autocorrelation; nothing if it does not fall to that within a cut-off, or if the roughness is 0.
  std::optional<double> correlation_length_um;
  double waviness_sq_nm = 0.0;               ///< 0 if no more is there than roughness explains
  std::optional<double> waviness_length_um;  ///< period: 2 pi Sq over the rms slope; nothing without waviness
};

/// The model of a levelled map that was split at `cutoff_um`. The filter leaves long roughness in the waviness and some
/// waviness in the roughness; both shares are known in closed form for the model and are put back where they belong, so
/// the result does not depend on the cut-off as Sq of either part does (docs/theory/metrology.md).
TextureModel texture_model(const Split& split, double cutoff_um);

}  // namespace retrace::surface_models
