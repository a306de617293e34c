#pragma once

// Scatter model of facets without texture: all light is specular.

#include "core/warning.h"
#include "surface_models/scatter/random_stream.h"
#include "surface_models/scatter/scatter_event.h"

namespace retrace::surface_models {

/// Ideal plane: all light is specular.
class Smooth {
 public:
  Facet sample_facet(const ScatterEvent&, RandomStream&) const { return {}; }
  double specular_fraction(const ScatterEvent&, const Facet&, Lobe) const { return 1.0; }
  std::optional<Vec2> sample_scattered(const ScatterEvent&, const Facet&, Lobe, RandomStream&) const { return {}; }
  double scattered_density(const ScatterEvent&, const Facet&, Lobe, const Vec2&) const { return 0.0; }
  double unmasked_fraction(const Vec3&) const { return 1.0; }
  Warnings warnings(double, double) const { return {}; }
};

}  // namespace retrace::surface_models
