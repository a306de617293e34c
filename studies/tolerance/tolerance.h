#pragma once

// Spread and yield of quantities when parameters vary as manufacture lets them, and which parameters cause it. The
// study behind `retrace tolerance`.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "studies/quantity/constraint.h"
#include "studies/sweep/sweep.h"
#include "studies/tolerance/indices.h"

namespace retrace::studies {

/// What is asked of a tolerance study.
struct ToleranceRequest {
  std::uint64_t samples = 256;  ///< rows: with indices 2 parts each, and as many more points as there are parameters
  UnitSamples::Kind sampling = UnitSamples::Kind::sobol;
  bool indices = true;
  double confidence = 0.95;             ///< of all intervals
  std::optional<double> least_yield;    ///< below it the answer is no
  std::vector<Constraint> constraints;  ///< that a good part holds
};

/// The points of a tolerance study: the nominal part, all parameters at their medians, then row by row the parts A, and
/// with indices B and A with one parameter after the other from B.
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
  UnitSamples samples_;
};

/// A study with the points of its plan.
Sweep tolerance_sweep(Study study, const ToleranceRequest& request);

/// How one quantity comes out over the parts that are made.
struct QuantityTolerance {
  std::string quantity;
  std::optional<double> nominal;
  std::size_t parts = 0;    ///< that have a value
  std::size_t without = 0;  ///< that could not be computed, or have none
  std::optional<Spread> spread;
  std::vector<std::pair<double, double>> percentiles;  ///< share, value
  std::vector<SobolIndex> indices;  ///< by parameter; empty if they were not requested or do not exist
  std::size_t rows = 0;             ///< that they rest on
  /// Root mean square of the standard errors of the values over their deviation: what of the spread is noise.
  std::optional<double> noise;
  std::vector<double> values;  ///< ascending
};

/// The share of parts that hold a limit.
struct LimitYield {
  std::string text;  ///< of the limit
  Estimate yield;
};

struct ToleranceResult {
  std::vector<QuantityTolerance> quantities;
  std::optional<Estimate> yield;  ///< of parts that hold all limits; none without limits
  std::vector<LimitYield> limits;
  std::size_t parts = 0;   ///< that were made
  std::size_t failed = 0;  ///< of those that could not be computed: no good parts
  std::vector<std::string> warnings;
  bool is_enough = true;  ///< false: the yield is below the least that was requested
};

/// \param points of `sweep`, which tolerance_sweep() made for this request; may be incomplete
ToleranceResult analyse(const Sweep& sweep, const ToleranceRequest& request, const std::vector<StoredPoint>& points);

}  // namespace retrace::studies
