#pragma once

// What lies on an entrance face that is not clean, and what its own surface is like (docs/theory/entrance.md).

#include <optional>
#include <span>
#include <vector>

#include "materials/thick_layers.h"
#include "surface_models/scatter/scatter_model.h"

namespace retrace::raytrace {

/// Water as caps of spheres. Light that meets one is followed through it.
struct Drops {
  double coverage = 0.0;           ///< share of the face under them, 0..1
  double contact_angle_rad = 1.0;  ///< between their surface and the face, at their rim; above 0, at most pi / 2
};

/// Spots that absorb a part of what falls on them and scatter the rest by Lambert's law.
struct Dust {
  double coverage = 0.0;       ///< share of the face under it, 0..1
  double albedo = 0.0;         ///< share of the light on it that it scatters
  double forward_share = 0.0;  ///< of that: what goes on to its other side
};

/// Light on its way through the air at a face that is thrown off: direction cosines along the face get a Gaussian shift
/// exp(-shift^2 / spread^2); one that would leave the air's unit disc is not made.
struct Haze {
  double share = 0.0;   ///< of the light of each passage that gets a shift, 0..1
  double spread = 0.0;  ///< > 0 where there is a share
};

/// The same across lines.
struct FineScratches {
  double coverage = 0.0;                   ///< share of the face that they take, 0..1
  double spread = 0.0;                     ///< > 0 where there are any
  std::optional<double> azimuth_rad = {};  ///< of the lines, from +x; none: all directions alike
};

/// The state of a flat entrance face. All shares at 0 and no layers: clean.
struct EntranceCondition {
  /// Thick against the coherence of light, on the thin layers of the face, from the body outwards; water last, where
  /// film_coverage says that there is some.
  std::vector<materials::ThickLayer> layers;
  double film_coverage = 0.0;  ///< share of the face on which the last of `layers` lies
  double water_index = 1.333;  ///< of drops
  Drops drops;
  Dust dust;
  FineScratches scratches;
  Haze haze;
  surface_models::ScatterModel roughness;  ///< of the bare face or of its thin layers

  std::span<const materials::ThickLayer> layers_under_film() const {
    return std::span(layers).first(layers.size() - (film_coverage > 0.0 ? 1 : 0));
  }
  double spots() const { return drops.coverage + dust.coverage + scratches.coverage; }
  bool is_rough() const { return !std::holds_alternative<surface_models::Smooth>(roughness); }
  /// Whether light leaves the face in more directions than a plane sends it to.
  bool scatters() const { return spots() > 0.0 || haze.share > 0.0 || is_rough(); }
  bool absorbs() const {
    for (const materials::ThickLayer& layer : layers)
      if (layer.absorption_per_mm > 0.0) return true;
    return false;
  }
};

}  // namespace retrace::raytrace
