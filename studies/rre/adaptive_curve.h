#pragma once

// Chooses the angles at which a curve of RRE is computed, denser where it bends or has kinks.

#include <cstddef>
#include <map>
#include <vector>

namespace retrace::studies {

/// A value of a curve, with the standard error that sampling left in it.
struct CurveValue {
  double value = 0.0, std_error = 0.0;
};

/// A piece of the axis over which a curve is wanted.
struct CurveSpan {
  double low = 0.0, high = 0.0;
};

/// Chooses the places at which to find curves, in degrees, until straight lines between neighbours follow all of them.
///
/// It begins with the ends of the spans, 0, known kinks, and so many between that none are wider apart than
/// kWidestGapDeg. Then the middle between neighbours is looked at. One kink between them lies at most twice as far from
/// the straight line as the middle does, so that half the tolerance is allowed there, and twice the standard error of
/// the difference besides. Where it is farther off both halves are looked at in the same way, and once more where it is
/// not: a middle may lie on the line by chance. Gaps below kNarrowestGapDeg are not halved: slopes are infinite where
/// total reflection ends. Places are numbers of few decimals.
class AdaptiveCurve {
 public:
  static constexpr double kWidestGapDeg = 2.5;
  static constexpr double kNarrowestGapDeg = 0.01;
  static constexpr std::size_t kMostPlaces = 513;  ///< in a span

  /// \param kinks where they are known; those outside the spans do not matter
  /// \param fixed places that are looked at in any case, inside the spans or not
  /// \pre low < high
  AdaptiveCurve(std::vector<CurveSpan> spans, const std::vector<double>& kinks, const std::vector<double>& fixed,
                double tolerance);

  /// The places to look at next, ascending; empty if the curves are known. \pre those of the last call are added
  std::vector<double> next();
  /// Adds the value of one more curve at a place. \pre curves come in the same order at all places
  void add(double place, CurveValue value) { values_[place].push_back(value); }

  /// How far the worst straight line may miss when kMostPlaces ended the search; 0 if they did not.
  double worst_left() const { return 2.0 * worst_left_; }

 private:
  /// Between two places next to each other.
  struct Gap {
    double low = 0.0, high = 0.0;
    double miss = 0.0;                 ///< of the middle of the gap that it was cut from
    bool is_half_of_straight = false;  ///< that middle lay on the line
  };

  void begin(const CurveSpan& span, const std::vector<double>& kinks);
  double miss_of(const Gap& gap) const;
  /// Looks at the middles of these, as far as kMostPlaces allow the worst.
  void look_at(std::vector<Gap> gaps);

  double tolerance_ = 0.0;
  std::size_t most_places_ = 0;
  double worst_left_ = 0.0;
  std::map<double, std::vector<CurveValue>> values_;  ///< by place; empty where none was added yet
  std::vector<Gap> gaps_;                             ///< whose middles are looked at
  bool has_begun_ = false;
};

}  // namespace retrace::studies
