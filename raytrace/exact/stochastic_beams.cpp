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
constexpr std::uint32_t kScatterStream = 8;  // and of rays of scattered light
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
// What the first and the last rays of scattered light stand for.
constexpr double kFirstRayPower = 1e-3;
constexpr double kLastRayPower = 1e-10;
// Of the target error, that of beams and that of rays where there are both.
constexpr double kShareOfTarget = 0.7;
// What a straight piece of a ray takes, in looks.
constexpr std::uint64_t kLooksPerSegment = 25;
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
  Tally beams;
  Tally rays;  ///< scattered by beams
  std::uint64_t beam_work = 0;
  std::uint64_t beam_count = 0;
};

bool StochasticBeams::serves(const Optics& optics) {
  if (!optics.facet_form.is_plane() || !optics.has_one_back() || optics.entrance.scatters()) return false;
  const auto* rough = std::get_if<surface_models::HarveyShack>(&optics.facet_scatter);
  return optics.is_smooth() || (rough != nullptr && rough->roughness().waviness_sq_nm == 0.0);
}

StochasticBeams::StochasticBeams(const BeamTracer& tracer, const BackSurface* surface, const Optics& optics,
                                 const Illumination& illumination, const std::vector<double>& cones_deg,
                                 const Sampling& sampling, const Cancellation* cancel)
    : tracer_(tracer),
      setup_(tracer.part_, tracer.centre_mm_, optics, illumination, cones_deg),
      cones_deg_(cones_deg),
      sampling_(sampling),
      cancel_(cancel),
      strong_(
          std::make_unique<BeamWalk>(tracer.part_, tracer.centre_mm_, tracer.cells_, setup_, policy_, BeamObserver{})),
      threshold_(kFirstThreshold),
      ray_power_(kFirstRayPower) {
  if (surface != nullptr) {
    paths_.emplace(tracer.part_, *surface, tracer.centre_mm_, optics, illumination, cones_deg, PathPolicy{});
    strong_->collect(strong_sites_);
  }
  strong_->enter(entrance_outline(tracer.part_), threshold_, BeamWalk::Approach::kept);
}

StochasticBeams::~StochasticBeams() = default;

bool StochasticBeams::advance() {
  if (round_ > 0) {
    ray_power_ = next_ray_power();
    threshold_ = next_threshold();
    strong_->lower_cutoff_to(threshold_);
  }
  const std::uint64_t before = strong_->work();
  result_.complete = strong_->run(std::numeric_limits<std::uint64_t>::max(), cancel_) == BeamWalk::End::done;
  if (!result_.complete) return true;
  const Queue first = queue_of(strong_->kept());
  first_survivors_ = std::max(1.0, std::ceil(first.power / (kThinning * threshold_)));
  std::vector<std::optional<Replicate>> replicates(kReplicates);
  for_each_in_parallel(kReplicates, [&](std::size_t k) {
    replicates[k] = replicate(static_cast<std::uint32_t>(k), first);
    return replicates[k].has_value();
  });
  std::vector<Tally> beams;
  std::vector<Tally> rays;
  std::vector<Tally> both;
  beam_work_ = strong_->work() - before;
  ray_work_ = 0;
  for (const auto& one : replicates) {
    result_.complete = result_.complete && one.has_value();
    if (!result_.complete) return true;
    beams.push_back(one->beams);
    rays.push_back(one->rays);
    both.push_back(strong_->tally());
    both.back().add(one->beams);
    both.back().add(one->rays);
    beam_work_ += one->beam_work;
    ray_work_ += kLooksPerSegment * one->rays.segments;
    weak_beams_ += one->beam_count;
  }
  work_ += beam_work_ + ray_work_;
  result_ = result_of(both, 1, cones_deg_);
  result_.rays = 0;
  const double unseen = first.power > kLeastPower ? std::min(kThinning * threshold_, first.power) / kReplicates : 0.0;
  beam_error_ = std::max(unseen, kStudent * largest_error(result_of(beams, 1, cones_deg_)));
  ray_error_ = kStudent * largest_error(result_of(rays, 1, cones_deg_));
  for (ConeResult& cone : result_.cones) cone.std_error = std::max(kStudent * cone.std_error, unseen);
  result_.reached_target = largest_error(result_) <= sampling_.target_error;
  ++round_;
  return result_.reached_target || threshold_ <= kLastThreshold || ray_power_ <= kLastRayPower ||
         first.places.size() > kMostKept;
}

std::uint64_t StochasticBeams::beams() const {
  return strong_->beams() + weak_beams_;
}

double StochasticBeams::next_threshold() const {
  const double target = (paths_ ? kShareOfTarget : 1.0) * sampling_.target_error;
  if (paths_ && beam_error_ <= target) return threshold_;
  const double fall = kMargin * std::pow(target / beam_error_, 1.0 / kConvergence);
  return std::max(kLastThreshold, threshold_ * std::clamp(fall, kSteepestFall, kGentlestFall));
}

double StochasticBeams::next_ray_power() const {
  const double target = kShareOfTarget * sampling_.target_error;
  if (ray_error_ <= target) return ray_power_;
  return std::max(kLastRayPower, ray_power_ * std::min(kGentlestFall, kMargin * std::pow(target / ray_error_, 2.0)));
}

double StochasticBeams::expected_work() const {
  if (result_.reached_target) return work();
  const double next = next_threshold();
  // Of beams that are weaker than the next threshold as well, as all are of an array of many elements, there are as
  // many more survivors as that is lower.
  double still_weak = 0.0;
  for (const Beam& beam : strong_->kept())
    if (beam.power < next) still_weak += beam.power;
  const double more =
      std::max(std::pow(threshold_ / next, kWorkSlope), still_weak / (kThinning * next) / first_survivors_);
  if (more * static_cast<double>(strong_->kept().size()) > static_cast<double>(kMostKept))
    return std::numeric_limits<double>::infinity();
  return work() + static_cast<double>(beam_work_) * more +
         static_cast<double>(ray_work_) * ray_power_ / next_ray_power();
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
  std::vector<ScatterSite> sites;
  std::optional<ScatteredRays> rays;
  if (paths_) {
    rays.emplace(*paths_, RandomKey{sampling_.seed, kScatterStream}, number, round_, cancel_);
    walk.collect(sites);
    rays->launch(strong_sites_, ray_power_);
  }
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
    if (rays) rays->launch(sites, ray_power_);
    sites.clear();
    const Queue queue = queue_of(next);
    left = queue.power;
    survivors = queue.survivors(most_power, offset(generation));
  }
  if (is_cancelled(cancel_)) return std::nullopt;
  walk.book_truncated(left);
  return Replicate{walk.tally(), rays ? rays->tally() : Tally(setup_.cone_chord2.size()), walk.work(), walk.beams()};
}

}  // namespace retrace::raytrace
