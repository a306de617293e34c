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

/// Cross sections for one wavelength and one direction of light. A member is empty if it is not defined.
struct CrossSection {
  double wavelength_nm = 0.0;
  double incidence_deg = 0.0, azimuth_deg = 0.0;
  double centre_m2 = 0.0;  ///< in the direction exactly towards the source
  /// Mean, minimum and maximum over the annulus of velocity aberration; empty if the request defines no annulus.
  std::optional<double> mean_m2, min_m2, max_m2;
  std::optional<double> range_correction_mm;  ///< range correction of a single cube; empty for arrays
  /// mean one-way range of an array relative to its origin; empty for a single cube
  std::optional<double> centroid_mm;
};

struct RangingResult {
  std::vector<CrossSection> points;
  Warnings warnings;
  bool complete = true;
  std::string json;          ///< result as JSON of the format retrace.ranging/1
  std::string csv;           ///< table with one line for each point
  std::string map_csv;       ///< map of the far field of the first point, as CSV; empty if no light returns
  std::string cubes_csv;     ///< illuminated cubes of the first point; empty for a single cube
  std::string response_csv;  ///< response of an array to a pulse; empty for continuous light
  std::string shots_csv;     ///< single shots; empty if no shots are requested
  std::string table;         ///< summary for the terminal
  Drawing map;               ///< plot of the map; empty if no light returns
  Drawing rings;             ///< plot of the cross section over the angle from the direction to the source
  Drawing response;          ///< plot of the pulse response; empty for continuous light
};

/// Computes the cross sections of a single cube corner, or of the array of cubes in the file RangingRequest::cubes.
/// \throw InputError
RETRACE_API RangingResult ranging(const Design& design, const RangingRequest& request = {},
                                  const Running& running = {});

}  // namespace retrace
