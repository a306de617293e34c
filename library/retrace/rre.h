#pragma once

// Computes the retroreflective efficiency (RRE) over the angle of incidence, and a ledger with the fate of all incident
// light.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

/// Settings of the computation. They correspond to the options of `retrace rre` (docs/commands.md).
struct RreRequest {
  std::vector<double> incidence_deg = {0.0};  ///< angles of incidence, each in (-90, 90)
  /// Ranges within (-90, 90) in which further angles of incidence are selected automatically, in the same way as for
  /// `start:stop:auto` on the command line.
  std::vector<std::array<double, 2>> incidence_spans_deg = {};
  std::vector<double> azimuth_deg = {0.0};    ///< azimuths of the source
  std::string engine = "auto";                ///< auto, exact, stochastic, montecarlo, cell or embree
  std::optional<double> target_error = {};    ///< standard error of RRE to reach, as a fraction; by default 1e-4
  std::optional<std::uint64_t> samples = {};  ///< number of rays for each point, instead of `target_error`
  std::optional<double> cutoff = {};  ///< minimum power of light that is followed, as a fraction of the incident power
  std::string sampling = "stratified";  ///< stratified, or plain: random points without splitting of rays
  std::uint32_t seed = 1;
  bool derivatives = false;  ///< true: compute derivatives of RRE with respect to parameters (engine exact)
  bool footprint = false;    ///< true: compute the regions of the entrance face that return light (engine exact)
  bool far_field = false;    ///< true: compute the directions in which light leaves the entrance face (engine exact)
};

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

struct RreResult {
  std::vector<RrePoint> points;  ///< in the order design, azimuth, incidence, acceptance
  Warnings warnings;
  bool complete = true;   ///< false if the computation was cancelled
  std::string json;       ///< JSON document retrace.rre/1
  std::string csv;        ///< one line per point
  std::string table;      ///< summary as text
  std::string footprint;  ///< document retrace.footprint/1 (GeoJSON); empty unless RreRequest::footprint is true
  std::string far_field;  ///< document retrace.far_field/1; empty unless RreRequest::far_field is true
  Drawing curve;          ///< RRE over the angles; empty if there are no points
  Drawing footprint_map;  ///< empty unless RreRequest::footprint is true
};

/// Computes the RRE of designs for all combinations of the given directions.
/// \throw InputError for a direction out of range or an unknown engine
/// \throw BudgetError if the ray tracer lost power or needs too many beams
RETRACE_API RreResult rre(const std::vector<Design>& designs, const RreRequest& request, const Running& running = {});
RETRACE_API RreResult rre(const Design& design, const RreRequest& request, const Running& running = {});

}  // namespace retrace
