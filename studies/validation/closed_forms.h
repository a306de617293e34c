#pragma once

// Closed forms for the light that cube corners return. They are derived in docs/theory/closed_forms.md and
// polarisation.md, and do not use the tracer.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace retrace::studies::closed_forms {

inline constexpr double kDeg = std::numbers::pi / 180.0;

/// Returns the cosines of the angles between the light inside a cube corner and the three dihedral edges, in ascending
/// order. The axis of the cube corner is -z, and one dihedral edge has the azimuth of +x. The light comes from the
/// direction (incidence, azimuth) and is refracted by a plane face of index n.
inline std::array<double, 3> edge_cosines(double incidence_deg, double azimuth_deg, double n) {
  const double inner = std::asin(std::sin(incidence_deg * kDeg) / n);
  const double p = azimuth_deg * kDeg;
  const Eigen::Vector3d to_source(std::sin(inner) * std::cos(p), std::sin(inner) * std::sin(p), std::cos(inner));
  std::array<double, 3> cosines{};
  for (int k = 0; k < 3; ++k) {
    const double a = 120.0 * k * kDeg;
    const Eigen::Vector3d edge =
        Eigen::Vector3d(std::sqrt(2.0 / 3.0) * std::cos(a), std::sqrt(2.0 / 3.0) * std::sin(a), 1.0 / std::sqrt(3.0));
    cosines[static_cast<std::size_t>(k)] = edge.dot(to_source);
  }
  std::sort(cosines.begin(), cosines.end());
  return cosines;
}

/// Returns the fraction of the aperture of a triangular cube corner that returns light. This is the projected active
/// area for dihedral edges of length 1, divided by the projected aperture sqrt(3)/2 cos_inner. Eckhardt, Appl. Opt. 10,
/// 1559 (1971); docs/theory/closed_forms.md, 3.
inline double triangular_fraction(const std::array<double, 3>& cosines, double cos_inner) {
  const auto [l, m, k] = cosines;
  if (l <= 0.0) return 0.0;
  const double s = l + m + k;
  const double active = l + m <= k ? 4.0 * l * m / s : s - 2.0 / s;
  return active / (0.5 * std::sqrt(3.0) * cos_inner);
}

/// Returns the fraction of the hexagonal aperture of a full cube corner that returns light.
inline double hexagonal_fraction(const std::array<double, 3>& cosines, double cos_inner) {
  const auto [l, m, k] = cosines;
  if (l <= 0.0) return 0.0;
  const double active = m <= 0.5 * k ? 4.0 * l * m / k : (4.0 - k / m) * l;
  return active / (std::sqrt(3.0) * cos_inner);
}

/// Returns the cosine of the angle of refraction inside a plate.
inline double cos_inner(double incidence_deg, double n) {
  const double s = std::sin(incidence_deg * kDeg) / n;
  return std::sqrt(1.0 - s * s);
}

/// Returns the RRE of an infinite honeycomb of cube corners with mirrors behind a lossless face.
inline double honeycomb_rre(double incidence_deg, double azimuth_deg, double n) {
  return hexagonal_fraction(edge_cosines(incidence_deg, azimuth_deg, n), cos_inner(incidence_deg, n));
}

/// Returns the RRE of an infinite triangular array with mirrors behind a lossless face. Every second cell is rotated by
/// 180 degrees.
inline double triangular_rre(double incidence_deg, double azimuth_deg, double n) {
  const double c = cos_inner(incidence_deg, n);
  return 0.5 * (triangular_fraction(edge_cosines(incidence_deg, azimuth_deg, n), c) +
                triangular_fraction(edge_cosines(incidence_deg, azimuth_deg + 180.0, n), c));
}

/// Returns the diffracted intensity that an uncoated solid cube corner returns exactly towards the source, divided by
/// that of the same cube corner with mirrors. It applies to normal incidence and includes all six sub-beams
/// (docs/theory/polarisation.md).
/// \pre n >= sqrt(3/2)
inline double total_reflection_peak(double n) {
  const double retardance = 2.0 * std::atan(std::sqrt(2.0 / 3.0 - 1.0 / (n * n)) / std::sqrt(3.0) / (2.0 / 3.0));
  const double c = std::cos(0.5 * retardance);
  const double s = std::sin(0.5 * retardance);
  const double amplitude = 0.5 * c * std::sin(retardance) + s * (0.75 - 0.25 * std::cos(retardance));
  return amplitude * amplitude;
}

}  // namespace retrace::studies::closed_forms
