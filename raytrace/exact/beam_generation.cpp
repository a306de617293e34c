#include "raytrace/exact/beam_generation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "core/random.h"
#include "raytrace/exact/beam_walk.h"

namespace retrace::raytrace {
namespace {

/// Philox stream of the offsets of systematic resampling.
constexpr std::uint32_t kResamplingStream = 7;
// Directions whose components differ by less are sorted as one.
constexpr double kOneDirection = 1e-7;
// Power that is no longer followed.
constexpr double kLeastPower = 1e-14;

/// Bits of a and b in turn: neighbours in the plane are mostly neighbours in this order.
std::uint64_t interleaved(std::uint32_t a, std::uint32_t b) {
  const auto spread = [](std::uint64_t x) {
    x = (x | (x << 16)) & 0x0000ffff0000ffffU;
    x = (x | (x << 8)) & 0x00ff00ff00ff00ffU;
    x = (x | (x << 4)) & 0x0f0f0f0f0f0f0f0fU;
    x = (x | (x << 2)) & 0x3333333333333333U;
    return (x | (x << 1)) & 0x5555555555555555U;
  };
  return spread(a) | (spread(b) << 1);
}

/// What beams are sorted by: where they go, then where in the period or outline they start.
struct SortKey {
  std::tuple<bool, std::int64_t, std::int64_t, std::int64_t, std::uint64_t> state;
  std::size_t beam = 0;
  std::size_t place = 0;  ///< of Beam::places

  bool operator<(const SortKey& other) const {
    return std::tie(state, beam, place) < std::tie(other.state, other.beam, other.place);
  }
};

/// Over the size of a period or outline.
Vec2 scale_of(const geometry::Part& part) {
  if (part.period_mm) return part.period_mm->cwiseInverse();
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  return (box.upper - box.lower).cwiseInverse();
}

/// Where it starts, in the mean.
Vec2 middle_of(const Beam& beam) {
  Vec2 at = Vec2::Zero();
  for (const Vec3& p : beam.corners) at += p.head<2>();
  return at / static_cast<double>(beam.corners.size());
}

/// \param at where it starts
SortKey key_of(const Beam& beam, std::size_t number, std::size_t place, const Vec2& at, const Vec2& scale) {
  const auto rounded = [](double x) { return static_cast<std::int64_t>(std::llround(x / kOneDirection)); };
  const auto share = [](double x) { return static_cast<std::uint32_t>((x - std::floor(x)) * 65535.0); };
  return {{beam.inside, rounded(beam.direction.x()), rounded(beam.direction.y()), rounded(beam.direction.z()),
           interleaved(share(at.x() * scale.x()), share(at.y() * scale.y()))},
          number,
          place};
}

}  // namespace

BeamGeneration::BeamGeneration(const geometry::Part& part, const WaitingBeams& beams) : beams_(beams) {
  const Vec2 scale = scale_of(part);
  std::vector<SortKey> keys;
  keys.reserve(beams.size());
  const bool is_endless = part.period_mm.has_value();
  for (std::size_t k = 0; k < beams.size(); ++k) {
    const Vec2 at = middle_of(beams[k]);
    const std::size_t count = beams[k].places && !is_endless ? beams[k].places->size() : 1;
    for (std::size_t place = 0; place < count; ++place)
      keys.push_back(key_of(beams[k], k, place, place == 0 ? at : Vec2(at + (*beams[k].places)[place]), scale));
  }
  std::sort(keys.begin(), keys.end());
  places_.reserve(keys.size());
  for (const SortKey& key : keys) {
    const Beam& beam = beams[key.beam];
    places_.push_back({key.beam, key.place, is_endless ? beam.total_power() : beam.power});
    power_ += places_.back().power;
  }
}

bool BeamGeneration::counts() const {
  return power_ > kLeastPower;
}

double BeamGeneration::survivor_count(double most_power) const {
  return std::ceil(power_ / most_power);
}

std::size_t BeamGeneration::for_each_survivor(double most_power, double offset, const BeamWalk& walk,
                                              const std::function<void(const Beam&)>& follow) const {
  if (!counts()) return 0;
  std::size_t survivors = 0;
  const double count = survivor_count(most_power);
  const double each = power_ / count;
  double passed = 0.0;
  double taken = 0.0;
  for (const Place& place : places_) {
    passed += place.power / each;
    const double until = &place == &places_.back() ? count : std::floor(passed + offset);
    if (until <= taken) continue;
    const Beam& beam = beams_[place.beam];
    Beam survivor = walk.at_place(beam, place.place);
    survivor.share *= (until - taken) * each / beam.power;
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
        now.for_each_survivor(how.most_power, how.offset(generation), walk, [&](const Beam& beam) {
          if (!is_cancelled(cancel)) walk.step(beam, cancel);
        });
    if (is_cancelled(cancel)) return false;
    if (survivors == 0) {
      walk.book_truncated(now.power());
      return true;
    }
    if (after_each) after_each();
    walk.take_waiting(beams);
    parts.emplace(part, beams);
  }
}

}  // namespace retrace::raytrace
