#pragma once

// Request for a photometric test: coefficients of retroreflection at the test points of a standard.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace retrace {

/// Settings of a photometric test, as in `retrace photometry`. For empty settings, the values of the standard are used.
struct PhotometryRequest {
  std::string standard = {};
  std::optional<std::string> part_class = {};
  std::optional<std::string> colour = {};
  double area_cm2 = 0.0;
  std::optional<std::vector<double>> rotation_deg = {};
  std::optional<std::string> dye = {};
  std::optional<double> source_arcmin = {};
  std::optional<double> receiver_arcmin = {};
  double window_deg = 2.0;
  std::string light = "a";
  std::string engine = "auto";
  std::optional<double> cutoff = {};
  std::optional<std::uint64_t> samples = {};
  std::uint32_t seed = 1;
  bool diffraction = true;
  bool window_power = false;
  bool advice = true;
  bool pictures = false;
};

}  // namespace retrace
