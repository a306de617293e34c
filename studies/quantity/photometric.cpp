#include "studies/quantity/photometric.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace retrace::studies {
namespace {

using Points = std::vector<PhotometricPoint>;

class PhotometricQuantity final : public Quantity {
 public:
  PhotometricQuantity(std::string name, std::shared_ptr<const PhotometricTable> table, std::optional<std::size_t> point,
                      PhotometricFigure figure)
      : Quantity(std::move(name)), table_(std::move(table)), point_(point), figure_(figure) {}

  std::optional<Measured> measure(const Candidate& candidate, const Cancellation* cancel) const override {
    // A measurement that was cancelled is kept as one without points.
    const auto points = candidate.shared<Points>("photometry " + table_->key, [&] {
      return std::make_shared<const Points>(measured_points(candidate, cancel));
    });
    if (points->empty()) return std::nullopt;
    if (point_) return figure_of(points->at(*point_));
    std::vector<Measured> all;
    for (const PhotometricPoint& point : *points) all.push_back(figure_of(point));
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
    if (table_->dye_unless_coloured && !candidate.design().absorption_by_wavelength.empty()) {
      request.dye.clear();
      request.dye_absorption_per_mm = {};
    }
    const PhotometryResult result = PhotometryStudy(candidate.design(), std::move(request)).run(nullptr, cancel);
    return result.complete ? result.points : Points{};
  }

  Measured figure_of(const PhotometricPoint& point) const {
    switch (figure_) {
      case PhotometricFigure::margin:
        return {point.margin(), point.std_error_mcd_per_lx / point.limit_mcd_per_lx};
      case PhotometricFigure::r_i_mcd_per_lx:
        return {point.r_i_mcd_per_lx, point.std_error_mcd_per_lx};
      case PhotometricFigure::r_a:
        break;
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
