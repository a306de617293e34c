#include "raytrace/cells/cell_walker.h"

#include <algorithm>
#include <bit>

namespace retrace::raytrace {
namespace {

using geometry::FacetRole;

// More values of `which`, in addition to those in the class. The first border is number 2. kHandedOver marks rays that
// leave the region in which this class traces them.
constexpr std::size_t kFirstBorder = 2;
constexpr double kHandedOver = -1.0;
// Maximum distance of a position from its column that is caused by rounding, relative to the period.
constexpr double kSlack = 1e-12;

Vec3 lifted(const Vec2& normal) {
  return {normal.x(), normal.y(), 0.0};
}

std::size_t numbers_of(const CellArray& array, bool has_owners) {
  if (has_owners) return lanes::kRayNumbers;
  return array.inner() ? lanes::kNumbersOfFinite : lanes::kNumbersOfEndless;
}

}  // namespace

CellWalker::CellWalker(const LightSetup& setup, const PathPolicy& policy, const CellArray& array, const Vec2& centre_mm,
                       bool has_owners)
    : setup_(setup),
      policy_(policy),
      array_(array),
      waiting_(64),
      moved_(numbers_of(array, has_owners)),
      chosen_(moved_),
      entering_{chosen_, chosen_},
      left_(has_owners ? lanes::kRayNumbers : lanes::kNumbersOfEndless) {
  if (setup.optics.entrance.scatters()) soiled_.emplace(setup.optics);
  anchor_mm_ = -centre_mm;
  if (const auto& inner = array.inner()) {
    inner_ = {inner->where_mm.lower - centre_mm, inner->where_mm.upper - centre_mm};
    anchor_mm_ += inner->anchor_mm;
  }
  for (const CellArray::Column& column : array.columns()) {
    Shape& shape = shapes_.emplace_back();
    shape.role = column.facets.front().role;
    for (const CellArray::Facet& facet : column.facets) {
      shape.facets.push_back({facet.normal, facet.offset_mm});
      shape.frames.emplace_back();
      if (facet.middle_mm) shape.frames.back() = FacetFrame(facet.normal, facet.offset_mm, *facet.middle_mm);
      shape.heights.push_back({facet.height.slope.x(), facet.height.slope.y(), facet.height.height_mm});
    }
    for (const CellArray::Edge& edge : column.edges) shape.borders.push_back({lifted(edge.normal), edge.offset_mm});
  }
  for (std::uint32_t column = 0; column < array.columns().size(); ++column)
    for (const bool scattered : {false, true})
      for (const Place place : {Place::inside, Place::below, Place::below_after_leaving}) {
        Stream& stream = streams_.emplace_back(Stream{column, place, scattered, RayStore(moved_), {}, {}, {}});
        prepare(stream);
      }
  // The pieces are enlarged slightly, so that rounding leaves no gap between them. A ray just outside of its column
  // crosses into the next column in its next step.
  const double slack_mm = kSlack * array.period_mm().maxCoeff();
  for (const CellArray::Piece& piece : array.pieces()) {
    piece_starts_.push_back(static_cast<std::uint32_t>(pieces_.size()));
    for (const CellArray::Edge& edge : array.columns()[piece.column].edges)
      pieces_.push_back(
          {-edge.normal.x(), -edge.normal.y(), edge.offset_mm - edge.normal.dot(piece.shift_mm) + slack_mm});
  }
  piece_starts_.push_back(static_cast<std::uint32_t>(pieces_.size()));
}

/// Determines the neighbours behind the borders of a stream's column.
void CellWalker::prepare(Stream& stream) const {
  const std::vector<CellArray::Edge>& edges = array_.columns()[stream.column].edges;
  const bool inside = stream.place == Place::inside;
  std::size_t next = kFirstBorder + edges.size();
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const CellArray::Edge& edge = edges[k];
    const auto crossing = [&](const CellArray::Neighbour& neighbour) {
      const Vec3 out = lifted(edge.normal);
      return Crossing{neighbour.column, neighbour.shift_mm, inside ? out : Vec3(-out)};
    };
    stream.borders.emplace_back();
    if (edge.neighbours.size() == 1 && edge.neighbours[0].is_level) {
      stream.borders.back() = crossing(edge.neighbours[0]);
      continue;
    }
    Refinement refinement;
    refinement.number = static_cast<double>(kFirstBorder + k);
    refinement.to = static_cast<double>(next);
    refinement.first_crossing = stream.crossings.size();
    refinement.border.along = {edge.along.x(), edge.along.y(), 0.0};
    refinement.border.inside = inside;
    for (const CellArray::Neighbour& neighbour : edge.neighbours) {
      refinement.border.limits.push_back(neighbour.until_mm);
      refinement.border.stretches.push_back(
          {neighbour.is_level, neighbour.shift_mm, shapes_[neighbour.column].heights});
      stream.crossings.push_back(crossing(neighbour));
    }
    refinement.border.limits.pop_back();
    next += 2 * edge.neighbours.size();
    stream.refinements.push_back(std::move(refinement));
  }
}

void CellWalker::reserve(std::size_t count) {
  moved_.reserve(count);
  chosen_.reserve(count);
  if (capacity_ >= count + lanes::kPadding) return;
  capacity_ = 2 * count + lanes::kPadding;
  met_.resize(4 * capacity_);
  branches_.resize(capacity_);
}

void CellWalker::begin(const geometry::Rectangle& entrance_mm, std::uint32_t first, std::size_t count, RandomKey key,
                       std::uint32_t replicate, Tally& tally) {
  key_ = key;
  replicate_ = replicate;
  sample_ = first;
  choices_ = 0;
  batches_ = 0;
  tally_ = &tally;
  outline_ = entrance_mm;
  handed_over_.clear();
  reserve(count);
  chosen_.resize(count);
}

void CellWalker::trace(const geometry::Rectangle& entrance_mm, std::uint64_t key_x, std::uint64_t key_y,
                       std::uint32_t first, std::size_t count, RandomKey key, std::uint32_t replicate, Tally& tally) {
  begin(entrance_mm, first, count, key, replicate, tally);
  const lanes::Rays rays = chosen_.rays();
  lanes::sobol(key_x, key_y, first, count, entrance_mm.size(), rays[lanes::kX], rays[lanes::kY]);
  std::fill_n(rays[lanes::kZ], count, setup_.thickness_mm);
  if (array_.inner()) {
    std::fill_n(rays[lanes::kOx], count, entrance_mm.lower.x());
    std::fill_n(rays[lanes::kOy], count, entrance_mm.lower.y());
    lanes::shift(rays, count, entrance_mm.lower - anchor_mm_);
  }
  if (soiled_)
    enter_soiled(count);
  else
    enter(count);
  while (const auto stream = fullest()) advance(*stream);
}

void CellWalker::follow(const std::vector<Start>& starts, const geometry::Rectangle& entrance_mm, RandomKey key,
                        std::uint32_t replicate, std::uint32_t first, Tally& tally, Observer& observer) {
  begin(entrance_mm, first, starts.size(), key, replicate, tally);
  observer_ = &observer;
  const lanes::Rays rays = chosen_.rays();
  for (std::size_t k = 0; k < starts.size(); ++k) {
    for (std::size_t n = 0; n < 3; ++n) rays[lanes::kX + n][k] = starts[k].position[static_cast<Eigen::Index>(n)];
    set(rays, k, starts[k].ray);
    rays[lanes::kOx][k] = rays[lanes::kOy][k] = 0.0;
    rays[lanes::kOwner][k] = static_cast<double>(starts[k].owner);
  }
  lanes::shift(rays, starts.size(), -anchor_mm_);
  if (!chosen_.empty()) fall(false);
  while (const auto stream = fullest()) advance(*stream);
  observer_ = nullptr;
}

/// Starts the rays of `chosen_` at their positions on the entrance face.
void CellWalker::enter(std::size_t count) {
  const LightSetup::Entry& entry = setup_.entry;
  tally_->front[entry.front_cone] += static_cast<double>(count) * entry.front;
  tally_->other[Account::absorbed] += static_cast<double>(count) * entry.absorbed;
  if (setup_.score != nullptr)
    setup_.score->add(entry.front_direction, static_cast<double>(count) * entry.front.i, tally_->score);
  const lanes::Rays rays = chosen_.rays();
  for (std::size_t k = 0; k < count; ++k) set(rays, k, {entry.direction, entry.light});
  fall(false);
}

void CellWalker::waits(std::uint32_t stream) {
  waiting_[static_cast<std::size_t>(std::bit_width(streams_[stream].rays.size()))].push_back(stream);
}

std::optional<std::uint32_t> CellWalker::fullest() {
  for (std::size_t bits = waiting_.size(); bits-- > 1;)
    while (!waiting_[bits].empty()) {
      const std::uint32_t stream = waiting_[bits].back();
      waiting_[bits].pop_back();
      // Streams are listed again when they grow, and their old entries remain. Old entries are ignored.
      if (static_cast<std::size_t>(std::bit_width(streams_[stream].rays.size())) == bits) return stream;
    }
  return std::nullopt;
}

/// Adds rays to a stream. Their data have already been written behind its last ray.
void CellWalker::grow(std::uint32_t number, std::size_t more) {
  if (more == 0) return;
  RayStore& rays = streams_[number].rays;
  const std::size_t before = rays.size();
  rays.resize(before + more);
  if (std::bit_width(before) != std::bit_width(before + more)) waits(number);
}

/// Adds rays that come from another column to a stream. Rays that leave the inner region of the part are handed over.
void CellWalker::come_in(std::uint32_t number, std::size_t more, const Vec2& shift) {
  if (more == 0) return;
  const Stream& stream = streams_[number];
  const lanes::Rays rays = streams_[number].rays.rays(stream.rays.size());
  if (shift != Vec2::Zero()) lanes::shift(rays, more, shift);
  if (array_.inner()) {
    std::fill_n(branches_.begin(), more, 0.0);
    if (lanes::mark_beyond(rays, more, {0.0, inner_.lower, inner_.upper}, 0.0, kHandedOver, branches_.data()) > 0) {
      hand_over(rays, more, branches_, kHandedOver, stream.place == Place::inside, stream.scattered);
      more = lanes::select(branches_.data(), 0.0, more, rays, rays);
    }
  }
  grow(number, more);
}

void CellWalker::set(const lanes::Rays& rays, std::size_t k, const Ray& ray) {
  const auto put = [&](std::size_t first, const auto& values) {
    for (std::size_t n = 0; n < values.size(); ++n) rays[first + n][k] = values[n];
  };
  const auto three = [](const Vec3& v) { return std::array{v.x(), v.y(), v.z()}; };
  put(lanes::kDx, three(ray.direction));
  put(lanes::kI, ray.light.stokes.values());
  put(lanes::kAx, three(ray.light.s_axis));
}

Ray CellWalker::ray_of(const lanes::Rays& rays, std::size_t k, bool inside, bool scattered) const {
  return {vector_of(rays, lanes::kDx, k),
          {{rays[lanes::kI][k], rays[lanes::kQ][k], rays[lanes::kU][k], rays[lanes::kV][k]},
           vector_of(rays, lanes::kAx, k).normalized()},
          inside,
          scattered};
}

void CellWalker::hand_over(const lanes::Rays& rays, std::size_t count, const std::vector<double>& which, double number,
                           bool inside, bool scattered) {
  for (std::size_t k = 0; k < count; ++k)
    if (which[k] == number)
      handed_over_.push_back({place_of(rays, k), ray_of(rays, k, inside, scattered), owner_of(rays, k)});
}

/// Returns the arrays behind the last ray of a stream, with memory for `most` rays.
lanes::Rays CellWalker::end_of(std::uint32_t stream, std::size_t most) {
  RayStore& rays = streams_[stream].rays;
  rays.reserve(rays.size() + most);
  return rays.rays(rays.size());
}

lanes::Met CellWalker::met() {
  return {met_.data(), {&met_[capacity_], &met_[2 * capacity_], &met_[3 * capacity_]}};
}

lanes::Meeting CellWalker::meeting(double number, bool inside) {
  return {met(), number, inside ? -1.0 : 1.0, policy_.split_power, random()};
}

/// Ends the rays of `moved_` that have met a face with this number, and adds their power to an account of the ledger.
void CellWalker::book(double number, Account account) {
  const lanes::Share share = lanes::sum_of(met_.data(), number, moved_.rays(), moved_.size());
  tally_->other[account] += share.power;
  tally_->segments += share.count;
}

void CellWalker::tell_of_transmitted(double number) {
  const lanes::Rays rays = moved_.rays();
  for (std::size_t k = 0; k < moved_.size(); ++k)
    if (met_[k] == number) observer_->is_transmitted(owner_of(rays, k), rays[lanes::kI][k]);
}

void CellWalker::tell_of_leaving(const lanes::Rays& left, std::size_t k) {
  observer_->leaves(owner_of(left, k), place_of(left, k), vector_of(left, lanes::kDx, k), left[lanes::kI][k]);
}

/// Moves the rays of `chosen_` from the entrance face down to the top of the surface.
void CellWalker::fall(bool scattered) {
  const std::vector<CellArray::Piece>& pieces = array_.pieces();
  const double height_mm = setup_.thickness_mm - setup_.top_mm;
  if (array_.inner()) {
    std::fill_n(branches_.begin(), chosen_.size(), 0.0);
    const lanes::Reach down{-height_mm, inner_.lower, inner_.upper};
    if (lanes::mark_beyond(chosen_.rays(), chosen_.size(), down, 0.0, kHandedOver, branches_.data()) > 0) {
      hand_over(chosen_.rays(), chosen_.size(), branches_, kHandedOver, true, scattered);
      chosen_.resize(lanes::select(branches_.data(), 0.0, chosen_.size(), chosen_.rays(), chosen_.rays()));
    }
  }
  tally_->other[Account::absorbed] += lanes::fall(chosen_.rays(), chosen_.size(), height_mm, setup_.top_mm,
                                                  array_.period_mm(), setup_.optics.absorption_per_mm);
  std::size_t left = chosen_.size();
  if (pieces.size() > 1)
    lanes::mark_polygon(chosen_.rays(), left, pieces_, piece_starts_, branches_.data());
  else
    std::fill_n(branches_.begin(), left, 0.0);
  for (std::size_t k = 0; k < pieces.size() && left > 0; ++k) {
    const std::uint32_t stream = stream_of(pieces[k].column, Place::inside, scattered);
    const lanes::Rays to = end_of(stream, left);
    const std::size_t more =
        lanes::select(branches_.data(), static_cast<double>(k), chosen_.size(), chosen_.rays(), to);
    if (pieces[k].shift_mm != Vec2::Zero()) lanes::shift(to, more, pieces[k].shift_mm);
    grow(stream, more);
    left -= more;
  }
  // The pieces fill the period, so that every ray should be in one of them. Rays that are in no piece are counted as
  // lost.
  tally_->misses += left;
  tally_->other[Account::lost] += static_cast<double>(left);
}

/// Ends the rays of `moved_` with less power than the cut-off.
void CellWalker::truncate_weak() {
  if (lanes::mark_weak(moved_.rays(), policy_.cutoff, moved_.size(), branches_.data()) == 0) return;
  const double before = lanes::sum(moved_.rays(), moved_.size());
  moved_.resize(lanes::select(branches_.data(), 0.0, moved_.size(), moved_.rays(), moved_.rays()));
  tally_->other[Account::truncated] += before - lanes::sum(moved_.rays(), moved_.size());
}

void CellWalker::advance(std::uint32_t number) {
  Stream& stream = streams_[number];
  moved_.clear();
  moved_.swap(stream.rays);
  reserve(moved_.size());
  truncate_weak();
  // A batch moves each ray at most one time, so that a path cannot meet more interfaces than there are batches.
  if (++batches_ > policy_.max_events) {
    tally_->other[Account::truncated] += lanes::sum(moved_.rays(), moved_.size());
    return;
  }
  move(stream);
  meet_surface(stream);
  if (stream.place == Place::inside) {
    meet_entrance(stream.scattered);
  } else {
    book(kTopOrNothing, Account::transmitted);
    if (observer_ != nullptr) tell_of_transmitted(kTopOrNothing);
  }
  for (std::size_t k = 0; k < stream.borders.size(); ++k)
    if (stream.borders[k]) cross(stream, *stream.borders[k], static_cast<double>(kFirstBorder + k));
  for (const Refinement& refinement : stream.refinements)
    for (std::size_t k = 0; k < refinement.border.stretches.size(); ++k) {
      const Crossing& crossing = stream.crossings[refinement.first_crossing + k];
      const double first = refinement.to + 2.0 * static_cast<double>(k);
      cross(stream, crossing, first);
      if (!refinement.border.stretches[k].is_level) meet_wall(stream, crossing, first + 1.0);
    }
}

/// Moves the rays of `moved_` to the next face.
void CellWalker::move(const Stream& stream) {
  const Shape& shape = shapes_[stream.column];
  const lanes::Rays rays = moved_.rays();
  if (stream.place == Place::inside)
    tally_->other[Account::absorbed] += lanes::advance_inside(rays, moved_.size(), shape.facets, setup_.top_mm,
                                                              shape.borders, setup_.optics.absorption_per_mm, met());
  else if (stream.place == Place::below)
    lanes::advance_outside(rays, moved_.size(), shape.facets, setup_.depth_mm, shape.borders, met());
  else
    lanes::advance_outside(rays, moved_.size(), {}, setup_.depth_mm, shape.borders, met());
  for (const Refinement& refinement : stream.refinements)
    lanes::refine(rays, moved_.size(), refinement.border, refinement.number, refinement.to, met_.data());
}

void CellWalker::meet_surface(const Stream& stream) {
  const bool inside = stream.place == Place::inside;
  const Optics& optics = setup_.optics;
  const std::uint32_t part = stream_of(stream.column, Place::inside, stream.scattered);
  const std::uint32_t below = stream_of(stream.column, Place::below_after_leaving, stream.scattered);
  const bool is_retro = shapes_[stream.column].role == FacetRole::retro_facet;
  if (is_retro && !optics.facet_form.is_plane()) turn_normals(stream);
  if (is_retro && optics.mirror_facets) {
    const std::uint32_t to = inside ? part : below;
    const std::size_t more =
        lanes::meet_mirrors(moved_.rays(), moved_.size(), meeting(kFacet, inside), end_of(to, moved_.size()));
    tally_->segments += more;
    return grow(to, more);
  }
  if (is_retro && !optics.is_smooth()) return meet_texture(stream);
  const std::uint32_t reflected_to = inside ? part : below;
  const std::uint32_t transmitted_to = inside ? below : part;
  if (is_retro && !optics.facet_layers.empty()) return meet_layers(stream, reflected_to, transmitted_to);
  meet_faces(kFacet, inside, reflected_to, transmitted_to, nullptr);
}

/// Moves rays into the next column.
void CellWalker::cross(const Stream& stream, const Crossing& crossing, double number) {
  const std::uint32_t to =
      stream_of(crossing.column, stream.place == Place::inside ? Place::inside : Place::below, stream.scattered);
  const std::size_t more = lanes::select(met_.data(), number, moved_.size(), moved_.rays(), end_of(to, moved_.size()));
  come_in(to, more, crossing.shift_mm);
}

/// Processes rays at the wall between two surfaces of different height.
void CellWalker::meet_wall(const Stream& stream, const Crossing& crossing, double number) {
  if (setup_.optics.absorbing_walls) {
    book(number, Account::absorbed);
    return;
  }
  if (std::find(met_.begin(), met_.begin() + static_cast<std::ptrdiff_t>(moved_.size()), number) ==
      met_.begin() + static_cast<std::ptrdiff_t>(moved_.size()))
    return;
  const bool inside = stream.place == Place::inside;
  for (std::size_t k = 0; k < 3; ++k)  // the normals of facets are no longer needed and are replaced
    std::fill_n(&met_[(k + 1) * capacity_], moved_.size(), crossing.wall_normal[static_cast<Eigen::Index>(k)]);
  const Place here = inside ? Place::inside : Place::below;
  const Place there = inside ? Place::below : Place::inside;
  meet_faces(number, inside, stream_of(stream.column, here, stream.scattered),
             stream_of(crossing.column, there, stream.scattered), &crossing);
}

/// Traces both branches of the rays of `moved_` that have met faces with this number.
/// \param crossing next column for the transmitted rays; null if they stay in the column
void CellWalker::meet_faces(double number, bool inside, std::uint32_t reflected_to, std::uint32_t transmitted_to,
                            const Crossing* crossing) {
  const lanes::Rays reflected = end_of(reflected_to, moved_.size());
  const lanes::Rays transmitted = end_of(transmitted_to, moved_.size());
  const lanes::Branches more = lanes::meet_faces(moved_.rays(), moved_.size(), meeting(number, inside),
                                                 setup_.optics.ratio_at_back(inside), reflected, transmitted);
  tally_->segments += more.count;
  grow(reflected_to, more.reflected);
  if (crossing != nullptr)
    come_in(transmitted_to, more.transmitted, crossing->shift_mm);
  else
    grow(transmitted_to, more.transmitted);
}

/// Moves rays from the top of the surface up to the entrance face. Rays that are reflected there are moved back down.
void CellWalker::meet_entrance(bool scattered) {
  const Optics& optics = setup_.optics;
  const double height_mm = setup_.thickness_mm - setup_.top_mm;
  const lanes::Rays rays = moved_.rays();
  // Rays that reach a side before the entrance face are handed over.
  if (array_.inner() && lanes::mark_beyond(rays, moved_.size(), {height_mm, outline_.lower, outline_.upper},
                                           kTopOrNothing, kHandedOver, met_.data()) > 0)
    hand_over(rays, moved_.size(), met_, kHandedOver, true, scattered);
  if (soiled_) return meet_soiled_entrance(scattered);
  if (!optics.has_bare_entrance()) return meet_layers_of_entrance(scattered);
  const lanes::Entrance entrance = {
      height_mm,        optics.index,      optics.absorption_per_mm, optics.lossless_entrance,
      setup_.to_source, setup_.cone_chord2};
  const bool is_kept = setup_.score != nullptr || observer_ != nullptr;
  if (is_kept) left_.reserve(moved_.size());
  const lanes::Rays left = left_.rays();
  const lanes::Arrivals arrivals =
      lanes::meet_entrance(rays, moved_.size(), meeting(kTopOrNothing, true), entrance, chosen_.rays(),
                           scattered ? tally_->scattered : tally_->returned, is_kept ? &left : nullptr);
  for (std::size_t k = 0; k < arrivals.left; ++k) {
    if (setup_.score != nullptr) setup_.score->add(vector_of(left, lanes::kDx, k), left[lanes::kI][k], tally_->score);
    if (observer_ != nullptr) tell_of_leaving(left, k);
  }
  tally_->segments += arrivals.count;
  tally_->other[Account::absorbed] += arrivals.absorbed;
  chosen_.resize(arrivals.reflected);
  if (!chosen_.empty()) fall(scattered);
}

}  // namespace retrace::raytrace
