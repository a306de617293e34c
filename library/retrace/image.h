#pragma once

// Computes pictures of a detector, of a camera, and of a driver's view at night.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/warning.h"
#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

/// Settings for maps of the returned light, as in `retrace image --detector`.
struct DetectorRequest {
  double incidence_deg = 0.0;      ///< angle of incidence, in (-90, 90)
  double azimuth_deg = 0.0;        ///< azimuth of the source
  std::size_t pixels = 400;        ///< number of pixels along the longer side of the entrance face
  std::size_t angle_pixels = 201;  ///< number of pixels along each side of the angular map
  double window_deg = 1.0;         ///< half width of the angular map
  std::string engine = "auto";     ///< auto, exact, montecarlo or embree
  /// Minimum power of a beam that the exact engine follows, as a fraction of the incident power.
  std::optional<double> cutoff = {};
  std::optional<std::uint64_t> samples = {};  ///< number of rays if a Monte Carlo engine is used; empty: 2^22
  std::uint32_t seed = 1;
};

/// Settings for a camera picture of the part in the light of a lamp, as in `retrace image --camera`.
struct CameraRequest {
  double distance_m = 10.0;                           ///< distance of the lamp and the eye from the part
  double observation_deg = 0.33;                      ///< observation angle; the eye is above the lamp
  double v_deg = 0.0;                                 ///< vertical angle of the lamp
  double h_deg = 0.0;                                 ///< horizontal angle of the lamp
  double rotation_deg = 0.0;                          ///< rotation of the part about its normal
  std::optional<std::array<double, 3>> eye_mm = {};   ///< position of the eye, instead of distance and angles
  std::optional<std::array<double, 3>> lamp_mm = {};  ///< position of the lamp, instead of distance and angles
  double lamp_arcmin = 10.0;                          ///< angular diameter of the lamp
  double pupil_arcmin = 10.0;                         ///< angular diameter of the pupil of the eye
  double illuminance_lx = 10.0;  ///< illuminance by the lamp at the part, on a plane normal to the light
  double ambient_lx = 0.0;       ///< illuminance of the face by uniform light from the front
  double backlight_lx = 0.0;     ///< illuminance by uniform light from behind and around the part
  std::size_t columns = 400;     ///< width of the picture in pixels
  std::size_t rows = 300;        ///< height of the picture in pixels
  /// Width of the picture, measured at the part; if empty, the picture shows the whole part with a margin.
  std::optional<double> field_mm = {};
  std::array<double, 2> film_mm = {100.0, 100.0};  ///< width and height of the sheet that shows an infinite design
  /// Radius of the cylinder around which the sheet is bent; if < 0, the sheet is on the inside of the cylinder.
  std::optional<double> cylinder_mm = {};
  double noise = 0.02;  ///< intended relative noise of pixels
  /// Number of passes (four light paths per pixel each); if given, `noise` is not used.
  std::optional<std::uint32_t> passes = {};
  std::filesystem::path lamp = {};  ///< photometric file of the lamp (.ies, .ldt), instead of illuminance_lx
  double lamp_aim_deg = 0.0;        ///< downward tilt of the axis of the lamp in `lamp`, in degrees
  std::uint32_t seed = 1;
};

/// Settings for a driver's view of two reflectors on a car ahead at night, as in `retrace image --road`.
struct RoadRequest {
  std::vector<double> distance_m = {10.0, 30.0, 100.0};  ///< distances of the car ahead
  double lamp_cd = 10'000.0;                             ///< luminous intensity of each headlamp towards the reflectors
  std::filesystem::path lamp = {};  ///< photometric file of each headlamp (.ies, .ldt), instead of lamp_cd
  double lamp_height_m = 0.65;      ///< height of the centers of the headlamps above the road
  double lamp_aim_deg = 0.0;        ///< downward tilt of the axes of the headlamps in `lamp`, in degrees
  std::string dye = "none";         ///< none, red, amber or a file
  std::uint32_t seed = 1;
};

/// A picture as numbers, with its drawing.
struct Picture {
  std::string name;  ///< name of the file that --out writes, without extension, such as "irradiance"
  std::size_t columns = 0;
  std::size_t rows = 0;
  /// Names of the channels and their values, one for each pixel, row by row from the top.
  std::vector<std::pair<std::string, std::vector<double>>> channels;
  Drawing drawing;
};

struct ImageResult {
  std::vector<Picture> pictures;
  Warnings warnings;
  bool complete = true;
  std::string json;   ///< JSON document retrace.image/1
  std::string table;  ///< summary as text
};

/// Computes maps of the returned light over the entrance face and over the directions.
/// \throw InputError
/// \throw BudgetError if the ray tracer lost power
RETRACE_API ImageResult detector(const Design& design, const DetectorRequest& request = {},
                                 const Running& running = {});
/// Computes a camera picture of the part. Throws like detector().
RETRACE_API ImageResult camera(const Design& design, const CameraRequest& request = {}, const Running& running = {});
/// Computes the views from a car at night. Throws like detector().
RETRACE_API ImageResult road(const Design& design, const RoadRequest& request = {}, const Running& running = {});

}  // namespace retrace
