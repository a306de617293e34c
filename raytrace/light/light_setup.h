#pragma once

// Data that all tracers use: the bounding planes of the part, the light that enters the part, the acceptance cones, and
// the sums of power.

#include <cstdint>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/light/coherent_light.h"
#include "raytrace/light/direction_score.h"
#include "raytrace/light/face_stops.h"
#include "raytrace/light/ledger.h"
#include "raytrace/light/optics.h"

namespace retrace::raytrace {

/// A part that is illuminated from one direction. Positions are relative to the centre of the entrance face in x and y.
struct LightSetup {
  /// A vertical side plane of the part.
  struct Side {
    Vec3 normal = Vec3::UnitX();  ///< points out of the part
    double offset_mm = 0.0;
  };

  /// \param cones_deg half angles of the acceptance cones, ascending, each > 0
  LightSetup(const geometry::Part& part, const Vec2& centre_mm, const Optics& optics, const Illumination& illumination,
             const std::vector<double>& cones_deg);

  Optics optics;
  double thickness_mm = 0.0;
  double depth_mm = 0.0;  ///< the back surface is in the range -depth_mm <= z <= top_mm
  double top_mm = 0.0;
  std::vector<Side> sides;  ///< empty for an infinite part
  FaceStops stops;          ///< chamfer of the entrance face and mount in front of it
  Vec3 to_source = Vec3::UnitZ();
  /// Light of the incident beam, which travels along -to_source. If all shells are plane-parallel, this is the light
  /// behind the shells. Otherwise, it is the light in front of them.
  Light incident;
  ShellLosses arrival_losses;             ///< power that the incident light loses in plane-parallel shells
  const DirectionScore* score = nullptr;  ///< function that is summed over the light that leaves; may be null
  std::vector<double> cone_chord2;        ///< per cone: squared distance between unit vectors to its edge and its axis

  bool infinite() const { return sides.empty(); }

  /// Returns the index of the narrowest cone that contains a direction, or the number of cones if none does.
  std::size_t cone_of(const Vec3& direction) const { return cone_of(direction, to_source); }
  /// Returns the index of the narrowest cone about the direction `back` that contains `direction`.
  /// \param back axis of the cones; use this function for light that does not come from `to_source`
  std::size_t cone_of(const Vec3& direction, const Vec3& back) const;

  /// Light after the incident light has met the entrance face.
  struct Entry {
    Vec3 direction = -Vec3::UnitZ();  ///< direction of the light that enters the part
    CoherentLight light;
    Vec3 reflected_direction = Vec3::UnitZ();  ///< direction in air of the light that the face reflects
    std::size_t reflected_cone = 0;            ///< narrowest cone that contains `reflected_direction`, see cone_of()
    Stokes
        reflected;  ///< Stokes parameters of the reflected light, with source_axis(reflected_direction) as first axis
    /// Jones matrix of the reflection. The first axis of the incident field is source_axis(to_source). The first axis
    /// of the reflected field is source_axis(reflected_direction).
    JonesMatrix reflected_jones = JonesMatrix::Zero();
    double absorbed = 0.0;         ///< power that the layers on the entrance face absorb
    ShellLosses reflected_losses;  ///< power that the reflected light loses in plane-parallel shells
  };
  Entry entry;

  /// Reduces light that has left through the entrance face by the losses in plane-parallel shells. Returns these
  /// losses.
  /// \param direction direction of the light in air
  /// \pre !deflect(optics.shells)
  template <class AnyLight>
  ShellLosses pass_shells_outward(AnyLight& light, const Vec3& direction) const {
    return optics.shells.empty() ? ShellLosses{}
                                 : pass_plates(optics.shells, ShellPassage::from_part, direction, light);
  }

 private:
  Entry enter(const CoherentLight& light) const;
};

/// Sums of power over paths or beams. Light that leaves through the entrance face is stored per acceptance cone, so
/// that a single trace gives the results for several cones.
struct Tally {
  explicit Tally(std::size_t cone_count = 0, std::size_t score_size = 0)
      : returned(cone_count + 1),
        scattered(cone_count + 1),
        entrance_reflected(cone_count + 1),
        score(score_size, 0.0) {}

  /// Light that left through the entrance face, by the narrowest cone that contains it. The last element is the light
  /// outside all cones. The following two vectors have the same order.
  std::vector<Stokes> returned;
  std::vector<Stokes> scattered;           ///< light with at least one non-specular event on its path
  std::vector<Stokes> entrance_reflected;  ///< light that the entrance face reflects from outside
  std::vector<double> score;               ///< sums of LightSetup::score; empty without a score
  Ledger other;                            ///< the remaining accounts
  std::uint64_t segments = 0;              ///< number of straight ray segments traced
  std::uint64_t misses = 0;                ///< number of rays that missed every face although faces surround them
  void add(const Tally& more);
  /// Adds the power that light has lost in shells to the accounts.
  /// \param missed account to which ShellLosses::missed is added
  /// \param factor factor by which the losses are multiplied
  void add(const ShellLosses& losses, Account missed, double factor = 1.0);
  /// Sets all sums to 0.
  void clear();
  /// Returns the ledger for one cone. Its powers have the unit of the sums of this tally.
  /// \param cone index into the cones of the set-up
  Ledger ledger(std::size_t cone) const;
  /// Returns the Stokes parameters of the light that is retroreflected into one cone.
  Stokes retroreflected(std::size_t cone) const;
};

/// Returns the first axis of the Stokes parameters of light above the part that travels along `direction` or against
/// it. It is the projection of +x perpendicular to `direction`. The second axis is `direction` x first axis. Seen from
/// the source, the first axis points to the right and the second axis up.
/// \pre `direction` is not parallel to x
Vec3 source_axis(const Vec3& direction);

/// Returns the unit vector from the part to the source, in the part frame.
Vec3 direction_to_source(const Illumination& illumination);

/// Returns the light of the incident beam, which travels along -`to_source`.
/// \param stokes Stokes parameters with source_axis(to_source) as first axis
Light light_of_beam(const Stokes& stokes, const Vec3& to_source);

/// Returns the Stokes parameters of light that leaves the entrance face, with source_axis(direction) as first axis.
Stokes in_source_axes(Light light, const Vec3& direction);

/// Returns the account for light that leaves the part through a face with this role and does not enter again.
/// \pre the face is not the entrance
Account account_of_exit(geometry::FacetRole role);

/// Returns the Fresnel coefficients of a face of the back surface, for light from inside or outside the part.
materials::FresnelCoefficients fresnel_at_back(const Optics& optics, geometry::FacetRole role, bool inside,
                                               double cos_incidence);

/// Returns the refractive index before a face of the back surface divided by the index after the face. Sides of the
/// plate are in air.
inline double ratio_at_face(const Optics& optics, geometry::FacetRole role, bool inside) {
  if (role != geometry::FacetRole::side) return optics.ratio_at_back(inside);
  return inside ? optics.index : 1.0 / optics.index;
}

/// Returns the Fresnel coefficients of the entrance face for light from inside or outside the part. For
/// `lossless_entrance`, only the angle of refraction is valid, and the amplitudes must not be used.
materials::FresnelCoefficients fresnel_at_entrance(const Optics& optics, bool inside, double cos_incidence);

/// Returns the Fresnel coefficients of the entrance face under a drop of water. The face has its layers except for the
/// film, and the outer medium is water instead of air.
materials::FresnelCoefficients fresnel_under_drop(const Optics& optics, bool inside, double cos_incidence);

/// Returns the Fresnel coefficients of the mirror behind a ball, for light from the ball's side.
/// \param from_index refractive index of the medium in front of the mirror
/// \pre the facets are mirrors or have an opaque layer
materials::FresnelCoefficients fresnel_at_mirror(const Optics& optics, double from_index, double cos_incidence);

/// Returns the power that the layers on a face absorb.
inline double absorbed_by(const materials::LayerStack& layers, const Light& met, const Light& reflected,
                          const Light& transmitted) {
  return layers.absorbs() ? met.power() - reflected.power() - transmitted.power() : 0.0;
}

/// Returns the power that the layers on the entrance face absorb.
inline double absorbed_at_entrance(const Optics& optics, const Light& met, const Light& reflected,
                                   const Light& transmitted) {
  return optics.entrance_absorbs() ? met.power() - reflected.power() - transmitted.power() : 0.0;
}

/// Returns the power that the layers on a face of the back surface absorb.
double absorbed_at_back(const Optics& optics, geometry::FacetRole role, const Light& met, const Light& reflected,
                        const Light& transmitted);

/// Returns the direction after refraction at a plane. The unit normal `facing_normal` faces the ray.
/// \param ratio refractive index before the plane divided by that after the plane
Vec3 refracted(const Vec3& direction, const Vec3& facing_normal, double ratio, double cos_incidence,
               double cos_refracted);

/// Returns the direction after reflection at a plane.
Vec3 mirrored(const Vec3& direction, const Vec3& normal);

}  // namespace retrace::raytrace
