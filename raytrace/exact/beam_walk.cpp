#include "raytrace/exact/beam_walk.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "core/infinity.h"
#include "geometry/centroid.h"

namespace retrace::raytrace {
namespace {

using geometry::FacetRole, geometry::PatchCell, geometry::PatchFacet, geometry::SurfacePatch;

// Fragments of a cross-section with an area below this fraction of size_mm^2 are caused by rounding. Their power is
// added to `truncated`, and they are not traced.
constexpr double kLeastAreaShare = 1e-15;
// Two fragments are joined if their union differs from a convex polygon by less than this fraction of size_mm^2.
constexpr double kJoinShare = 1e-13;
// Corners of a cross-section are merged if their distance is less than this fraction of the element size.
constexpr double kMergeShare = 1e-11;
// Maximum length, in element sizes, of one step of a nearly horizontal beam. kMaxLevelSteps limits the number of steps.
constexpr double kReachInElements = 4.0;
// Maximum step length of a beam that represents several positions. It is shorter than kReachInElements, because fewer
// positions then reach a border within the step.
constexpr double kReachOfShared = 2.0;
// Limit of the distance, in element sizes, that a slowly descending beam travels until all of its corners are in the
// layer of elements. If the distance is longer, a step is measured from the point where the lowest corner enters the
// layer. A horizontal beam above the layer never enters it and meets no facet.
constexpr double kFarInElements = 64.0;
constexpr std::uint32_t kMaxLevelSteps = 1000;
constexpr double kLastCutoff = 1e-25;
// Number of facets of an element above which the incident light is divided into several fragments. Each fragment then
// meets about this number of facets.
constexpr double kFacetsOfPiece = 30.0;
// Factors by which the cut-off decreases between passes. A pass traces all beams above the present cut-off. kGentleFall
// is used for coarse goals, because a single pass after a decrease by kFall may trace much more than is needed.
constexpr double kFall = 0.1;
constexpr double kGentleFall = 0.3;
// Measured work of clipping two polygons, and the constant work per beam. The unit is a test of a bounding box.
constexpr std::uint64_t kWorkOfCut = 30;
constexpr std::uint64_t kWorkOfBeam = 50;
// Assumed exponent until two passes have been measured: the work is proportional to (truncated power)^-kUsualSlope.
constexpr double kUsualSlope = 0.5;
// Maximum number of beams below the cut-off that are kept for a later pass with a lower cut-off. They take about 150
// MB. Their memory is also limited to three quarters of beam_memory_bytes().
constexpr std::size_t kMostDeferred = 200'000;
// Work of moving one position of a beam between lists, in units of BeamWalk::work().
constexpr std::uint64_t kWorkOfPlace = 1;

/// Returns the memory in bytes of a queued beam, without its list of positions.
std::uint64_t bytes_of(const Beam& beam) {
  return sizeof(Beam) + beam.hits.capacity() * sizeof(TexturedHit);
}

}  // namespace

BeamWalk::BeamWalk(const geometry::Part& part, const Vec2& centre_mm, const CellIndex& cells, const LightSetup& setup,
                   const BeamPolicy& policy, BeamObserver observer, const EqualPlaces* equal)
    : part_(part),
      centre_mm_(centre_mm),
      cells_(cells),
      setup_(setup),
      policy_(policy),
      observer_(std::move(observer)),
      equal_(equal),
      tally_(setup.cone_chord2.size()),
      least_area_(kLeastAreaShare * part.size_mm * part.size_mm),
      join_area_(kJoinShare * part.size_mm * part.size_mm),
      merge_mm_(kMergeShare * part.size_mm) {}

void BeamWalk::enter(const geometry::Polygon& entrance, double cutoff, Approach approach) {
  cutoff_ = cutoff;
  approach_ = approach;
  const LightSetup::Entry& entry = setup_.entry;
  tally_.front[entry.front_cone] += entry.front;
  tally_.other[Account::absorbed] += entry.absorbed;
  if (observer_ && entry.front.i > 0.0) observe_front();
  Beam whole;
  whole.direction = entry.direction;
  whole.light = entry.light;
  // The incident wave has phase 0 at the centre of the entrance face. Beam::phase_mm is extrapolated from there to the
  // origin.
  whole.phase_mm = -setup_.optics.index * entry.direction.z() * setup_.thickness_mm;
  whole.start = {-Vec3::UnitZ(), -setup_.thickness_mm};
  whole.path_length = PathLength{}.continued(whole.start, whole.direction, 1.0);
  whole.entry.constant_mm = centre_mm_;
  whole.entry.slope.leftCols<2>().setIdentity();
  whole.entry = whole.entry.continued(whole.start, whole.direction);
  for (const auto& p : entrance)
    whole.corners.push_back({p.x() - centre_mm_.x(), p.y() - centre_mm_.y(), setup_.thickness_mm});
  const double parts = parts_of_element();
  if (equal_ != nullptr && setup_.infinite())
    enter_within_period(whole, parts);
  else if (equal_ != nullptr && !equal_->regions().empty())
    enter_regions(whole, parts);
  else if (equal_ != nullptr)
    enter_at_places(whole, parts);
  else if (setup_.infinite() && parts == 1.0)
    pend(std::move(whole));
  else
    enter_in_pieces(whole, step_of_entrance(parts));
  pass_ = {0.0, pending_.power};
  // With a coarse goal, the first cut-off is relative to the mean power of the beams that enter.
  if (approach_ == Approach::falling && policy_.truncated_goal > kFinestGoal)
    cutoff_ *= pending_.power / static_cast<double>(pending_.beams.size());
}

void BeamWalk::pend(Beam&& beam) {
  beam.power = power_of(beam);
  pending_.power += beam.total_power();
  pending_.bytes += bytes_of(beam);
  memory_->add(bytes_of(beam));
  pending_.beams.push_back(std::move(beam));
}

Beam BeamWalk::next_pending() {
  Beam beam = std::move(pending_.beams.back());
  pending_.beams.pop_back();
  pending_.power -= beam.total_power();
  pending_.bytes -= bytes_of(beam);
  memory_->remove(bytes_of(beam));
  return beam;
}

std::shared_ptr<const BeamPlaces> BeamWalk::shared(BeamPlaces places) const {
  if (places.size() <= 1) return nullptr;
  places.shrink_to_fit();
  const std::uint64_t bytes = places.size() * sizeof(Vec2);
  work_ += kWorkOfPlace * places.size();
  memory_->add(bytes);
  return {new BeamPlaces(std::move(places)), [memory = memory_, bytes](const BeamPlaces* gone) {
            memory->remove(bytes);
            delete gone;
          }};
}

bool BeamWalk::has_many_deferred() const {
  return deferred_.beams.size() > kMostDeferred || deferred_.bytes > beam_memory_bytes() / 4 * 3;
}

void BeamWalk::require_memory() const {
  if (memory_->is_exceeded())
    throw TraceBudgetError(fmt::format(
        "beams exceed {} with {:.3g} of the power not accounted for: give a larger {}, which follows fewer beams, a "
        "larger budget, or {} montecarlo",
        memory_budget_text(), open_power(), reference({"cutoff"}), reference({"engine"})));
  memory_->require_shared();
}

/// Returns the number of parts, along either axis, into which the light on an element is divided. The work of finding
/// hidden facets grows as the square of the number of facets, and elements with rounded edges have dozens.
double BeamWalk::parts_of_element() const {
  double facets = 0.0;
  for (const SurfacePatch& patch : part_.patches)
    facets = std::max(facets, static_cast<double>(patch.facets.size()) / static_cast<double>(patch.cells.size()));
  return std::max(1.0, std::ceil(std::sqrt(facets / kFacetsOfPiece)));
}

/// Returns the maximum size in x and y of fragments of the incident beam. A fragment covers at most one element, so
/// that it meets few facets.
Vec2 BeamWalk::step_of_entrance(double parts) const {
  Vec2 step = Vec2::Constant(part_.size_mm);
  if (const auto* rtp = std::get_if<geometry::RtpElement>(&part_.spec.element))
    step = Vec2(rtp->base_mm + part_.spec.array.x_gap_mm, rtp->width_mm + part_.spec.array.y_gap_mm);
  return step / parts;
}

void BeamWalk::enter_in_pieces(const Beam& whole, const Vec2& step) {
  const Frame from_above(-Vec3::UnitZ());
  const double whole_area = area(flattened(whole.corners, from_above, merge_mm_));
  PlanBox box;
  for (const Vec3& p : whole.corners) box.include(p.head<2>());
  double entered = 0.0;
  for (double y = box.lower.y(); y < box.upper.y() - 1e-9 * step.y(); y += step.y()) {
    const Corners row = cut(cut(whole.corners, {Vec3::UnitY(), y}), {-Vec3::UnitY(), -(y + step.y())});
    for (double x = box.lower.x(); x < box.upper.x() - 1e-9 * step.x(); x += step.x()) {
      Beam piece = whole;
      piece.corners = cut(cut(row, {Vec3::UnitX(), x}), {-Vec3::UnitX(), -(x + step.x())});
      if (piece.corners.empty()) continue;
      piece.share = whole.share * (area(flattened(piece.corners, from_above, merge_mm_)) / whole_area);
      if (piece.share <= 0.0) continue;
      entered += piece.share;
      pend(std::move(piece));
    }
  }
  place_count_ = whole.place_count();
  book_rest(whole, whole.share - entered);
}

BeamWalk::End BeamWalk::run(std::uint64_t most_work, const Cancellation* cancel) {
  cancel_ = cancel;
  for (;;) {
    while (!pending_.beams.empty() && !may_stop()) {
      if (is_cancelled(cancel)) return End::cancelled;
      if (work_ >= most_work) return End::paused;
      require_memory();
      Beam beam = next_pending();
      if (strength_of(beam) < cutoff_) {
        defer(std::move(beam));
        if (deferred_.beams.size() >= most_kept_) return End::paused;
        continue;
      }
      if (++beams_ > policy_.max_beams) fail_on_budget();
      if (beam.places) keep_equal_places(beam);
      advance(beam);
    }
    if (approach_ == Approach::kept) return End::done;
    const bool is_enough = approach_ == Approach::fixed || open_power() <= policy_.truncated_goal;
    if ((is_enough && (may_stop() || policy_.spare_work <= work_)) || cutoff_ < kLastCutoff) break;
    if (has_many_deferred()) {
      if (is_enough) break;
      return End::cutoff_too_high;
    }
    lower_cutoff();
  }
  close();
  return End::done;
}

/// Returns true if the trace may stop. With a falling cut-off, this is the case if the power of the beams not yet
/// traced (the open power) is at most the goal. Until `spare_work` has been done, the finest goal is used instead. The
/// function may be called at any time, because the open power never increases. For the finest goals, the sum
/// `pending_.power` is too inaccurate, and the trace stops when the queue is empty and the power below the cut-off is
/// at most the goal. With the other approaches, the trace stops when the queue is empty.
bool BeamWalk::may_stop() const {
  if (approach_ != Approach::falling) return pending_.beams.empty();
  if (policy_.truncated_goal <= kFinestGoal) return pending_.beams.empty() && deferred_.power <= policy_.truncated_goal;
  return open_power() <= (work_ < policy_.spare_work ? kFinestGoal : policy_.truncated_goal);
}

void BeamWalk::lower_cutoff() {
  lower_cutoff_to(cutoff_ * (policy_.truncated_goal <= kFinestGoal ? kFall : kGentleFall));
}

void BeamWalk::lower_cutoff_to(double cutoff) {
  cutoff_ = cutoff;
  pass_ = {static_cast<double>(work_), deferred_.power};
  pending_.swap(deferred_);
  deferred_.power = 0.0;
}

/// Ends the trace. The power of all beams that have not been traced is added to `truncated`.
void BeamWalk::close() {
  for (const Beam& beam : pending_.beams) deferred_.power += beam.total_power();
  memory_->remove(pending_.bytes);
  Waiting none;
  pending_.swap(none);
  tally_.other[Account::truncated] += deferred_.power;
}

/// Returns the expected total work. It is extrapolated with a power law between work and open power. The work of the
/// present pass is extrapolated linearly from the fraction of the power that has been processed.
double BeamWalk::expected_work() const {
  const auto work = static_cast<double>(work_);
  const double settled = 1.0 - pending_.power / pass_.power;
  if (settled < 0.01) return 2.0 * work;
  const Pass end{pass_.work + (work - pass_.work) / settled, std::max(deferred_.power / settled, 1e-300)};
  if (approach_ == Approach::fixed || end.power <= policy_.truncated_goal) return std::max(end.work, work);
  const bool tells = pass_.work > 0.0 && end.power < 0.9 * pass_.power;
  const double slope = tells ? std::log(end.work / pass_.work) / std::log(pass_.power / end.power) : kUsualSlope;
  return end.work * std::pow(end.power / policy_.truncated_goal, std::clamp(slope, 0.2, 2.0));
}

BeamResult BeamWalk::result() const {
  BeamResult result;
  for (std::size_t cone = 0; cone < setup_.cone_chord2.size(); ++cone) {
    result.ledgers.push_back(tally_.ledger(cone));
    result.stokes.push_back(tally_.retroreflected(cone));
    result.std_error.push_back(0.0);
  }
  result.beams = beams_;
  result.depth = depth_;
  result.cutoff = cutoff_;
  return result;
}

/// Keeps a beam below the cut-off for a later pass. If there are too many such beams, the beam is discarded, and the
/// trace has to start again with a lower cut-off.
void BeamWalk::defer(Beam&& beam) {
  deferred_.power += beam.total_power();
  if (approach_ != Approach::kept && has_many_deferred()) return;
  deferred_.bytes += bytes_of(beam);
  memory_->add(bytes_of(beam));
  deferred_.beams.push_back(std::move(beam));
}

WaitingBeams BeamWalk::take_kept() {
  memory_->remove(deferred_.bytes);
  Waiting kept;
  deferred_.swap(kept);
  return std::move(kept.beams);
}

void BeamWalk::step(const Beam& beam, const Cancellation* cancel) {
  cancel_ = cancel;
  ++beams_;
  advance(beam);
}

void BeamWalk::take_waiting(WaitingBeams& into) {
  require_memory();
  memory_->remove(pending_.bytes);
  Waiting taken;  // a new queue replaces the old one, because clear() of an empty boost deque adds to a null pointer
  pending_.swap(taken);
  WaitingBeams().swap(into);
  taken.beams.swap(into);
}

void BeamWalk::advance(const Beam& beam) {
  depth_ = std::max(depth_, beam.depth);
  place_count_ = beam.place_count();
  work_ += kWorkOfBeam;
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
  double met_area = 0.0;
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    if (is_cancelled(cancel_)) return;
    for (const FlatPolygon& piece : visible_on_plane_of(k)) {
      met_area += area(piece);
      meet_facet(beam, frame, candidates_[k], piece, share_of(piece));
    }
  }
  if (whole_area - met_area > least_area_)
    for (const FlatPolygon& piece : what_passes(whole)) pass_by(beam, frame, piece, share_of(piece), horizon);
  book_rest(beam, beam.share - used);
}

/// Returns the parts of a beam's cross-section that no candidate (facet that may block the beam) covers.
FlatPolygons BeamWalk::what_passes(const FlatPolygon& whole) {
  FlatPolygons rest;
  rest.push_back(whole);
  for (const Candidate& candidate : candidates_) {
    FlatPolygons left;
    work_ += kWorkOfCut * rest.size();
    for (const FlatPolygon& piece : rest) subtract(piece, candidate.piece, least_area_, merge_mm_, left);
    rest = std::move(left);
  }
  if (rest.size() > 1) work_ += kWorkOfCut * rest.size() * (rest.size() - 1) / 4;
  join_convex(rest, join_area_);
  return rest;
}

/// Returns the distance at which the whole beam has left the layer of elements, -depth <= z <= top. The distance is
/// limited for nearly horizontal beams.
Horizon BeamWalk::horizon_of(const Beam& beam) const {
  double low = kInfinity;
  double high = -kInfinity;
  for (const Vec3& p : beam.corners) {
    low = std::min(low, p.z());
    high = std::max(high, p.z());
  }
  const double dz = beam.direction.z();
  const double slack = 1e-6 * part_.size_mm;
  if (dz > -kGrazing && low >= setup_.top_mm - merge_mm_) return {};
  // Distance at which all corners of the beam are in the layer. If it exceeds kFarInElements, it is replaced by the
  // distance at which the lowest corner enters the layer.
  double first = 0.0;
  double last = kInfinity;
  if (dz > 0.0) last = (setup_.top_mm - low) / dz;
  if (dz < 0.0) {
    first = std::max(0.0, (high - setup_.top_mm) / -dz);
    if (first > kFarInElements * part_.size_mm) first = std::max(0.0, (low - setup_.top_mm) / -dz);
    last = (high + setup_.depth_mm + slack) / -dz;
  }
  const bool is_shared = beam.places && !setup_.infinite();
  const double reach = first + (is_shared ? kReachOfShared : kReachInElements) * part_.size_mm;
  if (last <= reach) return {last, false};
  if (setup_.infinite()) return {reach, true};
  // A beam may leave a finite part through its outer faces. If this happens within reach, the horizon must include the
  // last exit, because the candidates contain only facets and not the outer faces.
  const auto [first_exit, last_exit] = distances_to_hull(beam);
  return reach < first_exit ? Horizon{reach, true} : Horizon{std::min(last, last_exit), false};
}

/// Returns the minimum and maximum distance from a beam's corners to the sides and, if it rises, to the entrance face.
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

/// Returns the bounding box in x and y of the beam's path through the layer of elements. The top of this layer is the
/// plane z = LightSetup::top_mm.
/// \param horizon maximum distance along the beam at which facets are searched
PlanBox BeamWalk::sweep_in_layer(const Beam& beam, const Horizon& horizon) const {
  // Due to rounding, a corner of a beam that starts at the top of the layer may be slightly above it. For a nearly
  // horizontal beam, the computed entry into the layer would then be many elements further on, and facets before it
  // would be missed. The top is therefore raised by the tolerance `merge_mm_`.
  const double top_mm = setup_.top_mm + merge_mm_;
  PlanBox plan;
  for (const Vec3& p : beam.corners) {
    const double above = p.z() - top_mm;
    const bool falls_in = above > 0.0 && beam.direction.z() < 0.0;
    const double from = falls_in ? std::min(horizon.t, above / -beam.direction.z()) : 0.0;
    plan.include((p + from * beam.direction).head<2>());
    plan.include((p + horizon.t * beam.direction).head<2>());
  }
  // If the beam's polygon intersects the top of the layer, its points on the plane of the top are included as well.
  for (const Vec3& p : cut(beam.corners, {-Vec3::UnitZ(), -top_mm})) plan.include(p.head<2>());
  return plan;
}

void BeamWalk::find_candidates(const Beam& beam, const Frame& frame, const FlatPolygon& whole, const Horizon& horizon) {
  candidates_.clear();
  if (horizon.t <= 0.0) return;
  const PlanBox plan = sweep_in_layer(beam, horizon);
  double nearest = kInfinity;
  for (const Vec3& p : beam.corners) nearest = std::min(nearest, beam.direction.dot(p));
  // Candidates are cut at the horizon, because facets beyond it may be hidden by other facets that were not searched.
  const Plane far{-beam.direction, -(nearest + horizon.t)};
  const PlanBox box = box_of(whole);
  cells_.visit(
      plan.lower, plan.upper,
      [&](const SurfacePatch& patch, const PatchCell& cell, const Vec2& offset, double height_mm) {
        const CellPlace place =
            equal_ != nullptr ? equal_->place_of(patch, cell, offset) : CellPlace{part_.number_of(patch, cell), offset};
        const Vec3 shift(offset.x(), offset.y(), height_mm);
        for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f)
          consider(beam, frame, whole, box, horizon.limited ? &far : nullptr, patch, patch.facets[f], shift, place);
      });
}

void BeamWalk::consider(const Beam& beam, const Frame& frame, const FlatPolygon& whole, const PlanBox& box,
                        const Plane* far, const SurfacePatch& patch, const PatchFacet& facet, const Vec3& shift,
                        const CellPlace& cell) {
  ++work_;
  const double towards = facet.normal.dot(beam.direction);
  if (beam.inside ? towards <= kGrazing : towards >= -kGrazing) return;
  Corners corners;
  PlanBox own;
  bool all_ahead = true;
  for (std::uint32_t c = 0; c < facet.corner_count; ++c) {
    corners.push_back(patch.vertices[patch.corners[facet.first_corner + c]] + shift);
    own.include(frame.across(corners.back()));
    all_ahead = all_ahead && beam.start.height(corners.back()) >= 0.0;
  }
  if (!own.overlaps(box)) return;
  work_ += kWorkOfCut;
  if (!all_ahead) corners = cut(corners, beam.start);
  if (far != nullptr) corners = cut(corners, *far);
  if (corners.empty()) return;
  const Plane plane{facet.normal, facet.offset_mm + facet.normal.dot(shift)};
  const FlatPolygon seen = flattened(corners, frame, merge_mm_);
  if (seen.size() < 3) return;
  FlatPolygon piece = intersection(whole, seen, merge_mm_);
  make_convex(piece);
  if (piece.size() < 3 || area(piece) <= least_area_) return;
  const PlanBox piece_box = box_of(piece);
  std::optional<Vec2> middle_mm = facet.middle_mm;
  if (middle_mm) *middle_mm += shift.head<2>();
  candidates_.push_back(
      {plane, facet.role, cell, Distance(frame, plane), std::move(piece), piece_box, false, middle_mm});
}

/// Returns true if all of a candidate's polygon is nearer than the plane of the other candidate.
bool BeamWalk::is_nearer(const Candidate& own, const Candidate& other) const {
  const auto is_before = [&](const Vec2& p) { return own.distance.at(p) < other.distance.at(p) - merge_mm_; };
  return std::all_of(own.piece.begin(), own.piece.end(), is_before);
}

/// Returns the parts of a candidate's polygon that no nearer candidate covers.
FlatPolygons BeamWalk::visible_pieces(std::size_t k) const {
  const Candidate& own = candidates_[k];
  FlatPolygons visible;
  visible.push_back(own.piece);
  for (std::size_t j = 0; j < candidates_.size() && !visible.empty(); ++j) {
    const Candidate& other = candidates_[j];
    if (j == k || !own.box.overlaps(other.box) || is_nearer(own, other)) continue;
    work_ += kWorkOfCut;
    const FlatPolygon common = intersection(own.piece, other.piece, merge_mm_);
    if (common.size() < 3 || area(common) <= least_area_) continue;
    const Vec2 at = geometry::centroid(std::span<const Vec2>(common.data(), common.size()));
    const double behind = own.distance.at(at) - other.distance.at(at);
    // If both candidates are at the same distance, the candidate with the lower index is visible.
    if (behind < 0.0 || (behind == 0.0 && k < j)) continue;
    FlatPolygons left;
    work_ += kWorkOfCut * visible.size();
    for (const FlatPolygon& piece : visible) subtract(piece, other.piece, least_area_, merge_mm_, left);
    visible = std::move(left);
  }
  return visible;
}

/// Returns the visible parts of all candidates in the plane of candidate k. Coplanar facets of neighbouring elements
/// therefore do not split a beam. The result is empty if the candidate has already been processed together with an
/// earlier candidate.
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
  if (visible.size() > 1) work_ += kWorkOfCut * visible.size() * (visible.size() - 1) / 4;
  join_convex(visible, join_area_);
  return visible;
}

/// Processes a fragment of a beam that no facet within the horizon blocks.
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
      pend(std::move(beam));
    else
      book(Account::truncated, power_of(beam));
    return;
  }
  if (from.inside) {
    leave_hull(from, frame, piece, share);
    return;
  }
  const bool rises_through_plate = setup_.infinite() && from.direction.z() > 0.0;
  const double power = power_at_start(from, frame, piece, share);
  book(rises_through_plate ? Account::truncated : account_of_exit(from.left_through), power);
}

/// Splits a fragment at the entrance face and the sides. Each face receives the part of the fragment for which it is
/// the nearest face.
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
      // Below z = 0, a side plane belongs to border walls. In the coordinates across the beam, z = up . p + start.
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

}  // namespace retrace::raytrace
