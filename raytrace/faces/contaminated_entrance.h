#pragma once

// Rays at an entrance face that scatters because of roughness, haze, dust, scratches or water drops.

#include <vector>

#include "raytrace/faces/textured_facet.h"

namespace retrace::raytrace {

/// Rays and power after a ray has met a scattering entrance face.
struct EntranceScatter {
  std::vector<Ray> rays;   ///< rays in the body, or rays in the air that travel away from the face
  double absorbed = 0.0;   ///< power that layers and dust absorb
  double truncated = 0.0;  ///< untraced power plus the error of the roughness model; may be negative

  void clear() { *this = {std::move(rays), 0.0, 0.0}, rays.clear(); }
};

/// A plane entrance face with the normal +z that scatters. A ray meets a single position of the face. This position is
/// clean or under one kind of contamination, with probabilities equal to the area fractions. Light that is reflected
/// back to the face meets the same position. Theory: docs/theory/entrance.md.
class ContaminatedEntrance {
 public:
  /// \pre optics.entrance.scatters()
  explicit ContaminatedEntrance(const Optics& optics);

  /// Appends to `result` the rays into which the face splits an incident ray. The power is preserved: the power of the
  /// rays, the absorbed and the truncated power add up to the power of the ray.
  /// \param split_power minimum power of the branches of a clean face at which both are traced, see PathPolicy
  void meet(const Ray& ray, double split_power, surface_models::RandomStream& random, EntranceScatter& result) const;

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
  Optics as_facet_;  ///< result of entrance_as_facet()
};

/// Returns optics in which the facets have the properties of the rough entrance face, with air behind them. The
/// functions of textured_facet.h can then process this face.
Optics entrance_as_facet(const Optics& optics);

/// Adds light that a scattering entrance face reflects from outside to the tally.
/// \param ray reflected ray, in the air
void add_entrance_reflection(const LightSetup& setup, const Ray& ray, Tally& tally);

}  // namespace retrace::raytrace
