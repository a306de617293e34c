#pragma once

// A lenslet is a surface that is placed on a base surface. A blend connects the two.

#include <Eigen/Core>

#include "geometry/surface/boundary.h"
#include "geometry/surface/sag.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Maximum order of the derivatives that a blend matches.
inline constexpr int kMaxBlendOrder = 4;

/// Returns the polynomial of degree 2 d + 1 that interpolates between two radii. At each end it has the first d + 1
/// Taylor coefficients of a given curve. Hermite's formula is used, so no system of equations is solved (W. Gautschi,
/// Numerical Analysis, 2nd ed., section 2.2.7, two-point case).
/// \param share relative position in the interval: 0 at the first end, 1 at the second
/// \param width width of the interval
/// \param first, second Taylor coefficients in the radius at the two ends, `order` + 1 each
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

/// Surface on the base, with a blend around it.
struct Lenslet {
  Sag sag;                        ///< in the frame of the lenslet
  Vec3 origin_mm = Vec3::Zero();  ///< origin of this frame in the part frame
  /// axes of this frame in the part frame; the z axis of a tilted lenslet is the base's normal
  Eigen::Matrix3d part_from_lenslet = Eigen::Matrix3d::Identity();
  Boundary inner;            ///< inner end of the blend, at the lenslet
  Boundary outer;            ///< outer end of the blend, at the base
  int blend_order = 2;       ///< order d: the surface is C^d at both ends
  bool ends_on_base = true;  ///< true if the blend ends where the base is not extrapolated; set by FreeformSurface

  /// Returns the lenslet's surface as z(x, y) in the part frame. T is double, Gradient, Jet2 or a series of them.
  template <class T>
  T evaluate(const T& x_mm, const T& y_mm) const;
};

}  // namespace retrace::geometry
