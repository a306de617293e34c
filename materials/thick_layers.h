#pragma once

// Plane layers that are thick compared with the coherence length of light, such as hard coats and films of water. The
// powers of all reflections are added, for s and p separately (docs/theory/entrance.md).

#include <span>

#include "materials/thin_film.h"

namespace retrace::materials {

/// Layer so thick that the phases of the reflections average out.
struct ThickLayer {
  double index = 1.0;  ///< relative to the air around the part, >= 1
  double thickness_mm = 0.0;
  double absorption_per_mm = 0.0;  ///< Napierian, for power
};

/// Returns the coefficients of a face of the body with thin and thick layers. The thin layers are next to the body. The
/// first of the `thick` layers is nearest to the body. The powers of reflections of different order are added, and the
/// squares of the coefficients are fractions of power. Within one order, s and p keep their phase difference.
/// r_coherence and t_coherence are the remaining degrees of coherence between s and p. R + T = 1 if nothing absorbs.
/// Light beyond the critical angle of a layer does not reach the layers behind it.
/// \param from_index n of the medium of the incident light, > 0
/// \param to_index n of the medium on the other side, > 0
/// \param cos_incidence 0..1
FresnelCoefficients fresnel_thick_layers(const LayerStack& thin, std::span<const ThickLayer> thick, StackSide from,
                                         double from_index, double to_index, double cos_incidence);

/// Returns the coefficients of a face that is a fine mixture of two types of area. The powers of both types are
/// averaged, and not the amplitudes.
/// \param fraction_of_other fraction of the area that has the coefficients `other`
/// \pre both coefficients are for the same media and angle of incidence
FresnelCoefficients mixed(const FresnelCoefficients& one, const FresnelCoefficients& other, double fraction_of_other);

}  // namespace retrace::materials
