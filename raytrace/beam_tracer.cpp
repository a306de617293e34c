#include "raytrace/beam_tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "raytrace/beam.h"
#include "raytrace/entrance_sampler.h"

namespace retrace::raytrace {
namespace {

using geometry::FacetRole;
using geometry::PatchCell;
using geometry::PatchFacet;
using geometry::SurfacePatch;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Pieces of a cross-section smaller than this share of an element's area are rounding: booked, not followed.
constexpr double kLeastAreaShare = 1e-15;
// Pieces are joined if their union is convex but for this share of an element's area.
constexpr double kJoinShare = 1e-13;
// Corners of a cross-section nearer than this share of an element are one.
constexpr double kMergeShare = 1e-11;
// Planes seen at a flatter angle than this have no cross-section.
constexpr double kGrazing = 1e-12;
// A level beam is followed this many elements at a time, and so often.
constexpr double kReachInElements = 4.0;
constexpr std::uint32_t kMaxLevelSteps = 1000;
// The cut-off starts here and falls tenfold until little enough is left behind.
constexpr double kFirstCutoff = 1e-6;
constexpr double kLastCutoff = 1e-25;
// Beams that are kept for a lower cut-off: some 100 MB.
constexpr std::size_t kMostDeferred = 200'000;
// Power left behind falls at least about as the cut-off to this power.
constexpr double kSlowestFall = 0.7;

/// A rectangle across a beam or in the plan of the part.
struct Box {
  Vec2 lower = Vec2::Constant(kInfinity);
  Vec2 upper = Vec2::Constant(-kInfinity);

  void include(const Vec2& p) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  bool overlaps(const Box& other) const {
    return (lower.array() < other.upper.array()).all() && (other.lower.array() < upper.array()).all();
  }
};

template <class Points>
Box box_of(const Points& points) {
  Box box;
  for (const Vec2& p : points) box.include(p);
  return box;
}

/// A facet that stands in a beam.
struct Candidate {
  Plane plane;
  FacetRole role = FacetRole::retro_facet;
  CellPlace cell;
  Distance distance;
  FlatPolygon piece;  ///< as far as it stands in the beam, hidden or not
  Box box;
  bool is_met = false;  ///< its light has been sent on
};

/// How far ahead of a beam facets are looked for.
struct Horizon {
  double t = 0.0;        ///< from each corner of the cross-section
  bool limited = false;  ///< the beam may meet facets beyond
};

class BeamWalk {
 public:
  BeamWalk(const geometry::Part& part, const Vec2& centre_mm, const CellIndex& cells, const LightSetup& setup,
           const BeamPolicy& policy, BeamObserver observer)
      : part_(part),
        centre_mm_(centre_mm),
        cells_(cells),
        setup_(setup),
        policy_(policy),
        observer_(std::move(observer)),
        tally_(setup.cone_chord2.size()),
        least_area_(kLeastAreaShare * part.size_mm * part.size_mm),
        join_area_(kJoinShare * part.size_mm * part.size_mm),
        merge_mm_(kMergeShare * part.size_mm) {}

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
  void consider(const Beam& beam, const Frame& frame, const FlatPolygon& whole, const Box& box, const Plane* far,
                const SurfacePatch& patch, const PatchFacet& facet, const CellPlace& cell);
  FlatPolygons visible_pieces(std::size_t k) const;
  FlatPolygons visible_on_plane_of(std::size_t k);
  void pass_by(const Beam& beam, const Frame& frame, const FlatPolygon& piece, double share, const Horizon& horizon);
  void leave_hull(const Beam& beam, const Frame& frame, const FlatPolygon& piece, double share);
  static Beam at_start(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share);
  Beam arrived(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share, const Plane& plane);
  void meet_facet(const Beam& from, const Frame& frame, const Candidate& candidate, const FlatPolygon& piece,
                  double share);
  void meet_hull(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share, const Plane& plane,
                 FacetRole role);
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

void BeamWalk::enter(const geometry::Polygon& entrance) {
  const LightSetup::Entry& entry = setup_.entry;
  tally_.front[entry.front_cone] += entry.front;
  if (observer_ && entry.front.i > 0.0) observe_front();
  Beam whole;
  whole.direction = entry.direction;
  whole.light = entry.light;
  // Continuous on the face with the incident wave, whose phase is 0 at the origin.
  whole.phase_mm = (-setup_.to_source - setup_.optics.index * entry.direction).z() * setup_.thickness_mm;
  whole.start = {-Vec3::UnitZ(), -setup_.thickness_mm};
  whole.path_length = PathLength{}.continued(whole.start, whole.direction, 1.0);
  whole.entry.constant_mm = centre_mm_;
  whole.entry.slope.leftCols<2>().setIdentity();
  whole.entry = whole.entry.continued(whole.start, whole.direction);
  for (const auto& p : entrance)
    whole.corners.push_back({p.x() - centre_mm_.x(), p.y() - centre_mm_.y(), setup_.thickness_mm});
  if (setup_.infinite())
    pending_.push_back(whole);
  else
    enter_in_pieces(whole);
}

/// A large entrance in pieces of an element, so that each meets few facets.
void BeamWalk::enter_in_pieces(const Beam& whole) {
  Vec2 step = Vec2::Constant(part_.size_mm);
  if (const auto* rtp = std::get_if<geometry::RtpElement>(&part_.spec.element))
    step = Vec2(rtp->base_mm + part_.spec.x_gap_mm, rtp->width_mm + part_.spec.y_gap_mm);
  const Frame from_above(-Vec3::UnitZ());
  const double whole_area = area(flattened(whole.corners, from_above, merge_mm_));
  Box box;
  for (const Vec3& p : whole.corners) box.include(p.head<2>());
  double entered = 0.0;
  for (double y = box.lower.y(); y < box.upper.y() - 1e-9 * step.y(); y += step.y()) {
    const Corners row = cut(cut(whole.corners, {Vec3::UnitY(), y}), {-Vec3::UnitY(), -(y + step.y())});
    for (double x = box.lower.x(); x < box.upper.x() - 1e-9 * step.x(); x += step.x()) {
      Beam piece = whole;
      piece.corners = cut(cut(row, {Vec3::UnitX(), x}), {-Vec3::UnitX(), -(x + step.x())});
      if (piece.corners.empty()) continue;
      piece.share = area(flattened(piece.corners, from_above, merge_mm_)) / whole_area;
      if (piece.share <= 0.0) continue;
      entered += piece.share;
      pending_.push_back(std::move(piece));
    }
  }
  book_rest(whole, 1.0 - entered);
}

BeamWalk::End BeamWalk::run(double cutoff, Approach approach, const Cancellation* cancel) {
  cutoff_ = cutoff;
  for (;;) {
    while (!pending_.empty()) {
      if (cancel != nullptr && cancel->requested()) return End::cancelled;
      const Beam beam = std::move(pending_.back());
      pending_.pop_back();
      const double power = power_of(beam);
      if (power < cutoff_) {
        defer(beam, power);
        continue;
      }
      if (++beams_ > policy_.max_beams) fail_on_budget();
      advance(beam);
    }
    const bool is_enough = approach == Approach::fixed || deferred_power_ <= policy_.truncated_goal;
    if (is_enough || cutoff_ < kLastCutoff) break;
    if (deferred_.size() > kMostDeferred) return End::cutoff_too_high;
    cutoff_ *= 0.1;
    pending_.swap(deferred_);
    deferred_power_ = 0.0;
  }
  tally_.other[Account::truncated] += deferred_power_;
  return End::done;
}

BeamResult BeamWalk::result(End end) const {
  BeamResult result;
  for (std::size_t cone = 0; cone < setup_.cone_chord2.size(); ++cone) {
    result.ledgers.push_back(tally_.ledger(cone));
    result.stokes.push_back(tally_.retroreflected(cone));
  }
  result.beams = beams_;
  result.depth = depth_;
  result.cutoff = cutoff_;
  result.complete = end == End::done;
  return result;
}

/// Beams below the cut-off are kept for a lower one, unless they are so many that they are better found again.
void BeamWalk::defer(const Beam& beam, double power) {
  deferred_power_ += power;
  if (deferred_.size() <= kMostDeferred) deferred_.push_back(beam);
}

void BeamWalk::advance(const Beam& beam) {
  depth_ = std::max(depth_, beam.depth);
  const Frame frame(beam.direction);
  const FlatPolygon whole = flattened(beam.corners, frame, merge_mm_);
  const double whole_area = area(whole);
  if (whole_area <= least_area_) {
    book_rest(beam, beam.share);
    return;
  }
  const Horizon horizon = horizon_of(beam);
  find_candidates(beam, frame, whole, horizon);
  double used = 0.0;
  const auto share_of = [&](const FlatPolygon& piece) {
    const double share = beam.share * area(piece) / whole_area;
    used += share;
    return share;
  };
  FlatPolygons rest;
  rest.push_back(whole);
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    for (const FlatPolygon& piece : visible_on_plane_of(k))
      meet_facet(beam, frame, candidates_[k], piece, share_of(piece));
    FlatPolygons left;
    for (const FlatPolygon& piece : rest) subtract(piece, candidates_[k].piece, least_area_, merge_mm_, left);
    rest = std::move(left);
  }
  join_convex(rest, join_area_);
  for (const FlatPolygon& piece : rest) pass_by(beam, frame, piece, share_of(piece), horizon);
  book_rest(beam, beam.share - used);
}

/// To where the whole beam has left the layer of the elements, -depth <= z <= top.
Horizon BeamWalk::horizon_of(const Beam& beam) const {
  double low = kInfinity;
  double high = -kInfinity;
  for (const Vec3& p : beam.corners) {
    low = std::min(low, p.z());
    high = std::max(high, p.z());
  }
  const double dz = beam.direction.z();
  const double slack = 1e-6 * part_.size_mm;
  if (dz >= 0.0 && low >= setup_.top_mm - slack) return {};
  double first = 0.0;  // when the last of the beam has come into the layer
  double last = kInfinity;
  if (dz > 0.0) last = (setup_.top_mm - low) / dz;
  if (dz < 0.0) {
    first = std::max(0.0, (high - setup_.top_mm) / -dz);
    last = (high + setup_.depth_mm + slack) / -dz;
  }
  const double reach = first + kReachInElements * part_.size_mm;
  if (last <= reach) return {last, false};
  if (setup_.infinite()) return {reach, true};
  // A finite part ends: what leaves it within reach must be looked for to the end, for its exit is not a facet's.
  const auto [first_exit, last_exit] = distances_to_hull(beam);
  return reach < first_exit ? Horizon{reach, true} : Horizon{std::min(last, last_exit), false};
}

/// The least and the greatest way of a beam's corners to the sides and, if it rises, the entrance.
std::pair<double, double> BeamWalk::distances_to_hull(const Beam& beam) const {
  double least = kInfinity;
  double greatest = 0.0;
  for (const Vec3& p : beam.corners) {
    double t = beam.direction.z() > 0.0 ? (setup_.thickness_mm - p.z()) / beam.direction.z() : kInfinity;
    for (const auto& side : setup_.sides) {
      const double towards = side.normal.dot(beam.direction);
      if (towards > kGrazing) t = std::min(t, (side.offset_mm - side.normal.dot(p)) / towards);
    }
    least = std::min(least, t);
    greatest = std::max(greatest, t);
  }
  return {least, greatest};
}

void BeamWalk::find_candidates(const Beam& beam, const Frame& frame, const FlatPolygon& whole, const Horizon& horizon) {
  candidates_.clear();
  if (horizon.t <= 0.0) return;
  Box plan;
  double nearest = kInfinity;
  for (const Vec3& p : beam.corners) {
    const double above = p.z() - setup_.top_mm;
    const bool falls_in = above > 0.0 && beam.direction.z() < 0.0;
    const double from = falls_in ? std::min(horizon.t, above / -beam.direction.z()) : 0.0;
    plan.include((p + from * beam.direction).head<2>());
    plan.include((p + horizon.t * beam.direction).head<2>());
    nearest = std::min(nearest, beam.direction.dot(p));
  }
  // Beyond the horizon facets may be hidden by others that were not looked for.
  const Plane far{-beam.direction, -(nearest + horizon.t)};
  const Box box = box_of(whole);
  cells_.visit(plan.lower, plan.upper,
               [&](const SurfacePatch& patch, const PatchCell& cell, const Vec2& offset, double height_mm) {
                 const CellPlace place{part_.number_of(patch, cell), offset, height_mm};
                 for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f)
                   consider(beam, frame, whole, box, horizon.limited ? &far : nullptr, patch, patch.facets[f], place);
               });
}

void BeamWalk::consider(const Beam& beam, const Frame& frame, const FlatPolygon& whole, const Box& box,
                        const Plane* far, const SurfacePatch& patch, const PatchFacet& facet, const CellPlace& cell) {
  const Vec3 shift(cell.offset_mm.x(), cell.offset_mm.y(), cell.height_mm);
  const double towards = facet.normal.dot(beam.direction);
  if (beam.inside ? towards <= kGrazing : towards >= -kGrazing) return;
  Corners corners;
  Box own;
  bool all_ahead = true;
  for (std::uint32_t c = 0; c < facet.corner_count; ++c) {
    corners.push_back(patch.vertices[patch.corners[facet.first_corner + c]] + shift);
    own.include(frame.across(corners.back()));
    all_ahead = all_ahead && beam.start.height(corners.back()) >= 0.0;
  }
  if (!own.overlaps(box)) return;
  if (!all_ahead) corners = cut(corners, beam.start);
  if (far != nullptr) corners = cut(corners, *far);
  if (corners.empty()) return;
  const Plane plane{facet.normal, facet.offset_mm + facet.normal.dot(shift)};
  const FlatPolygon seen = flattened(corners, frame, merge_mm_);
  if (seen.size() < 3) return;
  FlatPolygon piece = intersection(whole, seen, merge_mm_);
  if (piece.size() < 3 || area(piece) <= least_area_) return;
  const Box piece_box = box_of(piece);
  candidates_.push_back({plane, facet.role, cell, Distance(frame, plane), std::move(piece), piece_box, false});
}

/// What of a candidate's piece no nearer candidate covers.
FlatPolygons BeamWalk::visible_pieces(std::size_t k) const {
  const Candidate& own = candidates_[k];
  FlatPolygons visible;
  visible.push_back(own.piece);
  for (std::size_t j = 0; j < candidates_.size() && !visible.empty(); ++j) {
    const Candidate& other = candidates_[j];
    if (j == k || !own.box.overlaps(other.box)) continue;
    const FlatPolygon common = intersection(own.piece, other.piece, merge_mm_);
    if (common.size() < 3 || area(common) <= least_area_) continue;
    const Vec2 at = middle(common);
    const double behind = own.distance.at(at) - other.distance.at(at);
    // Of two at the same distance the first counts.
    if (behind < 0.0 || (behind == 0.0 && k < j)) continue;
    FlatPolygons left;
    for (const FlatPolygon& piece : visible) subtract(piece, other.piece, least_area_, merge_mm_, left);
    visible = std::move(left);
  }
  return visible;
}

/// The same for all candidates in one plane: facets of neighbouring elements that continue each other do not divide a
/// beam. Empty if they have been met with an earlier one.
FlatPolygons BeamWalk::visible_on_plane_of(std::size_t k) {
  FlatPolygons visible;
  if (candidates_[k].is_met) return visible;
  const Plane plane = candidates_[k].plane;
  const FacetRole role = candidates_[k].role;
  const CellPlace cell = candidates_[k].cell;
  for (std::size_t j = k; j < candidates_.size(); ++j) {
    Candidate& other = candidates_[j];
    const bool is_one_plane = other.role == role && other.plane.normal.isApprox(plane.normal, 1e-14) &&
                              std::abs(other.plane.offset_mm - plane.offset_mm) <= merge_mm_ &&
                              (!policy_.by_cell || other.cell == cell);
    if (other.is_met || !is_one_plane) continue;
    other.is_met = true;
    for (FlatPolygon& piece : visible_pieces(j)) visible.push_back(std::move(piece));
  }
  join_convex(visible, join_area_);
  return visible;
}

/// A piece of a beam that no facet within the horizon stands in the way of.
void BeamWalk::pass_by(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share,
                       const Horizon& horizon) {
  if (horizon.limited) {
    double nearest = kInfinity;
    for (const Vec3& p : from.corners) nearest = std::min(nearest, frame.w.dot(p));
    const Plane there{frame.w, nearest + horizon.t};
    Beam beam = arrived(from, frame, piece, share, there);
    beam.start = there;
    beam.depth = from.depth;
    beam.level_steps = from.level_steps + 1;
    if (beam.level_steps < kMaxLevelSteps)
      pending_.push_back(std::move(beam));
    else
      tally_.other[Account::truncated] += power_of(beam);
    return;
  }
  if (from.inside) {
    leave_hull(from, frame, piece, share);
    return;
  }
  const bool rises_through_plate = setup_.infinite() && from.direction.z() > 0.0;
  const double power = power_of(at_start(from, frame, piece, share));
  tally_.other[rises_through_plate ? Account::truncated : account_of_exit(from.left_through)] += power;
}

/// Out through the nearest of entrance and sides: each takes the part of the piece to which it is nearest.
void BeamWalk::leave_hull(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share) {
  struct Exit {
    Plane plane;
    Distance distance;
    FacetRole role;
  };
  boost::container::small_vector<Exit, 8> exits;
  const auto offer = [&](const Plane& plane, FacetRole role) {
    if (plane.normal.dot(from.direction) > kGrazing) exits.push_back({plane, Distance(frame, plane), role});
  };
  offer({Vec3::UnitZ(), setup_.thickness_mm}, FacetRole::entrance);
  for (const auto& side : setup_.sides) offer({side.normal, side.offset_mm}, FacetRole::side);

  const double whole = area(piece);
  double used = 0.0;
  const auto meet = [&](const Exit& exit, FacetRole role, const FlatPolygon& own) {
    if (own.empty() || area(own) <= least_area_) return;
    const double part = share * area(own) / whole;
    used += part;
    meet_hull(from, frame, own, part, exit.plane, role);
  };
  for (std::size_t k = 0; k < exits.size(); ++k) {
    FlatPolygon own = piece;
    for (std::size_t j = 0; j < exits.size() && !own.empty(); ++j) {
      if (j == k) continue;
      const Vec2 slope = exits[k].distance.slope - exits[j].distance.slope;
      own = clipped(own, {slope.x(), slope.y(), exits[j].distance.constant - exits[k].distance.constant}, merge_mm_);
    }
    if (exits[k].role == FacetRole::side && setup_.optics.border_walls_differ()) {
      // Below z = 0 the plane is that of border walls: z = up . p + start there, over the coordinates across the beam.
      const Distance& distance = exits[k].distance;
      const Vec2 up = Vec2(frame.u.z(), frame.v.z()) + frame.w.z() * distance.slope;
      const double start = frame.w.z() * distance.constant;
      if (up.norm() > kGrazing) {
        meet(exits[k], FacetRole::border_wall, clipped(own, {up.x(), up.y(), -start}, merge_mm_));
        meet(exits[k], FacetRole::side, clipped(own, {-up.x(), -up.y(), start}, merge_mm_));
        continue;
      }
    }
    meet(exits[k], exits[k].role, own);
  }
  book_rest(from, share - used);
}

/// A piece of a beam where the beam starts.
Beam BeamWalk::at_start(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share) {
  Beam beam = from;
  beam.share = share;
  const Plane start{from.start.normal, from.start.normal.dot(from.corners[0])};
  beam.corners = lifted(piece, frame, Distance(frame, start));
  return beam;
}

/// A piece of a beam where it meets a plane, with what the material took on the way booked.
Beam BeamWalk::arrived(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share,
                       const Plane& plane) {
  Beam beam = from;
  beam.share = share;
  beam.depth = from.depth + 1;
  beam.level_steps = 0;
  beam.corners = lifted(piece, frame, Distance(frame, plane));
  if (from.inside && setup_.optics.absorption_per_mm > 0.0)
    tally_.other[Account::absorbed] += power_of(at_start(from, frame, piece, share)) - power_of(beam);
  return beam;
}

/// Sends light on from an interface. \param ahead the plane's normal on the side it goes to
void BeamWalk::send(Beam beam, const Plane& plane, const Vec3& ahead, const Vec3& direction, const CoherentLight& light,
                    bool inside) {
  // Fields are continuous on the plane: their wave vectors differ only along its normal.
  beam.phase_mm +=
      (index_at(beam.inside) * beam.direction - index_at(inside) * direction).dot(plane.normal) * plane.offset_mm;
  beam.path_length = beam.path_length.continued(plane, direction, inside ? 1.0 : 0.0);
  beam.entry = beam.entry.continued(plane, direction);
  beam.start = {ahead, ahead.dot(plane.normal) * plane.offset_mm};
  beam.direction = direction;
  beam.light = light;
  beam.inside = inside;
  pending_.push_back(std::move(beam));
}

void BeamWalk::meet_facet(const Beam& from, const Frame& frame, const Candidate& candidate, const FlatPolygon& piece,
                          double share) {
  Beam beam = arrived(from, frame, piece, share, candidate.plane);
  const bool is_wall = candidate.role == FacetRole::inner_gable || candidate.role == FacetRole::border_wall;
  if (is_wall && setup_.optics.absorbing_walls) {
    tally_.other[Account::absorbed] += power_of(beam);
    return;
  }
  const Vec3 against = from.inside ? Vec3(-candidate.plane.normal) : candidate.plane.normal;
  const double ratio = setup_.optics.ratio_at_back(from.inside);
  const double cos_incidence = -against.dot(from.direction);
  const materials::FresnelCoefficients f = fresnel_at_back(setup_.optics, candidate.role, from.inside, cos_incidence);
  beam.trail.meet(candidate.cell);
  beam.light.turn_to(from.direction, against);
  if (!f.total_reflection) {
    Beam through = beam;
    if (from.inside) through.left_through = candidate.role;
    send(std::move(through), candidate.plane, -against,
         refracted(from.direction, against, ratio, cos_incidence, f.cos_refracted), beam.light.transmitted(f),
         !from.inside);
  }
  const CoherentLight reflected = beam.light.reflected(f);
  if (setup_.optics.coating_index && candidate.role == FacetRole::retro_facet)
    tally_.other[Account::absorbed] += transmission_of(beam) * (beam.light.power() - reflected.power());
  send(std::move(beam), candidate.plane, against, mirrored(from.direction, against), reflected, from.inside);
}

void BeamWalk::meet_hull(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share,
                         const Plane& plane, FacetRole role) {
  Beam beam = arrived(from, frame, piece, share, plane);
  if (role == FacetRole::border_wall && setup_.optics.absorbing_walls) {
    tally_.other[Account::absorbed] += power_of(beam);
    return;
  }
  const bool is_entrance = role == FacetRole::entrance;
  const Vec3 against = -plane.normal;
  const double cos_incidence = plane.normal.dot(from.direction);
  const double ratio = role == FacetRole::border_wall ? setup_.optics.ratio_at_back(true) : setup_.optics.index;
  const materials::FresnelCoefficients f = materials::fresnel(ratio, cos_incidence);
  const Vec3 out = refracted(from.direction, against, ratio, cos_incidence, f.cos_refracted);
  beam.light.turn_to(from.direction, against);
  if (is_entrance && setup_.optics.lossless_entrance) {
    if (f.total_reflection)
      tally_.returned.back().i += power_of(beam);
    else
      leave_through_entrance(beam, beam.light, out);
    return;
  }
  if (!f.total_reflection) {
    const CoherentLight through = beam.light.transmitted(f);
    if (is_entrance)
      leave_through_entrance(beam, through, out);
    else
      tally_.other[account_of_exit(role)] += transmission_of(beam) * through.power();
  }
  const CoherentLight reflected = beam.light.reflected(f);
  send(std::move(beam), plane, against, mirrored(from.direction, against), reflected, true);
}

/// \param direction in air
void BeamWalk::leave_through_entrance(const Beam& beam, const CoherentLight& light, const Vec3& direction) {
  const std::size_t cone = setup_.cone_of(direction);
  const Stokes stokes = transmission_of(beam) * seen_from_above(light, direction);
  tally_.returned[cone] += stokes;
  if (!observer_) return;
  ReturnedBeam returned = returned_beam(beam, light, direction);
  returned.stokes = stokes;
  returned.efficiency = stokes.i / beam.share;
  returned.cone = cone;
  observer_(returned);
}

/// Where it goes and came from, and its field.
ReturnedBeam BeamWalk::returned_beam(const Beam& beam, CoherentLight light, const Vec3& direction) const {
  ReturnedBeam returned;
  returned.direction = direction;
  returned.depth = beam.depth;
  for (const Vec3& p : beam.corners) {
    returned.entered_mm.push_back(beam.entry.of(p));
    returned.left_mm.push_back(p.head<2>() + centre_mm_);
  }
  // Light that is reflected an odd number of times sees its polygon turned over.
  for (geometry::Polygon* polygon : {&returned.entered_mm, &returned.left_mm})
    if (geometry::area(*polygon) < 0.0) std::reverse(polygon->begin(), polygon->end());
  light.turn_to_axis(direction, source_axis(direction));
  returned.jones = light.jones;
  returned.transmission = transmission_of(beam);
  // Continuous on the face, and counted in its plane.
  returned.phase_mm = beam.phase_mm + setup_.optics.index * beam.direction.z() * setup_.thickness_mm;
  returned.centre_mm = centre_mm_;
  returned.trail = beam.trail;
  return returned;
}

void BeamWalk::observe_front() const {
  ReturnedBeam front;
  front.direction = setup_.entry.front_direction;
  front.stokes = setup_.entry.front;
  front.efficiency = front.stokes.i;
  front.cone = setup_.entry.front_cone;
  observer_(front);
}

void BeamWalk::fail_on_budget() const {
  double open = deferred_power_;
  for (const Beam& beam : pending_) open += power_of(beam);
  throw BudgetError(
      fmt::format("the budget of {} beams ran out with {:.3g} of the power not accounted for; a larger "
                  "--cutoff follows fewer beams",
                  policy_.max_beams, open));
}

geometry::Polygon entrance_of(const geometry::Part& part) {
  if (part.period_mm) return geometry::to_polygon({Vec2::Zero(), *part.period_mm});
  return part.outline;
}

}  // namespace

BeamTracer::BeamTracer(const geometry::Part& part)
    : part_(part), centre_mm_(EntranceSampler(part).centre_mm()), cells_(part, centre_mm_) {}

BeamResult BeamTracer::trace(const Optics& optics, const Illumination& illumination,
                             const std::vector<double>& cones_deg, const BeamPolicy& policy, const Cancellation* cancel,
                             const BeamObserver& observer) const {
  const LightSetup setup(part_, centre_mm_, optics, illumination, cones_deg);
  if (policy.cutoff) return follow(setup, policy, *policy.cutoff, cancel, observer);
  const BeamResult result = find_cutoff(setup, policy, cancel);
  return observer && result.complete ? follow(setup, policy, result.cutoff, cancel, observer) : result;
}

BeamResult BeamTracer::follow(const LightSetup& setup, const BeamPolicy& policy, double cutoff,
                              const Cancellation* cancel, const BeamObserver& observer) const {
  BeamWalk walk(part_, centre_mm_, cells_, setup, policy, observer);
  walk.enter(entrance_of(part_));
  return walk.result(walk.run(cutoff, BeamWalk::Approach::fixed, cancel));
}

BeamResult BeamTracer::find_cutoff(const LightSetup& setup, BeamPolicy policy, const Cancellation* cancel) const {
  for (double cutoff = kFirstCutoff;;) {
    BeamWalk walk(part_, centre_mm_, cells_, setup, policy, {});
    walk.enter(entrance_of(part_));
    const auto end = walk.run(cutoff, BeamWalk::Approach::falling, cancel);
    if (end != BeamWalk::End::cutoff_too_high) return walk.result(end);
    policy.max_beams -= walk.beams();
    const double fall = std::pow(policy.truncated_goal / walk.left_behind(), 1.0 / kSlowestFall);
    cutoff = walk.cutoff() * std::clamp(fall, 1e-4, 0.1);
  }
}

}  // namespace retrace::raytrace
