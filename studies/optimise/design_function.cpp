#include "studies/optimise/design_function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "compute/sampling/unit_samples.h"
#include "design/engine_facts.h"
#include "design/optical_model.h"
#include "raytrace/engines/engine.h"
#include "studies/optimise/refine.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/quantity/study_names.h"

namespace retrace::studies {
namespace {

constexpr std::uint64_t kMaxCombinations = 10'000;
/// Maximum number of points that rounder_points() returns.
constexpr std::size_t kMaxRoundPoints = 60;

std::vector<PointValues> combinations_of(const Study& study) {
  std::vector<PointValues> all(1);
  for (const Parameter& parameter : study.parameters) {
    std::vector<PointValues> longer;
    for (const PointValues& begun : all) {
      if (parameter.interval) {
        longer.push_back(begun);
        longer.back().push_back(Parameter::value_of(parameter.interval->at(0.5)));
        continue;
      }
      for (const ParameterValue& value : parameter.values) {
        longer.push_back(begun);
        longer.back().push_back(value);
      }
    }
    if (longer.size() > kMaxCombinations)
      throw InputError(parameter.location,
                       fmt::format("the study has more than {} combinations of discrete values", kMaxCombinations));
    all = std::move(longer);
  }
  return all;
}

}  // namespace

Scan::Scan(const Study& study, const OptimiseRequest& request)
    : study_(study), request_(request), combinations_(combinations_of(study)) {
  for (std::size_t k = 0; k < study.parameters.size(); ++k)
    if (study.parameters[k].interval) continuous_.push_back(k);
}

PointValues Scan::with(PointValues design, const std::vector<double>& fractions) const {
  for (std::size_t k = 0; k < continuous_.size(); ++k) {
    // The value is rounded to 13 digits, so that conversion to a fraction and back does not change a value with few
    // digits.
    const double value = study_.parameters[continuous_[k]].interval->at(fractions[k]);
    design[continuous_[k]] = Parameter::value_of(std::stod(fmt::format("{:.13g}", value)));
  }
  return design;
}

std::vector<double> Scan::fractions_of(const PointValues& design) const {
  std::vector<double> fractions;
  for (const std::size_t k : continuous_)
    fractions.push_back(
        std::clamp(fraction_of(*study_.parameters[k].interval, std::get<double>(design[k].shown)), 0.0, 1.0));
  return fractions;
}

const WholeSizes& Scan::whole_sizes(std::size_t combination, std::size_t k) const {
  auto found = whole_sizes_.find(combination);
  if (found == whole_sizes_.end()) {
    std::vector<WholeSizes> sizes(continuous_.size());
    try {
      const design::Design design = make_candidate(study_, combinations_[combination]).design();
      for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = WholeSizes(design, study_.parameters[continuous_[i]]);
    } catch (const InputError&) {
      // The design is invalid. The search reports the error when it evaluates the design, so no sizes are adjusted
      // here.
    }
    found = whole_sizes_.emplace(combination, std::move(sizes)).first;
  }
  return found->second[k];
}

std::vector<double> Scan::at_whole_sizes(std::size_t combination, std::vector<double> fractions) const {
  for (std::size_t k = 0; k < fractions.size(); ++k) {
    const WholeSizes& sizes = whole_sizes(combination, k);
    // The scan must contain both ends of each interval. Only values between the ends are moved.
    if (sizes.is_empty() || fractions[k] <= 0.0 || fractions[k] >= 1.0) continue;
    const Interval& interval = *study_.parameters[continuous_[k]].interval;
    const double half = 0.5 * spacing();
    const std::vector<double> near = sizes.between(interval.at(fractions[k] - half), interval.at(fractions[k] + half));
    const double here = fractions[k];
    const auto distance = [&](double size) { return std::abs(fraction_of(interval, size) - here); };
    const auto nearest = std::ranges::min_element(near, {}, distance);
    if (nearest != near.end()) fractions[k] = fraction_of(interval, *nearest);
  }
  return fractions;
}

std::vector<PointValues> Scan::of(std::size_t combination) const {
  const std::size_t dimensions = continuous_.size();
  const PointValues& values = combinations_[combination];
  if (dimensions == 0) return {values};
  std::vector<PointValues> designs;
  std::set<std::string> added;
  const auto add = [&](const std::vector<double>& fractions) {
    PointValues design = with(values, at_whole_sizes(combination, fractions));
    std::string key;
    for (const ParameterValue& value : design) key += value.toml + '\n';
    if (added.insert(key).second) designs.push_back(std::move(design));
  };
  if (dimensions == 1) {
    for (std::size_t k = 0; k < request_.scan; ++k) add({static_cast<double>(k) * spacing()});
    return designs;
  }
  constexpr std::size_t most_corners = 6;
  for (std::size_t corner = 0; dimensions <= most_corners && corner < (std::size_t{1} << dimensions); ++corner) {
    std::vector<double> fractions;
    for (std::size_t k = 0; k < dimensions; ++k) fractions.push_back((corner >> k) % 2 == 0 ? 0.0 : 1.0);
    add(fractions);
  }
  const compute::UnitSamples samples(compute::UnitSamples::Kind::sobol, dimensions, request_.scan, study_.seed);
  for (std::size_t k = 0; k < request_.scan; ++k) add(samples.at(k));
  return designs;
}

bool may_be_noisy(const Study& study) {
  if (std::ranges::none_of(study.quantities, [](const auto& quantity) { return !quantity->tracing().empty(); }))
    return false;
  try {
    const Candidate candidate = make_candidate(study, example_values(study));
    const raytrace::Engine engine = candidate.analysis().engine;
    if (!raytrace::may_be_exact(engine)) return true;
    if (engine != raytrace::Engine::automatic) return false;
    const design::Design& design = candidate.design();
    // Rounded edges and random facet tilts produce too many beams for the exact engine. The engine `auto` then traces
    // rays, and the results of rays have random errors.
    const bool has_many_beams = design.elements() != nullptr &&
                                (!design.part().edges.is_sharp() || design.part().random_tilts.sigma_arcmin > 0.0);
    if (candidate.analysis().rays || has_many_beams) return true;
    const design::OpticalModel model = design::make_model(design, materials::MaterialLibrary::shipped());
    const raytrace::EngineFacts facts = design::engine_facts(design, &model.optics);
    return raytrace::obstacle_for(raytrace::Engine::exact, facts).has_value();
  } catch (const Error&) {
    return false;
  }
}

std::vector<Observation> DesignFunction::observe(const std::vector<SearchPoint>& points, const ErrorLevel& level) {
  std::vector<PointValues> designs;
  for (const SearchPoint& point : points) designs.push_back(design_at(point));
  std::vector<Observation> seen;
  for (const Variant& variant : evaluator_.evaluate(designs, level)) {
    Observation& observation = seen.emplace_back();
    if (variant.objective) observation.objective = Estimate{*variant.objective, variant.objective_error};
    const auto add = [&](std::optional<double> excess, const std::string& quantity) {
      observation.excess.push_back({excess.value_or(std::numeric_limits<double>::infinity()),
                                    excess ? evaluator_.error_of(variant, quantity) : 0.0});
    };
    for (const Constraint& constraint : request_.constraints) {
      const std::optional<double> value = evaluator_.value(variant, constraint.quantity);
      if (constraint.min) add(value ? std::optional(*constraint.min - *value) : std::nullopt, constraint.quantity);
      if (constraint.max) add(value ? std::optional(*value - *constraint.max) : std::nullopt, constraint.quantity);
    }
  }
  return seen;
}

/// Checks only constraints on quantities that are computed without tracing, such as areas and machining times.
bool DesignFunction::is_allowed(const SearchPoint& point) const {
  const auto known = allowed_.find(point);
  if (known != allowed_.end()) return known->second;
  bool is_allowed = true;
  try {
    const Candidate candidate = make_candidate(study_, design_at(point));
    for (const Constraint& constraint : request_.constraints) {
      const Quantity* const quantity = quantity_named(study_, constraint.quantity);
      if (quantity == nullptr || !quantity->tracing().empty()) continue;
      const std::optional<Measured> measured = quantity->measure(candidate, nullptr);
      is_allowed = is_allowed && measured && constraint.violation(measured->value) <= 0.0;
    }
  } catch (const Error&) {
    is_allowed = false;
  }
  allowed_.emplace(point, is_allowed);
  return is_allowed;
}

std::vector<SearchPoint> DesignFunction::peaks_near(const SearchPoint& point, double within) const {
  std::vector<SearchPoint> peaks;
  for (std::size_t k = 0; k < point.fractions.size(); ++k) {
    const WholeSizes& sizes = scan_.whole_sizes(point.combination, k);
    if (sizes.is_empty()) continue;
    const Interval& interval = *study_.parameters[scan_.continuous()[k]].interval;
    for (const double size :
         sizes.between(interval.at(point.fractions[k] - within), interval.at(point.fractions[k] + within))) {
      SearchPoint peak = point;
      peak.fractions[k] = fraction_of(interval, size);
      if (peak != point) peaks.push_back(std::move(peak));
    }
  }
  return peaks;
}

std::vector<SearchPoint> DesignFunction::rounder_points(const SearchPoint& point, double within) const {
  if (!request_.is_rounded) return {};
  // `values` contains one list for each parameter: values near the present value, ordered by increasing number of
  // digits. Point i combines entry i of all lists, so all its parameters have a similar number of digits.
  std::vector<std::vector<double>> values;
  std::size_t count = 0;
  for (std::size_t k = 0; k < point.fractions.size(); ++k) {
    const Interval& interval = *study_.parameters[scan_.continuous()[k]].interval;
    values.push_back(round_values(interval.at(point.fractions[k]), interval.at(point.fractions[k] - within),
                                  interval.at(point.fractions[k] + within), scan_.whole_sizes(point.combination, k)));
    count = std::max(count, values.back().size());
  }
  std::vector<SearchPoint> points;
  for (std::size_t i = 0; i < std::min(count, kMaxRoundPoints); ++i) {
    SearchPoint round = point;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const Interval& interval = *study_.parameters[scan_.continuous()[k]].interval;
      if (!values[k].empty()) round.fractions[k] = fraction_of(interval, values[k][std::min(i, values[k].size() - 1)]);
    }
    if (std::ranges::count(points, round) == 0) points.push_back(std::move(round));
  }
  return points;
}

}  // namespace retrace::studies
