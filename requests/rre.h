#pragma once

// Request for the retroreflective efficiency (RRE) of designs.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace retrace {

/// Settings for the retroreflective efficiency over directions of the light, as in `retrace rre`.
struct RreRequest {
  std::vector<double> incidence_deg = {0.0};
  std::vector<std::array<double, 2>> incidence_spans_deg = {};
  std::vector<double> azimuth_deg = {0.0};
  std::string engine = "auto";
  std::optional<double> target_error = {};
  std::optional<std::uint64_t> samples = {};
  std::optional<double> cutoff = {};
  std::string sampling = "stratified";
  std::uint32_t seed = 1;
  bool derivatives = false;
  bool footprint = false;
  bool far_field = false;
};

}  // namespace retrace
