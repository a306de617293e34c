#pragma once

// A run of the exact engine: finds the facets that a beam meets, removes hidden parts, and traces the fragments.

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/memory_budget.h"
#include "raytrace/exact/beam.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/equal_places.h"

namespace retrace::raytrace {

/// Minimum absolute cosine of incidence. Planes that are closer to parallel to a beam are treated as invisible.
inline constexpr double kGrazing = 1e-12;

/// Axis-aligned rectangle, either in the coordinates across a beam or in x and y of the part.
struct PlanBox {
  Vec2 lower = Vec2::Constant(INFINITY);
  Vec2 upper = Vec2::Constant(-INFINITY);

  void include(const Vec2& p) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  bool overlaps(const PlanBox& other) const {
    return (lower.array() < other.upper.array()).all() && (other.lower.array() < upper.array()).all();
  }
};

template <class Points>
PlanBox box_of(const Points& points) {
  PlanBox box;
  for (const Vec2& p : points) box.include(p);
  return box;
}

/// A facet that may block a beam.
struct Candidate {
  Plane plane;
  geometry::FacetRole role = geometry::FacetRole::retro_facet;
  CellPlace cell;
  Distance distance;
  FlatPolygon piece;  ///< intersection of the facet and the beam, including parts that other facets hide
  PlanBox box;
  bool is_met = false;                 ///< true if the candidate has been processed
  std::optional<Vec2> middle_mm = {};  ///< PatchFacet::middle_mm, displaced to the position of the cell
};

/// Distance along a beam up to which facets are searched.
struct Horizon {
  double t = 0.0;        ///< distance in mm along the beam, from each corner of its cross-section
  bool limited = false;  ///< true if the beam may meet further facets beyond this distance
};

/// Returns the outline of the entrance face, or the central period of an infinite part.
geometry::Polygon entrance_outline(const geometry::Part& part);

/// Traces beams through a part until the remaining power is small enough. It is used for one BeamTracer::trace().
class BeamWalk {
 public:
  /// \param equal symmetry of the array; if given, identical beams are traced as one beam; null if not used
  BeamWalk(const geometry::Part& part, const Vec2& centre_mm, const CellIndex& cells, const LightSetup& setup,
           const BeamPolicy& policy, BeamObserver observer, const EqualPlaces* equal = nullptr);

  enum class Approach { falling, fixed, kept };
  /// Starts the trace.
  /// \param cutoff minimum power of traced beams. Approach::fixed does not change it. Approach::falling lowers it until
  ///        the truncated power is small enough. Approach::kept keeps weaker beams until lower_cutoff_to() is called.
  void enter(const geometry::Polygon& entrance, double cutoff, Approach approach);
  enum class End { done, paused, cancelled, cutoff_too_high };
  /// Traces beams above the cut-off until the goal is reached, the total work is `most_work`, or too many beams are
  /// kept.
  End run(std::uint64_t most_work, const Cancellation* cancel);

  /// Returns the beams below the cut-off, in the order in which they were found.
  /// \pre the approach is Approach::kept, and run() has returned End::done
  const WaitingBeams& kept() const { return deferred_.beams; }
  /// Makes run() pause when this number of beams below the cut-off is kept. Then call take_kept().
  void pause_at_kept(std::size_t most) { most_kept_ = most; }
  WaitingBeams take_kept();
  /// Lowers the cut-off. The next run() traces the kept beams that are not below the new cut-off.
  /// \pre the approach is Approach::kept, and run() has returned End::done
  void lower_cutoff_to(double cutoff);
  /// Traces a single beam to the next faces. The resulting beams are queued, see take_waiting().
  void step(const Beam& beam, const Cancellation* cancel);
  /// Replaces `into` with the beams queued by step().
  void take_waiting(WaitingBeams& into);
  /// Sets the replicate number of the returned beams that the observer receives.
  void serve_replicate(std::uint32_t replicate) { replicate_ = replicate; }
  /// Makes the walk append a ScatterSite to `sites` wherever a rough facet scatters light. Without this call, the
  /// scattered power is added to `truncated`.
  void collect(std::vector<ScatterSite>& sites) { sites_ = &sites; }
  /// Adds power that is not traced further to the ledger.
  void book_truncated(double power) { tally_.other[Account::truncated] += power; }
  const Tally& tally() const { return tally_; }
  /// Returns the power that is compared with the cut-off (see BeamPolicy::cutoff).
  double strength_of(const Beam& beam) const { return setup_.infinite() ? beam.power : beam.total_power(); }
  /// Returns one of the beams that a beam represents, as a beam for a single position.
  Beam at_place(const Beam& beam, std::size_t place) const;

  BeamResult result() const;
  std::uint64_t beams() const { return beams_; }
  std::uint32_t depth() const { return depth_; }
  double cutoff() const { return cutoff_; }
  double left_behind() const { return deferred_.power; }
  /// Returns the work done so far. The unit is a test of a facet's bounding box, about 20 ns. The number does not
  /// depend on the machine.
  std::uint64_t work() const { return work_; }
  /// Returns the total work until the goal is reached, extrapolated from the work done so far.
  double expected_work() const;

 private:
  /// Returns the transmittance for the light of a beam: its fraction of the entrance area times its transmission.
  static double transmission_of(const Beam& beam) { return beam.share * beam.transmission; }
  static double power_of(const Beam& beam) { return transmission_of(beam) * beam.light.power(); }
  double parts_of_element() const;
  Vec2 step_of_entrance(double parts) const;
  void enter_in_pieces(const Beam& whole, const Vec2& step);
  void enter_at_places(const Beam& whole, double parts);
  void enter_within_period(const Beam& whole, double parts);
  double enter_region(const Beam& whole, std::uint32_t region, const Vec2& most_step_mm);
  void enter_regions(const Beam& whole, double parts);
  void pend(Beam&& beam);
  /// Removes and returns the beam that was queued last.
  Beam next_pending();
  void keep_equal_places(Beam& beam);
  /// Returns a shared list of the positions, or null for a single position. The list counts as memory of this walk
  /// until the last beam that uses it is destroyed.
  std::shared_ptr<const BeamPlaces> shared(BeamPlaces places) const;
  /// Returns true if the list of beams below the cut-off is full. Further beams are then discarded, and a lower cut-off
  /// requires a new walk.
  bool has_many_deferred() const;
  void defer(Beam&& beam);
  /// Returns the power of all beams that are queued, above or below the cut-off.
  double open_power() const { return pending_.power + deferred_.power; }
  bool may_stop() const;
  void lower_cutoff();
  void close();
  void advance(const Beam& beam);
  /// Adds the power of the current beam to the ledger, for all positions that the beam represents.
  void book(Account account, double power) { tally_.other[account] += place_count_ * power; }
  Horizon horizon_of(const Beam& beam) const;
  PlanBox sweep_of(const Beam& beam) const;
  std::pair<double, double> distances_to_hull(const Beam& beam) const;
  PlanBox sweep_in_layer(const Beam& beam, const Horizon& horizon) const;
  void find_candidates(const Beam& beam, const Frame& frame, const FlatPolygon& whole, const Horizon& horizon);
  void consider(const Beam& beam, const Frame& frame, const FlatPolygon& whole, const PlanBox& box, const Plane* far,
                const geometry::SurfacePatch& patch, const geometry::PatchFacet& facet, const Vec3& shift,
                const CellPlace& cell);
  bool is_nearer(const Candidate& own, const Candidate& other) const;
  FlatPolygons visible_pieces(std::size_t k) const;
  FlatPolygons visible_on_plane_of(std::size_t k);
  FlatPolygons what_passes(const FlatPolygon& whole);
  void pass_by(const Beam& beam, const Frame& frame, const FlatPolygon& piece, double share, const Horizon& horizon);
  void leave_hull(const Beam& beam, const Frame& frame, const FlatPolygon& piece, double share);
  double power_at_start(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share) const;
  Beam arrived(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share, const Plane& plane);
  void meet_facet(const Beam& from, const Frame& frame, const Candidate& candidate, const FlatPolygon& piece,
                  double share);
  /// Returns the reflected or transmitted field of a beam at a facet, without the light that the texture of a retro
  /// facet scatters. With BeamPolicy::keeps_phases, the scattered light is included.
  CoherentLight mean_field(const Beam& beam, const materials::FresnelCoefficients& f, geometry::FacetRole role,
                           double cos_incidence, surface_models::Lobe lobe) const;
  void book_scattered(const Beam& beam, const Plane& plane, double power);
  void keep_phases(Beam& beam, const Candidate& candidate, const materials::FresnelCoefficients& f,
                   double cos_incidence, surface_models::Lobe lobe) const;
  void meet_hull(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share, const Plane& plane,
                 geometry::FacetRole role);
  void send(Beam&& beam, const Plane& plane, const Vec3& ahead, const Vec3& direction, const CoherentLight& light,
            bool inside);
  /// Adds light that is lost by rounding to `truncated`. The value may be negative, because fragments may overlap.
  void book_rest(const Beam& beam, double share) { book(Account::truncated, share / beam.share * power_of(beam)); }
  void leave_through_entrance(const Beam& beam, const CoherentLight& light, const Vec3& direction);
  ReturnedBeam returned_beam(const Beam& beam, CoherentLight light, const Vec3& direction) const;
  /// Returns the refractive index of the medium inside the part or behind its back.
  double index_at(bool inside) const { return inside ? setup_.optics.index : setup_.optics.back_index; }
  void observe_front() const;
  [[noreturn]] void fail_on_budget() const;
  /// Checks the memory of the queued beams.
  /// \throw BudgetError if the beams of this walk exceed the memory budget
  /// \throw SharedMemoryShort if all parallel traces together exceed their limit, see BeamMemory::require_shared()
  void require_memory() const;

  const geometry::Part& part_;
  const Vec2& centre_mm_;
  const CellIndex& cells_;
  const LightSetup& setup_;
  const BeamPolicy& policy_;
  BeamObserver observer_;
  const EqualPlaces* equal_;
  const Cancellation* cancel_ = nullptr;
  std::vector<ScatterSite>* sites_ = nullptr;
  std::optional<std::uint32_t> replicate_;
  Tally tally_;
  /// Queue of beams, with their total power and their memory in bytes.
  struct Waiting {
    WaitingBeams beams;
    double power = 0.0;
    std::uint64_t bytes = 0;

    void swap(Waiting& other) {
      beams.swap(other.beams);
      std::swap(power, other.power);
      std::swap(bytes, other.bytes);
    }
  };
  Waiting pending_;
  Waiting deferred_;  ///< beams below the cut-off, kept for a lower cut-off
  std::shared_ptr<BeamMemory> memory_ = std::make_shared<BeamMemory>();
  std::size_t most_kept_ = std::numeric_limits<std::size_t>::max();
  double cutoff_ = 0.0;
  Approach approach_ = Approach::fixed;
  /// State at the start of the pass with the present cut-off.
  struct Pass {
    double work = 0.0;
    double power = 1.0;  ///< open power
  };
  Pass pass_;
  std::vector<Candidate> candidates_;  ///< facets that may block the current beam
  double place_count_ = 1.0;           ///< number of positions of the current beam
  double least_area_;
  double join_area_;
  double merge_mm_;
  std::uint64_t beams_ = 0;
  mutable std::uint64_t work_ = 0;
  std::uint32_t depth_ = 0;
};

}  // namespace retrace::raytrace
