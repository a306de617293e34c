#include "fabrication/turning/finish.h"
#include "core/angle.h"
#include "core/length_units.h"

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>

namespace retrace::fabrication::turning {
namespace {

constexpr double kSqrt3 = std::numbers::sqrt3;

}  // namespace

double effective_radius_mm(const TurningTool& tool) {
  const double b = std::cos(tool.skew_deg * kRadPerDeg);
  return tool.nose_radius_mm * b * b / std::cos(tool.rake_deg * kRadPerDeg);
}

FinishFigures finish_figures(double effective_radius_mm, double feed_mm, double curvature_per_mm) {
  const double h =
      feed_mm * feed_mm / (effective_radius_mm * (1.0 - effective_radius_mm * curvature_per_mm)) * kNmPerMm;
  return {h / 8.0, h / (18.0 * kSqrt3), h / (12.0 * std::sqrt(5.0)), h / 24.0};
}

FinishFigures exact_finish(const TurningTool& tool, double feed_mm) {
  const double a = tool.nose_radius_mm * std::cos(tool.rake_deg * kRadPerDeg) * kNmPerMm;
  const double b = tool.nose_radius_mm * std::cos(tool.skew_deg * kRadPerDeg);
  const double end = 0.5 * feed_mm / b;
  const auto height = [&](double u) { return a * u * u / (1.0 + std::sqrt(1.0 - u * u)); };
  using Gauss = boost::math::quadrature::gauss<double, 30>;
  const double mean = Gauss::integrate(height, 0.0, end) / end;
  // The absolute deviation from the mean has a kink where the profile crosses the mean. Integrate on both sides of this
  // kink.
  const double level = 1.0 - mean / a;
  const double crossing = std::sqrt(1.0 - level * level);
  const auto deviation = [&](double u) { return std::abs(height(u) - mean); };
  const auto square = [&](double u) { return (height(u) - mean) * (height(u) - mean); };
  FinishFigures figures = finish_figures(effective_radius_mm(tool), feed_mm);
  figures.peak_to_valley_nm = height(end);
  figures.ra_nm = (Gauss::integrate(deviation, 0.0, crossing) + Gauss::integrate(deviation, crossing, end)) / end;
  figures.rq_nm = std::sqrt(Gauss::integrate(square, 0.0, end) / end);
  return figures;
}

double feed_for_scallop_mm(double effective_radius_mm, double scallop_nm) {
  return std::sqrt(8.0 * effective_radius_mm * scallop_nm / kNmPerMm);
}

}  // namespace retrace::fabrication::turning
