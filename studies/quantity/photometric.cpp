#include "studies/quantity/photometric.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "core/error.h"

namespace retrace::studies {
namespace {

/// Without points if it was cancelled.
struct Points {
  std::vector<PhotometricPoint> judged;    ///< may be lower bounds
  std::vector<PhotometricPoint> measured;  ///< may lack diffraction
  std::string reason;                      ///< why points are undetermined; empty if none is
};

class PhotometricQuantity final : public Quantity {
 public:
  PhotometricQuantity(std::string name, std::shared_ptr<const PhotometricTable> table, std::optional<std::size_t> point,
                      PhotometricFigure figure)
      : Quantity(std::move(name)), table_(std::move(table)), point_(point), figure_(figure) {}

  std::optional<Measured> measure(const Candidate& candidate, const Cancellation* cancel) const override {
    const auto points = candidate.shared<Points>("photometry " + table_->key, [&] {
      return std::make_shared<const Points>(measured_points(candidate, cancel));
    });
    if (points->judged.empty()) return std::nullopt;
    if (point_) return figure_of(*points, *point_);
    std::vector<Measured> all;
    for (std::size_t k = 0; k < points->judged.size(); ++k) all.push_back(figure_of(*points, k));
    return *std::min_element(all.begin(), all.end(),
                             [](const Measured& a, const Measured& b) { return *a.value < *b.value; });
  }

 private:
  Points measured_points(const Candidate& candidate, const Cancellation* cancel) const {
    PhotometryRequest request = table_->request;
    const AnalysisSettings& analysis = candidate.analysis();
    request.engine = analysis.engine;
    request.cutoff = analysis.cutoff;
    if (analysis.rays) request.rays = *analysis.rays;
    request.seed = analysis.seed;
    if (table_->dye_unless_coloured && candidate.design().substance.is_coloured()) {
      request.dye.clear();
      request.dye_absorption_per_mm = {};
    }
    const PhotometryResult result = PhotometryStudy(candidate.design(), std::move(request)).run(nullptr, cancel);
    return result.complete ? Points{result.points, result.measured, result.reason} : Points{};
  }

  /// A margin without the diffraction that was requested would be taken for a verdict.
  Measured margin_of(const PhotometricPoint& point, const std::string& reason) const {
    if (point.lacks_diffraction && table_->request.diffraction)
      throw BudgetError(fmt::format("the margin of the photometry is undetermined: {}", reason));
    return {point.margin(), point.std_error_mcd_per_lx / point.limit_mcd_per_lx};
  }

  Measured figure_of(const Points& points, std::size_t k) const {
    const PhotometricPoint& point = points.measured.at(k);
    switch (figure_) {
      case PhotometricFigure::margin: return margin_of(points.judged.at(k), points.reason);
      case PhotometricFigure::r_i_mcd_per_lx: return {point.r_i_mcd_per_lx, point.std_error_mcd_per_lx};
      case PhotometricFigure::r_a: break;
    }
    const double per_r_i = point.r_i_mcd_per_lx > 0.0 ? point.r_a / point.r_i_mcd_per_lx : 0.0;
    return {point.r_a, point.std_error_mcd_per_lx * per_r_i};
  }

  std::shared_ptr<const PhotometricTable> table_;
  std::optional<std::size_t> point_;
  PhotometricFigure figure_;
};

}  // namespace

std::shared_ptr<const Quantity> make_photometric(std::string name, std::shared_ptr<const PhotometricTable> table,
                                                 std::optional<std::size_t> point, PhotometricFigure figure) {
  return std::make_shared<PhotometricQuantity>(std::move(name), std::move(table), point, figure);
}

}  // namespace retrace::studies
