#pragma once

// Converts between the designs of a study and the points of a search. Internal to studies/optimise.

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "studies/optimise/evaluator.h"
#include "studies/optimise/searched_function.h"
#include "studies/optimise/whole_sizes.h"

namespace retrace::studies {

/// Designs that an optimization evaluates first: all combinations of discrete values, each with a set of continuous
/// values. Also converts continuous values to positions in their intervals and back.
class Scan {
 public:
  /// \throw InputError if there are too many combinations of discrete values
  Scan(const Study& study, const OptimiseRequest& request);

  /// Returns the indices of the parameters that vary continuously between two limits.
  const std::vector<std::size_t>& continuous() const { return continuous_; }
  /// Returns all combinations of discrete values. Continuous parameters have the values in the middle of their
  /// intervals.
  const std::vector<PointValues>& combinations() const { return combinations_; }
  /// Returns a copy of a design with other values of the continuous parameters.
  /// \param fractions position of each value in the interval of its parameter: 0 at the start, 1 at the end
  PointValues with(PointValues design, const std::vector<double>& fractions) const;
  /// Returns the position of each continuous parameter of a design in its interval: 0 at the start, 1 at the end.
  std::vector<double> fractions_of(const PointValues& design) const;
  /// Returns the designs of the scan for one combination of discrete values, without duplicates. A single continuous
  /// parameter is sampled at equal steps. Several continuous parameters are sampled at the corners of their intervals
  /// and at Sobol points. Sizes of prisms are then moved by up to half a step to a size with which a whole number of
  /// elements fills the part.
  std::vector<PointValues> of(std::size_t combination) const;
  /// Returns the distance between neighbouring designs of the scan, as a fraction of the interval.
  double spacing() const { return 1.0 / static_cast<double>(request_.scan - 1); }
  /// Returns the sizes with which a whole number of elements fills the part, for one combination of discrete values.
  /// \param k index of the parameter in continuous()
  const WholeSizes& whole_sizes(std::size_t combination, std::size_t k) const;

 private:
  std::vector<double> at_whole_sizes(std::size_t combination, std::vector<double> fractions) const;

  const Study& study_;
  const OptimiseRequest& request_;
  std::vector<std::size_t> continuous_;
  std::vector<PointValues> combinations_;
  mutable std::map<std::size_t, std::vector<WholeSizes>> whole_sizes_;
};

/// Returns true if quantities of the study may have random errors, judged from the engine and the first design of the
/// study.
bool may_be_noisy(const Study& study);

/// Objective and constraints of a study, as a function that search_with_noise() maximizes.
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
