// Compares the RRE (retroreflective efficiency) of the exact engine with that of the Monte Carlo engine, for random
// designs that are each lit from one direction.
//   retrace_error_coverage_benchmark [DESIGNS [FIRST_SEED [TARGET_ERROR]]]
// The exact engine truncates a small power, which may be retroreflected or not. The expected RRE is therefore the RRE
// of the exact engine plus half of the truncated power.
// The two engines agree if the Monte Carlo RRE differs from the expected RRE by at most 1.96 standard errors plus half
// of the truncated power.
// The program prints one line for each design for which the engines disagree. At the end it prints the percentage of
// designs for which they agree.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

#include "benchmarks/processor_time.h"
#include "benchmarks/random_designs.h"
#include "core/error.h"
#include "design/io/design_reader.h"
#include "studies/rre/rre.h"

namespace retrace::benchmarks {
namespace {

// Ratio of the target error of the exact engine to the target error of Monte Carlo.
constexpr double kTargetErrorRatio = 0.05;
// Maximum time for one run of an engine. A design is skipped if a run takes longer.
constexpr double kMaxTime_s = 5.0;

std::optional<studies::RrePoint> answer(const design::Design& design, studies::RreSettings request,
                                        raytrace::Engine engine) {
  request.engine = engine;
  const Deadline deadline(kMaxTime_s);
  const studies::RreResult found = studies::RreStudy({design}, request).run(nullptr, &deadline.cancellation);
  return found.complete ? std::optional(found.points.front()) : std::nullopt;
}

struct Trial {
  /// Monte Carlo RRE minus the expected RRE, in standard errors of the Monte Carlo RRE.
  double difference = 0.0;
  /// True if the two engines agree. The criterion is described at the top of this file.
  bool agrees = false;
};

/// Runs both engines on the random design that `seed` generates. Returns nothing if the design is invalid or has rough
/// facets. It also returns nothing if an engine exceeds kMaxTime_s or its own limit on time, memory or accuracy.
std::optional<Trial> trial(unsigned seed, double target_error) {
  RandomDesigns random(seed);
  const std::string text = random.next();
  if (text.find("roughness") != std::string::npos) return std::nullopt;
  studies::RreSettings request;
  request.incidence_deg = {random.between(0.0, 40.0)};
  request.azimuth_deg = {random.between(0.0, 90.0)};
  request.seed = seed;
  try {
    const design::Design design = design::parse_design(text, fmt::format("design {}", seed));
    request.target_error = kTargetErrorRatio * target_error;
    const auto exact = answer(design, request, raytrace::Engine::exact);
    if (!exact) return std::nullopt;
    request.target_error = target_error;
    const auto rays = answer(design, request, raytrace::Engine::montecarlo);
    if (!rays) return std::nullopt;
    const double half_truncated = 0.5 * exact->ledger[raytrace::Account::truncated];
    const double difference = rays->rre - exact->rre - half_truncated;
    const Trial result{difference / rays->std_error, std::abs(difference) <= 1.96 * rays->std_error + half_truncated};
    if (!result.agrees)
      fmt::print(
          "seed {:4}: RRE {:.7f} +- {:.2g} by {}, exact RRE {:.7f}, difference from the expected RRE {:.2f} standard "
          "errors\n",
          seed, rays->rre, rays->std_error, rays->engine, exact->rre, result.difference);
    return result;
  } catch (const InputError&) {
    return std::nullopt;
  } catch (const BudgetError&) {
    return std::nullopt;
  }
}

}  // namespace

int run(unsigned designs, unsigned seed, double target_error) {
  unsigned count = 0, agreeing = 0;
  double squares = 0.0;
  for (; count < designs; ++seed) {
    const std::optional<Trial> one = trial(seed, target_error);
    if (!one) continue;
    ++count;
    if (one->agrees) ++agreeing;
    squares += one->difference * one->difference;
  }
  fmt::print(
      "{} designs, target error {}: {:.1f} % agree within 1.96 standard errors plus half of the truncated power; "
      "root mean square difference of the two values: {:.2f} standard errors\n",
      count, target_error, 100.0 * agreeing / count, std::sqrt(squares / count));
  return 0;
}

}  // namespace retrace::benchmarks

int main(int count, char** values) {
  const auto number = [&](int k, double otherwise) { return k < count ? std::atof(values[k]) : otherwise; };
  return retrace::benchmarks::run(static_cast<unsigned>(number(1, 200)), static_cast<unsigned>(number(2, 1)),
                                  number(3, 1e-4));
}
