#pragma once

// A few lobes about the direction back to the source, fitted to a reflection table, for shaders.

#include <array>
#include <vector>

#include "studies/appearance/reflection_table.h"

namespace retrace::studies {

/// A Gaussian over the deviation, with a power that is a polynomial of the direction of light.
struct Lobe {
  /// Terms x^i y^j of degree 4 or less, by rising i + j, then by rising j.
  static constexpr std::size_t kTerms = 15;

  geometry::Vec2 centre = geometry::Vec2::Zero();
  geometry::Vec2 spread = geometry::Vec2::Zero();  ///< variances along x and y
  double covariance = 0.0;
  Rgb colour{};  ///< of its light, with luminous() = 1
  /// Share of the power of light of x and y, in units of ReflectionLobes::scale; may be below 0, where the sum over
  /// lobes counts as 0 if it is.
  std::array<double, kTerms> power{};

  double determinant() const { return spread.x() * spread.y() - covariance * covariance; }
  /// Density at the centre, whose integral over deviations is 1.
  double peak() const;
};

/// BRDF = sum over lobes of colour x power x density of the Gaussian at the deviation. Where the table has mirrors,
/// light and deviation are mirrored to where the table has directions first.
struct ReflectionLobes {
  std::vector<Lobe> lobes;
  double scale = 1.0;  ///< sine of the largest entrance angle
  std::array<bool, 2> mirrors{};
  geometry::Vec2 back = geometry::Vec2::Ones();  ///< as ReflectionTable has it

  /// In cd/(lx m^2), as ReflectionTable::r_a(); 0 of light from beyond the largest entrance angle.
  Rgb r_a(const geometry::Vec3& to_source, const geometry::Vec3& to_observer) const;
};

/// Fits the lobes by expectation and maximisation over all directions of the table, then their powers to each by least
/// squares of relative errors, then the polynomials to these.
ReflectionLobes fitted_lobes(const ReflectionTable& table);

}  // namespace retrace::studies
