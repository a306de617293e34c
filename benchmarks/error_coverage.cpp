// Compares the RRE of the exact engine with the RRE of Monte Carlo. Random designs are each lit from one direction.
//   retrace_error_coverage_benchmark [DESIGNS [FIRST_SEED [TARGET_ERROR]]]
// The program prints one line for each design whose two values differ by more than 1.96 standard errors and half of the
// truncated power. At the end it prints the percentage of designs whose values differ by less.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

#include "benchmarks/processor_time.h"
#include "benchmarks/random_designs.h"
#include "core/error.h"
#include "studies/design/io/design_reader.h"
#include "studies/rre/rre.h"

namespace retrace::benchmarks {
namespace {

// Ratio of the target error of the exact engine to the target error of Monte Carlo.
constexpr double kExactness = 0.05;
// Maximum time for one run of an engine. Designs that need more time are skipped.
constexpr double kPatience_s = 5.0;

std::optional<studies::RrePoint> answer(const studies::Design& design, studies::RreRequest request,
                                        studies::Engine engine) {
  request.engine = engine;
  const Deadline deadline(kPatience_s);
  const studies::RreResult found = studies::RreStudy({design}, request).run(nullptr, &deadline.cancellation);
  return found.complete ? std::optional(found.points.front()) : std::nullopt;
}

struct Trial {
  /// RRE of Monte Carlo minus the RRE expected from the exact engine, in standard errors of Monte Carlo. The expected
  /// RRE is the RRE of the exact engine plus half of its truncated power.
  double off = 0.0;
  /// True if the difference is at most 1.96 standard errors plus half of the truncated power.
  bool within = false;
};

/// Runs both engines on the random design that `seed` generates. Returns nothing if the design is invalid or has rough
/// facets. Returns nothing if an engine exceeds kPatience_s or its budget.
std::optional<Trial> trial(unsigned seed, double target_error) {
  RandomDesigns random(seed);
  const std::string text = random.next();
  if (text.find("roughness") != std::string::npos) return std::nullopt;
  studies::RreRequest request;
  request.incidence_deg = {random.between(0.0, 40.0)};
  request.azimuth_deg = {random.between(0.0, 90.0)};
  request.seed = seed;
  try {
    const studies::Design design = studies::parse_design(text, fmt::format("design {}", seed));
    request.target_error = kExactness * target_error;
    const auto exact = answer(design, request, studies::Engine::exact);
    if (!exact) return std::nullopt;
    request.target_error = target_error;
    const auto rays = answer(design, request, studies::Engine::montecarlo);
    if (!rays) return std::nullopt;
    const double left = 0.5 * exact->ledger[raytrace::Account::truncated];
    const double off = rays->rre - exact->rre - left;
    const Trial result{off / rays->std_error, std::abs(off) <= 1.96 * rays->std_error + left};
    if (!result.within)
      fmt::print("seed {:4}: RRE {:.7f} +- {:.2g} by {}, exact RRE {:.7f}, difference {:.2f} standard errors\n", seed,
                 rays->rre, rays->std_error, rays->engine, exact->rre, result.off);
    return result;
  } catch (const InputError&) {
    return std::nullopt;
  } catch (const BudgetError&) {
    return std::nullopt;
  }
}

}  // namespace

int run(unsigned designs, unsigned seed, double target_error) {
  unsigned count = 0, within = 0;
  double squares = 0.0;
  for (; count < designs; ++seed) {
    const std::optional<Trial> one = trial(seed, target_error);
    if (!one) continue;
    ++count;
    if (one->within) ++within;
    squares += one->off * one->off;
  }
  fmt::print(
      "{} designs, target error {}: {:.1f} % differ by at most 1.96 standard errors and half of the truncated power; "
      "root mean square difference "
      "{:.2f} standard errors\n",
      count, target_error, 100.0 * within / count, std::sqrt(squares / count));
  return 0;
}

}  // namespace retrace::benchmarks

int main(int count, char** values) {
  const auto number = [&](int k, double otherwise) { return k < count ? std::atof(values[k]) : otherwise; };
  return retrace::benchmarks::run(static_cast<unsigned>(number(1, 200)), static_cast<unsigned>(number(2, 1)),
                                  number(3, 1e-4));
}
