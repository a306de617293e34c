#include "raytrace/exact/beam_generation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>

#include "core/random.h"
#include "geometry/centroid.h"
#include "raytrace/exact/beam_walk.h"

namespace retrace::raytrace {
namespace {

/// Philox stream of the offsets of systematic resampling.
constexpr std::uint32_t kResamplingStream = 7;
// Directions whose components differ by less than this value are treated as equal when beams are sorted.
constexpr double kOneDirection = 1e-7;
// Generations with less total power than this value are not traced.
constexpr double kMinPower = 1e-14;

/// Returns the Morton code of a and b, which interleaves their bits. Points close to each other in the plane usually
/// have similar codes.
std::uint64_t morton_code(std::uint32_t a, std::uint32_t b) {
  const auto spread = [](std::uint64_t x) {
    x = (x | (x << 16)) & 0x0000ffff0000ffffU;
    x = (x | (x << 8)) & 0x00ff00ff00ff00ffU;
    x = (x | (x << 4)) & 0x0f0f0f0f0f0f0f0fU;
    x = (x | (x << 2)) & 0x3333333333333333U;
    return (x | (x << 1)) & 0x5555555555555555U;
  };
  return spread(a) | (spread(b) << 1);
}

/// Rounded direction of a beam, and whether the beam is inside the part. It is the first key by which beams are sorted.
using Heading = std::tuple<bool, std::int64_t, std::int64_t, std::int64_t>;

Heading heading_of(const Beam& beam) {
  const auto rounded = [](double x) { return static_cast<std::int64_t>(std::llround(x / kOneDirection)); };
  return {beam.inside, rounded(beam.direction.x()), rounded(beam.direction.y()), rounded(beam.direction.z())};
}

/// Returns a rank for each beam. Beams with equal headings have equal ranks, and the ranks are in the order of
/// headings.
std::vector<std::uint32_t> ranks_of_headings(const WaitingBeams& beams) {
  std::vector<std::pair<Heading, std::size_t>> sorted;
  sorted.reserve(beams.size());
  for (std::size_t k = 0; k < beams.size(); ++k) sorted.emplace_back(heading_of(beams[k]), k);
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint32_t> ranks(beams.size());
  std::uint32_t rank = 0;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    if (k > 0 && sorted[k].first != sorted[k - 1].first) ++rank;
    ranks[sorted[k].second] = rank;
  }
  return ranks;
}

/// Returns the reciprocal size of the period, or of the bounding box of the outline, in 1 / mm.
Vec2 scale_of(const geometry::Part& part) {
  if (part.period_mm) return part.period_mm->cwiseInverse();
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  return (box.upper - box.lower).cwiseInverse();
}

/// Returns the x and y coordinates of the centroid of the polygon at which the beam starts.
Vec2 centroid_of(const Beam& beam) {
  return geometry::centroid(std::span<const Vec3>(beam.corners.data(), beam.corners.size())).head<2>();
}

/// Returns the Morton code of a position.
/// \param scale reciprocal size of the period or outline, in 1 / mm
std::uint64_t number_of_place(const Vec2& at, const Vec2& scale) {
  const auto share = [](double x) { return static_cast<std::uint32_t>((x - std::floor(x)) * 65535.0); };
  return morton_code(share(at.x() * scale.x()), share(at.y() * scale.y()));
}

/// Returns the first position, beginning with `at`, for which `holds` is true. The search is fast if the result is near
/// `at`.
/// \pre `holds` is monotonic: if it is true for a position, it is true for all later positions
template <typename Iterator, typename Predicate>
Iterator first_that(Iterator at, Iterator end, const Predicate& holds) {
  std::ptrdiff_t step = 1;
  for (; end - at > step && !holds(at[step]); step *= 2) at += step;
  const Iterator last = end - at > step ? at + step : end;
  return std::partition_point(at, last, [&](const auto& one) { return !holds(one); });
}

}  // namespace

BeamGeneration::BeamGeneration(const geometry::Part& part, const WaitingBeams& beams)
    : beams_(beams), is_infinite_(part.period_mm.has_value()) {
  const Vec2 scale = scale_of(part);
  const std::vector<std::uint32_t> ranks = ranks_of_headings(beams);
  entries_.reserve(beams.size());
  for (std::size_t k = 0; k < beams.size(); ++k)
    if (beams[k].power > 0.0)
      entries_.push_back({std::uint64_t{ranks[k]} << 32 | number_of_place(centroid_of(beams[k]), scale), k, 0.0});
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return std::tie(a.order, a.beam) < std::tie(b.order, b.beam); });
  for (Entry& entry : entries_) entry.power_up_to = power_ += beams[entry.beam].total_power();
}

bool BeamGeneration::is_significant() const {
  return power_ > kMinPower;
}

double BeamGeneration::survivor_count(double max_power) const {
  return std::ceil(power_ / max_power);
}

std::size_t BeamGeneration::for_each_survivor(double max_power, double offset, const BeamWalk& walk,
                                              const std::function<void(const Beam&)>& follow) const {
  if (!is_significant()) return 0;
  std::size_t survivors = 0;
  const double count = survivor_count(max_power);
  const double each = power_ / count;
  const Entry& last = entries_.back();
  const auto marks_up_to = [&](double power) { return std::min(count, std::floor(power / each + offset)); };
  const auto marks_up_to_end_of = [&](const Entry& entry) {
    return &entry == &last ? count : marks_up_to(entry.power_up_to);
  };
  double taken = 0.0;
  auto at = entries_.begin();
  while (taken < count) {
    at = first_that(at, entries_.end(), [&](const Entry& entry) { return marks_up_to_end_of(entry) > taken; });
    const Beam& beam = beams_[at->beam];
    const double places = is_infinite_ ? 1.0 : beam.instance_count();
    const double power = beam.total_power() / places;
    const double before = at->power_up_to - beam.total_power();
    const double place = std::clamp(std::floor(((taken + 1.0 - offset) * each - before) / power), 0.0, places - 1.0);
    const double until = place < places - 1.0 ? std::max(taken + 1.0, marks_up_to(before + (place + 1.0) * power))
                                              : marks_up_to_end_of(*at);
    Beam survivor = walk.instance(beam, static_cast<std::size_t>(place));
    survivor.area_fraction *= (until - taken) * each / beam.power;
    survivor.power = (until - taken) * each;
    taken = until;
    ++survivors;
    follow(survivor);
  }
  return survivors;
}

double Resampling::offset(std::uint32_t generation) const {
  return unit_interval(philox({seed, kResamplingStream}, replicate, generation, round)[0]);
}

bool follow_survivors(BeamWalk& walk, const geometry::Part& part, const BeamGeneration& first, const Resampling& how,
                      const Cancellation* cancel, const std::function<void()>& after_each) {
  WaitingBeams beams;
  std::optional<BeamGeneration> parts;
  for (std::uint32_t generation = 0;; ++generation) {
    const BeamGeneration& now = parts ? *parts : first;
    const std::size_t survivors =
        now.for_each_survivor(how.max_power, how.offset(generation), walk, [&](const Beam& beam) {
          if (!is_cancelled(cancel)) walk.step(beam, cancel);
        });
    if (is_cancelled(cancel)) return false;
    if (survivors == 0) {
      walk.add_truncated(now.power());
      return true;
    }
    if (after_each) after_each();
    walk.take_waiting().swap(beams);
    parts.emplace(part, beams);
  }
}

}  // namespace retrace::raytrace
