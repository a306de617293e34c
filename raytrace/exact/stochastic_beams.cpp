#include "raytrace/exact/stochastic_beams.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/random.h"
#include "raytrace/exact/beam_walk.h"
#include "raytrace/sampling/replicates.h"
#include "raytrace/sampling/threads.h"

namespace retrace::raytrace {
namespace {

/// Philox stream of the offsets of systematic resampling.
constexpr std::uint32_t kResamplingStream = 7;
constexpr double kFirstThreshold = 1e-3;
constexpr double kLastThreshold = 1e-10;
// The standard error falls about as the threshold to this power, and the work of a round rises as that to the other.
constexpr double kConvergence = 0.9;
constexpr double kWorkSlope = 0.5;
// How far the threshold falls at once, and how much further than the error asks for, as that is known to some 20 %
// only.
constexpr double kSteepestFall = 0.003;
constexpr double kGentlestFall = 0.5;
constexpr double kMargin = 0.8;
// Beams that wait for replicates: some 100 MB.
constexpr std::size_t kMostKept = 200'000;
// Directions whose components differ by less are sorted as one.
constexpr double kOneDirection = 1e-7;
// Power that is no longer followed.
constexpr double kLeastPower = 1e-14;
// The 97.5 % point of Student's distribution of kReplicates - 1 degrees of freedom, over that of the normal one.
constexpr double kStudent = 2.1314 / 1.9600;
static_assert(StochasticBeams::kReplicates == 16, "kStudent is that of 16 replicates");

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

  bool operator<(const SortKey& other) const { return std::tie(state, beam) < std::tie(other.state, other.beam); }
};

/// Over the size of a period or outline.
Vec2 scale_of(const geometry::Part& part) {
  if (part.period_mm) return part.period_mm->cwiseInverse();
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  return (box.upper - box.lower).cwiseInverse();
}

SortKey key_of(const Beam& beam, std::size_t number, const Vec2& scale) {
  const auto rounded = [](double x) { return static_cast<std::int64_t>(std::llround(x / kOneDirection)); };
  const auto place = [](double x) { return static_cast<std::uint32_t>((x - std::floor(x)) * 65535.0); };
  Vec2 at = Vec2::Zero();
  for (const Vec3& p : beam.corners) at += p.head<2>();
  at = (at / static_cast<double>(beam.corners.size())).cwiseProduct(scale);
  return {{beam.inside, rounded(beam.direction.x()), rounded(beam.direction.y()), rounded(beam.direction.z()),
           interleaved(place(at.x()), place(at.y()))},
          number};
}

}  // namespace

/// A generation of beams, in the order in which survivors are chosen.
struct StochasticBeams::Queue {
  struct Place {
    std::size_t beam;
    double power;
  };
  const std::vector<Beam>& beams;
  std::vector<Place> places;
  double power = 0.0;

  /// Each stands for `most_power` or less, and all together for what the generation has.
  /// \param offset in [0, 1): where the first of equally spaced marks falls
  std::vector<Beam> survivors(double most_power, double offset) const {
    std::vector<Beam> chosen;
    if (power <= kLeastPower) return chosen;
    const double count = std::ceil(power / most_power);
    const double each = power / count;
    chosen.reserve(static_cast<std::size_t>(std::min(count, static_cast<double>(places.size()))));
    double passed = 0.0;
    double taken = 0.0;
    for (const Place& place : places) {
      passed += place.power / each;
      const double until = &place == &places.back() ? count : std::floor(passed + offset);
      if (until <= taken) continue;
      chosen.push_back(beams[place.beam]);
      chosen.back().share *= (until - taken) * each / place.power;
      chosen.back().power = (until - taken) * each;
      taken = until;
    }
    return chosen;
  }
};

struct StochasticBeams::Replicate {
  Tally tally;
  std::uint64_t work = 0;
  std::uint64_t beams = 0;
};

StochasticBeams::StochasticBeams(const BeamTracer& tracer, const Optics& optics, const Illumination& illumination,
                                 const std::vector<double>& cones_deg, const Sampling& sampling,
                                 const Cancellation* cancel)
    : tracer_(tracer),
      setup_(tracer.part_, tracer.centre_mm_, optics, illumination, cones_deg),
      cones_deg_(cones_deg),
      sampling_(sampling),
      cancel_(cancel),
      strong_(
          std::make_unique<BeamWalk>(tracer.part_, tracer.centre_mm_, tracer.cells_, setup_, policy_, BeamObserver{})),
      threshold_(kFirstThreshold) {
  strong_->enter(entrance_outline(tracer.part_), threshold_, BeamWalk::Approach::kept);
}

StochasticBeams::~StochasticBeams() = default;

bool StochasticBeams::advance() {
  if (round_ > 0) {
    threshold_ = next_threshold();
    strong_->lower_cutoff_to(threshold_);
  }
  const std::uint64_t before = strong_->work();
  result_.complete = strong_->run(std::numeric_limits<std::uint64_t>::max(), cancel_) == BeamWalk::End::done;
  if (!result_.complete) return true;
  const Queue first = queue_of(strong_->kept());
  std::vector<std::optional<Replicate>> replicates(kReplicates);
  for_each_in_parallel(kReplicates, [&](std::size_t k) {
    replicates[k] = replicate(static_cast<std::uint32_t>(k), first);
    return replicates[k].has_value();
  });
  std::vector<Tally> tallies;
  round_work_ = strong_->work() - before;
  for (const auto& one : replicates) {
    result_.complete = result_.complete && one.has_value();
    if (!result_.complete) return true;
    tallies.push_back(strong_->tally());
    tallies.back().add(one->tally);
    round_work_ += one->work;
    weak_beams_ += one->beams;
  }
  work_ += round_work_;
  result_ = result_of(tallies, 1, cones_deg_);
  result_.rays = 0;
  const double unseen = std::min(kThinning * threshold_, first.power) / kReplicates;
  for (ConeResult& cone : result_.cones)
    if (first.power > kLeastPower) cone.std_error = std::max(kStudent * cone.std_error, unseen);
  result_.reached_target = largest_error() <= sampling_.target_error;
  ++round_;
  return result_.reached_target || threshold_ <= kLastThreshold || first.places.size() > kMostKept;
}

std::uint64_t StochasticBeams::beams() const {
  return strong_->beams() + weak_beams_;
}

double StochasticBeams::largest_error() const {
  double largest = 0.0;
  for (const ConeResult& cone : result_.cones) largest = std::max(largest, cone.std_error);
  return largest;
}

double StochasticBeams::next_threshold() const {
  const double fall = kMargin * std::pow(sampling_.target_error / largest_error(), 1.0 / kConvergence);
  return std::max(kLastThreshold, threshold_ * std::clamp(fall, kSteepestFall, kGentlestFall));
}

double StochasticBeams::expected_work() const {
  if (result_.reached_target) return work();
  return work() + static_cast<double>(round_work_) * std::pow(threshold_ / next_threshold(), kWorkSlope);
}

StochasticBeams::Queue StochasticBeams::queue_of(const std::vector<Beam>& beams) const {
  const Vec2 scale = scale_of(tracer_.part_);
  std::vector<SortKey> keys;
  keys.reserve(beams.size());
  for (std::size_t k = 0; k < beams.size(); ++k) keys.push_back(key_of(beams[k], k, scale));
  std::sort(keys.begin(), keys.end());
  Queue queue{beams, {}, 0.0};
  queue.places.reserve(beams.size());
  for (const SortKey& key : keys) {
    queue.places.push_back({key.beam, beams[key.beam].power});
    queue.power += beams[key.beam].power;
  }
  return queue;
}

/// Nothing if it was cancelled.
std::optional<StochasticBeams::Replicate> StochasticBeams::replicate(std::uint32_t number, const Queue& first) const {
  BeamWalk walk(tracer_.part_, tracer_.centre_mm_, tracer_.cells_, setup_, policy_, BeamObserver{});
  const auto offset = [&](std::uint32_t generation) {
    return unit_interval(philox({sampling_.seed, kResamplingStream}, number, generation, round_)[0]);
  };
  const double most_power = kThinning * threshold_;
  std::vector<Beam> survivors = first.survivors(most_power, offset(0));
  double left = first.power;
  for (std::uint32_t generation = 1; !survivors.empty(); ++generation) {
    std::vector<Beam> next;
    for (const Beam& beam : survivors) {
      if (is_cancelled(cancel_)) return std::nullopt;
      walk.step(beam, cancel_, next);
    }
    const Queue queue = queue_of(next);
    left = queue.power;
    survivors = queue.survivors(most_power, offset(generation));
  }
  walk.book_truncated(left);
  return Replicate{walk.tally(), walk.work(), walk.beams()};
}

}  // namespace retrace::raytrace
