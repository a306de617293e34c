#pragma once

// Cubic splines in B-spline form, which interpolate values at equal distances: curves z(t) and patches z(x, y). CAD
// formats store surfaces in this form.

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "geometry/polygon.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Interval with cubic B-splines. The values are interpolated at `count` points at equal distances. The knots are the
/// inner points except the second and the last but one ("not-a-knot" condition; de Boor, A Practical Guide to Splines).
class SplineAxis {
 public:
  /// \pre low < high, count >= 4
  SplineAxis(double low, double high, std::size_t count);

  std::size_t count() const { return count_; }
  double low() const { return low_; }
  double high() const { return high_; }
  double step() const { return (high_ - low_) / static_cast<double>(count_ - 1); }
  /// Returns the position of an interpolated value.
  double site(std::size_t k) const;
  /// Returns the mean of three knots. A coefficient at this position reproduces linear functions.
  double greville(std::size_t k) const { return (knots_[k + 1] + knots_[k + 2] + knots_[k + 3]) / 3.0; }
  /// Returns all knots in ascending order. The first and the last knot occur four times.
  const std::vector<double>& knots() const { return knots_; }

  /// Values of the four B-splines that are not 0 at a position.
  struct Basis {
    std::size_t first = 0;  ///< index of the first of the four B-splines
    std::array<double, 4> value{};
  };
  Basis at(double position) const;

  /// Returns the coefficients of the spline that has the given values at the sites.
  std::vector<double> interpolated(std::vector<double> values) const;

 private:
  double low_;
  double high_;
  std::size_t count_;
  std::vector<double> knots_;
};

/// Returns the value of a spline at a position.
double spline_value(const SplineAxis& axis, const std::vector<double>& coefficients, double position);

/// Bicubic patch z(x, y) over a rectangle. The B-spline coefficients of x and y are the positions greville().
struct SplinePatch {
  SplineAxis x;
  SplineAxis y;
  std::vector<double> heights_mm;  ///< B-spline coefficients of z; index = number along y * x.count() + number along x

  double height_mm(const Vec2& point_mm) const;
};

/// Returns the patch that interpolates a function at the sites of two axes.
SplinePatch interpolated_patch(const SplineAxis& x, const SplineAxis& y,
                               const std::function<double(const Vec2&)>& height_mm);

}  // namespace retrace::geometry
