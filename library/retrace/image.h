#pragma once

// Pictures: what a detector or a camera sees, and a driver at night.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

/// Maps of the light that comes back, as `retrace image --detector`.
struct DetectorRequest {
  double incidence_deg = 0.0;  ///< in (-90, 90)
  double azimuth_deg = 0.0;
  std::size_t pixels = 400;        ///< along the longer side of the face
  std::size_t angle_pixels = 201;  ///< along either side of the angular map
  double window_deg = 1.0;         ///< half width of the angular map
  std::string engine = "auto";     ///< auto, exact, montecarlo or embree
  /// Exact engine: minimum power of a beam that is followed, as a fraction of the incident power.
  std::optional<double> cutoff = {};
  std::optional<std::uint64_t> samples = {};  ///< number of rays of the Monte Carlo engines; empty: 2^22
  std::uint32_t seed = 1;
};

/// The part in the light of a lamp, as `retrace image --camera`.
struct CameraRequest {
  double distance_m = 10.0;       ///< of lamp and eye
  double observation_deg = 0.33;  ///< by which the eye is above the lamp
  double v_deg = 0.0;             ///< where the lamp is
  double h_deg = 0.0;
  double rotation_deg = 0.0;                          ///< of the part about its normal
  std::optional<std::array<double, 3>> eye_mm = {};   ///< in place of distance and angles
  std::optional<std::array<double, 3>> lamp_mm = {};  ///< likewise
  double lamp_arcmin = 10.0;                          ///< diameter of the lamp's disc
  double pupil_arcmin = 10.0;                         ///< diameter of the eye's disc
  double illuminance_lx = 10.0;                       ///< of the lamp, across its beam at the part
  double ambient_lx = 0.0;                            ///< even light from in front, on the face
  double backlight_lx = 0.0;                          ///< even light from behind and round the part
  std::size_t columns = 400;                          ///< pixels
  std::size_t rows = 300;
  std::optional<double> field_mm = {};             ///< width shown at the part
  std::array<double, 2> film_mm = {100.0, 100.0};  ///< sheet that an endless design is seen as
  std::optional<double> cylinder_mm = {};          ///< radius that the sheet is bent to; < 0: seen from inside
  double noise = 0.02;                             ///< relative, of pixels, to reach
  std::optional<std::uint32_t> passes = {};        ///< in place of noise
  std::filesystem::path lamp = {};  ///< photometric file (.ies, .ldt), in place of illuminance_lx; empty: none
  double lamp_aim_deg = 0.0;        ///< by which its axis points down
  std::uint32_t seed = 1;
};

/// Two such reflectors on a car ahead at night, as `retrace image --road`.
struct RoadRequest {
  std::vector<double> distance_m = {10.0, 30.0, 100.0};  ///< of the car ahead
  double lamp_cd = 10'000.0;                             ///< of each headlamp towards the reflectors
  std::filesystem::path lamp =
      {};                       ///< photometric file (.ies, .ldt) of each headlamp, in place of lamp_cd; empty: none
  double lamp_height_m = 0.65;  ///< of the headlamps' middles
  double lamp_aim_deg = 0.0;    ///< by which the axes of headlamps from a file point down
  std::string dye = "none";     ///< none, red, amber or a file
  std::uint32_t seed = 1;
};

/// Numbers in pixels.
struct Picture {
  std::string name;  ///< that of its file with --out, such as "irradiance"
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<std::pair<std::string, std::vector<double>>>
      channels;  ///< name, one value a pixel, row by row from above
  Drawing drawing;
};

struct ImageResult {
  std::vector<Picture> pictures;
  std::vector<std::string> warnings;
  bool complete = true;
  std::string json;   ///< document retrace.image/1
  std::string table;  ///< for people
};

/// \throw InputError, BudgetError if power was lost
RETRACE_API ImageResult detector(const Design& design, const DetectorRequest& request = {},
                                 const Running& running = {});
RETRACE_API ImageResult camera(const Design& design, const CameraRequest& request = {}, const Running& running = {});
RETRACE_API ImageResult road(const Design& design, const RoadRequest& request = {}, const Running& running = {});

}  // namespace retrace
