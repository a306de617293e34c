#pragma once

// What all tracers share: the part's bounding planes, the light that enters, acceptance cones, and the sums of power
// they keep.

#include <cstdint>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/light/coherent_light.h"
#include "raytrace/light/ledger.h"
#include "raytrace/light/optics.h"
#include "raytrace/observers/direction_score.h"

namespace retrace::raytrace {

/// One part, lit from one direction: what every tracer needs to know of it. Positions are relative to the centre of the
/// entrance face in x and y.
struct LightSetup {
  /// A side of the part: a vertical plane.
  struct Side {
    Vec3 normal = Vec3::UnitX();  ///< out of the part
    double offset_mm = 0.0;
  };

  /// \param cones_deg half angles of the acceptance cones, ascending, each > 0
  LightSetup(const geometry::Part& part, const Vec2& centre_mm, const Optics& optics, const Illumination& illumination,
             const std::vector<double>& cones_deg);

  Optics optics;
  double thickness_mm = 0.0;
  double depth_mm = 0.0;  ///< the back surface lies in -depth_mm <= z <= top_mm
  double top_mm = 0.0;
  std::vector<Side> sides;  ///< empty for an infinite part
  Vec3 to_source = Vec3::UnitZ();
  Light incident;                         ///< of the beam, along -to_source
  const DirectionScore* score = nullptr;  ///< sums over the directions in which light leaves; null: none are kept
  std::vector<double> cone_chord2;  ///< squared distance of unit vectors at each cone's edge from the one to the source

  bool infinite() const { return sides.empty(); }

  /// The narrowest cone that holds a direction; their number if none does.
  std::size_t cone_of(const Vec3& direction) const { return cone_of(direction, to_source); }
  /// The same of light that came from elsewhere. \param back to where it came from
  std::size_t cone_of(const Vec3& direction, const Vec3& back) const;

  /// What the entrance face makes of the incident light.
  struct Entry {
    Vec3 direction = -Vec3::UnitZ();  ///< of what enters
    CoherentLight light;
    Vec3 front_direction = Vec3::UnitZ();  ///< direction in which light travels after reflection outside the part
    std::size_t front_cone = 0;            ///< narrowest cone that contains `front_direction`, see cone_of()
    Stokes front;  ///< Stokes parameters of the reflected light, with source_axis(front_direction) as first axis
    /// Jones matrix of the reflection. The first axis is source_axis(to_source) before and
    /// source_axis(front_direction) after the reflection.
    JonesMatrix front_jones = JonesMatrix::Zero();
    double absorbed = 0.0;  ///< power that the layers on the entrance face absorb
  };
  Entry entry;

 private:
  Entry enter(const Stokes& stokes) const;
};

/// Sums of power over paths or beams. What leaves through the entrance face is kept by acceptance cone, so that one run
/// serves several cones.
struct Tally {
  explicit Tally(std::size_t cone_count = 0, std::size_t score_size = 0)
      : returned(cone_count + 1), scattered(cone_count + 1), front(cone_count + 1), score(score_size, 0.0) {}

  std::vector<Stokes> returned;   ///< through the entrance, by the narrowest cone that holds it; last: outside all
  std::vector<Stokes> scattered;  ///< the same for light with a non-specular event on its way
  std::vector<Stokes> front;      ///< first-surface reflection, likewise
  std::vector<double> score;      ///< of LightSetup::score; empty without one
  Ledger other;                   ///< the remaining accounts
  std::uint64_t segments = 0;     ///< straight pieces traced
  std::uint64_t misses = 0;       ///< rays that missed every face although the part or its surface surrounds them

  void add(const Tally& more);
  /// Nothing is in it any more.
  void clear();
  /// The ledger for one cone, in units of the tally. \param cone index into the cones of the set-up
  Ledger ledger(std::size_t cone) const;
  /// Of what is retroreflected into one cone.
  Stokes retroreflected(std::size_t cone) const;
};

/// The first axis of the Stokes parameters of light that comes from or goes into a direction above the part: +x, seen
/// across it. The second is `direction` x it, so that both axes are as seen from the source.
/// \pre direction not along x
Vec3 source_axis(const Vec3& direction);

/// From the part to the source, in the part frame.
Vec3 direction_to_source(const Illumination& illumination);

/// Light of the incident beam, which travels along -`to_source`. \param stokes along source_axis(to_source)
Light light_of_beam(const Stokes& stokes, const Vec3& to_source);

/// Stokes parameters of light that leaves the entrance face, along source_axis().
Stokes seen_from_above(Light light, const Vec3& direction);

/// Where light is booked that left the part for good through a face of this role. \pre not the entrance
Account account_of_exit(geometry::FacetRole role);

/// What a face of the back surface makes of light on its way, inside the part or outside.
materials::FresnelCoefficients fresnel_at_back(const Optics& optics, geometry::FacetRole role, bool inside,
                                               double cos_incidence);

/// What the entrance face makes of light from inside the part or outside; of an ideal one only the directions count.
materials::FresnelCoefficients fresnel_at_entrance(const Optics& optics, bool inside, double cos_incidence);

/// The same under a drop: of the face with its layers but for the film, next to a medium other than air.
materials::FresnelCoefficients fresnel_under_drop(const Optics& optics, bool inside, double cos_incidence);

/// What the mirror behind a ball makes of light that comes from the ball's side, through a medium of index
/// `from_index`. \pre the facets are mirrors or have an opaque layer
materials::FresnelCoefficients fresnel_at_mirror(const Optics& optics, double from_index, double cos_incidence);

/// The power that layers on a face took of light that met it.
inline double absorbed_by(const materials::LayerStack& layers, const Light& met, const Light& reflected,
                          const Light& transmitted) {
  return layers.absorbs() ? met.power() - reflected.power() - transmitted.power() : 0.0;
}

/// The same of the entrance face.
inline double absorbed_at_entrance(const Optics& optics, const Light& met, const Light& reflected,
                                   const Light& transmitted) {
  return optics.entrance_absorbs() ? met.power() - reflected.power() - transmitted.power() : 0.0;
}

/// The same of a face of the back surface.
double absorbed_at_back(const Optics& optics, geometry::FacetRole role, const Light& met, const Light& reflected,
                        const Light& transmitted);

/// The direction after refraction at a plane whose unit normal `against` faces the ray. \param ratio index before over
/// after
Vec3 refracted(const Vec3& direction, const Vec3& against, double ratio, double cos_incidence, double cos_refracted);

/// The direction after reflection at a plane.
Vec3 mirrored(const Vec3& direction, const Vec3& normal);

}  // namespace retrace::raytrace
