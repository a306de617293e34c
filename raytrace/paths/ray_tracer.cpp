#include "raytrace/paths/ray_tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/memory_budget.h"
#include "core/threads.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/paths/path_tracer.h"
#include "raytrace/sampling/entrance_sampler.h"
#include "raytrace/sampling/flush_denormals.h"
#include "raytrace/sampling/replicate_means.h"

namespace retrace::raytrace {
namespace {

// Number of the Philox random stream for the random choices along a path.
constexpr std::uint32_t kRayChoiceStream = 17;
// Number of rays per task. It is small enough for load balancing and large enough to make the overhead negligible.
constexpr std::size_t kRaysTogether = 1024;
// Maximum standard deviation of a random number between 0 and 1. It is the standard deviation of a number that is 0 or
// 1 with equal probability.
constexpr double kMaxErrorOfFraction = 0.5;

}  // namespace

void RayLedger::add(const RayLedger& more) {
  incident += more.incident;
  for (std::size_t k = 0; k < kAccountCount; ++k) {
    ledger.power[k] += more.ledger.power[k];
    leaving[k] += more.leaving[k];
  }
  missed += more.missed;
  rays += more.rays;
  rays_missed += more.rays_missed;
  squares += more.squares;
  squares_back += more.squares_back;
  squares_back2 += more.squares_back2;
}

double RayLedger::std_error() const {
  if (!(incident > 0.0)) return 0.0;
  const double share = ledger[Account::retroreflected] / incident;
  const double spread =
      std::sqrt(std::max(0.0, squares_back2 - 2.0 * share * squares_back + share * share * squares)) / incident;
  return std::min(kMaxErrorOfFraction, with_unsampled_paths(spread, incident * incident / squares));
}

struct RayTracer::Scene {
  Scene(const geometry::Part& p, const geometry::Entrance* curved, double cone, const PathPolicy& how,
        std::uint32_t number)
      : part(p),
        centre_mm(EntranceSampler(p).centre_mm()),
        surface(p, centre_mm),
        cone_deg(cone),
        policy(how),
        seed(number) {
    if (curved != nullptr) entrance_face = make_entrance_face(*curved, p, centre_mm);
  }

  const geometry::Part& part;
  Vec2 centre_mm;
  BackSurface surface;
  std::unique_ptr<const EntranceFace> entrance_face;
  double cone_deg;
  PathPolicy policy;
  std::uint32_t seed;
  std::deque<PathSetup> setups;  ///< indexed by wavelength
};

/// Traces rays one by one and stores the rays that leave the part.
class RayTracer::Walk : public ExitObserver {
 public:
  /// \param memory counter of the memory for the leaving rays of all tasks
  Walk(const Scene& scene, TracedRays& traced, BeamMemory& memory)
      : scene_(scene), from_centre_(scene.centre_mm.x(), scene.centre_mm.y(), 0.0), traced_(traced), memory_(memory) {}

  void trace(const IncidentRay& ray, std::uint64_t number, std::uint32_t incident) {
    const double power = ray.light.power();
    incident_ = incident;
    power_ = power;
    traced_.ledger.incident += power;
    ++traced_.ledger.rays;
    traced_.ledger.squares += power * power;
    if (!(power > 0.0)) return;
    Ray start{ray.direction, ray.light, false, false};
    start.light.scale(1.0 / power);
    tally_.clear();
    PathWalker& walker = walker_at(ray.optics);
    if (!walker.launch(ray.position_mm - from_centre_, start, {scene_.seed, kRayChoiceStream},
                       static_cast<std::uint32_t>(number >> 32), static_cast<std::uint32_t>(number)))
      return miss();
    book();
  }

  void on_exit(const ExitEvent& departure) override {
    if (traced_.leaving.size() % kRaysTogether == 0) add_memory();
    LeavingRay& ray = traced_.leaving.emplace_back();
    ray.incident = incident_;
    ray.account = departure.account;
    ray.position_mm = departure.position + from_centre_;
    ray.position_mm.head<2>() += departure.shift_mm;
    ray.direction = departure.direction;
    ray.light = departure.light;
    ray.light.scale(power_);
    ++traced_.ledger.leaving[static_cast<std::size_t>(departure.account)];
  }

 private:
  /// Counts the memory of the next kRaysTogether leaving rays.
  /// \throw TraceBudgetError if the memory budget is exceeded
  void add_memory() {
    memory_.add(kRaysTogether * sizeof(LeavingRay));
    if (memory_.is_exceeded())
      throw TraceBudgetError(fmt::format("the rays that leave the part exceed {}: use a larger {} or {}",
                                         memory_budget_text(), reference({"cutoff"}), reference({"split"})));
  }

  PathWalker& walker_at(std::uint32_t optics) {
    if (walkers_.size() <= optics) walkers_.resize(optics + 1);
    if (!walkers_[optics]) walkers_[optics] = std::make_unique<PathWalker>(scene_.setups[optics], tally_, this);
    return *walkers_[optics];
  }

  void miss() {
    traced_.missed.push_back(incident_);
    traced_.ledger.missed += power_;
    ++traced_.ledger.rays_missed;
  }

  void book() {
    const Ledger shares = tally_.ledger(0);
    for (std::size_t k = 0; k < kAccountCount; ++k) traced_.ledger.ledger.power[k] += power_ * shares.power[k];
    const double back = shares[Account::retroreflected];
    traced_.ledger.squares_back += power_ * power_ * back;
    traced_.ledger.squares_back2 += power_ * power_ * back * back;
  }

  const Scene& scene_;
  Vec3 from_centre_;
  Tally tally_{1};
  std::vector<std::unique_ptr<PathWalker>> walkers_;  ///< indexed by wavelength
  TracedRays& traced_;
  BeamMemory& memory_;
  std::uint32_t incident_ = 0;
  double power_ = 0.0;
};

RayTracer::RayTracer(const geometry::Part& part, const geometry::Entrance* entrance_face, double cone_deg,
                     const PathPolicy& policy, std::uint32_t seed)
    : scene_(std::make_unique<Scene>(part, entrance_face, cone_deg, policy, seed)) {}
RayTracer::~RayTracer() = default;

std::uint32_t RayTracer::add(const Optics& optics) {
  Scene& s = *scene_;
  // The direction of incidence has no effect, because each ray has its own direction.
  s.setups.emplace_back(s.part, s.surface, s.centre_mm, optics, Illumination{}, std::vector<double>{s.cone_deg},
                        s.policy, s.entrance_face.get());
  return static_cast<std::uint32_t>(s.setups.size() - 1);
}

TracedRays RayTracer::trace(std::span<const IncidentRay> rays, std::uint64_t first, const Cancellation* cancel) const {
  const std::size_t tasks = (rays.size() + kRaysTogether - 1) / kRaysTogether;
  std::vector<TracedRays> done(tasks);
  BeamMemory memory;
  for_each_in_parallel(tasks, [&](std::size_t task) {
    if (is_cancelled(cancel)) return;
    const FlushDenormals flush;
    const std::size_t end = std::min(rays.size(), (task + 1) * kRaysTogether);
    done[task].leaving.reserve(end - task * kRaysTogether);
    Walk walk(*scene_, done[task], memory);
    for (std::size_t k = task * kRaysTogether; k < end && !is_cancelled(cancel); ++k)
      walk.trace(rays[k], first + k, static_cast<std::uint32_t>(k));
  });
  if (tasks == 0) return {};
  TracedRays all = std::move(done.front());
  std::size_t leaving = 0;
  for (const TracedRays& some : done) leaving += some.leaving.size();
  all.leaving.reserve(leaving + all.leaving.size());
  for (const TracedRays& some : std::span(done).subspan(1)) {
    all.leaving.insert(all.leaving.end(), some.leaving.begin(), some.leaving.end());
    all.missed.insert(all.missed.end(), some.missed.begin(), some.missed.end());
    all.ledger.add(some.ledger);
  }
  if (all.ledger.ledger[Account::lost] > kLostLimit * all.ledger.incident)
    throw BudgetError(
        fmt::format("a ray of number {} to {} missed every face from inside the part: this is a defect of retrace, "
                    "please report the design and the rays",
                    first + 1, first + rays.size()));
  return all;
}

}  // namespace retrace::raytrace
