#include "studies/optimise/noisy_search.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "studies/optimise/local_model.h"

namespace retrace::studies {
namespace {

/// Half width of a confidence interval of 95 %, as a multiple of the standard error.
constexpr double kInterval = 1.96;
/// Maximum loss of the objective by rounding, as a multiple of the standard error of the loss.
constexpr double kRoundingErrors = 1.5;
/// Half of the edge length of the first box in which a model is fitted, for a single continuous parameter. The unit is
/// the distance between neighbouring points of the scan.
constexpr double kFirstBox = 3.5;
constexpr double kSmallestBox = 1e-8;
/// A model is regarded as accurate if its LocalModel::deviation() is below this value.
constexpr double kAdequate = 1.3;
/// The box shrinks only while the range of the objective inside the box exceeds this multiple of the standard error.
constexpr double kBoxErrors = 6.0;
/// A search without random errors ends if a step improves the objective by less than this fraction.
constexpr double kSmallestGain = 1e-9;
/// Maximum number of points that nearest_of() returns.
constexpr std::size_t kMaxPeaks = 6;
/// Maximum number of scan points that are observed again with a smaller error, for each combination of discrete values.
constexpr std::size_t kMaxContenders = 5;
/// Maximum number of points with fewer digits that are observed.
constexpr std::size_t kMaxRounder = 6;
/// Maximum number of points with fewer digits that are observed with the smallest error.
constexpr std::size_t kMaxCompared = 3;

double square(double x) {
  return x * x;
}

double distance(const SearchPoint& a, const SearchPoint& b) {
  double max = 0.0;
  for (std::size_t k = 0; k < a.fractions.size(); ++k) max = std::max(max, std::abs(a.fractions[k] - b.fractions[k]));
  return max;
}

/// Implementation of search_with_noise(). It stores all observations.
class NoisySearch {
 public:
  NoisySearch(SearchedFunction& function, const NoisySearchSettings& settings)
      : function_(function), settings_(settings) {}

  NoisyOptimum run(const std::vector<std::vector<SearchPoint>>& scan) {
    std::vector<SearchPoint> all;
    for (const auto& points : scan) all.insert(all.end(), points.begin(), points.end());
    observe(all, {settings_.scan_scale, 0});
    // Each combination of discrete values has one start, which is its best scan point. refine() first observes again
    // all scan points of the combination whose difference from the start is within the errors.
    for (const SearchPoint& start : starts(scan)) refine(start);
    NoisyOptimum optimum;
    std::optional<SearchPoint> best = compare(finalists());
    if (best) {
      const SearchPoint precise = *best;
      best = rounded(*best);
      optimum.resolution = resolution(precise, *best);
    }
    optimum.best = best;
    optimum.has_noise = has_noise_;
    optimum.observations = observations_;
    return optimum;
  }

 private:
  /// Observes points at a level of accuracy. Skips points that were already observed at this level.
  void observe(const std::vector<SearchPoint>& points, const ErrorLevel& level) {
    std::vector<SearchPoint> open;
    std::set<SearchPoint> added;
    for (const SearchPoint& point : points)
      if (!known_[point].contains(level) && added.insert(point).second) open.push_back(point);
    if (open.empty()) return;
    const std::vector<Observation> seen = function_.observe(open, level);
    observations_ += open.size();
    for (std::size_t k = 0; k < open.size(); ++k) {
      known_[open[k]].emplace(level, seen[k]);
      const auto has_error = [](const Estimate& value) { return value.std_error > 0.0; };
      has_noise_ = has_noise_ || (seen[k].objective && has_error(*seen[k].objective)) ||
                   std::ranges::any_of(seen[k].excess, has_error);
    }
  }

  /// Returns the most accurate observations of a point, which are all replicates with the smallest ErrorLevel::scale.
  std::vector<const Observation*> best_seen(const SearchPoint& point) const {
    std::vector<const Observation*> found;
    const auto at = known_.find(point);
    if (at == known_.end()) return found;
    for (const auto& [level, observation] : at->second)
      if (level.scale == at->second.begin()->first.scale) found.push_back(&observation);
    return found;
  }

  /// Returns the mean objective of the most accurate observations of a point.
  std::optional<Estimate> estimate(const SearchPoint& point) const {
    Estimate mean;
    const std::vector<const Observation*> seen = best_seen(point);
    for (const Observation* const one : seen) {
      if (!one->objective) return std::nullopt;
      mean.value += one->objective->value;
      mean.std_error += square(one->objective->std_error);
    }
    if (seen.empty()) return std::nullopt;
    const double count = static_cast<double>(seen.size());
    return Estimate{mean.value / count, std::sqrt(mean.std_error) / count};
  }

  /// Returns the mean excess over one limit (Observation::excess) of the most accurate observations of a point.
  Estimate excess(const SearchPoint& point, std::size_t limit) const {
    Estimate mean;
    const std::vector<const Observation*> seen = best_seen(point);
    for (const Observation* const one : seen) {
      mean.value += one->excess[limit].value;
      mean.std_error += square(one->excess[limit].std_error);
    }
    const double count = static_cast<double>(seen.size());
    return {mean.value / count, std::sqrt(mean.std_error) / count};
  }

  std::size_t limits() const { return known_.empty() ? 0 : known_.begin()->second.begin()->second.excess.size(); }

  bool is_feasible(const SearchPoint& point) const {
    if (!estimate(point)) return false;
    for (std::size_t k = 0; k < limits(); ++k)
      if (!(excess(point, k).value <= 0.0)) return false;
    return true;
  }

  /// Returns the estimated objective minus its standard error. Points are ranked by this value, because a large random
  /// error could otherwise make a point look best.
  double cautious_value(const SearchPoint& point) const {
    const Estimate value = *estimate(point);
    return value.value - value.std_error;
  }

  std::vector<SearchPoint> feasible_points() const {
    std::vector<SearchPoint> found;
    for (const auto& [point, seen] : known_)
      if (is_feasible(point)) found.push_back(point);
    return found;
  }

  std::optional<SearchPoint> best_of(const std::vector<SearchPoint>& points) const {
    std::optional<SearchPoint> best;
    for (const SearchPoint& point : points)
      if (is_feasible(point) && (!best || cautious_value(point) > cautious_value(*best))) best = point;
    return best;
  }

  /// Returns the best scan point of every combination of discrete values, but only for the best few combinations.
  std::vector<SearchPoint> starts(const std::vector<std::vector<SearchPoint>>& scan) const {
    std::vector<SearchPoint> found;
    for (const auto& points : scan)
      if (const auto best = best_of(points)) found.push_back(*best);
    std::ranges::stable_sort(
        found, [&](const SearchPoint& a, const SearchPoint& b) { return estimate(a)->value > estimate(b)->value; });
    if (found.size() > settings_.max_combinations) found.resize(settings_.max_combinations);
    return found;
  }

  ErrorLevel refinement_level() const { return {has_noise_ ? settings_.refinement_scale : settings_.scan_scale, 0}; }

  /// Returns the observed points of a combination that are inside a box and have an objective.
  std::vector<SearchPoint> points_in(std::size_t combination, const SearchBox& box) const {
    std::vector<SearchPoint> found;
    for (const auto& [point, seen] : known_)
      if (point.combination == combination && box.contains(point.fractions) && estimate(point)) found.push_back(point);
    return found;
  }

  /// Observes additional points on the axes and diagonals of a box until there are enough points to fit a quadratic
  /// model.
  void fill(std::size_t combination, const SearchBox& box) {
    const std::size_t dimensions = box.centre.size();
    const std::size_t needed = LocalModel::coefficients(dimensions) + (has_noise_ ? dimensions : 0);
    std::vector<SearchPoint> added;
    std::size_t count = points_in(combination, box).size();
    const auto add = [&](const std::vector<double>& steps) {
      if (count + added.size() >= needed) return;
      SearchPoint point{combination, box.centre};
      for (std::size_t k = 0; k < dimensions; ++k) {
        const double at = box.centre[k] + steps[k] * box.radius;
        // If a step leaves the interval of the parameter, the step in the opposite direction is used.
        point.fractions[k] = at < 0.0 || at > 1.0 ? std::clamp(box.centre[k] - steps[k] * box.radius, 0.0, 1.0) : at;
      }
      if (function_.is_allowed(point) || dimensions > 1) added.push_back(point);
    };
    for (const double step : {0.6, -0.6, 0.95, -0.95})
      for (std::size_t k = 0; k < dimensions; ++k) {
        std::vector<double> steps(dimensions, 0.0);
        steps[k] = step;
        add(steps);
      }
    for (std::size_t i = 0; i < dimensions; ++i)
      for (std::size_t k = i + 1; k < dimensions; ++k) {
        std::vector<double> steps(dimensions, 0.0);
        steps[i] = 0.5;
        steps[k] = 0.5;
        add(steps);
      }
    observe(added, refinement_level());
  }

  LocalModel objective_model(const SearchBox& box, const std::vector<SearchPoint>& points) const {
    std::vector<FittedValue> values;
    for (const SearchPoint& point : points) values.push_back({point.fractions, *estimate(point)});
    return {box, values};
  }

  /// Returns one model for each limit. The model approximates the excess over this limit (Observation::excess). Points
  /// at which the limited quantity has no value are omitted.
  std::vector<LocalModel> limit_models(const SearchBox& box, const std::vector<SearchPoint>& points) const {
    std::vector<LocalModel> models;
    for (std::size_t k = 0; k < limits(); ++k) {
      std::vector<FittedValue> values;
      for (const SearchPoint& point : points)
        if (const Estimate here = excess(point, k); std::isfinite(here.value))
          values.push_back({point.fractions, here});
      if (!values.empty()) models.emplace_back(box, values);
    }
    return models;
  }

  /// Moves `point` towards `from` until it is allowed. Returns the allowed point on this line that is nearest to
  /// `point`.
  /// \pre `from` is allowed
  SearchPoint pulled_back(const SearchPoint& from, const SearchPoint& point) const {
    if (function_.is_allowed(point)) return point;
    double good = 0.0;
    double bad = 1.0;
    SearchPoint nearest = from;
    for (int k = 0; k < 24; ++k) {
      const double middle = 0.5 * (good + bad);
      SearchPoint here = from;
      for (std::size_t i = 0; i < here.fractions.size(); ++i)
        here.fractions[i] = std::lerp(from.fractions[i], point.fractions[i], middle);
      const bool is_allowed = function_.is_allowed(here);
      (is_allowed ? good : bad) = middle;
      if (is_allowed) nearest = here;
    }
    return nearest;
  }

  /// Improves the continuous parameters of a point by fitting quadratic models repeatedly.
  void refine(const SearchPoint& start) {
    if (start.fractions.empty()) return;
    SearchPoint centre = best_peak(best_contender(start));
    const auto dimensions = static_cast<double>(centre.fractions.size());
    // With one continuous parameter, the first box contains the nearest points of the scan. With several parameters,
    // the scan points are farther apart, so a larger box is necessary.
    double radius =
        dimensions > 1.0 ? 0.5 * std::pow(settings_.spacing * 12.0, 1.0 / dimensions) : kFirstBox * settings_.spacing;
    int quiet = 0;
    for (std::size_t iteration = 0; iteration < settings_.max_iterations && radius > kSmallestBox; ++iteration) {
      const SearchBox box{centre.fractions, radius};
      fill(centre.combination, box);
      const std::vector<SearchPoint> points = points_in(centre.combination, box);
      const LocalModel model = objective_model(box, points);
      const auto found = model_maximum(box, model, limit_models(box, points), centre.fractions);
      const SearchPoint proposal = pulled_back(centre, found ? SearchPoint{centre.combination, *found} : centre);
      const double gain = model.at(proposal.fractions) - model.at(centre.fractions);
      proposals_.push_back(proposal);
      observe({proposal}, refinement_level());
      const SearchPoint before = centre;
      const double noise = mean_error(points);
      // A model that agrees with all points within their errors is more accurate than a single observation.
      const bool is_adequate = has_noise_ && model.deviation() < kAdequate;
      if (is_adequate) last_model_.emplace(AdequateModel{box, model, centre.combination});
      if (is_feasible(proposal)) {
        if (is_adequate || cautious_value(proposal) >= cautious_value(centre)) centre = proposal;
        const auto best = best_of(points);
        if (!is_adequate && best && cautious_value(*best) > cautious_value(centre)) centre = *best;
      } else if (const auto best = best_of(points); best && cautious_value(*best) > cautious_value(centre)) {
        centre = *best;
      }
      const double moved = distance(before, proposal);
      const double spread = range_of(model, box);
      quiet = std::abs(gain) < tolerance(centre) && (is_adequate || moved < 0.1 * radius) ? quiet + 1 : 0;
      if (quiet >= (is_adequate && iteration > 0 ? 1 : 2) || (iteration > 0 && spread < tolerance(centre))) break;
      // In a very small box, the errors would exceed all differences. The box therefore shrinks only while the
      // differences are larger than the errors.
      if ((moved < 0.7 * radius || centre == before) && spread > kBoxErrors * noise) radius *= has_noise_ ? 0.6 : 0.35;
    }
  }

  /// Returns the root mean square of the standard errors of the objective at several points.
  double mean_error(const std::vector<SearchPoint>& points) const {
    double squares = 0.0;
    for (const SearchPoint& point : points) squares += square(estimate(point)->std_error);
    return std::sqrt(squares / static_cast<double>(points.size()));
  }

  /// Returns the difference between the largest and the smallest value of a model at the centre of a box and on its
  /// axes.
  static double range_of(const LocalModel& model, const SearchBox& box) {
    double low = model.at(box.centre);
    double high = low;
    for (std::size_t k = 0; k < box.centre.size(); ++k)
      for (const double step : {-1.0, 1.0}) {
        std::vector<double> at = box.centre;
        at[k] = std::clamp(at[k] + step * box.radius, 0.0, 1.0);
        low = std::min(low, model.at(at));
        high = std::max(high, model.at(at));
      }
    return high - low;
  }

  /// Returns the smallest difference of the objective that the search takes into account.
  double tolerance(const SearchPoint& point) const {
    const Estimate here = *estimate(point);
    if (!has_noise_) return kSmallestGain * std::abs(here.value);
    // The tolerance is the error of an observation with ErrorLevel::scale 1. The larger error of the refinement would
    // end the search too early, because the last comparison resolves smaller differences.
    const double scale = known_.at(point).begin()->first.scale;
    return here.std_error / scale;
  }

  /// Observes again the scan points whose difference from `start` is within the errors, and returns the best point.
  /// `start` is the best scan point of its combination of discrete values.
  SearchPoint best_contender(const SearchPoint& start) {
    std::vector<SearchPoint> contenders;
    const Estimate best = *estimate(start);
    for (const SearchPoint& point : feasible_points()) {
      const Estimate here = *estimate(point);
      if (point.combination == start.combination &&
          best.value - here.value < kInterval * std::hypot(best.std_error, here.std_error))
        contenders.push_back(point);
    }
    std::ranges::stable_sort(contenders, [&](const SearchPoint& a, const SearchPoint& b) {
      return estimate(a)->value > estimate(b)->value;
    });
    if (contenders.size() > kMaxContenders) contenders.resize(kMaxContenders);
    observe(contenders, refinement_level());
    return best_of(contenders).value_or(start);
  }

  /// Observes points near `start` at which the objective may have a peak. Returns the best point, which may be `start`
  /// itself.
  SearchPoint best_peak(const SearchPoint& start) {
    std::vector<SearchPoint> peaks = function_.peaks_near(start, kPeakBox * settings_.spacing);
    std::erase_if(peaks, [&](const SearchPoint& peak) { return !function_.is_allowed(peak); });
    peaks = nearest_of(std::move(peaks), start);
    peaks.push_back(start);
    observe(peaks, refinement_level());
    return best_of(peaks).value_or(start);
  }

  /// Returns the points for the last comparison: the points with the best observed values, and the maximum of the last
  /// model.
  std::vector<SearchPoint> finalists() const {
    std::vector<SearchPoint> ranked = feasible_points();
    std::ranges::stable_sort(
        ranked, [&](const SearchPoint& a, const SearchPoint& b) { return cautious_value(a) > cautious_value(b); });
    std::vector<SearchPoint> chosen;
    const auto add = [&](const SearchPoint& point) {
      if (chosen.size() < settings_.max_finalists && is_feasible(point) && std::ranges::count(chosen, point) == 0)
        chosen.push_back(point);
    };
    if (!ranked.empty()) add(ranked.front());
    if (!has_noise_) return chosen;
    if (!proposals_.empty()) add(proposals_.back());
    for (const SearchPoint& point : ranked) {
      const Estimate best = *estimate(ranked.front());
      const Estimate here = *estimate(point);
      // Points that are significantly worse than the best point are omitted.
      if (best.value - here.value < kInterval * std::hypot(best.std_error, here.std_error)) add(point);
    }
    return chosen;
  }

  void observe_at_last(const std::vector<SearchPoint>& points) {
    if (!has_noise_) return observe(points, {settings_.scan_scale, 0});
    for (std::uint32_t replicate = 0; replicate < settings_.last_replicates; ++replicate)
      observe(points, {settings_.last_scale, replicate});
  }

  /// Observes points at the smallest error of the search. Returns the best point that satisfies all limits.
  std::optional<SearchPoint> compare(const std::vector<SearchPoint>& points) {
    observe_at_last(points);
    std::optional<SearchPoint> best;
    for (const SearchPoint& point : points)
      if (is_feasible(point) && (!best || estimate(point)->value > estimate(*best)->value)) best = point;
    if (best || points.empty()) return best;
    // None of the points satisfies the limits when it is observed with smaller errors. The next candidates are
    // therefore observed one by one.
    std::vector<SearchPoint> others = feasible_points();
    std::ranges::stable_sort(
        others, [&](const SearchPoint& a, const SearchPoint& b) { return cautious_value(a) > cautious_value(b); });
    for (const SearchPoint& other : others) {
      observe_at_last({other});
      if (is_feasible(other)) return other;
    }
    return std::nullopt;
  }

  Estimate difference(const SearchPoint& a, const SearchPoint& b) const {
    std::vector<Estimate> of_a;
    std::vector<Estimate> of_b;
    for (const Observation* const one : best_seen(a)) of_a.push_back(*one->objective);
    for (const Observation* const one : best_seen(b)) of_b.push_back(*one->objective);
    const std::size_t common = std::min(of_a.size(), of_b.size());
    of_a.resize(common);
    of_b.resize(common);
    return paired_difference(of_a, of_b);
  }

  /// Returns true if an accurate model predicts that a point is worse than `best` by more than the error.
  bool is_predicted_worse(const SearchPoint& point, const SearchPoint& best) const {
    if (!last_model_ || last_model_->combination != point.combination || !last_model_->box.contains(point.fractions) ||
        !last_model_->box.contains(best.fractions))
      return false;
    const double loss = last_model_->model.at(best.fractions) - last_model_->model.at(point.fractions);
    return loss > kInterval * std::sqrt(2.0) * estimate(best)->std_error;
  }

  /// Returns a point with fewer digits whose objective does not differ significantly from the objective of `best`.
  /// Returns `best` if there is no such point.
  SearchPoint rounded(const SearchPoint& best) {
    if (best.fractions.empty()) return best;
    std::size_t observed = 0;
    std::size_t compared = 0;
    for (const SearchPoint& point : function_.rounder_points(best, kRoundingBox * settings_.spacing)) {
      if (point == best) return best;
      if (!function_.is_allowed(point) || is_predicted_worse(point, best)) continue;
      if (observed++ == kMaxRounder) return best;
      observe({point}, refinement_level());
      if (!is_feasible(point)) continue;
      if (has_noise_) {
        const Estimate here = *estimate(point);
        const Estimate there = *estimate(best);
        if (there.value - here.value > kInterval * std::hypot(here.std_error, there.std_error)) continue;
      }
      if (has_noise_ && compared++ == kMaxCompared) return best;
      observe_at_last({point});
      if (!is_feasible(point)) continue;
      const Estimate loss = difference(best, point);
      const Estimate here = *estimate(best);
      const double allowed = has_noise_ ? std::max(kRoundingErrors * loss.std_error, 0.5 * here.std_error)
                                        : settings_.rounding_loss * std::abs(here.value);
      if (loss.value <= allowed) return point;
    }
    return best;
  }

  /// Returns the resolution of the result (NoisyOptimum::resolution).
  /// \param precise best point before rounding
  /// \param chosen best point after rounding
  double resolution(const SearchPoint& precise, const SearchPoint& chosen) const {
    if (!has_noise_) return 0.0;
    const Estimate here = *estimate(chosen);
    const double lost = precise == chosen ? 0.0 : std::max(0.0, difference(precise, chosen).value);
    return kInterval * std::sqrt(2.0) * here.std_error + lost;
  }

  SearchedFunction& function_;
  const NoisySearchSettings& settings_;
  /// Observations of each point, ordered by their accuracy. The most accurate observation comes first.
  std::map<SearchPoint, std::map<ErrorLevel, Observation>> known_;
  /// Model whose deviations from all points in a box are within the errors.
  struct AdequateModel {
    SearchBox box;
    LocalModel model;
    std::size_t combination = 0;
  };
  std::optional<AdequateModel> last_model_;
  std::vector<SearchPoint> proposals_;  ///< maxima of the fitted models, in the order of the search
  bool has_noise_ = false;
  std::size_t observations_ = 0;
};

}  // namespace

std::vector<SearchPoint> nearest_of(std::vector<SearchPoint> peaks, const SearchPoint& at) {
  std::ranges::stable_sort(
      peaks, [&](const SearchPoint& a, const SearchPoint& b) { return distance(a, at) < distance(b, at); });
  if (peaks.size() > kMaxPeaks) peaks.resize(kMaxPeaks);
  return peaks;
}

Estimate paired_difference(const std::vector<Estimate>& a, const std::vector<Estimate>& b) {
  const double count = static_cast<double>(a.size());
  double sum = 0.0;
  double unpaired = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    sum += a[k].value - b[k].value;
    unpaired += square(a[k].std_error) + square(b[k].std_error);
  }
  Estimate difference{sum / count, std::sqrt(unpaired) / count};
  if (a.size() < 3) return difference;
  double squares = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) squares += square(a[k].value - b[k].value - difference.value);
  // The standard deviation of a few differences is uncertain. Student's t distribution accounts for this uncertainty.
  const double student = boost::math::quantile(boost::math::students_t(count - 1.0), 0.975) / kInterval;
  const double paired = student * std::sqrt(squares / (count - 1.0) / count);
  // With common random numbers, a difference is at least as accurate as a difference between independent values.
  difference.std_error = std::min(difference.std_error, paired);
  return difference;
}

NoisyOptimum search_with_noise(SearchedFunction& function, const std::vector<std::vector<SearchPoint>>& scan,
                               const NoisySearchSettings& settings) {
  return NoisySearch(function, settings).run(scan);
}

}  // namespace retrace::studies
