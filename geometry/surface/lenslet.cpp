#include "geometry/surface/lenslet.h"

#include <cmath>
#include <limits>

namespace retrace::geometry {
namespace {

using jets::constant_like;
using jets::Gradient;
using jets::Jet2;
using jets::line_series;
using jets::Series;
using jets::value_of;

/// Residual F(z) = w - sag(u, v), where (u, v, w) is the point (x, y, z) in the lenslet's frame. The surface is at F(z)
/// = 0.
template <class T>
T residual(const Lenslet& lenslet, const T& x, const T& y, const T& z) {
  const Eigen::Matrix3d& r = lenslet.part_from_lenslet;
  const T u = x * r(0, 0) + y * r(1, 0) + z * r(2, 0);
  const T v = x * r(0, 1) + y * r(1, 1) + z * r(2, 1);
  return x * r(0, 2) + y * r(1, 2) + z * r(2, 2) - lenslet.sag.evaluate(u, v);
}

/// Returns F and its derivative with respect to z, with the derivatives of the type T.
template <class T>
Series<T, 1> residual_and_slope(const Lenslet& lenslet, const T& x, const T& y, const T& z) {
  const T none = constant_like(x, 0.0);
  return residual(lenslet, line_series<T, 1>(x, none, 1), line_series<T, 1>(y, none, 1),
                  line_series<T, 1>(z, constant_like(x, 1.0), 1));
}

/// Point on the lenslet. Its coordinates are relative to the origin of the lenslet, along the axes of the part frame.
struct Root {
  double z = 0.0;      ///< NaN under an overhang
  double slope = 0.0;  ///< derivative of F with respect to z
};

Root root_at(const Lenslet& lenslet, double x, double y) {
  const Eigen::Matrix3d& r = lenslet.part_from_lenslet;
  Root root{-(x * r(0, 2) + y * r(1, 2)) / r(2, 2), r(2, 2)};
  constexpr int kMaxSteps = 50;
  double last = 1e300;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Series<double, 1> f = residual_and_slope(lenslet, x, y, root.z);
    root.slope = f[1];
    const double change = f[0] / f[1];
    root.z -= change;
    if (!(std::abs(change) > 1e-16 * (std::abs(root.z) + 1e-3)) ||
        (std::abs(change) < 1e-12 && std::abs(change) >= last))
      break;
    last = std::abs(change);
  }
  // A decreasing F means that the point is on the underside of an overhang.
  if (!(root.slope > 0.0)) root.z = std::numeric_limits<double>::quiet_NaN();
  return root;
}

double height_over(const Lenslet& lenslet, double x, double y) {
  return root_at(lenslet, x, y).z;
}

/// Applies one corrector step per order of derivatives. Each step makes the next order exact.
template <class T>
T corrected(const Lenslet& lenslet, const T& x, const T& y, int orders) {
  const Root root = root_at(lenslet, value_of(x), value_of(y));
  T z = constant_like(x, root.z);
  for (int order = 0; order < orders; ++order) z = z - residual(lenslet, x, y, z) / root.slope;
  return z;
}
Gradient height_over(const Lenslet& lenslet, const Gradient& x, const Gradient& y) {
  return corrected(lenslet, x, y, 1);
}
Jet2 height_over(const Lenslet& lenslet, const Jet2& x, const Jet2& y) {
  return corrected(lenslet, x, y, 2);
}

/// Returns the height as a series along a line. The constant term is computed first, with all derivatives of T. Each
/// following term is then computed from the previous terms.
template <class T, int N>
Series<T, N> height_over(const Lenslet& lenslet, const Series<T, N>& x, const Series<T, N>& y) {
  Series<T, N> z = constant_like(x, 0.0);
  z[0] = height_over(lenslet, x[0], y[0]);
  const T slope = residual_and_slope(lenslet, x[0], y[0], z[0])[1];
  for (int k = 1; k <= z.order; ++k) z[k] = -(residual(lenslet, x, y, z)[k] / slope);
  return z;
}

}  // namespace

template <class T>
T Lenslet::evaluate(const T& x_mm, const T& y_mm) const {
  const T px = x_mm - origin_mm.x();
  const T py = y_mm - origin_mm.y();
  if (part_from_lenslet(2, 2) == 1.0) return sag.evaluate(px, py) + origin_mm.z();
  return height_over(*this, px, py) + origin_mm.z();
}
template double Lenslet::evaluate(const double&, const double&) const;
template Gradient Lenslet::evaluate(const Gradient&, const Gradient&) const;
template Jet2 Lenslet::evaluate(const Jet2&, const Jet2&) const;
template Series<double> Lenslet::evaluate(const Series<double>&, const Series<double>&) const;
template Series<double, 1> Lenslet::evaluate(const Series<double, 1>&, const Series<double, 1>&) const;
template Series<double, 3> Lenslet::evaluate(const Series<double, 3>&, const Series<double, 3>&) const;
template Series<double, 4> Lenslet::evaluate(const Series<double, 4>&, const Series<double, 4>&) const;
template Series<Gradient> Lenslet::evaluate(const Series<Gradient>&, const Series<Gradient>&) const;
template Series<Jet2> Lenslet::evaluate(const Series<Jet2>&, const Series<Jet2>&) const;
template Series<Series<double>> Lenslet::evaluate(const Series<Series<double>>&, const Series<Series<double>>&) const;
template Series<Jet2, 1> Lenslet::evaluate(const Series<Jet2, 1>&, const Series<Jet2, 1>&) const;
template Series<Jet2, 2> Lenslet::evaluate(const Series<Jet2, 2>&, const Series<Jet2, 2>&) const;
template Series<Jet2, 3> Lenslet::evaluate(const Series<Jet2, 3>&, const Series<Jet2, 3>&) const;
template Series<Jet2, 4> Lenslet::evaluate(const Series<Jet2, 4>&, const Series<Jet2, 4>&) const;

}  // namespace retrace::geometry
