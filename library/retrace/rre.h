#pragma once

// Computes the retroreflective efficiency (RRE) over the angle of incidence, and a ledger with the fate of all incident
// light.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "core/warning.h"
#include "requests/rre.h"
#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

/// RRE of one design for one direction of the light and one acceptance cone.
struct RrePoint {
  std::size_t design = 0;  ///< index in the list of designs
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  double wavelength_nm = 0.0;  ///< wavelength, or centroid of a spectrum
  double acceptance_half_angle_deg = 0.0;
  double rre = 0.0;  ///< fraction of the incident power, 0 to 1
  double std_error = 0.0;
  std::string engine;  ///< engine that was used
  /// Fraction of the incident power for each account (fate of the light, such as absorption).
  std::map<std::string, double> ledger;
  bool missed_target = false;  ///< true if `std_error` is above the target error
};

/// RRE of one design and acceptance cone over a grid of directions.
struct RreMap {
  std::size_t design = 0;  ///< index in the list of designs
  double acceptance_half_angle_deg = 0.0;
  std::vector<double> incidence_deg;           ///< ascending
  std::vector<double> azimuth_deg;             ///< ascending, each >= 0 and < 360
  std::vector<std::vector<double>> rre;        ///< fractions, with the indices [azimuth][incidence]
  std::vector<std::vector<double>> std_error;  ///< as `rre`
  double mean_rre = 0.0;                       ///< mean over the directions of the map, by solid angle
};

struct RreResult {
  std::vector<RrePoint> points;  ///< in the order design, azimuth, incidence, acceptance
  Warnings warnings;
  bool complete = true;      ///< false if the computation was cancelled
  std::string json;          ///< JSON document retrace.rre/1
  std::string csv;           ///< one line per point
  std::string table;         ///< summary as text
  std::string footprint;     ///< document retrace.footprint/2 (GeoJSON); empty unless RreRequest::footprint is true
  std::string far_field;     ///< document retrace.far_field/1; empty unless RreRequest::far_field is true
  std::vector<RreMap> maps;  ///< polar maps; empty unless RreRequest::map is true and the result is complete
  Drawing curve;             ///< RRE over the angles; empty if there are no points, or if there are maps
  Drawing map;               ///< polar maps; empty if there are none
  Drawing map_difference;    ///< map of the second design minus that of the first; empty unless there are two designs
  Drawing footprint_map;     ///< empty unless RreRequest::footprint is true
};

/// Computes the RRE of designs for all combinations of the given directions.
/// \throw InputError for a direction out of range or an unknown engine
/// \throw BudgetError if the ray tracer lost power or needs too many beams
RETRACE_API RreResult rre(const std::vector<Design>& designs, const RreRequest& request, const Running& running = {});
RETRACE_API RreResult rre(const Design& design, const RreRequest& request, const Running& running = {});

}  // namespace retrace
