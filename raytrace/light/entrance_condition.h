#pragma once

// Contamination and surface condition of an entrance face (docs/theory/entrance.md).

#include <optional>
#include <span>
#include <vector>

#include "materials/thick_layers.h"
#include "surface_models/scatter/scatter_model.h"

namespace retrace::raytrace {

/// Water drops in the shape of spherical caps. Light that meets a drop is traced through it.
struct Drops {
  double coverage = 0.0;           ///< fraction of the face under drops, 0 to 1
  double contact_angle_rad = 1.0;  ///< angle between drop and face at the rim; above 0, at most pi / 2
};

/// Dust particles. They absorb a part of the incident light and scatter the rest according to Lambert's law.
struct Dust {
  double coverage = 0.0;          ///< fraction of the face under dust, 0 to 1
  double albedo = 0.0;            ///< fraction of the incident light that is scattered
  double forward_fraction = 0.0;  ///< fraction of the scattered light that continues to the other side of the dust
};

/// Haze: a fraction of the light in the air at the face is scattered. The direction of this light changes: its
/// direction cosines along the face are shifted by a random vector with the density exp(-shift^2 / spread^2). Shifts to
/// directions outside of the unit disc are omitted.
struct Haze {
  double fraction = 0.0;  ///< fraction of the light that is deflected at each passage, 0 to 1
  double spread = 0.0;    ///< > 0 if `fraction` is > 0
};

/// Fine scratches. Light that meets a scratch is deflected: its direction cosine perpendicular to the scratch is
/// shifted by a random number with the density exp(-shift^2 / spread^2).
struct FineScratches {
  double coverage = 0.0;                   ///< fraction of the face under scratches, 0 to 1
  double spread = 0.0;                     ///< > 0 if `coverage` is > 0
  std::optional<double> azimuth_rad = {};  ///< direction of the scratches, from +x; if not set: random directions
};

/// Condition of a plane entrance face. The face is clean if all fractions are 0 and there are no layers.
struct EntranceCondition {
  /// Layers that are thick compared with the coherence length of the light, from the body outwards. They are on top of
  /// the thin layers of the face. If film_coverage is above 0, the last layer is water.
  std::vector<materials::ThickLayer> layers;
  double film_coverage = 0.0;  ///< fraction of the face on which the last of `layers` is present
  double water_index = 1.333;  ///< refractive index of the drops
  Drops drops;
  Dust dust;
  FineScratches scratches;
  Haze haze;
  surface_models::ScatterModel roughness;  ///< roughness of the bare face or of its thin layers

  std::span<const materials::ThickLayer> layers_under_film() const {
    return std::span(layers).first(layers.size() - (film_coverage > 0.0 ? 1 : 0));
  }
  double covered_fraction() const { return drops.coverage + dust.coverage + scratches.coverage; }
  bool is_rough() const { return !std::holds_alternative<surface_models::Smooth>(roughness); }
  /// Returns true if the face sends light into other directions than a smooth plane does.
  bool scatters() const { return covered_fraction() > 0.0 || haze.fraction > 0.0 || is_rough(); }
  bool absorbs() const {
    for (const materials::ThickLayer& layer : layers)
      if (layer.absorption_per_mm > 0.0) return true;
    return false;
  }
};

}  // namespace retrace::raytrace
