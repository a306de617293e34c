#pragma once

// Selects the angles at which a curve of RRE is computed. The angles are closer together where the curve bends or has
// kinks.

#include <cstddef>
#include <map>
#include <vector>

namespace retrace::studies {

/// Value of a curve, with its standard error of sampling.
struct CurveValue {
  double value = 0.0, std_error = 0.0;
};

/// Interval over which a curve is computed.
struct CurveSpan {
  double low = 0.0, high = 0.0;
};

/// Selects the points at which curves are computed, in degrees, until linear interpolation between neighbours is
/// accurate for all curves.
///
/// The search begins with the ends of the spans, 0, known kinks, and further points such that no gap is wider than
/// kMaxGapDeg. Then it adds the centre of each gap. A kink in a gap causes at most twice the error that is found at
/// the centre. Therefore, the allowed error at the centre is half the tolerance, plus twice the standard error of the
/// difference.
/// If the error is larger, both halves of the gap are checked in the same manner. If it is smaller, both halves are
/// checked one more time, because the centre may be accurate by chance. Gaps below kMinGapDeg are not divided,
/// because slopes are infinite where total reflection ends. Points are numbers with few decimals.
class AdaptiveCurve {
 public:
  static constexpr double kMaxGapDeg = 2.5;
  static constexpr double kMinGapDeg = 0.01;
  static constexpr std::size_t kMaxPoints = 513;  ///< maximum number of points in a span

  /// \param kinks known kinks; those outside the spans are ignored
  /// \param fixed points that are computed in any case, even outside the spans
  /// \pre low < high
  AdaptiveCurve(std::vector<CurveSpan> spans, const std::vector<double>& kinks, const std::vector<double>& fixed,
                double tolerance);

  /// Returns the next points to compute, in ascending order. Empty if the curves are accurate.
  /// \pre values for all points of the last call were added
  std::vector<double> next();
  /// Adds the value of one more curve at a point.
  /// \pre the order of the curves is the same at all points
  void add(double angle_deg, CurveValue value) { values_[angle_deg].push_back(value); }

  /// Returns the maximum error of linear interpolation if the search ended because of kMaxPoints. Otherwise returns 0.
  double residual_error() const { return 2.0 * residual_error_; }

 private:
  /// Gap between two neighbouring points.
  struct Gap {
    double low = 0.0, high = 0.0;
    /// Interpolation error at the centre of the wider gap that was divided into this gap and its neighbour.
    double interpolation_error = 0.0;
    bool parent_passed = false;  ///< `interpolation_error` was within the allowed error
  };

  void begin(const CurveSpan& span, const std::vector<double>& kinks);
  double interpolation_error_of(const Gap& gap) const;
  /// Starts to check gaps: adds their centres as points. If kMaxPoints does not allow all, those with the largest
  /// errors are added.
  void check_gaps(std::vector<Gap> gaps);

  double tolerance_ = 0.0;
  std::size_t max_points_ = 0;
  double residual_error_ = 0.0;
  std::map<double, std::vector<CurveValue>> values_;  ///< values by point; empty if none was added yet
  std::vector<Gap> gaps_;                             ///< gaps whose centres are being computed
  bool has_begun_ = false;
};

}  // namespace retrace::studies
