#pragma once

// Computes cross sections and range corrections of cube corners and of arrays of cube corners, for laser ranging.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "requests/ranging.h"
#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

/// Cross sections for one wavelength and one direction of light. Values that do not apply are empty.
struct CrossSection {
  double wavelength_nm = 0.0;
  double incidence_deg = 0.0, azimuth_deg = 0.0;
  double centre_m2 = 0.0;  ///< in the direction exactly back to the source
  /// Mean and extremes over the annulus of velocity aberration; empty without an annulus.
  std::optional<double> mean_m2, min_m2, max_m2;
  std::optional<double> range_correction_mm;  ///< empty for arrays
  std::optional<double> centroid_mm;          ///< mean one-way range of an array, relative to its origin
};

struct RangingResult {
  std::vector<CrossSection> points;
  Warnings warnings;
  bool complete = true;
  std::string json;          ///< JSON document retrace.ranging/1
  std::string csv;           ///< table with one line for each point
  std::string map_csv;       ///< far field of the first point; empty if no light returns
  std::string cubes_csv;     ///< illuminated cubes of the first point; empty without an array
  std::string response_csv;  ///< response to a pulse; empty for continuous light
  std::string shots_csv;     ///< single shots; empty without shots
  std::string table;         ///< summary as text
  Drawing map;               ///< far field; empty if no light returns
  Drawing rings;             ///< cross section as a function of the angle from the direction to the source
  Drawing response;          ///< response to a pulse; empty for continuous light
};

/// Computes the cross sections of a single cube corner, or of an array of cubes that is given by RangingRequest::cubes.
/// \throw InputError
RETRACE_API RangingResult ranging(const Design& design, const RangingRequest& request = {},
                                  const Running& running = {});

}  // namespace retrace
