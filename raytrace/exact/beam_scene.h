#pragma once

// Data that all components of the exact engine read in a run: the part, its light, and the tolerances of polygons.

#include "raytrace/exact/beam.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/translational_symmetry.h"
#include "raytrace/light/light_setup.h"

namespace retrace::raytrace {

/// Minimum absolute cosine of the angle of incidence. A plane at which the cosine is smaller is nearly parallel to the
/// beam and is ignored.
inline constexpr double kMinIncidenceCosine = 1e-12;

/// Part, light and tolerances of a run. All references must outlive the run.
struct BeamScene {
  const geometry::Part& part;
  const Vec2& centre_mm;
  const CellIndex& cells;
  const LightSetup& setup;
  const BeamPolicy& policy;
  /// Symmetry of the array, with which identical beams are traced as one beam. Null if the symmetry is not used.
  const TranslationalSymmetry* symmetry = nullptr;
  /// Fragments of a cross-section with a smaller area (mm^2) are caused by rounding. Their power is added to
  /// `truncated`, and they are not traced.
  double min_area = 1e-15 * part.size_mm * part.size_mm;
  /// Two fragments are joined if their union differs from a convex polygon by less than this area (mm^2).
  double join_area = 1e-13 * part.size_mm * part.size_mm;
  double merge_mm = 1e-11 * part.size_mm;  ///< corners of a cross-section are merged if their distance is smaller

  /// Returns the refractive index of the medium inside the part or behind its back.
  double index_at(bool inside) const { return inside ? setup.optics.index : setup.optics.back_index; }
};

/// Returns the fraction of the entrance area that belongs to a beam, multiplied by the transmittance of the material.
inline double transmission_of(const Beam& beam) {
  return beam.area_fraction * beam.transmission;
}
inline double power_of(const Beam& beam) {
  return transmission_of(beam) * beam.light.power();
}

}  // namespace retrace::raytrace
