#pragma once

// Results of a run of the exact engine: the ledger, the beams that leave, and the light that rough facets scatter.

#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/exact/beam_scene.h"

namespace retrace::raytrace {

/// Adds the power of beams to the accounts of the ledger. The power that is passed with a beam is that of a single
/// copy. It is multiplied by the number of copies that the beam represents (Beam::instance_count()).
class BeamRecord {
 public:
  BeamRecord(const BeamScene& scene, BeamObserver observer);

  /// Makes the record append a ScatterSite to `sites` wherever a rough facet scatters light. Without this call, the
  /// scattered power is added to `truncated`.
  void collect_scatter_sites(std::vector<ScatterSite>& sites) { sites_ = &sites; }
  /// Sets the replicate number of the returned beams that the observer receives.
  void set_replicate(std::uint32_t replicate) { replicate_ = replicate; }

  /// Adds power of a beam to the ledger.
  void add_to_ledger(const Beam& beam, Account account, double power) {
    tally_.other[account] += beam.instance_count() * power;
  }
  /// Adds power to `truncated`. The power must include all copies of the beams.
  void add_truncated(double power) { tally_.other[Account::truncated] += power; }
  /// Adds to `truncated` the power that is lost by rounding. This power is negative if fragments overlap.
  /// \param area_fraction part of beam.area_fraction that is lost
  void add_rounding_loss(const Beam& beam, double area_fraction) {
    add_to_ledger(beam, Account::truncated, area_fraction / beam.area_fraction * power_of(beam));
  }
  /// Adds a scattering site, or adds the scattered power to `truncated` if sites are not collected.
  /// \param beam beam that arrives; its light is expressed in the s and p axes of the facet
  void scatter(const Beam& beam, const Plane& plane, double power);
  /// Records the incident light that the entrance face reflects or absorbs.
  void enter();
  /// Records light that leaves through the entrance face.
  /// \param direction direction of the light in air
  void leave_through_entrance(const Beam& beam, CoherentLight light, const Vec3& direction);
  /// Clips a beam on the entrance face to a convex polygon. The polygon is relative to the centre of the face. The
  /// power of the clipped light is added to `stopped`. Returns false if the beam is completely outside the polygon.
  /// \param power power of the beam before absorption in the part, that is, divided by transmission_of(beam)
  bool keep_within(Beam& beam, const geometry::Polygon& area, double power);
  /// Adds the light of a beam to the light that leaves through the entrance face outside of all cones.
  void leave_outside_cones(const Beam& beam) { tally_.returned.back().i += beam.instance_count() * power_of(beam); }

  const Tally& tally() const { return tally_; }
  /// Returns the ledger and the light of each cone.
  BeamResult result() const;

 private:
  ReturnedBeam returned_beam(const Beam& beam, CoherentLight light, const Vec3& direction) const;
  void enter_past_stops();
  ReturnedBeam reflection_of_face() const;
  void observe_entrance_reflection() const;
  void record_leaving(const Beam& beam, CoherentLight light, const Vec3& direction);

  BeamScene scene_;
  BeamObserver observer_;
  std::vector<ScatterSite>* sites_ = nullptr;
  std::optional<std::uint32_t> replicate_;
  Tally tally_;
};

}  // namespace retrace::raytrace
