#pragma once

// Request for the retroreflective efficiency (RRE) of a design as a function of the roughness of its facets.

#include <cstdint>
#include <optional>
#include <vector>

namespace retrace {

/// Settings for the retroreflective efficiency over the roughness of the facets, as in `retrace roughness`.
struct RoughnessRequest {
  std::vector<double> sa_nm = {0.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 75.0, 100.0, 150.0, 200.0};
  std::vector<double> correlation_length_um = {5.0, 20.0, 50.0};
  double waviness_length_um = 200.0;
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  std::optional<std::uint64_t> samples = {};
  double target_error = 1e-3;
  std::uint32_t seed = 1;
};

}  // namespace retrace
