#pragma once

// Request for the cross sections and range corrections of a cube corner, or of an array of cube corners.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace retrace {

struct RangingRequest {
  std::filesystem::path cubes;
  std::vector<double> wavelength_nm = {};
  std::vector<double> incidence_deg = {0.0};
  std::vector<double> azimuth_deg = {0.0};
  std::string polarisation = "design";
  double polarisation_deg = 0.0;
  std::optional<std::array<double, 2>> aberration_arcsec = {};
  std::optional<double> orbit_km = {};
  double elevation_deg = 20.0;
  std::optional<double> window_arcsec = {};
  std::size_t map_points = 81;
  double source_arcsec = 0.0;
  double receiver_arcsec = 0.0;
  bool entrance_reflections = false;
  std::optional<double> pulse_ps = {};
  std::size_t shots = 0;
  std::optional<std::array<double, 2>> observation_arcsec = {};
  std::uint32_t seed = 1;
};

}  // namespace retrace
