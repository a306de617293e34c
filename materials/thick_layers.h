#pragma once

// Plane layers that are thick against the coherence of light, such as hard coats and films of water: powers of all
// their reflections added up, s and p apart (docs/theory/entrance.md).

#include <span>

#include "materials/thin_film.h"

namespace retrace::materials {

/// A layer whose phases average out.
struct ThickLayer {
  double index = 1.0;  ///< relative to the air around the part, >= 1
  double thickness_mm = 0.0;
  double absorption_per_mm = 0.0;  ///< Napierian, for power
};

/// A face of the body that has `thin` layers on it and `thick` ones on these, the one nearest to the body first.
/// Reflections add by power, so that the coefficients' squares are shares of power; s and p of one order keep their
/// phase difference, orders have none between them, and r_coherence and t_coherence say how much of the coherence of s
/// and p is left. R + T = 1 where nothing absorbs. Light beyond the critical angle of a layer meets nothing behind it.
/// \param from_index n of the medium light comes from, > 0 \param to_index n of that on the other side, > 0
/// \param cos_incidence 0..1
FresnelCoefficients fresnel_thick_layers(const LayerStack& thin, std::span<const ThickLayer> thick, StackSide from,
                                         double from_index, double to_index, double cos_incidence);

/// A face of which a share `share_of_other` is like `other` and the rest like `one`, in pieces that light does not tell
/// apart: means of powers. \pre both are of the same media and angle of incidence
FresnelCoefficients mixed(const FresnelCoefficients& one, const FresnelCoefficients& other, double share_of_other);

}  // namespace retrace::materials
