#pragma once

// Stacks of thin plane layers on a face, such as anti-reflection coatings and metal films: amplitudes for s and p by
// characteristic matrices (docs/theory/thin_films.md).

#include <complex>
#include <vector>

#include "materials/fresnel.h"

namespace retrace::materials {

/// A layer at one wavelength.
struct ThinLayer {
  std::complex<double> index = 1.0;  ///< n + i k relative to the air around the part, k >= 0
  double thickness = 0.0;            ///< in wavelengths in that air, >= 0; infinite: opaque, which needs k > 0
};

/// Layers on a face, from the body outwards.
struct LayerStack {
  std::vector<ThinLayer> layers;

  bool empty() const { return layers.empty(); }
  /// Whether a layer takes light.
  bool absorbs() const;
  /// Whether a layer lets nothing through.
  bool is_opaque() const;
};

/// From where light meets a stack.
enum class StackSide { body, outside };

/// Of a face with layers on it: of the bare face, or the metal, if there are no layers in front of what ends them.
/// Phases are those of the field at the outermost faces of the stack, all of which counts as lying in the plane of the
/// face. r^2 + t^2 <= 1 for each component; the rest is absorbed. total_reflection is set where nothing passes: behind
/// the critical angle of the last medium, or an opaque layer. \param from_index n of the medium light comes from, > 0
/// \param to_index n of that on the other side of the stack, > 0 \param cos_incidence 0..1 (values beyond by rounding
/// are clamped). After Abeles, Ann. Phys. (Paris) 5, 596 (1950).
FresnelCoefficients fresnel_layers(const LayerStack& stack, StackSide from, double from_index, double to_index,
                                   double cos_incidence);

}  // namespace retrace::materials
