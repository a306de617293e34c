#pragma once

// Spread and yield of quantities when parameters vary in manufacture, and the contribution of each parameter to the
// spread. `retrace tolerance` runs this study.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compute/estimation/sample_statistics.h"
#include "core/warning.h"
#include "studies/quantity/constraint.h"
#include "studies/sweep/sweep.h"

namespace retrace::studies {

/// Request for a tolerance study.
struct ToleranceRequest {
  /// Number of rows; with Sobol indices, a row consists of 2 parts and of one more point for each parameter.
  std::uint64_t samples = 256;
  compute::UnitSamples::Kind sampling = compute::UnitSamples::Kind::sobol;
  bool indices = true;
  double confidence = 0.95;             ///< confidence level of all intervals
  std::optional<double> min_yield;      ///< minimum yield; below it, the study fails
  std::vector<Constraint> constraints;  ///< limits that a good part must satisfy
};

/// Points of a tolerance study. The first is the nominal part with all parameters at their medians. The rows follow. A
/// row begins with a random part A. If Sobol indices are requested, it also contains a random part B, and one point for
/// each parameter. Each of these points is equal to A except for its parameter, which has the value of B.
class TolerancePlan final : public PointPlan {
 public:
  /// \pre every parameter has a distribution
  TolerancePlan(const Study& study, const ToleranceRequest& request);

  std::uint64_t size() const override { return 1 + rows_ * points_of_row_; }
  PointValues values(std::uint64_t point) const override;

  std::uint64_t rows() const { return rows_; }

 private:
  Study study_;
  std::uint64_t rows_;
  std::uint64_t points_of_row_;
  std::size_t parameters_;
  compute::UnitSamples samples_;
};

/// Returns a sweep over the points of the plan.
Sweep tolerance_sweep(Study study, const ToleranceRequest& request);

/// Spread of one quantity over the parts.
struct QuantityTolerance {
  std::string quantity;
  std::optional<double> nominal;
  std::size_t parts = 0;          ///< number of parts with a value
  std::size_t missing_parts = 0;  ///< number of parts that could not be computed or have no value
  std::optional<compute::Spread> spread;
  /// Pairs of a fraction and of the value below which this fraction of the parts lies.
  std::vector<std::pair<double, double>> percentiles;
  /// Sobol indices, in the order of the parameters; empty if they were not requested or are not defined.
  std::vector<compute::SobolIndex> indices;
  std::size_t rows = 0;  ///< number of rows from which the indices were computed
  /// Root mean square of the values' standard errors, divided by their standard deviation. It shows how much of the
  /// spread is noise.
  std::optional<double> noise;
  std::vector<double> values;  ///< in ascending order
};

/// Fraction of the parts that satisfy a limit.
struct LimitYield {
  std::string text;  ///< text of the limit
  compute::IntervalEstimate yield;
};

struct ToleranceResult {
  std::vector<QuantityTolerance> quantities;
  std::optional<compute::IntervalEstimate> yield;  ///< fraction of parts that satisfy all limits; none without limits
  std::vector<LimitYield> limits;
  std::size_t parts = 0;   ///< number of manufactured parts
  std::size_t failed = 0;  ///< number of parts that could not be computed; they count as violating the limits
  Warnings warnings;
  bool is_enough = true;  ///< false: the yield is below the requested minimum
};

/// Computes the result of a tolerance study.
/// \param points points of `sweep`, which tolerance_sweep() has made for this request; may be incomplete
ToleranceResult analyse(const Sweep& sweep, const ToleranceRequest& request,
                        const std::vector<compute::StoredPoint>& points);

}  // namespace retrace::studies
