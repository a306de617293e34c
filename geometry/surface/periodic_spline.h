#pragma once

// Splines as functions of an angle, for curves around a centre.

#include <cmath>
#include <numbers>
#include <vector>

#include "core/math/jets.h"
#include "core/math/partials.h"

namespace retrace::geometry {

inline constexpr int kMaxSplineDegree = jets::kMaxOrder;

/// Interpolating spline of period 2 pi and degree p. It is C^(p - 1) everywhere, including the point where the period
/// closes (C. de Boor, A Practical Guide to Splines, Springer 1978, ch. IX and XIII). The sites are the angles at which
/// values are given. For odd degrees, the knots are the sites. For even degrees, the knots are midway between the
/// sites, which keeps the periodic problem regular.
class PeriodicSpline {
 public:
  /// \param sites_rad strictly ascending, within one period
  /// \param values one per site
  /// \param degree 2 to kMaxSplineDegree
  /// \throw std::invalid_argument if there are fewer than degree + 2 sites, if the sites do not ascend within one
  ///     period, or if they are so uneven that the spline is not determined
  PeriodicSpline(const std::vector<double>& sites_rad, const std::vector<double>& values, int degree);

  /// Returns a constant spline.
  static PeriodicSpline constant(double value, int degree = 3);

  /// Returns the spline with the values factor * value + offset.
  PeriodicSpline mapped(double factor, double offset) const;

  int degree() const { return degree_; }
  const std::vector<double>& knots_rad() const { return knots_; }

  /// Returns the value at any angle, with all derivatives of the type T.
  template <class T>
  T evaluate(const T& angle_rad) const {
    const double turns = std::floor((jets::value_of(angle_rad) - knots_.front()) / (2.0 * std::numbers::pi));
    const std::size_t piece = piece_at(jets::value_of(angle_rad) - turns * 2.0 * std::numbers::pi);
    const T local = angle_rad - (knots_[piece] + turns * 2.0 * std::numbers::pi);
    return jets::horner(&coefficients_[piece * stride()], degree_ + 1, local);
  }

  /// Returns the coefficients of the piece that begins at a knot, in powers of the angle relative to the knot.
  const double* piece(std::size_t index) const { return &coefficients_[index * stride()]; }

 private:
  std::size_t stride() const { return static_cast<std::size_t>(degree_) + 1; }
  std::size_t piece_at(double angle_rad) const;
  void index_pieces();

  int degree_ = 3;
  std::vector<double> knots_;         // ascending, within one period; as many as sites
  std::vector<double> coefficients_;  // degree + 1 coefficients per piece
  std::vector<std::size_t> buckets_;  // for the search: pieces at the beginnings of equal intervals of the period
};

}  // namespace retrace::geometry
