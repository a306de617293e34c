#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/command.h"

namespace retrace::app {

/// Options of `retrace image`. Exactly one kind of picture is asked for.
struct ImageOptions {
  std::string design;
  bool detector = false;
  bool camera = false;
  bool road = false;

  // Detector.
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  std::string engine = "auto";
  std::optional<double> cutoff;
  std::uint64_t samples = 1U << 22;
  double window_deg = 1.0;
  std::uint64_t angle_pixels = 201;

  // Camera.
  double distance_m = 10.0;
  double observation_deg = 0.33;
  double v_deg = 0.0;
  double h_deg = 0.0;
  double rotation_deg = 0.0;
  std::optional<std::string> eye_mm;
  std::optional<std::string> lamp_mm;
  double lamp_arcmin = 10.0;
  double pupil_arcmin = 10.0;
  double illuminance_lx = 10.0;
  double ambient_lx = 0.0;
  double backlight_lx = 0.0;
  std::optional<double> field_mm;
  std::string film_mm = "100x100";
  std::optional<double> cylinder_mm;
  double noise = 0.02;
  std::optional<std::uint32_t> passes;
  bool false_colour = false;

  // Road.
  std::string road_distance_m = "10,30,100";
  double lamp_cd = 10'000.0;
  std::string dye = "none";

  std::optional<std::string> pixels;
};

/// Those of all kinds of pictures.
std::vector<Argument> image_arguments(ImageOptions& options);

}  // namespace retrace::app
