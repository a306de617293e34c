#include "core/math/derivative.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace retrace {
namespace {

constexpr int kRows = 12;
/// Minimum number of rows before the result is accepted; in fewer rows, entries may agree by chance.
constexpr int kMinRows = 4;
/// Relative error below which the extrapolation stops.
constexpr double kGoal = 1e-5;

/// Richardson extrapolation of difference quotients to step 0. The step is halved from row to row.
class Tableau {
 public:
  /// \param order 2 for central differences, whose error is a series in powers of step^2; 1 for one-sided differences,
  /// whose error is a series in powers of step
  explicit Tableau(int order) : ratio_(order == 2 ? 4.0 : 2.0) {}

  void add(const Sample& quotient) {
    std::vector<Sample> row = {quotient};
    if (!last_.empty()) offer(row[0], std::abs(quotient.value - last_[0].value));
    double power = ratio_;
    for (const Sample& before : last_) {
      const Sample from = row.back();
      const Sample next = {from.value + (from.value - before.value) / (power - 1.0),
                           (power * from.noise + before.noise) / (power - 1.0)};
      offer(next, std::max(std::abs(next.value - from.value), std::abs(next.value - before.value)));
      row.push_back(next);
      power *= ratio_;
    }
    last_ = std::move(row);
  }

  const Derivative& best() const { return best_; }

 private:
  void offer(const Sample& entry, double difference) {
    const double error = difference + entry.noise;
    if (error < best_.error) best_ = {entry.value, error, entry.noise};
  }

  double ratio_;
  std::vector<Sample> last_;
  Derivative best_;
};

Sample quotient_of(const Sample& from, const Sample& to, double distance) {
  return {(to.value - from.value) / distance, (to.noise + from.noise) / std::abs(distance)};
}

/// Central and one-sided differences that are computed from the same samples.
class BothSides {
 public:
  explicit BothSides(const Sample& middle) : middle_(middle) {}

  void add(const Sample& below, const Sample& above, double step) {
    central_.add(quotient_of(below, above, 2.0 * step));
    above_.add(quotient_of(middle_, above, step));
    below_.add(quotient_of(middle_, below, -step));
  }

  Derivative best() const {
    Derivative best = central_.best();
    const Derivative& above = above_.best();
    const Derivative& below = below_.best();
    // At a kink, central differences converge to the mean of the left and the right slope. This mean is not a
    // derivative.
    const double apart = std::abs(above.value - below.value) - above.error - below.error;
    if (apart > 0.0) best.error = std::max(best.error, 0.5 * apart);
    return best;
  }

 private:
  Sample middle_;
  Tableau central_{2};
  Tableau above_{1};
  Tableau below_{1};
};

class OneSide {
 public:
  explicit OneSide(const Sample& edge) : edge_(edge) {}
  void add(const Sample& inside, double signed_step) { differences_.add(quotient_of(edge_, inside, signed_step)); }
  Derivative best() const { return differences_.best(); }

 private:
  Sample edge_;
  Tableau differences_{1};
};

/// Decides when smaller steps cannot improve the result.
class Patience {
 public:
  /// \param noise bound on the noise of the next difference quotient
  bool ends_after(int row, const Derivative& best, double noise) {
    constexpr int kIdleRows = 2;
    idle_rows_ = best.error > 0.5 * error_ ? idle_rows_ + 1 : 0;
    error_ = best.error;
    if (row < kMinRows) return false;
    return best.error <= kGoal * std::abs(best.value) || noise > best.error ||
           (best.converged() && idle_rows_ >= kIdleRows);
  }

 private:
  double error_ = std::numeric_limits<double>::infinity();
  int idle_rows_ = 0;
};

template <typename Differences, typename Add>
Derivative extrapolate(Differences differences, double step, double noise, const Add& add) {
  Patience patience;
  for (int row = 1; row <= kRows; ++row, step *= 0.5) {
    add(differences, step);
    if (patience.ends_after(row, differences.best(), noise / (0.5 * step))) break;
  }
  return differences.best();
}

}  // namespace

Derivative differentiate(const std::function<Sample(double)>& f, double x, const DifferenceRange& range) {
  // Minimum distance from x to the nearer end of the range, relative to the first step, for central differences. If x
  // is closer to this end, one-sided differences into the other direction are more accurate.
  constexpr double kNarrow = 1.0 / 8.0;
  const double room_below = x - range.lower;
  const double room_above = range.upper - x;
  const double narrower = std::min(room_below, room_above);
  const double wider = std::max(room_below, room_above);
  if (!(wider > 0.0)) return {};
  const Sample middle = f(x);
  if (narrower >= kNarrow * range.first_step)
    return extrapolate(BothSides(middle), std::min(range.first_step, narrower), middle.noise,
                       [&](BothSides& sides, double step) { sides.add(f(x - step), f(x + step), step); });
  const double sign = room_above > room_below ? 1.0 : -1.0;
  return extrapolate(OneSide(middle), std::min(range.first_step, wider), middle.noise,
                     [&](OneSide& side, double step) { side.add(f(x + sign * step), sign * step); });
}

}  // namespace retrace
