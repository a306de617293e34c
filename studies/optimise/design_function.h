#pragma once

// Maps the designs of a study to the points of a search. Internal to studies/optimise.

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "studies/optimise/evaluator.h"
#include "studies/optimise/searched_function.h"
#include "studies/optimise/whole_sizes.h"

namespace retrace::studies {

/// Designs of the first scan. Also converts between designs and positions in the intervals of their parameters.
class Scan {
 public:
  /// \throw InputError for too many combinations of discrete values
  Scan(const Study& study, const OptimiseRequest& request);

  /// Returns the indices of the parameters that vary continuously between two limits.
  const std::vector<std::size_t>& continuous() const { return continuous_; }
  /// Returns all combinations of discrete values. Continuous parameters are set to the middle of their intervals.
  const std::vector<PointValues>& combinations() const { return combinations_; }
  /// Replaces the values of the continuous parameters of a design and returns the new design.
  /// \param fractions positions in the intervals
  PointValues with(PointValues design, const std::vector<double>& fractions) const;
  /// Returns the positions of the continuous parameters of a design in their intervals.
  std::vector<double> fractions_of(const PointValues& design) const;
  /// Returns the designs of the scan for one combination of discrete values, without duplicates. For one continuous
  /// parameter, the designs are equally spaced. For several continuous parameters, the designs are the corners of the
  /// intervals and Sobol points. Sizes of prisms are moved by up to half a step of the scan if a whole number of
  /// elements then fills the part.
  std::vector<PointValues> of(std::size_t combination) const;
  /// Returns the distance between neighbouring points of the scan, as a fraction of the interval.
  double spacing() const { return 1.0 / static_cast<double>(request_.scan - 1); }
  /// Returns the sizes for which a whole number of elements fills the part. `k` is the index of the parameter in
  /// continuous().
  const WholeSizes& whole_sizes(std::size_t combination, std::size_t k) const;

 private:
  std::vector<double> at_whole_sizes(std::size_t combination, std::vector<double> fractions) const;

  const Study& study_;
  const OptimiseRequest& request_;
  std::vector<std::size_t> continuous_;
  std::vector<PointValues> combinations_;
  mutable std::map<std::size_t, std::vector<WholeSizes>> whole_sizes_;
};

/// Returns true if quantities of the study may have random errors. The decision uses the engine and the first design of
/// the study.
bool may_be_noisy(const Study& study);

/// The objective and the constraints of a study as a function that search_with_noise() maximizes.
class DesignFunction final : public SearchedFunction {
 public:
  DesignFunction(const Study& study, const OptimiseRequest& request, const Scan& scan, Evaluator& evaluator)
      : study_(study), request_(request), scan_(scan), evaluator_(evaluator) {}

  PointValues design_at(const SearchPoint& point) const {
    return scan_.with(scan_.combinations()[point.combination], point.fractions);
  }

  std::vector<Observation> observe(const std::vector<SearchPoint>& points, const ErrorLevel& level) override;
  bool is_allowed(const SearchPoint& point) const override;
  std::vector<SearchPoint> peaks_near(const SearchPoint& point, double within) const override;
  std::vector<SearchPoint> rounder_points(const SearchPoint& point, double within) const override;

 private:
  const Study& study_;
  const OptimiseRequest& request_;
  const Scan& scan_;
  Evaluator& evaluator_;
  mutable std::map<SearchPoint, bool> allowed_;
};

}  // namespace retrace::studies
