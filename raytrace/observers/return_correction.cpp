#include "raytrace/observers/return_correction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace retrace::raytrace {

namespace {

using geometry::Vec2, std::numbers::pi;

}  // namespace

DiffractionBlur DiffractionBlur::for_cells(double width_mm, double wavelength_nm, double reach_rad) {
  // Far from its centre, the diffraction pattern of a circular aperture of diameter D has the mean density
  // lambda / (pi^3 D angle^3) per steradian. The tail has this density at large angles.
  const double spread_rad = 1e-6 * wavelength_nm / width_mm;
  DiffractionBlur blur;
  blur.tail_width_rad = std::max(spread_rad, reach_rad);
  blur.tail_fraction = 2.0 * spread_rad / (pi * pi * blur.tail_width_rad);
  return blur;
}

double DiffractionBlur::per_sr(const ApertureKernel& kernel, double separation_rad) const {
  const double core = kernel.per_sr(separation_rad);
  if (!(tail_fraction > 0.0)) return core;
  const double square = separation_rad * separation_rad + tail_width_rad * tail_width_rad;
  return (1.0 - tail_fraction) * core + tail_fraction * tail_width_rad / (2.0 * pi * square * std::sqrt(square));
}

double ReturnCorrection::gain_at(const Vec2& local_mm) const {
  struct Interval {
    std::size_t first = 0;
    std::size_t last = 0;
    double fraction = 0.0;
  };
  const auto interval = [&](Eigen::Index axis, std::size_t count) {
    if (count < 2) return Interval{};
    const double length = face_mm.upper[axis] - face_mm.lower[axis];
    if (!(length > 0.0)) return Interval{};
    const auto steps = static_cast<double>(count - 1);
    const double at = std::clamp((local_mm[axis] - face_mm.lower[axis]) / length, 0.0, 1.0) * steps;
    const double first = std::min(std::floor(at), steps - 1.0);
    return Interval{static_cast<std::size_t>(first), static_cast<std::size_t>(first) + 1, at - first};
  };
  const Interval x = interval(0, columns);
  const Interval y = interval(1, rows);
  const auto along_x = [&](std::size_t row) {
    return std::lerp(gain[row * columns + x.first], gain[row * columns + x.last], x.fraction);
  };
  return std::lerp(along_x(y.first), along_x(y.last), y.fraction);
}

}  // namespace retrace::raytrace
