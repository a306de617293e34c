#pragma once

// Request for the retroreflective efficiency (RRE) of designs.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace retrace {

/// Settings for the retroreflective efficiency as a function of the direction of the incident light, as in
/// `retrace rre`.
struct RreRequest {
  /// Angles of incidence, in degrees. Default: 0, or no angles if ranges with automatically chosen angles are given;
  /// for maps 0:80:5.
  std::vector<double> incidence_deg = {};
  /// Ranges in which further angles of incidence are chosen automatically, as many as the curve requires, in degrees.
  std::vector<std::array<double, 2>> incidence_spans_deg = {};
  /// Azimuths of the source, in degrees. Default: 0; for maps 0:350:10.
  std::vector<double> azimuth_deg = {};
  /// Method of tracing: exact, stochastic, montecarlo (cell or embree), or auto: the fastest for each direction.
  std::string engine = "auto";
  /// Standard error of RRE to reach, as a fraction; with exact, the maximum truncated power; > 0 and < 1. Default:
  /// 0.0001; with exact: 1e-10.
  std::optional<double> target_error = {};
  /// Number of rays for each point; a whole number >= 1 and <= 68719476736. Default: until the target error is reached.
  std::optional<std::uint64_t> samples = {};
  /// Minimum power of light that is followed, as a fraction of the incident power; >= 0 and < 1. Default: 1e-10; exact:
  /// determined by the target error.
  std::optional<double> cutoff = {};
  /// Method of sampling: stratified, or plain (random points without splitting, for comparison).
  std::string sampling = "stratified";
  /// Seed of the random numbers; a whole number >= 0 and <= 4294967295.
  std::uint32_t seed = 1;
  /// Compute the derivatives of RRE with respect to the parameters of the design.
  bool derivatives = false;
  /// Compute the regions of the entrance face that return light, as polygons.
  bool footprint = false;
  /// Compute the directions in which light leaves the entrance face.
  bool far_field = false;
  /// Compute RRE over incidence and azimuth as a polar map.
  bool map = false;
};

}  // namespace retrace
