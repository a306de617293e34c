#pragma once

// Computes the light that a part reflects, as a table over the directions of light and view. Renderers and lidar
// simulators use the table as the material of a surface. `retrace export` uses this study to write material files.

#include <vector>

#include "core/progress.h"
#include "core/warning.h"
#include "design/design.h"
#include "requests/part.h"
#include "studies/appearance/reflection_table.h"

namespace retrace::studies {

/// Errors of a table, or of lobes that are fitted to it, compared with the photometer at random directions of light and
/// view. Each error is relative to the photometer's value. If this value is below the fraction kErrorFloor of the
/// maximum value for the same light, the error is relative to this fraction of the maximum.
struct AppearanceError {
  std::size_t geometries = 0;
  double median = 0.0;
  double percentile_95 = 0.0;
  double max = 0.0;
};

/// Random geometry with its photometer reading.
struct AppearanceProbe {
  geometry::Vec3 to_source;
  geometry::Vec3 to_observer;
  double r_a = 0.0;      ///< reading for the eye's response
  double r_a_max = 0.0;  ///< maximum value of the table for the same direction of light
};

struct AppearanceResult {
  design::Design design;
  MaterialRequest request;
  ReflectionTable table;
  std::vector<AppearanceProbe> probes;
  AppearanceError error;      ///< error of the table
  double min_cell_deg = 0.0;  ///< extent of the smallest cell in entrance angle
  double elapsed_s = 0.0;
  bool complete = true;  ///< false: the computation was cancelled, and the table must not be used
  Warnings warnings;
};

/// Returns the errors of values compared with the photometer readings of the probes.
/// \param r_a value at each probe
/// \pre `r_a` has one value for each probe, and there is at least one
AppearanceError appearance_error(const std::vector<AppearanceProbe>& probes, const std::vector<double>& r_a);

/// Computes the reflection table with the exact engine (beam tracing) and diffraction, for CIE D65 and the CIE 1931
/// observer. First, the grid of view directions is refined until interpolation between its points is accurate. Then the
/// cells of light directions are halved where interpolation within a cell has an error above `error`. The cell with the
/// largest product of error and projected solid angle comes first. Refinement ends when all cells are accurate, or when
/// the table has `max_directions` directions of light.
/// \throw InputError for numbers out of range, and for designs that the exact engine does not support
AppearanceResult compute_appearance(const design::Design& design, const MaterialRequest& request,
                                    Progress* progress = nullptr, const Cancellation* cancel = nullptr);

}  // namespace retrace::studies
