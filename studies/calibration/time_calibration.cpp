#include "studies/calibration/time_calibration.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "compute/estimation/least_squares.h"
#include "core/error.h"
#include "core/number_format.h"

namespace retrace::studies {
namespace {

using Eigen::Index, Eigen::VectorXd;
using fabrication::Machine, fabrication::LinearAxis, fabrication::RotaryAxis;

constexpr auto kUnknowns = static_cast<Index>(kTimeQuantities);
constexpr auto at(TimeQuantity quantity) {
  return static_cast<Index>(quantity);
}

/// Standard uncertainties above which an unknown counts as undetermined. Settling and ramp are in s, and accelerations
/// are natural logarithms of their factors.
constexpr double kTooUncertain[kTimeQuantities] = {0.05, 0.7, 0.05, 0.7};
/// Length of the last step of the search, as a fraction of kTooUncertain.
constexpr double kLastTimeStep = 1e-7;
constexpr int kMaxTimeSteps = 60;
/// Ramps and acceleration factors at which searches start. Several starts are needed because the sum of squares is not
/// convex in these unknowns.
constexpr double kFirstRampsS[] = {0.0, 3e-3, 1e-2, 3e-2, 0.1};
constexpr double kFirstFactors[] = {0.5, 1.0, 2.0};
/// Deviation, in standard deviations, above which a row of the table causes a warning.
constexpr double kManyDeviations = 4.0;
/// Ramps below this time count as 0.
constexpr double kMinRampS = 1e-6;

/// Unknowns as multiples of kTooUncertain. For both acceleration factors, the unknown is the logarithm of the factor.
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

bool is_bounded(Index unknown) {
  return unknown == at(TimeQuantity::settling) || unknown == at(TimeQuantity::linear_ramp);
}

/// Returns the maximum value of an unknown in a calibrated machine: 10 s for settling and ramp, a factor of 100 for
/// accelerations.
double most(Index unknown) {
  return (is_bounded(unknown) ? 10.0 : std::log(100.0)) / kTooUncertain[unknown];
}

double value_of(const Unknowns& unknowns, TimeQuantity quantity) {
  const double amount = unknowns[at(quantity)] * kTooUncertain[at(quantity)];
  return is_bounded(at(quantity)) ? amount : std::exp(amount);
}

/// Returns the time in which an axis reaches its acceleration.
double ramp_s(const LinearAxis& axis) {
  return axis.acceleration_mm_per_s2.value / axis.jerk_mm_per_s3.value;
}

double longest_ramp_s(const Machine& machine) {
  return std::max({ramp_s(machine.x), ramp_s(machine.y), ramp_s(machine.z)});
}

/// Returns the unknowns for the values of a machine file. Both acceleration factors are 1.
Unknowns of_machine(const Machine& machine) {
  Unknowns unknowns = Unknowns::Zero();
  unknowns[at(TimeQuantity::settling)] = machine.settling_s.value / kTooUncertain[at(TimeQuantity::settling)];
  unknowns[at(TimeQuantity::linear_ramp)] = longest_ramp_s(machine) / kTooUncertain[at(TimeQuantity::linear_ramp)];
  return unknowns;
}

/// Returns the machine with the settling time, ramps and accelerations of the unknowns.
Machine with_times(Machine machine, const Unknowns& unknowns) {
  machine.settling_s.value = value_of(unknowns, TimeQuantity::settling);
  // The ratios between the ramps of the axes do not change. If the machine file has no jerks, all ramps are equal.
  const double longest_before = longest_ramp_s(machine);
  const double longest = value_of(unknowns, TimeQuantity::linear_ramp);
  for (LinearAxis* axis : {&machine.x, &machine.y, &machine.z}) {
    const double ramp = longest_before > 0.0 ? longest * ramp_s(*axis) / longest_before : longest;
    axis->acceleration_mm_per_s2.value *= value_of(unknowns, TimeQuantity::linear_acceleration);
    axis->jerk_mm_per_s3.value =
        ramp > kMinRampS ? axis->acceleration_mm_per_s2.value / ramp : std::numeric_limits<double>::infinity();
  }
  for (RotaryAxis* axis : {&machine.a, &machine.c}) {
    // Acceleration and jerk are scaled by the same factor, so that the ramp takes the same time.
    axis->acceleration_deg_per_s2.value *= value_of(unknowns, TimeQuantity::rotary_acceleration);
    axis->jerk_deg_per_s3.value *= value_of(unknowns, TimeQuantity::rotary_acceleration);
  }
  return machine;
}

/// Least-squares problem of the table's rows: residuals and derivatives, each divided by the standard uncertainty of
/// its row.
class Fit {
 public:
  Fit(const TimedPrograms& programs, const Machine& nominal) : programs_(programs), nominal_(nominal) {}

  VectorXd residual(const Unknowns& unknowns) const {
    const Machine machine = with_times(nominal_, unknowns);
    VectorXd left(static_cast<Index>(programs_.rows.size()));
    for (Index k = 0; k < left.size(); ++k) {
      const TimedMoves& row = programs_.rows[static_cast<std::size_t>(k)];
      left[k] = (row.seconds - row.predicted_s(machine)) / row.uncertainty_s;
    }
    return left;
  }

  Eigen::MatrixXd derivatives(const Unknowns& unknowns) const {
    constexpr double kDifference = 1e-5;
    Eigen::MatrixXd result(static_cast<Index>(programs_.rows.size()), kUnknowns);
    for (Index k = 0; k < kUnknowns; ++k) {
      Unknowns more = unknowns;
      Unknowns less = unknowns;
      more[k] += kDifference;
      if (!is_bounded(k) || less[k] >= kDifference) less[k] -= kDifference;
      result.col(k) = (residual(less) - residual(more)) / (more[k] - less[k]);
    }
    return result;
  }

  /// Returns the derivatives. The column of an unknown is 0 if the unknown is at its lower bound and would fall below
  /// it.
  Eigen::MatrixXd free_derivatives(const Unknowns& unknowns, const VectorXd& left) const {
    Eigen::MatrixXd result = derivatives(unknowns);
    for (Index k = 0; k < kUnknowns; ++k)
      if (is_bounded(k) && unknowns[k] <= 0.0 && result.col(k).dot(left) <= 0.0) result.col(k).setZero();
    return result;
  }

  /// Returns the local minimum near the given unknowns. Gauss-Newton steps are halved until they do not increase the
  /// sum of squares.
  Unknowns nearest(Unknowns unknowns) const {
    const Eigen::MatrixXd nothing(static_cast<Index>(programs_.rows.size()), 0);
    VectorXd left = residual(unknowns);
    for (int k = 0; k < kMaxTimeSteps; ++k) {
      const Unknowns step = compute::estimate(free_derivatives(unknowns, left), nothing, left, 1.0).value;
      double share = 1.0;
      Unknowns next;
      VectorXd next_left;
      do {
        next = unknowns + share * step;
        for (Index q = 0; q < kUnknowns; ++q) next[q] = std::clamp(next[q], is_bounded(q) ? 0.0 : -most(q), most(q));
        next_left = residual(next);
        share *= 0.5;
      } while (!(next_left.squaredNorm() <= left.squaredNorm()) && share > 1e-6);
      if (!(next_left.squaredNorm() <= left.squaredNorm())) return unknowns;
      const double moved = (next - unknowns).norm();
      unknowns = next;
      left = next_left;
      if (moved < kLastTimeStep) return unknowns;
    }
    return unknowns;
  }

  /// Returns the best local minimum of searches from several starts.
  Unknowns best() const {
    Unknowns found = nearest(of_machine(nominal_));
    for (const double ramp : kFirstRampsS)
      for (const double factor : kFirstFactors) {
        Unknowns start = of_machine(nominal_);
        start[at(TimeQuantity::linear_ramp)] = ramp / kTooUncertain[at(TimeQuantity::linear_ramp)];
        start[at(TimeQuantity::linear_acceleration)] =
            std::log(factor) / kTooUncertain[at(TimeQuantity::linear_acceleration)];
        const Unknowns other = nearest(start);
        // Accept only an improvement beyond rounding errors, so that undetermined unknowns keep the values of the
        // machine file.
        if (residual(other).squaredNorm() < residual(found).squaredNorm() * (1.0 - 1e-6) - 1e-9) found = other;
      }
    return found;
  }

 private:
  const TimedPrograms& programs_;
  const Machine& nominal_;
};

/// Records the calibrated values and their uncertainties in the texts that name the sources of the machine's values.
void tell_sources(TimeCalibration& result) {
  const auto tell = [&](auto& sourced, TimeQuantity quantity) {
    const CalibratedTime& found = result.quantities[static_cast<std::size_t>(quantity)];
    if (!found.is_observable) return;
    sourced.basis = fabrication::Basis::measured;
    sourced.source = fmt::format(
        "retrace calibrate {}: {} {:.4g} +- {:.2g}", std::filesystem::path(result.programs.file).filename().string(),
        kTimeQuantityWords[static_cast<std::size_t>(quantity)].key, found.value, found.uncertainty);
  };
  tell(result.machine.settling_s, TimeQuantity::settling);
  for (LinearAxis* axis : {&result.machine.x, &result.machine.y, &result.machine.z}) {
    tell(axis->acceleration_mm_per_s2, TimeQuantity::linear_acceleration);
    tell(axis->jerk_mm_per_s3, TimeQuantity::linear_ramp);
  }
  for (RotaryAxis* axis : {&result.machine.a, &result.machine.c})
    tell(axis->acceleration_deg_per_s2, TimeQuantity::rotary_acceleration);
}

/// Returns the groups of quantities that the times do not separate.
std::vector<std::string> unseparated_groups(const compute::LeastSquaresEstimate& fitted) {
  const Eigen::MatrixXd combinations = compute::reduced_combinations(fitted.unobservable);
  std::vector<std::string> words;
  for (Index k = 0; k < combinations.cols(); ++k) {
    std::string& keys = words.emplace_back();
    for (std::size_t q = 0; q < kTimeQuantities; ++q) {
      if (combinations(static_cast<Index>(q), k) == 0.0) continue;
      keys += keys.empty() ? "" : ", ";
      keys += kTimeQuantityWords[q].key;
    }
  }
  return words;
}

/// Adds a warning for each row that differs from the fit by more than kManyDeviations.
void warn_of_misses(TimeCalibration& result, const compute::LeastSquaresEstimate& fitted) {
  for (std::size_t k = 0; k < result.residuals.size(); ++k) {
    const auto row = static_cast<Index>(k);
    const double spare = 1.0 - fitted.leverage[row];
    // If no other row checks a row, the leverage of the row is 1 and its residual is usually 0. The residual is above 0
    // only if no machine within the bounds of the unknowns can take so long. In this case, the residual is not scaled.
    const double deviations = std::abs(result.residuals[k]) / (spare > 1e-6 ? std::sqrt(spare) : 1.0);
    if (deviations > kManyDeviations)
      result.warnings.push_back(
          {"outlier",
           fmt::format("line {}: {} s differs from the best fit of all rows by {} standard uncertainties",
                       result.programs.rows[k].line, shortest(result.programs.rows[k].seconds), fixed(deviations, 1))});
  }
}

}  // namespace

double TimedMoves::predicted_s(const Machine& machine) const {
  double sum_s = dwell_s;
  for (const RepeatedMove& alike : moves) {
    fabrication::ProgramTime time;
    time.add(machine, alike.motion);
    sum_s += static_cast<double>(alike.count) * time.total_s();
  }
  return sum_s;
}

TimeCalibration calibrate_times(TimedPrograms programs, const Machine& machine) {
  if (programs.rows.empty())
    throw InputError({programs.file, 0, ""}, "the table must contain at least one row with a time");
  TimeCalibration result;
  result.programs = std::move(programs);
  result.nominal = machine;
  const Fit fit(result.programs, result.nominal);
  const Unknowns found = fit.best();
  const VectorXd left = fit.residual(found);
  const Eigen::MatrixXd nothing(left.size(), 0);
  const compute::LeastSquaresEstimate fitted = compute::estimate(fit.derivatives(found), nothing, left, 1.0);
  result.residuals.assign(left.begin(), left.end());
  result.degrees_of_freedom =
      static_cast<std::size_t>(std::max(0L, std::lround(static_cast<double>(left.size()) - fitted.leverage.sum())));
  if (result.degrees_of_freedom > 0)
    result.scatter = std::sqrt(left.squaredNorm() / static_cast<double>(result.degrees_of_freedom));
  result.machine = with_times(result.nominal, found);
  for (std::size_t k = 0; k < kTimeQuantities; ++k) {
    const auto quantity = static_cast<TimeQuantity>(k);
    CalibratedTime& told = result.quantities[k];
    told.is_observable = fitted.is_observable(at(quantity));
    told.value = value_of(found, quantity);
    const double deviation = kTooUncertain[k] * std::sqrt(fitted.covariance(at(quantity), at(quantity)));
    told.uncertainty = deviation * std::max(1.0, result.scatter) * (is_bounded(at(quantity)) ? 1.0 : told.value);
  }
  result.unobservable = unseparated_groups(fitted);
  tell_sources(result);
  warn_of_misses(result, fitted);
  return result;
}

}  // namespace retrace::studies
