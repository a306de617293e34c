#pragma once

#include <complex>

#include "core/infinity.h"
#include "geometry/part/part.h"
#include "raytrace/paths/monte_carlo.h"
#include "tests/support/part_specs.h"

// Parts, optics and films that many tests use.

namespace retrace::testing {

/// Refractive index of PMMA in the closed forms of the array-size study.
inline constexpr double kPmma = 1.4917;
/// Aperture, in mm, of cube corners with an edge length of 1 mm.
inline constexpr double kCubeAperture = 1.6329931618554521;

inline raytrace::Optics pmma() {
  raytrace::Optics optics;
  optics.index = kPmma;
  return optics;
}

/// Returns optics with mirror facets and a lossless entrance face, as in theories without Fresnel reflection.
inline raytrace::Optics ideal() {
  raytrace::Optics optics = pmma();
  optics.mirror_facets = true;
  optics.lossless_entrance = true;
  return optics;
}

/// Returns an opaque film.
/// \param index complex refractive index n + i k
inline materials::LayerStack opaque(std::complex<double> index) {
  return {{{index, kInfinity}}};
}
/// Returns a quarter-wave layer of magnesium fluoride.
inline materials::LayerStack anti_reflection() {
  return {{{1.3777, 0.25 / 1.3777}}};
}
/// Returns a layer of aluminium under silica. The aluminium is so thin that it transmits a third of the light.
inline materials::LayerStack thin_aluminium() {
  return {{{std::complex<double>(1.13, 6.85), 0.008}, {1.4585, 0.3}}};
}

/// Part, direction of the light and optics of a test case, and its name in messages.
struct TraceCase {
  std::string name;
  geometry::PartSpec spec;
  double incidence_deg;
  double azimuth_deg;
  raytrace::Optics optics = pmma();
  raytrace::Stokes stokes = raytrace::kUnpolarised;
};

inline raytrace::Illumination from(double incidence_deg, double azimuth_deg = 0.0) {
  return {Angle::from_deg(incidence_deg), Angle::from_deg(azimuth_deg)};
}

inline raytrace::Sampling rays(std::uint64_t count, std::uint32_t seed = 1) {
  raytrace::Sampling sampling;
  sampling.rays = count;
  sampling.seed = seed;
  return sampling;
}

}  // namespace retrace::testing
