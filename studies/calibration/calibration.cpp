#include "studies/calibration/calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/QR>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <random>
#include <set>
#include <utility>

#include "core/error.h"
#include "studies/calibration/linear_model.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using Eigen::Index, Eigen::VectorXd;

/// Maximum length of the last Gauss-Newton step. Its unit is the standard uncertainty of the observable combinations,
/// which are the combinations of set-up errors that the measurements determine.
constexpr double kLastStep = 1e-3;
constexpr int kMaxSteps = 20;
/// Probability that a calibration with correct measurements rejects one of them as an outlier.
constexpr double kFalseAlarm = 0.01;
/// Maximum fraction of the measurements that may be outliers.
constexpr double kMaxOutlierFraction = 0.1;
/// Assumed standard deviations of the unobservable combinations. They are typical of axes that are set with dial gauges
/// and of tools that are set under a microscope.
constexpr double kUnobservableArcsec = 50.0;
constexpr double kUnobservableUm = 2.0;
/// Leverage above which no other measurement can check a measurement, because an unknown is determined by this
/// measurement only.
constexpr double kUnchecked = 1.0 - 1e-9;

void check(const MeasuredParts& measured, const std::vector<CutPart>& parts) {
  for (const Measurement& m : measured.measurements)
    if (const std::string fault = parts[m.part].obstacle_for(m); !fault.empty())
      throw InputError({measured.file, m.line, ""}, fault);
}

/// Returns the covariance of the observable combinations that is due to the unobservable ones. Unobservable errors
/// change the measurements by terms of second order: products of two unobservable errors, or of an unobservable and an
/// observable error. The covariance is the mean over random machines with the assumed deviations kUnobservableArcsec
/// and kUnobservableUm.
Eigen::MatrixXd covariance_of_unobservable(const std::vector<CutPart>& parts, const MeasuredParts& measured,
                                           const compute::LeastSquaresEstimate& fitted,
                                           const compute::LeastSquaresEstimate& first,
                                           const std::vector<PartPose>& poses) {
  constexpr int kMachines = 64;
  const auto quantities = setup_quantities(measured.plans.front().machine.tilt);
  const Machine& nominal = measured.plans.front().machine;
  const auto machine = [&](const VectorXd& errors) {
    return with_errors(nominal, {errors.data(), static_cast<std::size_t>(errors.size())});
  };
  const LinearModel model = with_pose_priors(
      linear_model(parts, measured.measurements, machine(fitted.value), measured.map_faces, poses), poses);
  const VectorXd now = residual_of(parts, measured.measurements, machine(fitted.value), measured.map_faces, poses);
  std::mt19937_64 bits(1);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(first.observable.cols(), first.observable.cols());
  for (int k = 0; k < kMachines; ++k) {
    VectorXd errors(first.unobservable.rows());
    for (Index q = 0; q < errors.size(); ++q)
      errors[q] =
          normal(bits) * (quantities[static_cast<std::size_t>(q)].is_angle() ? kUnobservableArcsec : kUnobservableUm);
    const VectorXd untold = first.unobservable * (first.unobservable.transpose() * errors);
    VectorXd change = VectorXd::Zero(model.residual.size());
    change.head(now.size()) =
        now - residual_of(parts, measured.measurements, machine(fitted.value + untold), measured.map_faces, poses);
    const VectorXd moved = compute::estimate(model.setup_jacobian * first.observable, model.pose_jacobian, change,
                                             2.0 * kMaxObservableUncertainty)
                               .value;
    spread += moved * moved.transpose() / kMachines;
  }
  return first.observable * spread * first.observable.transpose();
}

/// Estimates the observable combinations by Gauss-Newton steps, which start at the nominal machine. Unobservable
/// combinations are not varied. They change the measurements only by second-order terms, and these must not be mistaken
/// for observations. The poses of the parts are estimated as well, because they can be as large as the errors of the
/// machine. Measurements from height maps depend on products of poses and errors.
compute::LeastSquaresEstimate fit(const std::vector<CutPart>& parts, const MeasuredParts& measured) {
  const Machine& nominal = measured.plans.front().machine;
  std::vector<PartPose> poses(parts.size());
  LinearModel model = linear_model(parts, measured.measurements, nominal, measured.map_faces, poses);
  // Observability is determined from the measurements only, before the priors on the poses are added.
  compute::LeastSquaresEstimate result =
      compute::estimate(model.setup_jacobian, model.pose_jacobian, model.residual, kMaxObservableUncertainty);
  model = with_pose_priors(std::move(model), poses);
  const compute::LeastSquaresEstimate first = result;
  const Eigen::MatrixXd& told = first.observable;
  VectorXd left = model.residual - model.setup_jacobian * result.value;
  for (int step = 0; step < kMaxSteps; ++step) {
    move(poses, model.pose_jacobian.colPivHouseholderQr().solve(left));
    const VectorXd before = told.transpose() * result.value;
    const std::span<const double> amounts(result.value.data(), static_cast<std::size_t>(result.value.size()));
    model = with_pose_priors(
        linear_model(parts, measured.measurements, with_errors(nominal, amounts), measured.map_faces, poses), poses);
    const Eigen::MatrixXd of_observable = model.setup_jacobian * told;
    const compute::LeastSquaresEstimate next = compute::estimate(
        of_observable, model.pose_jacobian, model.residual + of_observable * before, 2.0 * kMaxObservableUncertainty);
    left = model.residual - of_observable * (next.value - before);
    result.value = told * next.value;
    result.covariance = told * next.covariance * told.transpose();
    result.residual = next.residual;
    result.leverage = next.leverage;
    if ((next.value - before).cwiseQuotient(next.covariance.diagonal().cwiseSqrt()).norm() < kLastStep) {
      result.covariance += covariance_of_unobservable(parts, measured, result, first, poses);
      return result;
    }
  }
  throw InputError({measured.file, 0, ""},
                   "the measurements cannot be explained by a machine similar to the machine of the jobs: check the "
                   "units and the numbers of the facets");
}

/// Returns the index of the measurement with the largest deviation from the fit, and this deviation in standard
/// uncertainties.
std::pair<std::size_t, double> worst(const compute::LeastSquaresEstimate& estimate, std::size_t measurements) {
  std::pair<std::size_t, double> found{0, 0.0};
  for (Index k = 0; k < static_cast<Index>(measurements); ++k) {
    if (estimate.leverage[k] >= kUnchecked) continue;
    const double deviations = std::abs(estimate.residual[k]) / std::sqrt(1.0 - estimate.leverage[k]);
    if (deviations > found.second) found = {static_cast<std::size_t>(k), deviations};
  }
  return found;
}

/// Returns the deviation, in standard uncertainties, above which a measurement is rejected as an outlier.
double max_by_chance(std::size_t measurements) {
  const double tail = 0.5 * kFalseAlarm / static_cast<double>(measurements);
  return boost::math::quantile(boost::math::complement(boost::math::normal(), tail));
}

[[noreturn]] void refuse(const MeasuredParts& measured, const std::vector<Outlier>& outliers) {
  std::string places;
  for (const Outlier& outlier : outliers) {
    const Measurement& m = outlier.measurement;
    places += places.empty() ? "" : ", ";
    places += m.line > 0 ? std::to_string(m.line) : fmt::format("facet {} of element {}", m.at.facet + 1, m.at.element);
  }
  const int line = outliers.front().measurement.line;
  throw InputError({line > 0 ? measured.file : measured.jobs[outliers.front().measurement.part], line, ""},
                   fmt::format("some measurements contradict the others by more than their uncertainties: {}{} (in "
                               "order of decreasing contradiction)",
                               line > 0 ? "lines " : "", places));
}

/// Returns true if two measurements have the same sign convention. This is the case if they are of the same quantity
/// and of similar facets. Facets are similar if they have the same number in elements of the same orientation.
bool is_alike(const MeasuredParts& measured, const Measurement& a, const Measurement& b) {
  const auto is_rotated = [&](const Measurement& m) {
    return measured.plan_of(m.part).plan.elements[m.at.element].rotated;
  };
  return a.what == b.what && a.at.facet == b.at.facet && is_rotated(a) == is_rotated(b);
}

/// Refuses a table if all measurements of one quantity of similar facets of a part are outliers, because their sign is
/// then probably wrong. If a part has only one such measurement, it is accepted as an outlier if similar measurements
/// of other parts agree with the fit.
/// \param measured measurements without the outliers
void check_signs(const MeasuredParts& measured, const std::vector<CutPart>& parts,
                 const std::vector<Outlier>& outliers) {
  for (const Outlier& outlier : outliers) {
    const Measurement& worst = outlier.measurement;
    if (worst.line == 0) continue;  // values from height maps have no line, and their signs cannot be entered wrongly
    bool is_in_part = false;
    bool is_in_others = false;
    for (const Measurement& m : measured.measurements)
      if (is_alike(measured, m, worst)) (m.part == worst.part ? is_in_part : is_in_others) = true;
    std::vector<int> lines;
    for (const Outlier& other : outliers)
      if (is_alike(measured, other.measurement, worst) && other.measurement.part == worst.part)
        lines.push_back(other.measurement.line);
    if (is_in_part || (is_in_others && lines.size() < 2)) continue;
    std::sort(lines.begin(), lines.end());
    const FabricationResult& plan = measured.plan_of(worst.part);
    throw InputError({measured.file, lines.front(), "value"},
                     fmt::format("all values of {} for facet {}{} of {} (line{} {}) contradict the other rows: check "
                                 "the sign of these values. A positive value means \"{}\" at {}0 C0",
                                 kFacetQuantityWords[static_cast<std::size_t>(worst.what)], worst.at.facet + 1,
                                 plan.plan.elements[worst.at.element].rotated ? " of rotated elements" : "",
                                 measured.jobs[worst.part], lines.size() > 1 ? "s" : "", fmt::join(lines, ", "),
                                 parts[worst.part].positive_sense(worst), plan.machine.tilt_letter()));
  }
}

/// Returns a combination of quantities as text, such as "2 c_x_um + 1 tool_x_um".
std::string description_of(const VectorXd& combination, std::span<const SetupQuantity> quantities) {
  std::string words;
  for (Index k = 0; k < combination.size(); ++k) {
    const double share = combination[k];
    if (share == 0.0) continue;
    const std::string size = std::abs(std::abs(share) - 1.0) < 5e-4 ? "" : fmt::format("{:.3g} ", std::abs(share));
    words += words.empty() ? (share < 0.0 ? "-" : "") : (share < 0.0 ? " - " : " + ");
    words += size + std::string(quantities[static_cast<std::size_t>(k)].key);
  }
  return words;
}

/// Records the calibrated value of a quantity and its uncertainty in the text that names the source of the machine's
/// value.
void tell_source(Machine& machine, const CalibratedQuantity& found, const std::string& file) {
  const std::string source = fmt::format("retrace calibrate {}", file);
  const auto mark = [&](auto& sourced) {
    if (sourced.basis == Basis::measured && sourced.source.starts_with(source)) {
      sourced.source += fmt::format("; {} {:+.4g} +- {:.2g}", found.quantity->key, found.value, found.uncertainty);
      return;
    }
    sourced.basis = Basis::measured;
    sourced.source =
        fmt::format("{}: {} {:+.4g} +- {:.2g}", source, found.quantity->key, found.value, found.uncertainty);
  };
  switch (found.quantity->part) {
    case SetupPart::c_point: return mark(machine.c.point_mm);
    case SetupPart::tilt_point: return mark(machine.a.point_mm);
    case SetupPart::c_direction: return mark(machine.c.direction);
    case SetupPart::tilt_direction: return mark(machine.a.direction);
    case SetupPart::y_direction: return mark(machine.y.direction);
    case SetupPart::z_direction: return mark(machine.z.direction);
    case SetupPart::tool_offset: return mark(machine.mount.offset_mm);
    case SetupPart::tool_rotation: return mark(machine.mount.rotation_deg);
  }
}

/// Sets the results of a calibration: machine, quantities, unobservable combinations and residuals.
void tell(Calibration& result, const compute::LeastSquaresEstimate& fitted) {
  const Machine& nominal = result.parts.plans.front().machine;
  const auto quantities = setup_quantities(nominal.tilt);
  result.machine = with_errors(nominal, {fitted.value.data(), static_cast<std::size_t>(fitted.value.size())});
  result.covariance = fitted.covariance;
  for (std::size_t k = 0; k < quantities.size(); ++k) {
    const auto at = static_cast<Index>(k);
    const CalibratedQuantity found{&quantities[k], fitted.is_observable(at), fitted.value[at],
                                   std::sqrt(fitted.covariance(at, at))};
    result.quantities.push_back(found);
    if (found.value != 0.0)
      tell_source(result.machine, found, std::filesystem::path(result.parts.file).filename().string());
  }
  result.unobservable = unobservable_texts(fitted, nominal.tilt);
  const auto measurements = static_cast<std::ptrdiff_t>(result.parts.measurements.size());
  result.residuals.assign(fitted.residual.begin(), fitted.residual.begin() + measurements);
  result.chi_square = fitted.residual.squaredNorm();
  // The sum of the leverages is the number of observable unknowns, including the poses of the parts.
  const double freedom = static_cast<double>(fitted.residual.size()) - fitted.leverage.sum();
  result.degrees_of_freedom = static_cast<std::size_t>(std::max(0L, std::lround(freedom)));
}

}  // namespace

std::vector<std::string> unobservable_texts(const compute::LeastSquaresEstimate& estimate, Tilt tilt) {
  const Eigen::MatrixXd untold = compute::reduced_combinations(estimate.unobservable);
  std::vector<std::string> words;
  for (Index k = 0; k < untold.cols(); ++k) words.push_back(description_of(untold.col(k), setup_quantities(tilt)));
  return words;
}

std::vector<CutPart> cut_parts(const MeasuredParts& measured) {
  std::vector<CutPart> parts;
  for (std::size_t k = 0; k < measured.parts(); ++k) {
    std::set<std::size_t> elements;
    for (const Measurement& m : measured.measurements) {
      if (m.part != k) continue;
      elements.insert(m.at.element);
      if (m.from) elements.insert(m.from->element);
    }
    parts.emplace_back(measured.plan_of(k), std::vector<std::size_t>(elements.begin(), elements.end()));
  }
  return parts;
}

Calibration calibrate(MeasuredParts measured) {
  const std::vector<CutPart> parts = cut_parts(measured);
  check(measured, parts);
  Calibration result;
  std::vector<Measurement>& measurements = measured.measurements;
  const auto most = static_cast<std::size_t>(std::ceil(kMaxOutlierFraction * static_cast<double>(measurements.size())));
  const double by_chance = max_by_chance(measurements.size());
  compute::LeastSquaresEstimate fitted = fit(parts, measured);
  for (auto [at, deviations] = worst(fitted, measurements.size()); deviations > by_chance;) {
    result.outliers.push_back({measurements[at], deviations});
    if (result.outliers.size() > most) refuse(measured, result.outliers);
    measurements.erase(measurements.begin() + static_cast<std::ptrdiff_t>(at));
    fitted = fit(parts, measured);
    std::tie(at, deviations) = worst(fitted, measurements.size());
  }
  check_signs(measured, parts, result.outliers);
  result.parts = std::move(measured);
  tell(result, fitted);
  return result;
}

}  // namespace retrace::studies
