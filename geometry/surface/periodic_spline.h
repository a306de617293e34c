#pragma once

// Splines of an angle, for curves round a centre.

#include <cmath>
#include <numbers>
#include <vector>

#include "core/math/jets.h"
#include "core/math/partials.h"

namespace retrace::geometry {

inline constexpr int kMostSplineDegree = jets::kMostOrder;

/// An interpolating spline of period 2 pi: degree p, C^(p - 1) everywhere, the seam included (C. de Boor, A Practical
/// Guide to Splines, Springer 1978, ch. IX and XIII). Knots are the sites for odd degrees and lie midway between them
/// for even ones, which keeps the periodic problem regular.
class PeriodicSpline {
 public:
  /// \param sites_rad strictly rising, within one period \param values as many \param degree 2 to kMostSplineDegree
  /// \throw std::invalid_argument for fewer than degree + 2 sites, or sites that do not rise within one period, or so
  /// uneven that no spline of that degree is determined
  PeriodicSpline(const std::vector<double>& sites_rad, const std::vector<double>& values, int degree);

  /// The spline that is constant.
  static PeriodicSpline constant(double value, int degree = 3);

  /// factor times this one plus offset.
  PeriodicSpline mapped(double factor, double offset) const;

  int degree() const { return degree_; }
  const std::vector<double>& knots_rad() const { return knots_; }

  /// The value at any angle, with all derivatives that T carries.
  template <class T>
  T evaluate(const T& angle_rad) const {
    const double turns = std::floor((jets::value_of(angle_rad) - knots_.front()) / (2.0 * std::numbers::pi));
    const std::size_t piece = piece_at(jets::value_of(angle_rad) - turns * 2.0 * std::numbers::pi);
    const T local = angle_rad - (knots_[piece] + turns * 2.0 * std::numbers::pi);
    return jets::horner(&coefficients_[piece * stride()], degree_ + 1, local);
  }

  /// Coefficients of the piece that starts at that knot, in powers of the angle from it.
  const double* piece(std::size_t index) const { return &coefficients_[index * stride()]; }

 private:
  std::size_t stride() const { return static_cast<std::size_t>(degree_) + 1; }
  std::size_t piece_at(double angle_rad) const;
  void index_pieces();

  int degree_ = 3;
  std::vector<double> knots_;         // as many as sites, rising, within one period
  std::vector<double> coefficients_;  // degree + 1 a piece
  std::vector<std::size_t> buckets_;  // piece at the start of each equal part of the period
};

}  // namespace retrace::geometry
