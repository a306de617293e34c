#include "raytrace/cell/cell_walker.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace retrace::raytrace {
namespace {

using geometry::FacetRole;

// Numbers of what lanes::advance_inside() and lanes::advance_outside() find.
constexpr double kFacet = 0.0;
constexpr double kTopOrNothing = 1.0;
constexpr std::size_t kFirstBorder = 2;
// By how much places may miss their column by rounding, relative to the period.
constexpr double kSlack = 1e-12;

Vec3 lifted(const Vec2& normal) {
  return {normal.x(), normal.y(), 0.0};
}

}  // namespace

CellWalker::CellWalker(const LightSetup& setup, const PathPolicy& policy, const CellArray& array)
    : setup_(setup), policy_(policy), array_(array), waiting_(64) {
  for (const CellArray::Column& column : array.columns()) {
    Shape& shape = shapes_.emplace_back();
    shape.role = column.facets.front().role;
    for (const CellArray::Facet& facet : column.facets) {
      shape.facets.push_back({facet.normal, facet.offset_mm});
      shape.heights.push_back({facet.height.slope.x(), facet.height.slope.y(), facet.height.height_mm});
    }
    for (const CellArray::Edge& edge : column.edges) shape.borders.push_back({lifted(edge.normal), edge.offset_mm});
  }
  for (std::uint32_t column = 0; column < array.columns().size(); ++column)
    for (const Place place : {Place::inside, Place::below, Place::below_after_leaving}) {
      Stream& stream = streams_.emplace_back();
      stream.column = column;
      stream.place = place;
      prepare(stream);
    }
  // Rounding must not leave a gap between two pieces; a ray a little outside its column crosses into the next at once.
  const double slack_mm = kSlack * array.period_mm().maxCoeff();
  for (const CellArray::Piece& piece : array.pieces()) {
    piece_starts_.push_back(static_cast<std::uint32_t>(pieces_.size()));
    for (const CellArray::Edge& edge : array.columns()[piece.column].edges)
      pieces_.push_back(
          {-edge.normal.x(), -edge.normal.y(), edge.offset_mm - edge.normal.dot(piece.shift_mm) + slack_mm});
  }
  piece_starts_.push_back(static_cast<std::uint32_t>(pieces_.size()));
}

/// What lies behind the borders of a stream.
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

void CellWalker::trace(std::uint64_t key_x, std::uint64_t key_y, std::uint32_t first, std::size_t count, RandomKey key,
                       std::uint32_t replicate, Tally& tally) {
  key_ = key;
  replicate_ = replicate;
  sample_ = first;
  choices_ = 0;
  batches_ = 0;
  tally_ = &tally;
  const LightSetup::Entry& entry = setup_.entry;
  tally.front[entry.front_cone] += static_cast<double>(count) * entry.front;
  reserve(count);
  chosen_.resize(count);
  const lanes::Rays rays = chosen_.rays();
  lanes::sobol(key_x, key_y, first, count, array_.period_mm(), rays[lanes::kX], rays[lanes::kY]);
  const Vec3& d = entry.direction;
  const Stokes& s = entry.light.stokes;
  const Vec3& a = entry.light.s_axis;
  const std::array<double, 10> shared = {d.x(), d.y(), d.z(), s.i, s.q, s.u, s.v, a.x(), a.y(), a.z()};
  for (std::size_t k = 0; k < shared.size(); ++k) std::fill_n(rays[lanes::kDx + k], count, shared[k]);
  fall();
  while (const auto stream = fullest()) advance(*stream);
}

void CellWalker::waits(std::uint32_t stream) {
  waiting_[static_cast<std::size_t>(std::bit_width(streams_[stream].rays.size()))].push_back(stream);
}

std::optional<std::uint32_t> CellWalker::fullest() {
  for (std::size_t bits = waiting_.size(); bits-- > 1;)
    while (!waiting_[bits].empty()) {
      const std::uint32_t stream = waiting_[bits].back();
      waiting_[bits].pop_back();
      // Streams are entered again when they grow, and stay in their old lists.
      if (static_cast<std::size_t>(std::bit_width(streams_[stream].rays.size())) == bits) return stream;
    }
  return std::nullopt;
}

/// Takes in rays that have been put behind those of a stream.
void CellWalker::grow(std::uint32_t number, std::size_t more, const Vec2& shift) {
  if (more == 0) return;
  RayStore& rays = streams_[number].rays;
  const std::size_t before = rays.size();
  rays.resize(before + more);
  if (shift != Vec2::Zero()) lanes::shift(rays.rays(before), more, shift);
  if (std::bit_width(before) != std::bit_width(before + more)) waits(number);
}

/// Where the next rays of a stream go, with room for `most`.
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

/// Ends those rays of `moved_` that have met what is numbered so.
void CellWalker::book(double number, Account account) {
  const lanes::Share share = lanes::sum_of(met_.data(), number, moved_.rays(), moved_.size());
  tally_->other[account] += share.power;
  tally_->segments += share.count;
}

/// From the entrance down to the top of the surface: the rays of `chosen_`.
void CellWalker::fall() {
  const std::vector<CellArray::Piece>& pieces = array_.pieces();
  tally_->other[Account::absorbed] += lanes::fall(chosen_.rays(), chosen_.size(), setup_.thickness_mm - setup_.top_mm,
                                                  setup_.top_mm, array_.period_mm(), setup_.optics.absorption_per_mm);
  std::size_t left = chosen_.size();
  if (pieces.size() > 1)
    lanes::mark_polygon(chosen_.rays(), left, pieces_, piece_starts_, branches_.data());
  else
    std::fill_n(branches_.begin(), left, 0.0);
  for (std::size_t k = 0; k < pieces.size() && left > 0; ++k) {
    const std::uint32_t stream = stream_of(pieces[k].column, Place::inside);
    const std::size_t more =
        lanes::select(branches_.data(), static_cast<double>(k), chosen_.size(), chosen_.rays(), end_of(stream, left));
    grow(stream, more, pieces[k].shift_mm);
    left -= more;
  }
  // None can be left: the pieces fill the period.
  tally_->misses += left;
  tally_->other[Account::lost] += static_cast<double>(left);
}

/// Books rays of `moved_` below the cut-off and takes them away.
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
  // A ray is moved at most once in every batch.
  if (++batches_ > policy_.max_events) {
    tally_->other[Account::truncated] += lanes::sum(moved_.rays(), moved_.size());
    return;
  }
  move(stream);
  meet_surface(stream);
  if (stream.place == Place::inside) {
    meet_entrance();
  } else {
    book(kTopOrNothing, Account::transmitted);
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

/// The rays of `moved_` to what they meet next.
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
  const std::uint32_t part = stream_of(stream.column, Place::inside);
  const std::uint32_t below = stream_of(stream.column, Place::below_after_leaving);
  const bool is_retro = shapes_[stream.column].role == FacetRole::retro_facet;
  if (is_retro && optics.mirror_facets) {
    const std::uint32_t to = inside ? part : below;
    const std::size_t more =
        lanes::meet_mirrors(moved_.rays(), moved_.size(), meeting(kFacet, inside), end_of(to, moved_.size()));
    tally_->segments += more;
    return grow(to, more, Vec2::Zero());
  }
  if (is_retro && optics.coating_index) return meet_metal(stream, *optics.coating_index);
  meet_faces(kFacet, inside, inside ? part : below, inside ? below : part, Vec2::Zero());
}

/// Rays on into the next column.
void CellWalker::cross(const Stream& stream, const Crossing& crossing, double number) {
  const std::uint32_t to = stream_of(crossing.column, stream.place == Place::inside ? Place::inside : Place::below);
  const std::size_t more = lanes::select(met_.data(), number, moved_.size(), moved_.rays(), end_of(to, moved_.size()));
  grow(to, more, crossing.shift_mm);
}

/// Against the wall that stands where one surface is lower than the other.
void CellWalker::meet_wall(const Stream& stream, const Crossing& crossing, double number) {
  if (setup_.optics.absorbing_walls) {
    book(number, Account::absorbed);
    return;
  }
  const bool inside = stream.place == Place::inside;
  for (std::size_t k = 0; k < 3; ++k)  // the facets' normals have done their duty
    std::fill_n(&met_[(k + 1) * capacity_], moved_.size(), crossing.wall_normal[static_cast<Eigen::Index>(k)]);
  const Place here = inside ? Place::inside : Place::below;
  const Place there = inside ? Place::below : Place::inside;
  meet_faces(number, inside, stream_of(stream.column, here), stream_of(crossing.column, there), crossing.shift_mm);
}

/// Both branches of those rays of `moved_` that have met the faces numbered so.
void CellWalker::meet_faces(double number, bool inside, std::uint32_t reflected_to, std::uint32_t transmitted_to,
                            const Vec2& transmitted_shift) {
  const lanes::Rays reflected = end_of(reflected_to, moved_.size());
  const lanes::Rays transmitted = end_of(transmitted_to, moved_.size());
  const lanes::Branches more = lanes::meet_faces(moved_.rays(), moved_.size(), meeting(number, inside),
                                                 setup_.optics.ratio_at_back(inside), reflected, transmitted);
  tally_->segments += more.count;
  grow(reflected_to, more.reflected, Vec2::Zero());
  grow(transmitted_to, more.transmitted, transmitted_shift);
}

/// One by one: films are rare, and their amplitudes complex.
void CellWalker::meet_metal(const Stream& stream, std::complex<double> metal) {
  const bool inside = stream.place == Place::inside;
  const std::complex<double> ratio = (inside ? setup_.optics.index : setup_.optics.back_index) / metal;
  const lanes::Rays rays = moved_.rays();
  for (std::size_t k = 0; k < moved_.size(); ++k) {
    if (met_[k] != kFacet) continue;
    const auto vector = [&](std::size_t first) { return Vec3(rays[first][k], rays[first + 1][k], rays[first + 2][k]); };
    const auto set = [&](std::size_t first, const Vec3& v) {
      for (std::size_t axis = 0; axis < 3; ++axis) rays[first + axis][k] = v[static_cast<Eigen::Index>(axis)];
    };
    const Vec3 direction = vector(lanes::kDx);
    const Vec3 normal(met_[capacity_ + k], met_[2 * capacity_ + k], met_[3 * capacity_ + k]);
    const Vec3 against = inside ? Vec3(-normal) : normal;
    Light light{{rays[lanes::kI][k], rays[lanes::kQ][k], rays[lanes::kU][k], rays[lanes::kV][k]}, vector(lanes::kAx).normalized()};
    light.turn_to(direction, against);
    const Light reflected = light.reflected(materials::fresnel_metal(ratio, -against.dot(direction)));
    tally_->other[Account::absorbed] += light.power() - reflected.power();
    const std::array<double, 4> stokes = reflected.stokes.values();
    for (std::size_t n = 0; n < 4; ++n) rays[lanes::kI + n][k] = stokes[n];
    set(lanes::kAx, reflected.s_axis);
    set(lanes::kDx, mirrored(direction, against));
  }
  const std::uint32_t to = stream_of(stream.column, inside ? Place::inside : Place::below_after_leaving);
  const std::size_t more = lanes::select(met_.data(), kFacet, moved_.size(), moved_.rays(), end_of(to, moved_.size()));
  tally_->segments += more;
  grow(to, more, Vec2::Zero());
}

/// From the top of the surface up to the entrance, out, and back down.
void CellWalker::meet_entrance() {
  const Optics& optics = setup_.optics;
  const lanes::Entrance entrance = {setup_.thickness_mm - setup_.top_mm,
                                    optics.index,
                                    optics.absorption_per_mm,
                                    optics.lossless_entrance,
                                    setup_.to_source,
                                    setup_.cone_chord2};
  const lanes::Arrivals arrivals = lanes::meet_entrance(moved_.rays(), moved_.size(), meeting(kTopOrNothing, true),
                                                        entrance, chosen_.rays(), tally_->returned);
  tally_->segments += arrivals.count;
  tally_->other[Account::absorbed] += arrivals.absorbed;
  chosen_.resize(arrivals.reflected);
  if (!chosen_.empty()) fall();
}

}  // namespace retrace::raytrace
