#pragma once

// Requests for pictures: of a detector, of a camera, and of a driver's view at night.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace retrace {

/// Settings for maps of the returned light, as in `retrace image --detector`.
struct DetectorRequest {
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  std::size_t pixels = 400;
  std::size_t angle_pixels = 201;
  double window_deg = 1.0;
  std::string engine = "auto";
  std::optional<double> cutoff = {};
  std::optional<std::uint64_t> samples = {};
  std::uint32_t seed = 1;
};

/// Settings for a camera picture of the part in the light of a lamp, as in `retrace image --camera`. Positions are in
/// the frame of the camera (CONVENTIONS.md).
struct CameraRequest {
  double distance_m = 10.0;
  double observation_deg = 0.33;
  double v_deg = 0.0;
  double h_deg = 0.0;
  double rotation_deg = 0.0;
  std::optional<std::array<double, 3>> eye_mm = {};
  std::optional<std::array<double, 3>> lamp_mm = {};
  double lamp_arcmin = 10.0;
  double pupil_arcmin = 10.0;
  double illuminance_lx = 10.0;
  double ambient_lx = 0.0;
  double backlight_lx = 0.0;
  std::size_t columns = 400;
  std::size_t rows = 300;
  std::optional<double> field_mm = {};
  std::optional<std::array<double, 2>> film_mm = {};
  std::optional<double> cylinder_mm = {};
  double noise = 0.02;
  std::optional<std::uint32_t> passes = {};
  std::filesystem::path lamp = {};
  double lamp_aim_deg = 0.0;
  std::uint32_t seed = 1;
};

/// Settings for a driver's view of two reflectors on a car ahead at night, as in `retrace image --road`.
struct RoadRequest {
  std::vector<double> distance_m = {10.0, 30.0, 100.0};
  double lamp_cd = 10'000.0;
  std::filesystem::path lamp = {};
  double lamp_height_m = 0.65;
  double lamp_aim_deg = 0.0;
  std::string dye = "none";
  std::uint32_t seed = 1;
};

}  // namespace retrace
