#include "studies/compose/mixture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace retrace::studies {
namespace {

/// Fraction of the area below which a cell is not part of a mixture.
constexpr double kFractionTolerance = 1e-12;
/// Minimum improvement of the merit that counts, relative to 1 + |merit|.
constexpr double kAsGood = 1e-10;

/// Returns the minimum increase of a merit that counts as an improvement.
double as_good(double merit) {
  return kAsGood * (1.0 + std::abs(merit));
}

/// Set of cells of a mixture, with the minimum fraction that each cell must have.
struct CellSet {
  std::vector<std::size_t> cells;
  double min_fraction = 0.0;
};

/// Returns the linear programme of a set of cells. Its variables (columns) are the fractions of the cells and the
/// minimum goal. It has a constraint (row) for each goal, for each mean, and for the sum of the fractions.
compute::LinearProgramme programme_of(const std::vector<MixedCell>& cells, const CellSet& set,
                                      const MixtureRules& rules) {
  compute::LinearProgramme programme;
  for (const std::size_t cell : set.cells)
    programme.add_column({set.min_fraction, rules.max_fraction}, -cells[cell].cost);
  const std::size_t least = programme.add_column({}, 1.0);
  using Terms = std::vector<compute::LinearProgramme::Term>;
  const auto weighted = [&](auto value) {
    Terms terms;
    for (std::size_t k = 0; k < set.cells.size(); ++k) terms.emplace_back(k, value(cells[set.cells[k]]));
    return terms;
  };
  for (std::size_t goal = 0; goal < cells.front().goals.size(); ++goal) {
    Terms terms = weighted([&](const MixedCell& cell) { return cell.goals[goal]; });
    terms.emplace_back(least, -1.0);
    programme.add_row({.lower = 0.0}, std::move(terms));
  }
  for (std::size_t mean = 0; mean < rules.means.size(); ++mean)
    programme.add_row(rules.means[mean], weighted([&](const MixedCell& cell) { return cell.means[mean]; }));
  programme.add_row({1.0, 1.0}, weighted([](const MixedCell&) { return 1.0; }));
  return programme;
}

/// Returns the prices of a mixture from the dual values of the rows of the linear programme.
MixturePrices prices_of(const std::vector<double>& of_rows, std::size_t goals, std::size_t means) {
  MixturePrices prices;
  for (std::size_t k = 0; k < goals; ++k) prices.goals.push_back(-of_rows[k]);
  for (std::size_t k = 0; k < means; ++k) prices.means.push_back(of_rows[goals + k]);
  prices.area = of_rows[goals + means];
  return prices;
}

double weighted_sum(const std::vector<double>& weights, const std::vector<double>& values) {
  return std::inner_product(weights.begin(), weights.end(), values.begin(), 0.0);
}

/// Computes the goals, means and merit of a mixture from the fractions of its cells.
void add_up(const std::vector<MixedCell>& cells, const CellSet& set, const std::vector<double>& shares,
            Mixture& mixture) {
  mixture.goals.assign(cells.front().goals.size(), 0.0);
  mixture.means.assign(cells.front().means.size(), 0.0);
  double cost = 0.0;
  for (std::size_t k = 0; k < set.cells.size(); ++k) {
    if (!(shares[k] > kFractionTolerance)) continue;
    const MixedCell& cell = cells[set.cells[k]];
    mixture.zones.push_back({set.cells[k], shares[k]});
    cost += shares[k] * cell.cost;
    for (std::size_t goal = 0; goal < mixture.goals.size(); ++goal) mixture.goals[goal] += shares[k] * cell.goals[goal];
    for (std::size_t mean = 0; mean < mixture.means.size(); ++mean) mixture.means[mean] += shares[k] * cell.means[mean];
  }
  std::ranges::stable_sort(mixture.zones, std::ranges::greater{}, &ZoneFraction::fraction);
  mixture.min_goal = *std::ranges::min_element(mixture.goals);
  mixture.merit = mixture.min_goal - cost;
}

/// Returns the best mixture of a set of cells, without a limit on their number.
Mixture mixture_of(const std::vector<MixedCell>& cells, const CellSet& set, const MixtureRules& rules,
                   const Cancellation* cancel) {
  const compute::LinearOptimum optimum = solve(programme_of(cells, set, rules), cancel);
  Mixture mixture;
  if (optimum.kind == compute::LinearOptimum::Kind::interrupted) {
    mixture.kind = Mixture::Kind::interrupted;
    return mixture;
  }
  mixture.prices = prices_of(optimum.prices, cells.front().goals.size(), rules.means.size());
  if (optimum.kind != compute::LinearOptimum::Kind::optimal) return mixture;
  mixture.kind = Mixture::Kind::optimal;
  add_up(cells, set, optimum.values, mixture);
  mixture.bound = mixture.merit;
  return mixture;
}

/// Upper bound of the merit of mixtures, which follows from dual prices: no mixture has a higher merit than the best of
/// its cells, if the merits of the cells are evaluated at these prices.
class PriceBound {
 public:
  PriceBound(const std::vector<MixedCell>& cells, const MixtureRules& rules, const MixturePrices& prices) {
    // Part of the merit that is equal for all cells: the price of each active bound on a mean times this bound, and the
    // price of the whole area.
    double constant = prices.area;
    for (std::size_t k = 0; k < rules.means.size(); ++k)
      if (prices.means[k] != 0.0)
        constant += prices.means[k] * (prices.means[k] > 0.0 ? rules.means[k].upper : rules.means[k].lower);
    for (const MixedCell& cell : cells) merits_.push_back(constant + gain(prices, cell));
    order_.resize(cells.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::ranges::stable_sort(order_, [&](std::size_t x, std::size_t y) { return merits_[x] > merits_[y]; });
  }

  double merit_of(std::size_t cell) const { return merits_[cell]; }
  /// Returns the cells in descending order of merit.
  const std::vector<std::size_t>& order() const { return order_; }
  /// Returns the number of cells whose merit is above a value.
  std::size_t count_above(double merit) const {
    const auto end = std::ranges::partition_point(order_, [&](std::size_t cell) { return merits_[cell] > merit; });
    return static_cast<std::size_t>(end - order_.begin());
  }
  /// Returns true if the upper bound of the set is above `merit`. A mixture of the set can then have a merit above
  /// `merit`.
  bool lets_pass(const std::vector<std::size_t>& set, double merit) const {
    return std::ranges::any_of(set, [&](std::size_t cell) { return merits_[cell] > merit; });
  }
  /// Returns the upper bound of the merit for mixtures of the set.
  double upper_bound_of(const std::vector<std::size_t>& set) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const std::size_t cell : set) most = std::max(most, merits_[cell]);
    return most;
  }

 private:
  std::vector<double> merits_;
  std::vector<std::size_t> order_;
};

/// Branch and bound over small sets of cells. At any dual prices, a set that is better than the best mixture found so
/// far contains a cell with a higher merit than this mixture. Sets are therefore extended by such cells only. Of all
/// stored dual prices, those with the smallest number of such cells are used.
class SetSearch {
 public:
  SetSearch(const std::vector<MixedCell>& cells, const MixtureRules& rules, const Cancellation* cancel,
            std::size_t most_sets)
      : cells_(cells), rules_(rules), cancel_(cancel), max_sets_(most_sets), is_out_(cells.size(), false) {
    max_zones_ = std::min(rules.max_zones, cells.size());
    while (static_cast<double>(max_zones_) * rules.min_fraction > 1.0 + 1e-9) --max_zones_;
    for (std::size_t goal = 0; goal < cells.front().goals.size(); ++goal) {
      MixturePrices alone{std::vector<double>(cells.front().goals.size(), 0.0), std::vector<double>(rules.means.size()),
                          0.0};
      alone.goals[goal] = 1.0;
      bounds_.emplace_back(cells, rules, alone);
    }
  }

  /// Returns the best mixture that the search finds.
  /// \param relaxed best mixture without a limit on zones and without a minimum fraction
  Mixture run(const Mixture& relaxed) {
    bounds_.emplace_back(cells_, rules_, relaxed.prices);
    begin_with(relaxed);
    improve();
    grow({}, {});
    if (is_cancelled(cancel_)) best_.kind = Mixture::Kind::interrupted;
    if (!best_.is_feasible()) return best_;
    const bool is_all = sets_ <= max_sets_;
    best_.kind = is_all ? Mixture::Kind::optimal : Mixture::Kind::best_found;
    best_.bound = is_all ? best_.merit : relaxed.merit;
    return best_;
  }

 private:
  static constexpr std::size_t kMaxBounds = 400;  ///< maximum number of stored bounds
  static constexpr std::size_t kMaxAddedCells =
      200;  ///< maximum number of cells that are tried as an addition to a set

  bool is_over() const { return sets_ > max_sets_ || is_cancelled(cancel_); }
  double to_beat() const {
    return best_.is_feasible() ? best_.merit + as_good(best_.merit) : -std::numeric_limits<double>::infinity();
  }

  /// Searches for a good first mixture, because it shortens the search. The search begins with the relaxed mixture and
  /// removes the cells with the smallest fractions one by one.
  void begin_with(const Mixture& relaxed) {
    std::vector<ZoneFraction> zones = relaxed.zones;
    while (zones.size() > 1) {
      CellSet set;
      for (const ZoneFraction& zone : zones) set.cells.push_back(zone.cell);
      const Mixture mixture = mixture_of(cells_, set, rules_, cancel_);
      if (!mixture.is_feasible()) return;
      keep_bound(mixture.prices);
      take(mixture);
      zones = mixture.zones;
      zones.pop_back();
    }
  }

  /// Replaces single cells of the best mixture by other cells as long as the mixture becomes better.
  void improve() {
    for (double before = -std::numeric_limits<double>::infinity(); best_.is_feasible() && best_.merit > before;) {
      before = best_.merit;
      std::vector<std::size_t> set;
      for (const ZoneFraction& zone : best_.zones) set.push_back(zone.cell);
      if (set.size() < max_zones_) try_beside(set);
      for (std::size_t k = 0; k < set.size() && set.size() > 1; ++k) {
        std::vector<std::size_t> others = set;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
        try_beside(others);
      }
    }
  }

  /// Tries sets with one additional cell. The cells with the highest upper bounds of the merit are tried first.
  void try_beside(const std::vector<std::size_t>& set) {
    const Mixture mixture = mixture_of(cells_, {set}, rules_, cancel_);
    if (!mixture.is_feasible()) return;
    keep_bound(mixture.prices);
    std::vector<std::pair<double, std::size_t>> next;
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      if (std::ranges::count(set, cell) > 0) continue;
      std::vector<std::size_t> larger = set;
      larger.push_back(cell);
      double most = mixture.merit + gain(mixture.prices, cells_[cell]);
      for (const PriceBound& bound : bounds_) most = std::min(most, bound.upper_bound_of(larger));
      if (most > to_beat()) next.emplace_back(most, cell);
    }
    std::ranges::stable_sort(next, [](const auto& a, const auto& b) { return a.first > b.first; });
    if (next.size() > kMaxAddedCells) next.resize(kMaxAddedCells);
    for (const auto& [most, cell] : next) {
      if (is_over()) return;
      std::vector<std::size_t> larger = set;
      larger.push_back(cell);
      ++sets_;
      const Mixture grown = mixture_of(cells_, {larger}, rules_, cancel_);
      if (!grown.is_feasible()) continue;
      keep_bound(grown.prices);
      take(grown);
    }
  }

  void keep_bound(const MixturePrices& prices) {
    if (bounds_.size() < kMaxBounds) bounds_.emplace_back(cells_, rules_, prices);
  }

  /// Stores a mixture as the best mixture if it satisfies the rules and its merit is higher than that of the stored
  /// one. Fractions that are too small are first raised to the minimum.
  void take(Mixture mixture) {
    if (mixture.zones.size() > max_zones_) return;
    if (rules_.min_fraction > 0.0 && mixture.zones.back().fraction < rules_.min_fraction - kFractionTolerance) {
      CellSet set{{}, rules_.min_fraction};
      for (const ZoneFraction& zone : mixture.zones) set.cells.push_back(zone.cell);
      mixture = mixture_of(cells_, set, rules_, cancel_);
    }
    if (mixture.is_feasible() && mixture.merit > to_beat()) best_ = std::move(mixture);
  }

  /// Searches all sets that contain this set and no cell that is marked in is_out_. Sets are skipped if the bounds show
  /// that they cannot be better than the best mixture.
  /// \param mixture best mixture of the set; without cells for an empty set
  void grow(const std::vector<std::size_t>& set, const Mixture& mixture) {
    if (set.size() >= max_zones_) return;
    const std::vector<std::size_t> next = candidates(set, mixture);
    std::vector<std::size_t> larger = set;
    larger.push_back(0);
    std::vector<std::size_t> tried;
    for (const std::size_t cell : next) {
      if (is_over()) break;
      larger.back() = cell;
      if (may_beat(larger)) look_at(larger);
      is_out_[cell] = true;
      tried.push_back(cell);
    }
    for (const std::size_t cell : tried) is_out_[cell] = false;
  }

  void look_at(const std::vector<std::size_t>& set) {
    ++sets_;
    const Mixture mixture = mixture_of(cells_, {set}, rules_, cancel_);
    if (mixture.kind == Mixture::Kind::interrupted) return;
    if (mixture.is_feasible()) {
      if (set.size() > 1) keep_bound(mixture.prices);
      take(mixture);
    }
    grow(set, mixture);
  }

  /// Returns false if one of the stored bounds shows that a set is not better than the best mixture. Always returns
  /// true for sets that can still be extended.
  bool may_beat(const std::vector<std::size_t>& set) const {
    if (set.size() < max_zones_) return true;
    return std::ranges::all_of(bounds_, [&](const PriceBound& bound) { return bound.lets_pass(set, to_beat()); });
  }

  /// Returns a list of cells. Every extension of `set` that is better than the best mixture contains at least one cell
  /// of the list. Each stored bound yields such a list; the shortest list is returned.
  std::vector<std::size_t> candidates(const std::vector<std::size_t>& set, const Mixture& mixture) const {
    const PriceBound* fewest = nullptr;
    std::size_t least = cells_.size() + 1;
    std::optional<PriceBound> own;
    if (mixture.is_feasible()) own.emplace(cells_, rules_, mixture.prices);
    const auto consider = [&](const PriceBound& bound) {
      const std::size_t count = bound.count_above(to_beat());
      if (count >= least || bound.lets_pass(set, to_beat())) return;
      fewest = &bound;
      least = count;
    };
    if (own) consider(*own);
    for (const PriceBound& bound : bounds_) consider(bound);
    std::vector<std::size_t> found;
    const std::vector<std::size_t>& order = fewest != nullptr ? fewest->order() : bounds_.back().order();
    for (const std::size_t cell : order) {
      if (fewest != nullptr && !(fewest->merit_of(cell) > to_beat())) break;
      if (!is_out_[cell] && std::ranges::count(set, cell) == 0) found.push_back(cell);
    }
    return found;
  }

  const std::vector<MixedCell>& cells_;
  const MixtureRules& rules_;
  const Cancellation* cancel_;
  std::size_t max_sets_;
  std::size_t max_zones_ = 0;
  std::vector<bool> is_out_;
  std::vector<PriceBound> bounds_;
  std::size_t sets_ = 0;
  Mixture best_;
};

}  // namespace

double gain(const MixturePrices& prices, const MixedCell& cell) {
  return weighted_sum(prices.goals, cell.goals) - cell.cost - weighted_sum(prices.means, cell.means) - prices.area;
}

Mixture best_mixture(const std::vector<MixedCell>& cells, const MixtureRules& rules, const Cancellation* cancel,
                     std::size_t max_sets) {
  CellSet all;
  all.cells.resize(cells.size());
  std::iota(all.cells.begin(), all.cells.end(), std::size_t{0});
  Mixture relaxed = mixture_of(cells, all, rules, cancel);
  const bool holds_all =
      relaxed.zones.size() <= rules.max_zones &&
      (relaxed.zones.empty() || relaxed.zones.back().fraction >= rules.min_fraction - kFractionTolerance);
  if (!relaxed.is_feasible() || holds_all) return relaxed;
  return SetSearch(cells, rules, cancel, max_sets).run(relaxed);
}

namespace {

/// Maximum number of zones for which all combinations of rounding up and down are compared. With more zones, the
/// fractions with the largest remainders are rounded up.
constexpr std::size_t kMaxZonesToCompare = 12;

bool satisfies(const Mixture& mixture, const MixtureRules& rules) {
  for (const ZoneFraction& zone : mixture.zones)
    if (zone.fraction < rules.min_fraction - kFractionTolerance ||
        zone.fraction > rules.max_fraction + kFractionTolerance)
      return false;
  for (std::size_t k = 0; k < rules.means.size(); ++k)
    if (mixture.means[k] < rules.means[k].lower || mixture.means[k] > rules.means[k].upper) return false;
  return true;
}

}  // namespace

Mixture rounded_mixture(const std::vector<MixedCell>& cells, const MixtureRules& rules, const Mixture& mixture,
                        std::size_t steps) {
  const std::size_t count = mixture.zones.size();
  const auto whole = static_cast<double>(steps);
  CellSet set;
  std::vector<double> lower;
  std::vector<std::pair<double, std::size_t>> remainders;
  double missing = whole;
  for (std::size_t k = 0; k < count; ++k) {
    set.cells.push_back(mixture.zones[k].cell);
    lower.push_back(std::floor(mixture.zones[k].fraction * whole + 1e-9));
    remainders.emplace_back(lower.back() - mixture.zones[k].fraction * whole, k);
    missing -= lower.back();
  }
  const auto up = static_cast<std::size_t>(std::llround(missing));
  Mixture best = mixture;
  bool is_found = false;
  const auto compare = [&](const std::vector<bool>& is_up) {
    std::vector<double> fractions;
    for (std::size_t k = 0; k < count; ++k) fractions.push_back((lower[k] + (is_up[k] ? 1.0 : 0.0)) / whole);
    Mixture rounded = mixture;
    rounded.zones.clear();
    add_up(cells, set, fractions, rounded);
    if (!satisfies(rounded, rules) || (is_found && rounded.merit <= best.merit)) return;
    best = rounded;
    is_found = true;
  };
  std::ranges::sort(remainders);
  std::vector<bool> is_up(count, false);
  for (std::size_t k = 0; k < std::min(up, count); ++k) is_up[remainders[k].second] = true;
  compare(is_up);
  if (count > kMaxZonesToCompare) return best;
  for (std::size_t mask = 0; mask < (std::size_t{1} << count); ++mask) {
    if (static_cast<std::size_t>(std::popcount(mask)) != up) continue;
    for (std::size_t k = 0; k < count; ++k) is_up[k] = (mask >> k) % 2 == 1;
    compare(is_up);
  }
  return best;
}

}  // namespace retrace::studies
