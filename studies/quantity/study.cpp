#include "studies/quantity/study.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "core/number_format.h"

namespace retrace::studies {
namespace {

double normal_quantile(const Distribution& d, double u) {
  const boost::math::normal_distribution<double> normal(d.mean, d.sigma);
  double low = 0.0;
  double high = 1.0;
  if (d.range) {
    low = boost::math::cdf(normal, d.range->from);
    high = boost::math::cdf(normal, d.range->to);
  }
  // The quantiles of exactly 0 and 1 would be infinite.
  constexpr double least = 1e-15;
  const double value = boost::math::quantile(normal, std::clamp(low + u * (high - low), least, 1.0 - least));
  return d.range ? std::clamp(value, d.range->from, d.range->to) : value;
}

double triangular_quantile(double from, double mode, double to, double u) {
  const double below = (mode - from) / (to - from);
  if (u < below) return from + std::sqrt(u * (to - from) * (mode - from));
  return to - std::sqrt((1.0 - u) * (to - from) * (to - mode));
}

}  // namespace

double Interval::at(double fraction) const {
  if (fraction <= 0.0) return from;
  if (fraction >= 1.0) return to;
  if (logarithmic) return from * std::pow(to / from, fraction);
  return from + fraction * (to - from);
}

double Distribution::quantile(double u) const {
  switch (kind) {
    case Kind::normal: return normal_quantile(*this, u);
    case Kind::uniform: return range->at(u);
    case Kind::triangular: break;
  }
  return triangular_quantile(range->from, mean, range->to, u);
}

ParameterValue Parameter::value_of(double number) {
  return {shortest(number), number};
}

PointValues example_values(const Study& study) {
  PointValues values;
  for (const Parameter& parameter : study.parameters) {
    if (!parameter.values.empty())
      values.push_back(parameter.values.front());
    else
      values.push_back(
          Parameter::value_of(parameter.interval ? parameter.interval->from : parameter.distribution->quantile(0.5)));
  }
  return values;
}

namespace {

/// Returns the value of a parameter that tables show as `shown`, or nothing if there is none. A number may lie outside
/// an interval by a rounding error.
std::optional<ParameterValue> value_of(const Parameter& parameter, const std::variant<double, std::string>& shown) {
  const auto found = std::ranges::find(parameter.values, shown, &ParameterValue::shown);
  if (found != parameter.values.end()) return *found;
  const double* const number = std::get_if<double>(&shown);
  if (number == nullptr || !parameter.interval) return std::nullopt;
  const Interval& interval = *parameter.interval;
  const double rounding = 1e-12 * std::max(std::abs(interval.from), std::abs(interval.to));
  if (!(*number >= interval.from - rounding && *number <= interval.to + rounding)) return std::nullopt;
  return Parameter::value_of(*number);
}

}  // namespace

std::optional<PointValues> values_of(const Study& study, const std::vector<std::variant<double, std::string>>& shown) {
  PointValues values;
  for (std::size_t k = 0; k < study.parameters.size() && k < shown.size(); ++k)
    if (std::optional<ParameterValue> value = value_of(study.parameters[k], shown[k]))
      values.push_back(*std::move(value));
  return values.size() == study.parameters.size() ? std::optional(values) : std::nullopt;
}

}  // namespace retrace::studies
