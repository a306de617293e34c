#include "studies/calibration/test_cuts.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "fabrication/job/io/job_files.h"
#include "studies/calibration/linear_model.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Apex angles of the test prisms. While a prism is cut, axis A is at half of the prism's apex angle. A chisel with a
/// wedge angle of 50 degrees and a clearance angle of 3 degrees can cut all of them.
constexpr double kApexAnglesDeg[] = {90.0, 70.0, 105.0};
/// Distance between neighbouring prisms. It is the lever arm for the measurement of angular errors, and is within the
/// travel of a microscope's stage.
constexpr double kPitchMm = 10.0;
/// Maximum ratio of the uncertainty with the chosen measurements to that with all possible measurements.
constexpr double kEnough = 3.0;

/// Returns the standard uncertainty of measurements with a profiler, an autocollimator and an AFM. The user can change
/// the values in the written table.
double uncertainty_of(FacetQuantity what) {
  switch (what) {
    case FacetQuantity::distance: return 20.0;
    case FacetQuantity::cut_end: return 10.0;
    default: return 1.0;
  }
}

/// Returns a design of four test prisms with a square outline. The size of the square is the base or the width of the
/// given design's prisms, whichever is smaller, and at most `most_mm`.
design::Design test_design(const design::Design& design, double apex_angle_deg, double most_mm) {
  const auto* const array = std::get_if<design::ElementArray>(&design.shape);
  const auto* const prism = array ? std::get_if<geometry::RtpElement>(&array->part.element) : nullptr;
  if (prism == nullptr)
    throw InputError(Field{"test_cuts"},
                     "test cuts are prisms: the design must have element.kind = \"rtp\", got another kind");
  design::Design test = design;
  test.title = fmt::format("Test cuts, apex angle {} degrees", shortest(apex_angle_deg));
  const double size_mm = std::min({prism->base_mm, prism->width_mm, most_mm});
  design::ElementArray cuts;
  cuts.part.element = geometry::RtpElement{size_mm, size_mm, apex_angle_deg};
  cuts.part.array.arrangement = geometry::Arrangement::checker;
  cuts.part.array.x_gap_mm = cuts.part.array.y_gap_mm = kPitchMm - size_mm;
  cuts.part.array.x_length_mm = cuts.part.array.y_length_mm = kPitchMm + size_mm;
  cuts.part.thickness_mm = array->part.thickness_mm;
  test.shape = std::move(cuts);
  test.surface = {};
  return test;
}

/// Returns all possible measurements of a part with four test prisms, without values.
std::vector<Measurement> all_figures(std::size_t part) {
  std::vector<Measurement> figures;
  const auto add = [&](std::size_t element, std::size_t facet, FacetQuantity what, double at) {
    figures.push_back({part, {element, facet}, what, 0.0, uncertainty_of(what), {}, at, 0});
  };
  for (std::size_t element = 0; element < 4; ++element)
    for (std::size_t facet = 0; facet < 2; ++facet) {
      for (const FacetQuantity what : {FacetQuantity::distance, FacetQuantity::tilt_up, FacetQuantity::tilt_along})
        add(element, facet, what, 0.0);
      for (const double at : {-1.0, 1.0}) add(element, facet, FacetQuantity::cut_end, at);
    }
  return figures;
}

/// Returns the model with only the chosen rows. Each row is one measurement.
LinearModel rows_of(const LinearModel& all, const std::vector<Index>& chosen) {
  return {all.setup_jacobian(chosen, Eigen::all), all.pose_jacobian(chosen, Eigen::all), all.residual(chosen)};
}

compute::LeastSquaresEstimate estimate_of(const LinearModel& model) {
  return compute::estimate(model.setup_jacobian, model.pose_jacobian, model.residual, kMaxObservableUncertainty);
}

/// Chooses measurements one by one.
class Chooser {
 public:
  explicit Chooser(const LinearModel& all) : all_(all), of_all_(estimate_of(all)) {
    const Index setup = all.setup_jacobian.cols();
    rows_.resize(all.setup_jacobian.rows(), setup + all.pose_jacobian.cols());
    rows_ << all.setup_jacobian, all.pose_jacobian;
    covariance_ =
        kMaxObservableUncertainty * kMaxObservableUncertainty * MatrixXd::Identity(rows_.cols(), rows_.cols());
    for (Index k = 0; k < setup; ++k)
      if (of_all_.is_observable(k)) told_.push_back(k);
  }

  std::vector<Index> choose() {
    std::vector<Index> chosen;
    while (static_cast<Index>(chosen.size()) < rows_.rows() && !is_enough(chosen)) chosen.push_back(take());
    std::sort(chosen.begin(), chosen.end());
    return chosen;
  }

 private:
  bool is_enough(const std::vector<Index>& chosen) const {
    if (static_cast<Index>(chosen.size()) < rows_.cols()) return false;
    const compute::LeastSquaresEstimate now = estimate_of(rows_of(all_, chosen));
    if (now.observable.cols() < of_all_.observable.cols()) return false;
    constexpr double kChecked = 0.95;
    return now.leverage.maxCoeff() < kChecked && std::all_of(told_.begin(), told_.end(), [&](Index k) {
             return now.covariance(k, k) < kEnough * kEnough * of_all_.covariance(k, k);
           });
  }

  /// Chooses the measurement that most reduces the uncertainties of the observable quantities. Each uncertainty is
  /// divided by the uncertainty that the quantity has with all possible measurements.
  Index take() {
    Index best = 0;
    double most = -1.0;
    for (Index k = 0; k < rows_.rows(); ++k) {
      if (taken_.size() > 0 && taken_[k]) continue;
      const VectorXd change = covariance_ * rows_.row(k).transpose();
      double gain = 0.0;
      for (const Index q : told_) gain += change[q] * change[q] / of_all_.covariance(q, q);
      gain /= 1.0 + rows_.row(k).dot(change);
      if (gain > most * (1.0 + 1e-9)) std::tie(best, most) = std::pair(k, gain);
    }
    if (taken_.size() == 0) taken_ = Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(rows_.rows(), false);
    taken_[best] = true;
    const VectorXd change = covariance_ * rows_.row(best).transpose();
    covariance_ -= change * change.transpose() / (1.0 + rows_.row(best).dot(change));
    return best;
  }

  const LinearModel& all_;
  compute::LeastSquaresEstimate of_all_;
  MatrixXd rows_;        ///< derivatives with respect to all unknowns, including poses
  MatrixXd covariance_;  ///< covariance matrix from the measurements taken so far
  Eigen::Array<bool, Eigen::Dynamic, 1> taken_;
  std::vector<Index> told_;
};

/// Sets the expected results of the test cuts for each quantity of the set-up, and the unobservable combinations.
void tell(TestCuts& cuts, const LinearModel& chosen, Tilt tilt) {
  const compute::LeastSquaresEstimate all = estimate_of(chosen);
  std::vector<compute::LeastSquaresEstimate> without;
  for (std::size_t part = 0; part < cuts.parts.jobs.size(); ++part) {
    std::vector<Index> rows;
    for (std::size_t k = 0; k < cuts.parts.measurements.size(); ++k)
      if (cuts.parts.measurements[k].part != part) rows.push_back(static_cast<Index>(k));
    without.push_back(estimate_of(rows_of(chosen, rows)));
  }
  for (const SetupQuantity& quantity : setup_quantities(tilt)) {
    const auto at = static_cast<Index>(cuts.quantities.size());
    PlannedQuantity planned{&quantity, all.is_observable(at), std::sqrt(all.covariance(at, at)), {}};
    for (std::size_t part = 0; planned.is_observable && part < without.size(); ++part)
      if (!without[part].is_observable(at)) planned.needs.push_back(part);
    cuts.quantities.push_back(std::move(planned));
  }
  cuts.unobservable = unobservable_texts(all, tilt);
}

}  // namespace

TestCuts plan_test_cuts(const design::Design& design, const JobRequest& request) {
  TestCuts cuts;
  std::vector<CutPart> parts;
  std::vector<Measurement> figures;
  for (const double angle : kApexAnglesDeg) {
    const std::string name = fmt::format("test-cuts-{}.toml", shortest(angle));
    cuts.jobs.push_back(make_job(test_design(design, angle, request.tool_width_mm), request));
    FabricationRequest plan;
    plan.job_text = job_text(cuts.jobs.back().job);
    cuts.parts.plans.push_back(fabricate(name, plan));
    for (const Measurement& figure : all_figures(cuts.parts.jobs.size())) figures.push_back(figure);
    cuts.parts.jobs.push_back(name);
    parts.emplace_back(cuts.parts.plans.back(), std::vector<std::size_t>());
  }
  const Machine& machine = cuts.parts.plans.front().machine;
  const LinearModel all = linear_model(parts, figures, machine);
  const std::vector<Index> chosen = Chooser(all).choose();
  for (const Index k : chosen) cuts.parts.measurements.push_back(figures[static_cast<std::size_t>(k)]);
  tell(cuts, rows_of(all, chosen), machine.tilt);
  return cuts;
}

}  // namespace retrace::studies
