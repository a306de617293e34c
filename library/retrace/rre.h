#pragma once

// Retroreflective efficiency against angle, with a ledger of where all other light goes.

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

/// What is asked, as the options of `retrace rre` (docs/commands.md).
struct RreRequest {
  std::vector<double> incidence_deg = {0.0};  ///< each in (-90, 90)
  /// Pieces in (-90, 90) over which incidences are chosen besides, as `start:stop:auto` does.
  std::vector<std::array<double, 2>> incidence_spans_deg = {};
  std::vector<double> azimuth_deg = {0.0};    ///< of the source
  std::string engine = "auto";                ///< auto, exact, stochastic, montecarlo, cell or embree
  std::optional<double> target_error = {};    ///< standard error of RRE to reach, as a fraction; by default 1e-4
  std::optional<std::uint64_t> samples = {};  ///< rays for each point, in place of a target
  std::optional<double> cutoff = {};          ///< least power that is followed, as a share of the incident power
  std::string sampling = "stratified";        ///< or plain: random points and no splitting
  std::uint32_t seed = 1;
  bool derivatives = false;  ///< of RRE by the parameters of the design (engine exact)
  bool footprint = false;    ///< which regions of the entrance face send light back (engine exact)
  bool far_field = false;    ///< the directions in which light leaves the entrance face (engine exact)
};

/// RRE at one direction, for one acceptance cone of one design.
struct RrePoint {
  std::size_t design = 0;  ///< which one of those that were given
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  double wavelength_nm = 0.0;  ///< of a spectrum: its centroid
  double acceptance_half_angle_deg = 0.0;
  double rre = 0.0;  ///< share of the incident power, 0 to 1
  double std_error = 0.0;
  std::string engine;                    ///< that ran
  std::map<std::string, double> ledger;  ///< shares of the incident power by account; they add up to 1
  bool missed_target = false;            ///< `std_error` stayed above what was asked
};

struct RreResult {
  std::vector<RrePoint> points;  ///< in the order design, azimuth, incidence, acceptance
  Warnings warnings;
  bool complete = true;   ///< it was not cancelled
  std::string json;       ///< document retrace.rre/1
  std::string csv;        ///< one line a point
  std::string table;      ///< for people
  std::string footprint;  ///< document retrace.footprint/1 (GeoJSON); empty unless it was asked for
  std::string far_field;  ///< document retrace.far_field/1, likewise
  Drawing curve;          ///< RRE over the angles; none without points
  Drawing footprint_map;  ///< none unless it was asked for
};

/// \throw InputError for a direction out of range or an engine that does not exist, BudgetError if power was lost or
/// too many beams are needed
RETRACE_API RreResult rre(const std::vector<Design>& designs, const RreRequest& request, const Running& running = {});
RETRACE_API RreResult rre(const Design& design, const RreRequest& request, const Running& running = {});

}  // namespace retrace
