#pragma once

// Request for the retroreflective efficiency (RRE) of a design as a function of the roughness of its facets.

#include <cstdint>
#include <optional>
#include <vector>

namespace retrace {

/// Settings for curves of the retroreflective efficiency as a function of facet roughness, as in `retrace roughness`.
struct RoughnessRequest {
  /// Sa values of the roughness, in nm; each curve has one point for each Sa value.
  std::vector<double> sa_nm = {0.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 75.0, 100.0, 150.0, 200.0};
  /// Correlation lengths of the roughness, in um; there is one curve for each length, and measured facets are computed
  /// with the first length.
  std::vector<double> correlation_length_um = {5.0, 20.0, 50.0};
  /// Period of the waviness of measured facets, in um; > 0 and <= 1e+06.
  double waviness_length_um = 200.0;
  /// Angle of incidence, in degrees; > -90 and < 90.
  double incidence_deg = 0.0;
  /// Azimuth of the source, in degrees; >= -360 and <= 360.
  double azimuth_deg = 0.0;
  /// Number of rays for each point; a whole number >= 1 and <= 68719476736. Default: until the target error is reached.
  std::optional<std::uint64_t> samples = {};
  /// Standard error of RRE at which tracing ends, as a fraction; > 0 and < 1.
  double target_error = 1e-3;
  /// Seed of the random numbers; a whole number >= 0 and <= 4294967295.
  std::uint32_t seed = 1;
};

}  // namespace retrace
