#pragma once

// Stacks of thin plane layers on a face, such as anti-reflection coatings and metal films. Amplitudes for s and p are
// computed with characteristic matrices (docs/theory/thin_films.md).

#include <complex>
#include <vector>

#include "materials/fresnel.h"

namespace retrace::materials {

/// Properties of a layer at one wavelength.
struct ThinLayer {
  std::complex<double> index = 1.0;  ///< n + i k relative to the air around the part, k >= 0
  /// thickness in wavelengths in the air around the part, >= 0; infinite for an opaque layer, which requires k > 0
  double thickness = 0.0;
};

/// Layers on a face, in order from the body outward.
struct LayerStack {
  std::vector<ThinLayer> layers;

  bool empty() const { return layers.empty(); }
  /// Returns true if a layer absorbs light.
  bool absorbs() const;
  /// Returns true if a layer is opaque.
  bool is_opaque() const;
};

/// Side from which light reaches a stack.
enum class StackSide { body, outside };

/// Returns the coefficients of a face with layers (Abeles, Ann. Phys. (Paris) 5, 596 (1950)). Without layers, these are
/// the coefficients of the bare face. If the first layer that the light reaches is opaque, these are the coefficients
/// of a thick metal with the index of this layer. Phases are those of the field at the outermost faces of the stack.
/// The thickness of the stack is neglected: all its faces are treated as located in the plane of the face. r^2 + t^2 <=
/// 1 for each component; the remaining power is absorbed. total_reflection is set if nothing is transmitted, because of
/// total reflection at the last medium or because of an opaque layer.
/// \param from_index n of the medium of the incident light, > 0
/// \param to_index n of the medium on the other side of the stack, > 0
/// \param cos_incidence 0..1; values outside because of rounding are clamped
FresnelCoefficients fresnel_layers(const LayerStack& stack, StackSide from, double from_index, double to_index,
                                   double cos_incidence);

}  // namespace retrace::materials
