#pragma once

// Rays at an entrance face that scatters: its roughness and haze, and the spots on it - dust, scratches, drops of
// water.

#include <vector>

#include "raytrace/paths/textured_facet.h"

namespace retrace::raytrace {

/// What becomes of a ray that has met such a face.
struct SoiledReturn {
  std::vector<Ray> rays;   ///< in the body, or in the air and on their way from the face
  double absorbed = 0.0;   ///< power that layers and dust take
  double truncated = 0.0;  ///< power that was followed no further, or that roughness keeps, or gives (negative)

  void clear() { *this = {std::move(rays), 0.0, 0.0}, rays.clear(); }
};

/// A plane entrance face with the normal +z in a condition that scatters. Light meets one place of it, which is clean
/// or under one kind of spot by its share of the area, from either side and on its way back as well. Theory:
/// docs/theory/entrance.md.
class SoiledEntrance {
 public:
  /// \pre optics.entrance.scatters()
  explicit SoiledEntrance(const Optics& optics);

  /// Power is kept: that of the rays, what is absorbed and what is truncated add to the ray's. Adds to `result`.
  /// \param split_power least power of a branch for both to be followed where the face is clean, as PathPolicy has it
  void meet(const Ray& ray, double split_power, surface_models::RandomStream& random, SoiledReturn& result) const;

 private:
  struct Event;
  struct Branches;

  void meet_clean(const Ray& ray, Event& event) const;
  void meet_face(const Ray& ray, Event& event) const;
  void send(const Ray& ray, Event& event) const;
  template <class On>
  void pass_haze(const Ray& ray, Event& event, const On& on) const;
  void meet_dust(Ray ray, Event& event) const;
  void meet_scratch(Ray ray, Event& event) const;
  void meet_drop(Ray ray, Event& event) const;
  void leave_drop(Ray ray, Event& event) const;
  Branches at_face(const Ray& ray, Event& event) const;
  Ray one_of(Branches branches, Event& event) const;

  Optics optics_;
  Optics as_facet_;  ///< the rough face as a facet: what lies behind it is air
};

/// The rough entrance face as a facet with air behind it, for the functions of textured_facet.h.
Optics entrance_as_facet(const Optics& optics);

/// Books light that a scattering face sends back at once. \param ray in the air
void book_front(const LightSetup& setup, const Ray& ray, Tally& tally);

}  // namespace retrace::raytrace
