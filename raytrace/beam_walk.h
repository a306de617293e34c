#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "raytrace/beam.h"
#include "raytrace/beam_tracer.h"

namespace retrace::raytrace {

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
  bool is_met = false;  ///< its light has been sent on
};

/// How far ahead of a beam facets are looked for.
struct Horizon {
  double t = 0.0;        ///< from each corner of the cross-section
  bool limited = false;  ///< the beam may meet facets beyond
};

/// Follows beams through a part until too little is left of them. Serves one trace() of BeamTracer.
class BeamWalk {
 public:
  BeamWalk(const geometry::Part& part, const Vec2& centre_mm, const CellIndex& cells, const LightSetup& setup,
           const BeamPolicy& policy, BeamObserver observer);

  void enter(const geometry::Polygon& entrance);
  enum class Approach { falling, fixed };
  enum class End { done, cancelled, cutoff_too_high };
  /// Follows all beams above a cut-off that is fixed, or that falls until little enough is left behind.
  End run(double cutoff, Approach approach, const Cancellation* cancel);

  BeamResult result(End end) const;
  std::uint64_t beams() const { return beams_; }
  double cutoff() const { return cutoff_; }
  double left_behind() const { return deferred_power_; }

 private:
  /// Share of the power of its light that a beam brings here: by its area, less what was absorbed.
  double transmission_of(const Beam& beam) const {
    return beam.share * mean_transmission(beam.corners, beam.path_length, setup_.optics.absorption_per_mm);
  }
  double power_of(const Beam& beam) const { return transmission_of(beam) * beam.light.power(); }
  void enter_in_pieces(const Beam& whole);
  void defer(const Beam& beam, double power);
  void advance(const Beam& beam);
  Horizon horizon_of(const Beam& beam) const;
  std::pair<double, double> distances_to_hull(const Beam& beam) const;
  void find_candidates(const Beam& beam, const Frame& frame, const FlatPolygon& whole, const Horizon& horizon);
  void consider(const Beam& beam, const Frame& frame, const FlatPolygon& whole, const PlanBox& box, const Plane* far,
                const geometry::SurfacePatch& patch, const geometry::PatchFacet& facet, const CellPlace& cell);
  FlatPolygons visible_pieces(std::size_t k) const;
  FlatPolygons visible_on_plane_of(std::size_t k);
  void pass_by(const Beam& beam, const Frame& frame, const FlatPolygon& piece, double share, const Horizon& horizon);
  void leave_hull(const Beam& beam, const Frame& frame, const FlatPolygon& piece, double share);
  static Beam at_start(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share);
  Beam arrived(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share, const Plane& plane);
  void meet_facet(const Beam& from, const Frame& frame, const Candidate& candidate, const FlatPolygon& piece,
                  double share);
  void meet_hull(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share, const Plane& plane,
                 geometry::FacetRole role);
  void send(Beam beam, const Plane& plane, const Vec3& ahead, const Vec3& direction, const CoherentLight& light,
            bool inside);
  /// Light of a beam that found no facet for want of digits. Signed: pieces may overlap by rounding as well.
  void book_rest(const Beam& beam, double share) {
    tally_.other[Account::truncated] += share / beam.share * power_of(beam);
  }
  void leave_through_entrance(const Beam& beam, const CoherentLight& light, const Vec3& direction);
  ReturnedBeam returned_beam(const Beam& beam, CoherentLight light, const Vec3& direction) const;
  /// Of where a beam travels behind the entrance face.
  double index_at(bool inside) const { return inside ? setup_.optics.index : setup_.optics.back_index; }
  void observe_front() const;
  [[noreturn]] void fail_on_budget() const;

  const geometry::Part& part_;
  const Vec2& centre_mm_;
  const CellIndex& cells_;
  const LightSetup& setup_;
  const BeamPolicy& policy_;
  BeamObserver observer_;
  Tally tally_;
  std::vector<Beam> pending_;
  std::vector<Beam> deferred_;  ///< below the cut-off
  double deferred_power_ = 0.0;
  double cutoff_ = 0.0;
  std::vector<Candidate> candidates_;  ///< of the beam at hand
  double least_area_;
  double join_area_;
  double merge_mm_;
  std::uint64_t beams_ = 0;
  std::uint32_t depth_ = 0;
};

}  // namespace retrace::raytrace
