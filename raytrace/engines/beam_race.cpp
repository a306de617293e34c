#include "raytrace/engines/beam_race.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "raytrace/exact/element_memory.h"

namespace retrace::raytrace {
namespace {

// Time in ns per unit of work when beams are traced exactly, as measured by benchmarks/engine_choice.cpp.
constexpr double kNsPerLook = 30.0;
/// Time in ns per unit of work when stochastic beams (resampled beams) are traced. These beams are fewer and wider than
/// exact beams.
constexpr double kNsPerStochasticLook = 15.0;
/// Expected work of stochastic beams before their first round. After a round, StochasticBeams predicts the total work.
/// The work is greater for prisms. Light that enters a prism obliquely travels far, and only a small fraction of it
/// returns.
constexpr double kLooksForCubes = 300'000.0;
constexpr double kLooksForPrisms = 1'000'000.0;
/// Number of facets per cell above which the first round needs more work. Above this number, its work is proportional
/// to the number of facets to the power of kGrowthWithFacets. The total work of cells with rounded edges varies more:
/// it is up to 30 times smaller or 3 times greater than that of rays. Only the first round shows which case applies.
constexpr double kFewFacets = 4.0;
constexpr double kGrowthWithFacets = 1.5;
/// Minimum time of exact beams, as a fraction of the predicted time of stochastic beams or rays. Exact beams are
/// granted this time even if their own predicted time is longer, because that prediction may be poor.
constexpr double kHedge = 0.2;
/// Work after which the methods are compared for the first time. This work takes about one millisecond.
constexpr double kFirstLook = 30'000.0;
constexpr double kNever = std::numeric_limits<double>::infinity();

double looks_of_stochastic(const geometry::Part& part) {
  const double looks =
      std::holds_alternative<geometry::RtpElement>(part.spec.element) ? kLooksForPrisms : kLooksForCubes;
  return looks * std::max(1.0, std::pow(facets_of_cell(part) / kFewFacets, kGrowthWithFacets));
}

}  // namespace

double facets_of_cell(const geometry::Part& part) {
  const geometry::SurfacePatch& patch = part.patches.front();
  return static_cast<double>(patch.facets.size()) / static_cast<double>(patch.cells.size());
}

double beam_tracer_ns(const geometry::Part& part) {
  const ElementCost cost = element_cost(part);
  return cost.fits_memory() ? kNsPerLook * cost.work : kNever;
}

BeamRace::BeamRace(const BeamTracer& tracer, const ScatteredLight* scattered, const Optics& optics,
                   const Illumination& illumination, const std::vector<double>& cones_deg, const BeamPolicy& policy,
                   const Sampling& sampling, Options options, const Cancellation* cancel)
    : cancel_(cancel), initial_work_(looks_of_stochastic(tracer.part())), may_resample_(options.may_resample) {
  if (optics.is_smooth()) beams_.emplace(tracer, optics, illumination, cones_deg, policy);
  make_stochastic_ = [&tracer, scattered, optics, illumination, cones_deg, sampling, cancel,
                      observer = std::move(options.observer)] {
    return std::make_unique<StochasticBeams>(tracer, scattered, optics, illumination, cones_deg, sampling, cancel,
                                             observer);
  };
}

double BeamRace::beams_ns() const {
  return beams_ ? kNsPerLook * std::min(beams_->expected_work(), beams_->work() / kHedge) : kNever;
}

double BeamRace::stochastic_ns() const {
  if (!may_resample_) return kNever;
  return kNsPerStochasticLook * (stochastic_ ? stochastic_->expected_work() : initial_work_);
}

double BeamRace::expected_ns() const {
  return std::min(beams_ns(), stochastic_ns());
}

double BeamRace::fraction_done() const {
  if (beams_ && beams_ns() <= stochastic_ns()) return beams_->work() / beams_->expected_work();
  return stochastic_ ? stochastic_->work() / stochastic_->expected_work() : 0.0;
}

bool BeamRace::advance() {
  if (beams_ && beams_ns() <= stochastic_ns()) return advance_exact();
  if (may_resample_) return advance_stochastic();
  throw BudgetError("tracing beams does not reach the target error within the memory and beam budgets: use " +
                    reference({"engine"}) + " montecarlo");
}

bool BeamRace::advance_exact() try {
  const double look = std::max(kFirstLook, 1.1 * beams_->work());
  return is_exact_ = beams_->advance(static_cast<std::uint64_t>(look), cancel_);
} catch (const BudgetError&) {
  if (!may_resample_) throw;
  beams_.reset();
  return false;
}

bool BeamRace::advance_stochastic() try {
  if (!stochastic_) stochastic_ = make_stochastic_();
  may_resample_ = !stochastic_->advance();
  return stochastic_->result().reached_target;
} catch (const BudgetError&) {
  if (!beams_) throw;
  may_resample_ = false;
  stochastic_.reset();
  return false;
}

}  // namespace retrace::raytrace
