#pragma once

// Fit of a few Gaussian lobes to a reflection table, for shaders.

#include <array>
#include <vector>

#include "studies/appearance/reflection_table.h"

namespace retrace::studies {

/// Gaussian lobe over the deviation from the central direction of view. Its power is a polynomial of the direction of
/// light.
struct Lobe {
  /// Number of terms x^i y^j with i + j <= 4. The terms are ordered by i + j, then by j.
  static constexpr std::size_t kTerms = 15;

  geometry::Vec2 centre = geometry::Vec2::Zero();
  geometry::Vec2 spread = geometry::Vec2::Zero();  ///< variances along x and y
  double covariance = 0.0;
  Rgb colour{};  ///< colour of the lobe's light, normalized so that luminous() = 1
  /// Coefficients of the polynomial for the lobe's power, as a fraction of the incident power. Its variables are x and
  /// y of the direction to the source, divided by ReflectionLobes::scale. The power of a single lobe may be negative.
  /// If the sum over all lobes is negative, it counts as 0.
  std::array<double, kTerms> power{};

  double determinant() const { return spread.x() * spread.y() - covariance * covariance; }
  /// Returns the density at the centre. The integral of the density over all deviations is 1.
  double peak() const;
};

/// BRDF that is a sum of lobes. Each lobe contributes its colour times its power times its Gaussian density at the
/// deviation from the central direction of view. If the table has mirror symmetries, directions are first mirrored into
/// the range that the table covers.
struct ReflectionLobes {
  std::vector<Lobe> lobes;
  double scale = 1.0;  ///< sine of the maximum entrance angle
  std::array<bool, 2> mirrors{};
  geometry::Vec2 back = geometry::Vec2::Ones();  ///< value of ReflectionTable::back

  /// Returns R_A in cd/(lx m^2), like ReflectionTable::r_a(). Returns 0 for light beyond the maximum entrance angle.
  Rgb r_a(const geometry::Vec3& to_source, const geometry::Vec3& to_observer) const;
};

/// Fits lobes to a table in three steps. Expectation maximization over all directions of light determines the shapes of
/// the lobes. Least squares of relative errors determine their powers for each direction of light. Finally, polynomials
/// are fitted to these powers.
ReflectionLobes fitted_lobes(const ReflectionTable& table);

}  // namespace retrace::studies
