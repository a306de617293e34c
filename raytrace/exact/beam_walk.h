#pragma once

// One run of the exact engine: which facets a beam meets, which hide others, and what becomes of its pieces.

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

/// Planes seen at a flatter angle than this have no cross-section.
inline constexpr double kGrazing = 1e-12;

/// A rectangle across a beam or in the plan of the part.
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

/// A facet that stands in a beam.
struct Candidate {
  Plane plane;
  geometry::FacetRole role = geometry::FacetRole::retro_facet;
  CellPlace cell;
  Distance distance;
  FlatPolygon piece;  ///< as far as it stands in the beam, hidden or not
  PlanBox box;
  bool is_met = false;                 ///< its light has been sent on
  std::optional<Vec2> middle_mm = {};  ///< of PatchFacet
};

/// How far ahead of a beam facets are looked for.
struct Horizon {
  double t = 0.0;        ///< from each corner of the cross-section
  bool limited = false;  ///< the beam may meet facets beyond
};

/// Where light enters a part; an infinite one: the central period.
geometry::Polygon entrance_outline(const geometry::Part& part);

/// Follows beams through a part until too little is left of them. Serves one trace() of BeamTracer.
class BeamWalk {
 public:
  /// \param equal where beams may be followed once for several places; null: nowhere
  BeamWalk(const geometry::Part& part, const Vec2& centre_mm, const CellIndex& cells, const LightSetup& setup,
           const BeamPolicy& policy, BeamObserver observer, const EqualPlaces* equal = nullptr);

  enum class Approach { falling, fixed, kept };
  /// \param cutoff that is fixed, or the first of those that fall until little enough is left behind; where beams below
  /// it are kept: until lower_cutoff_to()
  void enter(const geometry::Polygon& entrance, double cutoff, Approach approach);
  enum class End { done, paused, cancelled, cutoff_too_high };
  /// Follows beams above the cut-off until the goal is reached, as much work is done in all, or many are kept.
  End run(std::uint64_t most_work, const Cancellation* cancel);

  /// Beams below the cut-off, in the order in which they were found. \pre Approach::kept, and run() is done
  const WaitingBeams& kept() const { return deferred_.beams; }
  /// From now on run() pauses where so many are kept, for take_kept().
  void pause_at_kept(std::size_t most) { most_kept_ = most; }
  WaitingBeams take_kept();
  /// What is below the old cut-off and not below this one is for the next run() to follow. \pre likewise
  void lower_cutoff_to(double cutoff);
  /// Follows a beam that is alone to the next faces that it meets; its parts that go on from there wait.
  void step(const Beam& beam, const Cancellation* cancel);
  /// Those that wait after steps, in place of what the list holds.
  void take_waiting(WaitingBeams& into);
  /// Beams that it tells of belong to this replicate.
  void serve_replicate(std::uint32_t replicate) { replicate_ = replicate; }
  /// Makes the walk append a ScatterSite to `sites` wherever a rough facet scatters light. Without this call, the
  /// scattered power is booked as `truncated`.
  void collect(std::vector<ScatterSite>& sites) { sites_ = &sites; }
  /// Power that is given up.
  void book_truncated(double power) { tally_.other[Account::truncated] += power; }
  const Tally& tally() const { return tally_; }
  /// What is compared with the cut-off.
  double strength_of(const Beam& beam) const { return setup_.infinite() ? beam.power : beam.total_power(); }
  /// One of the beams that a beam stands for, by itself.
  Beam at_place(const Beam& beam, std::size_t place) const;

  BeamResult result() const;
  std::uint64_t beams() const { return beams_; }
  std::uint32_t depth() const { return depth_; }
  double cutoff() const { return cutoff_; }
  double left_behind() const { return deferred_.power; }
  /// Done so far, in looks at a facet's bounding box: some 20 ns each. The same on every machine.
  std::uint64_t work() const { return work_; }
  /// Of all until the goal is reached, judged by what has been settled so far.
  double expected_work() const;

 private:
  /// Share of the power of its light that a beam brings here: by its area, less what was absorbed.
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
  /// Returns a shared list of the positions, or null for a single position. The memory of the list is counted until the
  /// last beam with this list is destroyed.
  std::shared_ptr<const BeamPlaces> shared(BeamPlaces places) const;
  /// Returns true if the list of beams below the cut-off is full. Further beams are then discarded. To use a lower
  /// cut-off, the walk must start again.
  bool has_many_deferred() const;
  void defer(Beam&& beam);
  /// Power of beams that wait, in this pass or below its cut-off.
  double open_power() const { return pending_.power + deferred_.power; }
  bool may_stop() const;
  void lower_cutoff();
  void close();
  void advance(const Beam& beam);
  /// Of powers of the beam at hand, which may stand for others.
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
  /// A branch of a beam's light at a facet, less what the texture of a retro facet scatters; with phases that are kept:
  /// all of it.
  CoherentLight mean_field(const Beam& beam, const materials::FresnelCoefficients& f, geometry::FacetRole role,
                           double cos_incidence, surface_models::Lobe lobe) const;
  void book_scattered(const Beam& beam, const Plane& plane, double power);
  void keep_phases(Beam& beam, const Candidate& candidate, const materials::FresnelCoefficients& f,
                   double cos_incidence, surface_models::Lobe lobe) const;
  void meet_hull(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share, const Plane& plane,
                 geometry::FacetRole role);
  void send(Beam&& beam, const Plane& plane, const Vec3& ahead, const Vec3& direction, const CoherentLight& light,
            bool inside);
  /// Light of a beam that found no facet for want of digits. Signed: pieces may overlap by rounding as well.
  void book_rest(const Beam& beam, double share) { book(Account::truncated, share / beam.share * power_of(beam)); }
  void leave_through_entrance(const Beam& beam, const CoherentLight& light, const Vec3& direction);
  ReturnedBeam returned_beam(const Beam& beam, CoherentLight light, const Vec3& direction) const;
  /// Of where a beam travels behind the entrance face.
  double index_at(bool inside) const { return inside ? setup_.optics.index : setup_.optics.back_index; }
  void observe_front() const;
  [[noreturn]] void fail_on_budget() const;
  /// Checks the memory that the queued beams occupy.
  /// \throw BudgetError if the beams of this walk exceed the memory budget
  /// \throw SharedMemoryShort as BeamMemory::require_shared()
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
  /// Queue of beams, their total power, and the memory that they occupy.
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
  /// Where the pass of a cut-off began.
  struct Pass {
    double work = 0.0;
    double power = 1.0;  ///< that was open
  };
  Pass pass_;
  std::vector<Candidate> candidates_;  ///< of the beam at hand
  double place_count_ = 1.0;           ///< likewise
  double least_area_;
  double join_area_;
  double merge_mm_;
  std::uint64_t beams_ = 0;
  mutable std::uint64_t work_ = 0;
  std::uint32_t depth_ = 0;
};

}  // namespace retrace::raytrace
