#pragma once

// A surface of its own that stands on another one, and the blend between the two.

#include <Eigen/Core>

#include "geometry/surface/boundary.h"
#include "geometry/surface/sag.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Most derivatives that a blend matches.
inline constexpr int kMostBlendOrder = 4;

/// The polynomial of degree 2 d + 1 between two radii that has the first d + 1 Taylor coefficients of a curve at each
/// end: Hermite's, in the share of the way between them, so that no system is solved (W. Gautschi, Numerical Analysis,
/// 2nd ed., section 2.2.7, two-point case).
/// \param share 0 at the first end, 1 at the second \param width of the interval
/// \param first, second Taylor coefficients by radius at the ends, `order` + 1 each
template <class T, int N>
T hermite_blend(const T& share, const T& width, const jets::Series<T, N>& first, const jets::Series<T, N>& second,
                int order) {
  const T rest = 1.0 - share;
  const T to_first = jets::power(rest, order + 1);
  const T to_second = jets::power(share, order + 1);
  T sum = jets::constant_like(share, 0.0);
  T scale = jets::constant_like(share, 1.0);
  T share_k = jets::constant_like(share, 1.0);
  T rest_k = jets::constant_like(share, 1.0);
  for (int k = 0; k <= order; ++k) {
    T near_first = jets::constant_like(share, 0.0);
    T near_second = jets::constant_like(share, 0.0);
    for (int j = order - k; j >= 0; --j) {
      near_first = near_first * share + jets::binomial(order + j, j);
      near_second = near_second * rest + jets::binomial(order + j, j);
    }
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    sum = sum + scale * (first[k] * (share_k * to_first * near_first) +
                         second[k] * (rest_k * to_second * near_second) * sign);
    scale = scale * width;
    share_k = share_k * share;
    rest_k = rest_k * rest;
  }
  return sum;
}

/// A surface of its own on the base, with a blend round it.
struct Lenslet {
  Sag sag;                                                          ///< in its own frame
  Vec3 origin_mm = Vec3::Zero();                                    ///< of its frame, in that of the part
  Eigen::Matrix3d part_from_lenslet = Eigen::Matrix3d::Identity();  ///< its z is the base's normal if it is tilted
  Boundary inner;                                                   ///< where the blend leaves it
  Boundary outer;                                                   ///< where the blend reaches the base
  int blend_order = 2;                                              ///< d: C^d at both
  bool ends_on_base = true;  ///< the blend ends where the base is not extrapolated; found by the surface

  /// Its surface as z(x, y) in the part's frame, for double, Gradient, Jet2 and series of them.
  template <class T>
  T evaluate(const T& x_mm, const T& y_mm) const;
};

}  // namespace retrace::geometry
