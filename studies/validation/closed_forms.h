#pragma once

// Closed forms of the light that cube corners send back, derived in docs/theory/closed_forms.md and polarisation.md.
// Nothing of the tracer is in them.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace retrace::studies::closed_forms {

inline constexpr double kDeg = std::numbers::pi / 180.0;

/// Direction cosines inside a cube corner (axis -z, one dihedral edge over +x) to its three edges, for light that comes
/// from (incidence, azimuth) outside and is refracted by a flat face of index n; ascending.
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

/// Share of the aperture of a triangular cube corner that sends light back: projected active area for unit legs over
/// the projected aperture sqrt(3)/2. Eckhardt, Appl. Opt. 10, 1559 (1971); docs/theory/closed_forms.md, 3.
inline double triangular_share(const std::array<double, 3>& cosines, double cos_inner) {
  const auto [l, m, k] = cosines;
  if (l <= 0.0) return 0.0;
  const double s = l + m + k;
  const double active = l + m <= k ? 4.0 * l * m / s : s - 2.0 / s;
  return active / (0.5 * std::sqrt(3.0) * cos_inner);
}

/// The same for a full cube with its hexagonal aperture.
inline double hexagonal_share(const std::array<double, 3>& cosines, double cos_inner) {
  const auto [l, m, k] = cosines;
  if (l <= 0.0) return 0.0;
  const double active = m <= 0.5 * k ? 4.0 * l * m / k : (4.0 - k / m) * l;
  return active / (std::sqrt(3.0) * cos_inner);
}

/// Cosine of the angle inside a plate.
inline double cos_inner(double incidence_deg, double n) {
  const double s = std::sin(incidence_deg * kDeg) / n;
  return std::sqrt(1.0 - s * s);
}

/// RRE of an infinite honeycomb of mirror cubes under a lossless face.
inline double honeycomb_rre(double incidence_deg, double azimuth_deg, double n) {
  return hexagonal_share(edge_cosines(incidence_deg, azimuth_deg, n), cos_inner(incidence_deg, n));
}

/// The same of an infinite triangular array: every second cell is turned.
inline double triangular_rre(double incidence_deg, double azimuth_deg, double n) {
  const double c = cos_inner(incidence_deg, n);
  return 0.5 * (triangular_share(edge_cosines(incidence_deg, azimuth_deg, n), c) +
                triangular_share(edge_cosines(incidence_deg, azimuth_deg + 180.0, n), c));
}

/// Intensity that a solid cube corner without coating sends straight back, over that of the same one with mirrors:
/// diffracted, normal incidence, all six sub-beams (docs/theory/polarisation.md). \pre n >= sqrt(3/2)
inline double total_reflection_peak(double n) {
  const double retardance = 2.0 * std::atan(std::sqrt(2.0 / 3.0 - 1.0 / (n * n)) / std::sqrt(3.0) / (2.0 / 3.0));
  const double c = std::cos(0.5 * retardance);
  const double s = std::sin(0.5 * retardance);
  const double amplitude = 0.5 * c * std::sin(retardance) + s * (0.75 - 0.25 * std::cos(retardance));
  return amplitude * amplitude;
}

}  // namespace retrace::studies::closed_forms
