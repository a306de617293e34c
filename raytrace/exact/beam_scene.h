#pragma once

// What all parts of a run of the exact engine read: the part, its light, and the tolerances of polygons.

#include "raytrace/exact/beam.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/equal_places.h"
#include "raytrace/light/light_setup.h"

namespace retrace::raytrace {

/// Minimum absolute cosine of incidence. Planes that are closer to parallel to a beam are treated as invisible.
inline constexpr double kGrazing = 1e-12;

/// Part, light and tolerances of a run. All references must outlive the run.
struct BeamScene {
  const geometry::Part& part;
  const Vec2& centre_mm;
  const CellIndex& cells;
  const LightSetup& setup;
  const BeamPolicy& policy;
  /// Symmetry of the array. If it is given, identical beams are traced as one beam. Null if it is not used.
  const EqualPlaces* equal = nullptr;
  /// Fragments of a cross-section with a smaller area (mm^2) are caused by rounding. Their power is added to
  /// `truncated`, and they are not traced.
  double least_area = 1e-15 * part.size_mm * part.size_mm;
  /// Two fragments are joined if their union differs from a convex polygon by less than this area (mm^2).
  double join_area = 1e-13 * part.size_mm * part.size_mm;
  double merge_mm = 1e-11 * part.size_mm;  ///< corners of a cross-section with a smaller distance are merged

  /// Returns the refractive index of the medium inside the part or behind its back.
  double index_at(bool inside) const { return inside ? setup.optics.index : setup.optics.back_index; }
};

/// Returns the transmittance for the light of a beam: its fraction of the entrance area times its transmission.
inline double transmission_of(const Beam& beam) {
  return beam.share * beam.transmission;
}
inline double power_of(const Beam& beam) {
  return transmission_of(beam) * beam.light.power();
}

}  // namespace retrace::raytrace
