#include "studies/optimise/bands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/number_format.h"
#include "studies/optimise/evaluator.h"
#include "studies/optimise/noisy_search.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/quantity/study_names.h"

namespace retrace::studies {
namespace {

/// Returns the value of a key in a design; for a list, its first value. Returns nothing for a key without a value.
std::optional<double> nominal_of(const std::string& key, const design::Design& design) {
  const schema::Value value = design.document->value(key);
  if (const auto* const numbers = std::get_if<std::vector<double>>(&value)) return numbers->front();
  return design.document->number_if(key);
}

/// Returns the first step of the search for the end of a tolerance band. The step is so small that the objective hardly
/// changes. Its size depends on the unit at the end of the key's name.
double first_step(const std::string& key, double nominal) {
  if (key.ends_with("_arcmin") || key.ends_with("_um") || key.ends_with("_nm")) return 0.01;
  if (key.ends_with("_deg")) return 1e-4;
  return 1e-6 * std::max(1.0, std::abs(nominal));
}

/// Computes the first quantity of the objective for a design in which the value of one key is changed.
class OffDesign {
 public:
  /// \param level accuracy of the quantity; all values use common random numbers
  OffDesign(const Study& study, const OptimiseRequest& request, const Variant& best, const std::string& key,
            const ErrorLevel& level, const Cancellation* cancel)
      : study_(study), values_(best.values), key_(key), cancel_(cancel) {
    if (request.has_levels) study_.level = level;
    const auto& [name, weight] = request.objective.weights.front();
    sign_ = weight < 0.0 ? -1.0 : 1.0;
    quantity_ = quantity_named(study_, name);
    for (std::size_t k = 0; k < study.parameters.size(); ++k)
      if (std::find(study.parameters[k].keys.begin(), study.parameters[k].keys.end(), key) !=
          study.parameters[k].keys.end())
        parameter_ = k;
  }

  std::optional<double> nominal() const {
    if (parameter_) {
      const double* const number = std::get_if<double>(&values_[*parameter_].shown);
      return number != nullptr ? std::optional(*number) : std::nullopt;
    }
    return nominal_of(key_, make_candidate(study_, values_).design());
  }

  /// Returns the quantity, negated if it is minimized, so that larger is better. Returns nothing if the design with
  /// this value of the key is invalid.
  std::optional<double> at(double value) const {
    Study study = study_;
    PointValues values = values_;
    if (parameter_)
      values[*parameter_] = Parameter::value_of(value);
    else
      study.overrides.push_back(fmt::format("{}={}", key_, shortest(value)));
    try {
      const std::optional<Measured> measured = quantity_->measure(make_candidate(study, values), cancel_);
      if (!measured) throw Interrupted{};
      return measured->value ? std::optional(sign_ * *measured->value) : std::nullopt;
    } catch (const Error&) {
      return std::nullopt;
    }
  }

 private:
  Study study_;
  PointValues values_;
  const std::string& key_;
  const Cancellation* cancel_;
  double sign_ = 1.0;
  const Quantity* quantity_ = nullptr;
  std::optional<std::size_t> parameter_;
};

/// Returns the level of accuracy for the search of a band. Its error is small compared with the loss at the end of the
/// band. Errors that are smaller take more time and hardly change the band.
ErrorLevel level_of_band(const OptimiseRequest& request, const Variant& best) {
  // Maximum error of a value, relative to the loss at the end of the band.
  constexpr double max_error = 0.05;
  if (best.objective_error <= 0.0) return {};
  const double allowed = max_error * request.band_loss * std::abs(*best.objective);
  return {std::clamp(allowed / best.objective_error, 1.0, NoisySearchSettings{}.scan_scale), 0};
}

/// Returns the maximum change of the key in one direction for which the relative loss of the quantity stays below
/// `loss`. Returns nothing if designs become invalid before this loss is reached, or if the largest tested change
/// causes a smaller loss.
/// \param direction 1 for an increase of the value, -1 for a decrease
std::optional<double> band_to(const OffDesign& off, double nominal, double direction, double step, double loss) {
  constexpr int most_doublings = 40;
  constexpr int bisections = 30;
  const std::optional<double> whole = off.at(nominal);
  if (!whole) return std::nullopt;
  const auto is_lost = [&](double change) -> std::optional<bool> {
    const std::optional<double> value = off.at(nominal + direction * change);
    return value ? std::optional(*whole - *value >= loss * std::abs(*whole)) : std::nullopt;
  };
  double good = 0.0;
  double bad = step;
  for (int doubling = 0;; ++doubling, bad *= 2.0) {
    const std::optional<bool> lost = is_lost(bad);
    if (!lost || doubling == most_doublings) return std::nullopt;
    if (*lost) break;
    good = bad;
  }
  for (int k = 0; k < bisections && bad - good > 1e-4 * bad; ++k) {
    const double middle = 0.5 * (good + bad);
    (is_lost(middle).value_or(true) ? bad : good) = middle;
  }
  return good;
}

}  // namespace

ToleranceBand tolerance_band(const Study& study, const OptimiseRequest& request, const Variant& best,
                             const std::string& key, const Cancellation* cancel) {
  const OffDesign off(study, request, best, key, level_of_band(request, best), cancel);
  ToleranceBand band{key, 0.0, {}, {}};
  const std::optional<double> nominal = off.nominal();
  if (!nominal) return band;
  band.nominal = *nominal;
  const double step = first_step(key, *nominal);
  band.down = band_to(off, *nominal, -1.0, step, request.band_loss);
  band.up = band_to(off, *nominal, 1.0, step, request.band_loss);
  return band;
}

}  // namespace retrace::studies
