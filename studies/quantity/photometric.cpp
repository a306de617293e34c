#include "studies/quantity/photometric.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/error.h"

namespace retrace::studies {
namespace {

/// Readings at the test points. Empty if the computation was cancelled.
struct Points {
  std::vector<PhotometricPoint> judged;    ///< readings that are compared with the limits; may be lower bounds
  std::vector<PhotometricPoint> measured;  ///< measured readings; may lack diffraction
  std::vector<std::vector<PhotometricPoint>> readings;
  std::string reason;  ///< reason of undetermined points; empty if there are none
};

class PhotometricQuantity final : public Quantity {
 public:
  PhotometricQuantity(std::string name, std::shared_ptr<const PhotometricTable> table, const PhotometricChoice& choice,
                      PhotometricFigure figure)
      : Quantity(std::move(name)), table_(std::move(table)), choice_(choice), figure_(figure) {}

  std::optional<Measured> measure(const Candidate& candidate, const Cancellation* cancel) const override {
    const auto points = candidate.shared<Points>(
        tracing(), [&] { return std::make_shared<const Points>(measured_points(candidate, cancel)); });
    if (points->judged.empty()) return std::nullopt;
    if (choice_.reading) return figure_of_reading(*points);
    if (choice_.point) return figure_of(*points, *choice_.point);
    std::vector<Measured> all;
    for (std::size_t k = 0; k < points->judged.size(); ++k) all.push_back(figure_of(*points, k));
    return *std::min_element(all.begin(), all.end(),
                             [](const Measured& a, const Measured& b) { return *a.value < *b.value; });
  }

  std::string tracing() const override { return "photometry " + table_->key; }

  std::string label() const override {
    if (!choice_.point) return name();
    const TestPoint& point = table_->request.test_plan.points.at(*choice_.point);
    double v_deg = point.v_deg;
    std::string turn;
    if (choice_.reading) {
      if (!point.substitute_v_deg.empty()) v_deg = point.substitute_v_deg.at(choice_.reading->v_index);
      const double turn_deg = table_->request.rotation_deg.at(choice_.reading->rotation_index);
      if (turn_deg != 0.0) turn = fmt::format(", rotated {:g}", turn_deg);
    }
    return fmt::format("{:.3g}' V {:g} H {:g}{}", 60.0 * point.observation_deg, v_deg, point.h_deg, turn);
  }

  bool is_additive() const override {
    if (choice_.reading) return true;
    const PhotometrySettings& request = table_->request;
    return choice_.point && request.rotation_deg.size() == 1 &&
           request.test_plan.points.at(*choice_.point).substitute_v_deg.size() < 2;
  }

  std::optional<QuantityLimit> limit() const override {
    if (!choice_.point || figure_ != PhotometricFigure::margin) return std::nullopt;
    const TestPoint& point = table_->request.test_plan.points.at(*choice_.point);
    return QuantityLimit{point.minimum, std::string(unit_name(point.unit))};
  }

 private:
  Points measured_points(const Candidate& candidate, const Cancellation* cancel) const {
    PhotometrySettings request = table_->request;
    const AnalysisSettings& analysis = candidate.analysis();
    request.engine = analysis.engine;
    // Photometry by rays has no cut-off. Therefore the cut-off is passed only to engines that trace beams. The study
    // reader refuses a cut-off that no quantity uses.
    if (raytrace::may_be_exact(request.engine)) request.cutoff = analysis.cutoff;
    request.rays = analysis.rays;
    request.seed = analysis.seed;
    for (double& turn_deg : request.rotation_deg) turn_deg += analysis.rotation_deg;
    if (table_->dye_unless_coloured && candidate.design().substance.is_coloured()) {
      request.dye.clear();
      request.dye_absorption_per_mm = {};
    }
    const PhotometryResult result =
        PhotometryStudy(candidate.design(), std::move(request)).run(candidate.progress(), cancel);
    return result.complete ? Points{result.points, result.measured, result.readings, result.reason.text} : Points{};
  }

  /// Returns the margin to the limit.
  /// \throw BudgetError if diffraction was requested but is not included, because the margin would not be a verdict
  Measured margin_of(const PhotometricPoint& point, const std::string& reason) const {
    if (point.lacks_diffraction && table_->request.diffraction)
      throw BudgetError(fmt::format("the photometric margin cannot be determined: {}", reason));
    return {point.margin(), point.std_error_mcd_per_lx / point.limit_mcd_per_lx};
  }

  Measured figure_of(const Points& points, std::size_t k) const {
    return figure_of(points.measured.at(k), points.judged.at(k), points.reason);
  }

  Measured figure_of_reading(const Points& points) const {
    const std::vector<PhotometricPoint>& readings = points.readings.at(*choice_.point);
    const std::size_t turns = table_->request.rotation_deg.size();
    const std::size_t beside = std::min(choice_.reading->v_index, readings.size() / turns - 1);
    const PhotometricPoint& reading = readings.at(beside * turns + choice_.reading->rotation_index);
    return figure_of(reading, reading, points.reason);
  }

  Measured figure_of(const PhotometricPoint& point, const PhotometricPoint& judged, const std::string& reason) const {
    switch (figure_) {
      case PhotometricFigure::margin: return margin_of(judged, reason);
      case PhotometricFigure::r_i_mcd_per_lx: return {point.r_i_mcd_per_lx, point.std_error_mcd_per_lx};
      case PhotometricFigure::r_a: break;
    }
    const double per_r_i = point.r_i_mcd_per_lx > 0.0 ? point.r_a / point.r_i_mcd_per_lx : 0.0;
    return {point.r_a, point.std_error_mcd_per_lx * per_r_i};
  }

  std::shared_ptr<const PhotometricTable> table_;
  PhotometricChoice choice_;
  PhotometricFigure figure_;
};

}  // namespace

std::shared_ptr<const Quantity> make_photometric(std::string name, std::shared_ptr<const PhotometricTable> table,
                                                 const PhotometricChoice& choice, PhotometricFigure figure) {
  return std::make_shared<PhotometricQuantity>(std::move(name), std::move(table), choice, figure);
}

Quantities make_photometric_readings(const std::string& name, const std::shared_ptr<const PhotometricTable>& table,
                                     PhotometricFigure figure) {
  Quantities all;
  const PhotometrySettings& request = table->request;
  for (std::size_t point = 0; point < request.test_plan.points.size(); ++point) {
    const std::size_t besides = std::max<std::size_t>(1, request.test_plan.points[point].substitute_v_deg.size());
    std::size_t number = 0;
    for (std::size_t beside = 0; beside < besides; ++beside)
      for (std::size_t turn = 0; turn < request.rotation_deg.size(); ++turn)
        all.push_back(make_photometric(fmt::format("{}.{}.{}", name, point + 1, ++number), table,
                                       {point, PhotometricChoice::Reading{beside, turn}}, figure));
  }
  return all;
}

}  // namespace retrace::studies
