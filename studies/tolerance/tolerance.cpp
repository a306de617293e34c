#include "studies/tolerance/tolerance.h"
#include "studies/quantity/study_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

namespace retrace::studies {
namespace {

constexpr std::array kPercentiles = {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99};
constexpr double kMuchNoise = 0.3;

}  // namespace

TolerancePlan::TolerancePlan(const Study& study, const ToleranceRequest& request)
    : study_(study),
      rows_(request.samples),
      points_of_row_(request.indices ? study.parameters.size() + 2 : 1),
      parameters_(study.parameters.size()),
      samples_(request.sampling, (request.indices ? 2 : 1) * parameters_, rows_, study.seed) {}

PointValues TolerancePlan::values(std::uint64_t point) const {
  if (point == 0) return values_at(study_, std::vector<double>(parameters_, 0.5));
  const std::uint64_t row = (point - 1) / points_of_row_;
  const std::uint64_t place = (point - 1) % points_of_row_;
  const std::vector<double> both = samples_.at(row);
  const auto half = both.begin() + static_cast<std::ptrdiff_t>(parameters_);
  if (place == 1) return values_at(study_, {half, both.end()});
  std::vector<double> shares(both.begin(), half);
  if (place >= 2) shares[place - 2] = both[parameters_ + place - 2];
  return values_at(study_, shares);
}

Sweep tolerance_sweep(Study study, const ToleranceRequest& request) {
  auto plan = std::make_shared<const TolerancePlan>(study, request);
  return {std::move(study), "retrace.tolerance/1", std::move(plan)};
}

namespace {

/// Finished points of the plan (TolerancePlan), indexed by row and position in the row. Null for points that are not
/// finished.
class Finished {
 public:
  Finished(const Sweep& sweep, const ToleranceRequest& request, const std::vector<compute::StoredPoint>& points)
      : rows_(request.samples),
        parameters_(sweep.study().parameters.size()),
        points_of_row_(request.indices ? parameters_ + 2 : 1),
        points_(sweep.size(), nullptr) {
    for (const compute::StoredPoint& point : points)
      if (point.point < points_.size()) points_[point.point] = &point;
  }

  const compute::StoredPoint* nominal() const { return points_[0]; }
  std::uint64_t rows() const { return rows_; }
  std::size_t parameters() const { return parameters_; }
  const compute::StoredPoint* at(std::uint64_t row, std::uint64_t place) const {
    return points_[1 + row * points_of_row_ + place];
  }
  /// Returns the points that represent manufactured parts: the points A and, with indices, also the points B.
  std::vector<const compute::StoredPoint*> parts() const {
    std::vector<const compute::StoredPoint*> parts;
    for (std::uint64_t place = 0; place < std::min<std::uint64_t>(2, points_of_row_); ++place)
      for (std::uint64_t row = 0; row < rows_; ++row)
        if (at(row, place) != nullptr) parts.push_back(at(row, place));
    return parts;
  }

 private:
  std::uint64_t rows_;
  std::size_t parameters_;
  std::uint64_t points_of_row_;
  std::vector<const compute::StoredPoint*> points_;
};

std::optional<double> value_of(const compute::StoredPoint* point, std::size_t quantity) {
  if (point == nullptr || point->failed) return std::nullopt;
  return point->outputs.at(quantity).value;
}

/// Returns the values of a row, or nothing if one of its points has no value.
std::optional<compute::SaltelliRow> row_of(const Finished& finished, std::uint64_t row, std::size_t quantity) {
  const auto a = value_of(finished.at(row, 0), quantity);
  const auto b = value_of(finished.at(row, 1), quantity);
  if (!a || !b) return std::nullopt;
  compute::SaltelliRow values{*a, *b, {}};
  for (std::size_t k = 0; k < finished.parameters(); ++k) {
    const auto mixed = value_of(finished.at(row, 2 + k), quantity);
    if (!mixed) return std::nullopt;
    values.mixed.push_back(*mixed);
  }
  return values;
}

void add_indices(const Finished& finished, std::size_t quantity, const ToleranceRequest& request, std::uint32_t seed,
                 QuantityTolerance& result) {
  std::vector<compute::SaltelliRow> rows;
  for (std::uint64_t row = 0; row < finished.rows(); ++row)
    if (auto values = row_of(finished, row, quantity)) rows.push_back(std::move(*values));
  result.rows = rows.size();
  result.indices = compute::sobol_indices(rows, request.confidence, seed);
}

QuantityTolerance tolerance_of(const Sweep& sweep, const Finished& finished, const ToleranceRequest& request,
                               std::size_t quantity) {
  QuantityTolerance result;
  result.quantity = sweep.study().quantities[quantity]->name();
  result.nominal = value_of(finished.nominal(), quantity);
  double squared_errors = 0.0;
  for (const compute::StoredPoint* const part : finished.parts()) {
    const std::optional<double> value = value_of(part, quantity);
    if (!value) {
      ++result.missing_parts;
      continue;
    }
    result.values.push_back(*value);
    squared_errors += std::pow(part->outputs[quantity].std_error, 2);
  }
  result.parts = result.values.size();
  if (result.values.empty()) return result;
  result.spread = compute::spread_of(result.values, request.confidence);
  if (result.spread->deviation > 0.0)
    result.noise = std::sqrt(squared_errors / static_cast<double>(result.parts)) / result.spread->deviation;
  std::sort(result.values.begin(), result.values.end());
  for (const double share : kPercentiles)
    result.percentiles.emplace_back(share, compute::percentile(result.values, share));
  if (request.indices) add_indices(finished, quantity, request, sweep.study().seed, result);
  return result;
}

/// Returns true if a part satisfies a limit. A missing value violates every limit.
bool holds(const Sweep& sweep, const compute::StoredPoint& part, const Constraint& limit) {
  const std::optional<std::size_t> k = quantity_index(sweep.study(), limit.quantity);
  return k && limit.violation(value_of(&part, *k)) <= 0.0;
}

void add_yields(const Sweep& sweep, const Finished& finished, const ToleranceRequest& request,
                ToleranceResult& result) {
  const std::vector<const compute::StoredPoint*> parts = finished.parts();
  if (request.constraints.empty() || parts.empty()) return;
  const auto count = [&](const auto& is_good) {
    return static_cast<std::size_t>(std::count_if(parts.begin(), parts.end(), is_good));
  };
  const std::size_t good = count([&](const compute::StoredPoint* part) {
    return std::all_of(request.constraints.begin(), request.constraints.end(),
                       [&](const Constraint& limit) { return holds(sweep, *part, limit); });
  });
  result.yield = compute::yield_of(good, parts.size(), request.confidence);
  result.is_enough = !request.min_yield || result.yield->value >= *request.min_yield;
  for (const Constraint& limit : request.constraints)
    result.limits.push_back({limit.text(), compute::yield_of(count([&](const compute::StoredPoint* part) {
                                                               return holds(sweep, *part, limit);
                                                             }),
                                                             parts.size(), request.confidence)});
}

void add_warnings(const ToleranceRequest& request, ToleranceResult& result) {
  for (const QuantityTolerance& quantity : result.quantities) {
    if (quantity.missing_parts > 0)
      result.warnings.push_back(
          {"parts_without_value", fmt::format("{}: {} of {} parts have no value and are left out of its spread",
                                              quantity.quantity, quantity.missing_parts, result.parts)});
    if (quantity.noise && *quantity.noise > kMuchNoise)
      result.warnings.push_back(
          {"noisy_values", fmt::format("{}: the standard error of the values is {:.2g} of their standard deviation, so "
                                       "that part of the spread is noise: give a smaller analysis.target_error",
                                       quantity.quantity, *quantity.noise)});
    if (request.indices && quantity.rows > 1 && quantity.indices.empty())
      result.warnings.push_back(
          {"no_variation",
           fmt::format("{}: the Sobol indices are undefined, because this quantity does not vary", quantity.quantity)});
  }
}

}  // namespace

ToleranceResult analyse(const Sweep& sweep, const ToleranceRequest& request,
                        const std::vector<compute::StoredPoint>& points) {
  const Finished finished(sweep, request, points);
  ToleranceResult result;
  const std::vector<const compute::StoredPoint*> parts = finished.parts();
  result.parts = parts.size();
  result.failed = static_cast<std::size_t>(
      std::count_if(parts.begin(), parts.end(), [](const compute::StoredPoint* part) { return part->failed; }));
  for (std::size_t k = 0; k < sweep.study().quantities.size(); ++k)
    result.quantities.push_back(tolerance_of(sweep, finished, request, k));
  add_yields(sweep, finished, request, result);
  add_warnings(request, result);
  return result;
}

}  // namespace retrace::studies
