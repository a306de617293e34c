#include "studies/compose/compose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/number_format.h"
#include "studies/compose/composition_errors.h"
#include "studies/optimise/evaluator.h"
#include "studies/optimise/refine.h"
#include "studies/quantity/study_names.h"

namespace retrace::studies {
namespace {

constexpr const char* kStoreKind = "retrace.composition/1";
/// Minimum gain of a cell that counts as an improvement, relative to the absolute value of the merit.
constexpr double kHelps = 1e-3;
/// Initial step of a search for cells with a positive gain at the dual prices, as a fraction of each parameter's
/// interval.
constexpr double kFirstStep = 0.1;

/// Returns the request of a search for the best part with only one kind of cell.
OptimiseRequest single_request(const ComposeRequest& request) {
  OptimiseRequest single;
  for (const std::string& goal : request.goals) single.objective.weights.emplace_back(goal, 1.0);
  single.objective.uses_minimum = true;
  single.constraints = request.cell_constraints;
  single.scan = request.scan;
  single.has_levels = false;
  return single;
}

bool has_intervals(const Study& study) {
  return std::ranges::any_of(study.parameters, [](const Parameter& p) { return p.interval.has_value(); });
}

/// Numbers of steps into which the area may be divided if the study gives no step. The first ones are preferred.
constexpr std::size_t kAreaSteps[] = {10, 20, 50, 100, 200, 500, 1000};

/// Returns the standard error of the minimum goal of a mixture. Errors of different cells are independent.
double error_of_merit(const std::vector<FamilyCell>& catalogue, const Mixture& mixture) {
  const auto least = std::ranges::min_element(mixture.goals) - mixture.goals.begin();
  double square = 0.0;
  for (const ZoneFraction& zone : mixture.zones) {
    const double error = zone.fraction * catalogue[zone.cell].goal_errors[static_cast<std::size_t>(least)];
    square += error * error;
  }
  return std::sqrt(square);
}

/// Converts evaluated designs to cells of the family.
class CellReader {
 public:
  CellReader(const Study& study, const ComposeRequest& request) {
    for (const std::string& goal : request.goals) goals_.push_back(quantity_index(study, goal).value());
    for (const Constraint& constraint : request.part_constraints)
      means_.push_back(quantity_index(study, constraint.quantity).value());
    if (request.front) means_.push_back(quantity_index(study, request.front->quantity).value());
    for (const auto& [quantity, price] : request.price)
      prices_.emplace_back(quantity_index(study, quantity).value(), price);
  }

  /// Returns the cell for an evaluated design. Returns nothing if the design is infeasible or a quantity has no value.
  std::optional<FamilyCell> cell_of(const Variant& variant) const {
    if (!variant.feasible()) return std::nullopt;
    FamilyCell cell{variant.number, variant.values, {}};
    const auto take = [&](const std::vector<std::size_t>& of, std::vector<double>& values) {
      for (const std::size_t k : of)
        if (variant.outputs[k].value) values.push_back(*variant.outputs[k].value);
      return values.size() == of.size();
    };
    if (!take(goals_, cell.mixed.goals) || !take(means_, cell.mixed.means)) return std::nullopt;
    for (const std::size_t k : goals_) cell.goal_errors.push_back(variant.outputs[k].std_error);
    for (const auto& [k, price] : prices_) {
      if (!variant.outputs[k].value) return std::nullopt;
      cell.mixed.cost += price * *variant.outputs[k].value;
    }
    return cell;
  }

 private:
  std::vector<std::size_t> goals_;
  std::vector<std::size_t> means_;
  std::vector<std::pair<std::size_t, double>> prices_;
};

/// Passes the progress of a search with dual prices to an observer. Best designs of this search are not reported,
/// because its objective differs from the objective of the part.
class PricingObserver final : public OptimiseObserver {
 public:
  explicit PricingObserver(OptimiseObserver* observer) : observer_(observer) {}
  void at(std::size_t evaluated) override {
    if (observer_ != nullptr) observer_->at(evaluated);
  }
  void at_group(double fraction, std::size_t designs) override {
    if (observer_ != nullptr) observer_->at_group(fraction, designs);
  }

 private:
  OptimiseObserver* observer_;
};

/// Runs one composition from the scan to the result.
class Composer {
 public:
  Composer(const Study& study, const ComposeRequest& request, compute::ResultStore& store, OptimiseObserver* observer,
           const Cancellation* cancel)
      : study_(study),
        request_(request),
        store_(store),
        observer_(observer),
        cancel_(cancel),
        single_(single_request(request)),
        family_(study, single_, store, observer, cancel),
        reader_(study, request) {}

  void run(Composition& composition) {
    const Optimum optimum = optimise(study_, single_, family_, cancel_);
    if (!optimum.complete) throw Interrupted{};
    read_catalogue(composition);
    if (optimum.best) composition.single = reader_.cell_of(*optimum.best);
    search_by_prices(composition);
    choose(composition);
    if (!composition.best) return;
    count_zones(composition);
    draw_front(composition);
    if (request_.errors) composition.errors = effects_of_errors(study_, request_, composition, observer_, cancel_);
  }

  /// Chooses the best part from the cells in the store.
  void choose_from_store(Composition& composition) {
    family_.add_stored();
    read_catalogue(composition);
    choose(composition);
    composition.proof = Proof::none;
  }

  /// Fills the catalogue with the cells that this run has evaluated. Cells that only earlier runs have evaluated are
  /// not used, so that the result does not depend on the contents of the store.
  void read_catalogue(Composition& composition) const {
    composition.catalogue.clear();
    composition.failed = 0;
    composition.evaluations = family_.evaluated().size();
    for (const Variant& variant : family_.evaluated()) {
      if (variant.failed && composition.failed++ == 0) composition.first_failure = variant.reason;
      if (std::optional<FamilyCell> cell = reader_.cell_of(variant)) composition.catalogue.push_back(*std::move(cell));
    }
  }

 private:
  MixtureRules rules(std::optional<std::size_t> most_zones) const {
    MixtureRules rules;
    for (const Constraint& constraint : request_.part_constraints) {
      compute::Bounds bounds;
      if (constraint.min) bounds.lower = *constraint.min;
      if (constraint.max) bounds.upper = *constraint.max;
      rules.means.push_back(bounds);
    }
    if (request_.front) rules.means.push_back({});
    rules.min_fraction = request_.min_area_fraction;
    rules.max_fraction = request_.max_area_fraction;
    if (most_zones) rules.max_zones = *most_zones;
    return rules;
  }

  /// Returns rules that allow any number of zones with any fraction of the area. The problem is then a plain linear
  /// programme.
  MixtureRules relaxed_rules() const {
    MixtureRules relaxed = rules({});
    relaxed.min_fraction = 0.0;
    return relaxed;
  }

  Mixture mixture_of(const Composition& composition, const MixtureRules& rules) const {
    std::vector<MixedCell> cells;
    for (const FamilyCell& cell : composition.catalogue) cells.push_back(cell.mixed);
    if (cells.empty()) return {};
    Mixture mixture = best_mixture(cells, rules, cancel_);
    if (mixture.kind == Mixture::Kind::interrupted) throw Interrupted{};
    return mixture;
  }

  static std::vector<Zone> zones_of(const Composition& composition, const Mixture& mixture) {
    std::vector<Zone> zones;
    for (const ZoneFraction& zone : mixture.zones) zones.push_back({composition.catalogue[zone.cell], zone.fraction});
    return zones;
  }

  /// Adds cells with a positive gain (see gain() in mixture.h). The search uses the dual prices of the best mixture
  /// without the limits on zones, which are the maximum number and the minimum area. If these limits lower the merit, a
  /// second search uses the dual prices of the best mixture with the limits.
  void search_by_prices(Composition& composition) {
    for (std::size_t round = 0; round < request_.rounds; ++round) {
      const Mixture relaxed = mixture_of(composition, relaxed_rules());
      if (!relaxed.is_feasible()) return;
      const std::size_t before = composition.catalogue.size();
      bool helps = search(composition, relaxed);
      const Mixture few = mixture_of(composition, rules(request_.max_zones));
      if (few.is_feasible() && few.merit < relaxed.merit - kHelps * (1.0 + std::abs(relaxed.merit)))
        helps = search(composition, few) || helps;
      composition.has_converged = !helps;
      if (!helps || composition.catalogue.size() == before) return;
    }
  }

  /// Returns the request of a search for the cell with the highest gain at the dual prices of a mixture.
  OptimiseRequest pricing_request(const Mixture& mixture) const {
    std::map<std::string, double> weights;
    for (std::size_t k = 0; k < request_.goals.size(); ++k)
      if (mixture.prices.goals[k] > 0.0) weights[request_.goals[k]] += mixture.prices.goals[k];
    for (std::size_t k = 0; k < request_.part_constraints.size(); ++k)
      if (mixture.prices.means[k] != 0.0) weights[request_.part_constraints[k].quantity] -= mixture.prices.means[k];
    for (const auto& [quantity, price] : request_.price) weights[quantity] -= price;
    OptimiseRequest pricing;
    pricing.objective.weights.assign(weights.begin(), weights.end());
    pricing.constraints = request_.cell_constraints;
    pricing.has_levels = false;
    return pricing;
  }

  /// Searches for cells with a positive gain. The search starts from the cells of the mixture and from the cells with
  /// the highest gain.
  /// \return true if a cell with a positive gain was found
  bool search(Composition& composition, const Mixture& mixture) {
    if (!has_intervals(study_)) return false;
    const OptimiseRequest pricing = pricing_request(mixture);
    const std::vector<PointValues> starts = starts_of(composition, mixture);
    PricingObserver observer(observer_);
    Evaluator evaluator(study_, pricing, store_, &observer, cancel_);
    for (const PointValues& start : starts)
      refine(study_, pricing, evaluator, evaluator.evaluate(start), {request_.evaluations_per_start, kFirstStep});
    family_.add_evaluated(evaluator.evaluated());
    read_catalogue(composition);
    const double least_gain = kHelps * (1.0 + std::abs(mixture.merit));
    return std::ranges::any_of(composition.catalogue,
                               [&](const FamilyCell& cell) { return gain(mixture.prices, cell.mixed) > least_gain; });
  }

  /// Returns the starting points of a search. The cells of the mixture come first, in descending order of their areas.
  /// The cells with the highest gain follow. Cells near an earlier starting point are skipped.
  std::vector<PointValues> starts_of(const Composition& composition, const Mixture& mixture) const {
    std::vector<std::size_t> order;
    for (const ZoneFraction& zone : mixture.zones) order.push_back(zone.cell);
    std::vector<std::size_t> others(composition.catalogue.size());
    std::iota(others.begin(), others.end(), std::size_t{0});
    std::ranges::stable_sort(others, [&](std::size_t a, std::size_t b) {
      return gain(mixture.prices, composition.catalogue[a].mixed) >
             gain(mixture.prices, composition.catalogue[b].mixed);
    });
    order.insert(order.end(), others.begin(), others.end());
    std::vector<PointValues> starts;
    for (const std::size_t cell : order) {
      if (starts.size() == request_.starts) break;
      const PointValues& values = composition.catalogue[cell].values;
      if (std::ranges::none_of(starts, [&](const PointValues& other) { return are_near(values, other); }))
        starts.push_back(values);
    }
    return starts;
  }

  /// Returns true if two cells are so similar that one search covers both. Parameters with an interval may differ by
  /// the fraction kFirstStep of the interval. All other parameters must be equal.
  bool are_near(const PointValues& a, const PointValues& b) const {
    for (std::size_t k = 0; k < a.size(); ++k) {
      const std::optional<Interval>& interval = study_.parameters[k].interval;
      if (!interval && a[k].toml != b[k].toml) return false;
      if (!interval) continue;
      const double between =
          fraction_of(*interval, std::get<double>(a[k].shown)) - fraction_of(*interval, std::get<double>(b[k].shown));
      if (std::abs(between) > kFirstStep) return false;
    }
    return true;
  }

  /// Returns the best mixture of at most `most_zones` zones. If the mixture that was found for fewer zones is better,
  /// that mixture is returned.
  Mixture mixture_of_zones(const Composition& composition, std::size_t most_zones) const {
    Mixture mixture = mixture_of(composition, rules(most_zones));
    if (composition.by_zones.empty()) return mixture;
    const Mixture& fewer = composition.by_zones.back().mixture;
    if (mixture.is_feasible() && mixture.merit >= fewer.merit) return mixture;
    const double bound = std::max(mixture.bound, fewer.merit);
    mixture = fewer;
    mixture.bound = bound;
    return mixture;
  }

  void choose(Composition& composition) const {
    const Mixture relaxed = mixture_of(composition, relaxed_rules());
    Mixture mixture = relaxed.is_feasible() ? mixture_of(composition, rules(request_.max_zones)) : relaxed;
    if (mixture.is_feasible()) {
      const std::size_t most = request_.max_zones.value_or(mixture.zones.size());
      for (std::size_t zones = 1; zones <= most; ++zones) add_by_zones(composition, zones);
      if (!composition.by_zones.empty() && composition.by_zones.back().mixture.merit > mixture.merit)
        mixture = composition.by_zones.back().mixture;
    }
    if (!mixture.is_feasible()) {
      composition.infeasible_bounds = excluding_bounds(composition, relaxed);
      composition.infeasible_reason = why_none(composition, relaxed);
      return;
    }
    mixture = rounded(composition, mixture);
    composition.unlimited_merit = relaxed.merit;
    composition.best =
        PartOfZones{zones_of(composition, mixture), mixture, request_.max_zones.value_or(mixture.zones.size())};
    if (mixture.kind == Mixture::Kind::best_found)
      composition.proof = Proof::none;
    else
      composition.proof = has_intervals(study_) ? Proof::catalogue : Proof::family;
  }

  /// Returns a mixture whose area fractions are multiples of a step. The step is that of the request, or the largest
  /// step that lowers the merit by less than its standard error. If there is no such step, returns `mixture`.
  Mixture rounded(const Composition& composition, const Mixture& mixture) const {
    std::vector<MixedCell> cells;
    for (const FamilyCell& cell : composition.catalogue) cells.push_back(cell.mixed);
    const MixtureRules limits = rules(request_.max_zones);
    if (request_.area_steps) return rounded_mixture(cells, limits, mixture, *request_.area_steps);
    const double error = error_of_merit(composition.catalogue, mixture);
    for (const std::size_t steps : kAreaSteps) {
      const Mixture found = rounded_mixture(cells, limits, mixture, steps);
      const auto is_multiple = [&](const ZoneFraction& zone) {
        const double multiple = zone.fraction * static_cast<double>(steps);
        return std::abs(multiple - std::round(multiple)) < 1e-9;
      };
      if (found.merit >= mixture.merit - error && std::ranges::all_of(found.zones, is_multiple)) return found;
    }
    return mixture;
  }

  /// Returns the indices of those bounds over the part that together exclude every mixture of cells. Returns an empty
  /// list if a mixture exists without the limits on zones, or if there are no cells.
  /// \param relaxed best mixture without limits on the number of zones and on the minimum area of a zone
  std::vector<std::size_t> excluding_bounds(const Composition& composition, const Mixture& relaxed) const {
    std::vector<std::size_t> bounds;
    if (composition.catalogue.empty() || relaxed.is_feasible()) return bounds;
    for (std::size_t k = 0; k < request_.part_constraints.size(); ++k)
      if (std::abs(relaxed.prices.means[k]) > 1e-9) bounds.push_back(k);
    return bounds;
  }

  /// Returns a text for the user that explains why no mixture of cells satisfies the bounds.
  /// \param relaxed best mixture without limits on the number of zones and on the minimum area of a zone
  /// \pre composition.infeasible_bounds is set
  std::string why_none(const Composition& composition, const Mixture& relaxed) const {
    if (composition.catalogue.empty())
      return composition.failed > 0 ? fmt::format("no cell can be computed: {}", composition.first_failure)
                                    : "the constraints on cells exclude all cells";
    if (relaxed.is_feasible())
      return fmt::format(
          "no mixture of at most {} of the {} cells, each with an area fraction of at least {}, satisfies the "
          "constraints on the part",
          request_.max_zones.value_or(composition.catalogue.size()), composition.catalogue.size(),
          shortest(request_.min_area_fraction));
    std::string text;
    for (const std::size_t k : composition.infeasible_bounds)
      text += fmt::format("{}{}", text.empty() ? "" : " and ", request_.part_constraints[k].text());
    if (text.empty())
      return fmt::format("{} cells cannot fill the part if each cell covers at most the fraction {} of the part's area",
                         composition.catalogue.size(), shortest(request_.max_area_fraction));
    return fmt::format("the constraint {} on the mean over the part excludes every mixture of the {} cells", text,
                       composition.catalogue.size());
  }

  void add_by_zones(Composition& composition, std::size_t zones) const {
    const Mixture mixture = mixture_of_zones(composition, zones);
    if (mixture.is_feasible()) composition.by_zones.push_back({zones_of(composition, mixture), mixture, zones});
  }

  /// Adds to `by_zones` the best part of at most n + 1 zones. n is the number of zones of the best part, or the maximum
  /// number of zones in `by_zones` if it is larger. The added part shows how much a further zone improves the merit.
  void count_zones(Composition& composition) const {
    const PartOfZones& last = composition.by_zones.empty() ? *composition.best : composition.by_zones.back();
    add_by_zones(composition, std::max(last.max_zones, composition.best->zones.size()) + 1);
  }

  /// Computes the parts of the Pareto front. The bounds of the front's mean are equally spaced, from the best value of
  /// a single cell to the mean of the best part.
  void draw_front(Composition& composition) const {
    if (!request_.front) return;
    const double sign = request_.front->is_maximized ? 1.0 : -1.0;
    MixtureRules along = rules(request_.max_zones);
    compute::Bounds& bounds = along.means.back();
    double best = -std::numeric_limits<double>::infinity();
    for (const FamilyCell& cell : composition.catalogue) best = std::max(best, sign * cell.mixed.means.back());
    const double of_best = sign * composition.best->mixture.means.back();
    for (std::size_t k = 0; k < request_.front_points; ++k) {
      const double step = static_cast<double>(k) / static_cast<double>(request_.front_points - 1);
      const double mean = sign * (best + step * (of_best - best));
      (sign > 0.0 ? bounds.lower : bounds.upper) = mean;
      const Mixture mixture = mixture_of(composition, along);
      if (mixture.is_feasible())
        composition.front.push_back({mixture.means.back(), mixture.min_goal, zones_of(composition, mixture)});
    }
  }

  const Study& study_;
  const ComposeRequest& request_;
  compute::ResultStore& store_;
  OptimiseObserver* observer_;
  const Cancellation* cancel_;
  OptimiseRequest single_;
  Evaluator family_;  ///< evaluates cells, and keeps every cell that this run has evaluated
  CellReader reader_;
};

}  // namespace

std::vector<Zone> robust_zones(const Composition& composition) {
  const bool has_them = composition.errors && composition.errors->robust_part;
  return has_them ? composition.errors->robust_part->zones : std::vector<Zone>{};
}

compute::StoreLayout compose_layout(const Study& study) {
  compute::StoreLayout layout = optimise_layout(study);
  layout.kind = kStoreKind;
  layout.inputs.resize(study.parameters.size());  // stored cells have no inputs for ErrorLevel
  // Constraints and objectives of the mixture do not change the values of cells. They are therefore not part of the
  // store's identity.
  std::erase_if(layout.parts, [](const auto& part) {
    return part.first == "constraint" || part.first == "optimize" || part.first == "sweep" || part.first == "tolerance";
  });
  return layout;
}

Sweep compose_scan(const Study& study, const ComposeRequest& request) {
  return optimise_scan(study, single_request(request));
}

void choose_best_so_far(const Study& study, const ComposeRequest& request, compute::ResultStore& store,
                        Composition& composition) {
  Composer(study, request, store, nullptr, nullptr).choose_from_store(composition);
}

Composition compose(const Study& study, const ComposeRequest& request, compute::ResultStore& store,
                    OptimiseObserver* observer, const Cancellation* cancel) {
  Composition composition;
  Composer composer(study, request, store, observer, cancel);
  try {
    composer.run(composition);
  } catch (const Interrupted&) {
    composition = {};
    composition.complete = false;
    composer.read_catalogue(composition);
  }
  return composition;
}

}  // namespace retrace::studies
