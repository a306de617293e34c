#include "compute/estimation/sample_statistics.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

#include "core/random.h"

namespace retrace::compute {
namespace {

/// Identifier of the random-number stream for resampling. No other file uses it.
constexpr std::uint32_t kResample = 0x53776510U;
constexpr std::size_t kResamples = 1000;
/// Maximum number of groups of rows for resampling. If there are more rows, neighbouring rows form groups.
constexpr std::size_t kMaxGroups = 500;

/// Sums over rows (SaltelliRow) from which the indices are computed. The overall mean is subtracted from all values a
/// and b, which avoids cancellation.
struct Sums {
  double rows = 0.0;
  double values = 0.0;   ///< sum of all values a and b
  double squares = 0.0;  ///< sum of the squares of a and b
  double b = 0.0;
  std::vector<double> changes;          ///< for each parameter: sum of mixed - a
  std::vector<double> products;         ///< for each parameter: sum of b (mixed - a)
  std::vector<double> squared_changes;  ///< for each parameter: sum of (mixed - a)^2

  explicit Sums(std::size_t parameters) : changes(parameters), products(parameters), squared_changes(parameters) {}

  void add(const SaltelliRow& row, double centre) {
    const double a_value = row.a - centre;
    const double b_value = row.b - centre;
    rows += 1.0;
    values += a_value + b_value;
    squares += a_value * a_value + b_value * b_value;
    b += b_value;
    for (std::size_t k = 0; k < changes.size(); ++k) {
      const double change = row.mixed[k] - row.a;
      changes[k] += change;
      products[k] += b_value * change;
      squared_changes[k] += change * change;
    }
  }
  void add(const Sums& other) {
    rows += other.rows;
    values += other.values;
    squares += other.squares;
    b += other.b;
    for (std::size_t k = 0; k < changes.size(); ++k) {
      changes[k] += other.changes[k];
      products[k] += other.products[k];
      squared_changes[k] += other.squared_changes[k];
    }
  }

  double mean() const { return values / (2.0 * rows); }
  double variance() const { return std::max(0.0, squares / (2.0 * rows) - mean() * mean()); }
  /// \pre variance() > 0
  double first_order(std::size_t k) const { return (products[k] / rows - mean() * changes[k] / rows) / variance(); }
  double total(std::size_t k) const { return 0.5 * squared_changes[k] / rows / variance(); }
};

double centre_of(const std::vector<SaltelliRow>& rows) {
  double sum = 0.0;
  for (const SaltelliRow& row : rows) sum += row.a + row.b;
  return sum / (2.0 * static_cast<double>(rows.size()));
}

/// Returns the sums for groups of neighbouring rows.
std::vector<Sums> grouped(const std::vector<SaltelliRow>& rows, double centre) {
  const std::size_t groups = std::min(rows.size(), kMaxGroups);
  std::vector<Sums> sums(groups, Sums(rows.front().mixed.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) sums[k * groups / rows.size()].add(rows[k], centre);
  return sums;
}

IntervalEstimate interval_of(double value, std::vector<double>& resampled, double confidence) {
  std::sort(resampled.begin(), resampled.end());
  return {value, percentile(resampled, 0.5 * (1.0 - confidence)), percentile(resampled, 0.5 * (1.0 + confidence))};
}

}  // namespace

std::vector<SobolIndex> sobol_indices(const std::vector<SaltelliRow>& rows, double confidence, std::uint32_t seed) {
  if (rows.size() < 2) return {};
  const std::size_t parameters = rows.front().mixed.size();
  const std::vector<Sums> groups = grouped(rows, centre_of(rows));
  Sums all(parameters);
  for (const Sums& group : groups) all.add(group);
  if (!(all.variance() > 0.0)) return {};
  std::vector<std::vector<double>> first(parameters);
  std::vector<std::vector<double>> total(parameters);
  for (std::size_t sample = 0; sample < kResamples; ++sample) {
    Sums resampled(parameters);
    for (std::size_t k = 0; k < groups.size(); ++k) {
      const auto word = philox({seed, kResample}, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(sample))[0];
      resampled.add(groups[static_cast<std::size_t>(word) * groups.size() >> 32]);
    }
    if (!(resampled.variance() > 0.0)) continue;
    for (std::size_t k = 0; k < parameters; ++k) {
      first[k].push_back(resampled.first_order(k));
      total[k].push_back(resampled.total(k));
    }
  }
  std::vector<SobolIndex> indices;
  for (std::size_t k = 0; k < parameters; ++k)
    indices.push_back(
        {interval_of(all.first_order(k), first[k], confidence), interval_of(all.total(k), total[k], confidence)});
  return indices;
}

IntervalEstimate yield_of(std::size_t good, std::size_t parts, double confidence) {
  using Binomial = boost::math::binomial_distribution<double>;
  const auto n = static_cast<double>(parts);
  const auto k = static_cast<double>(good);
  const double tail = 0.5 * (1.0 - confidence);
  return {k / n, Binomial::find_lower_bound_on_p(n, k, tail), Binomial::find_upper_bound_on_p(n, k, tail)};
}

Spread spread_of(const std::vector<double>& values, double confidence) {
  const auto n = static_cast<double>(values.size());
  Spread spread;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  spread.min = *least;
  spread.max = *most;
  spread.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  spread.mean_interval = {spread.mean, spread.mean, spread.mean};
  if (values.size() < 2) return spread;
  double squares = 0.0;
  for (const double value : values) squares += (value - spread.mean) * (value - spread.mean);
  spread.deviation = std::sqrt(squares / (n - 1.0));
  const boost::math::students_t_distribution<double> student(n - 1.0);
  const double half = boost::math::quantile(student, 0.5 * (1.0 + confidence)) * spread.deviation / std::sqrt(n);
  spread.mean_interval = {spread.mean, spread.mean - half, spread.mean + half};
  return spread;
}

double percentile(const std::vector<double>& ascending, double fraction) {
  const double place = fraction * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 >= ascending.size()) return ascending.back();
  return ascending[below] + (place - static_cast<double>(below)) * (ascending[below + 1] - ascending[below]);
}

}  // namespace retrace::compute
