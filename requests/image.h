#pragma once

// Settings for computing images: maps of the returned light, camera pictures, and a driver's view at night.

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
  /// Angle of incidence, in degrees; > -90 and < 90.
  double incidence_deg = 0.0;
  /// Azimuth of the source, in degrees; >= -360 and <= 360.
  double azimuth_deg = 0.0;
  /// Pixels along the longer side of the face; a whole number >= 1 and <= 8192.
  std::size_t pixels = 400;
  /// Pixels along each side of the angular map; a whole number >= 1 and <= 2049.
  std::size_t angle_pixels = 201;
  /// Half width of the angular map, in degrees; > 0 and <= 90. Default: such that it contains 99.9 % of the light that
  /// returns near the source.
  std::optional<double> window_deg = {};
  /// Method of tracing: beams (exact), rays (montecarlo or embree, which are the same here), or auto: exact if
  /// possible.
  std::string engine = "auto";
  /// Minimum power of a beam that is followed, as a fraction of the incident power; > 0 and < 1. Default: such that at
  /// most 1e-5 of the power is truncated.
  std::optional<double> cutoff = {};
  /// Number of Monte Carlo rays; a whole number >= 1 and <= 68719476736. Default: 4194304, increased to at most
  /// 33554432 until the bins are small.
  std::optional<std::uint64_t> samples = {};
  /// Maximum relative standard error of a bin with light; pixels are merged into bins until it is reached; 0: pixels
  /// are not merged; >= 0 and < 1.
  double bin_error = 0.01;
  /// Seed of the random numbers; a whole number >= 0 and <= 4294967295.
  std::uint32_t seed = 1;
};

/// Settings for a camera picture of the part in the light of a lamp, as in `retrace image --camera`. Positions are in
/// the frame of the camera (CONVENTIONS.md).
struct CameraRequest {
  /// Distance of the lamp and the eye from the part; > 0 and <= 1e+06.
  double distance_m = 10.0;
  /// Observation angle, in degrees; the eye is above the lamp; >= 0 and < 180.
  double observation_deg = 0.33;
  /// Vertical angle of the lamp, in degrees; > -90 and < 90.
  double v_deg = 0.0;
  /// Horizontal angle of the lamp, in degrees; > -90 and < 90.
  double h_deg = 0.0;
  /// Rotation of the part about its normal, in degrees; >= -360 and <= 360.
  double rotation_deg = 0.0;
  /// Position of the eye, in mm. Default: from distance and angles.
  std::optional<std::array<double, 3>> eye_mm = {};
  /// Position of the lamp, in mm. Default: from distance and angles.
  std::optional<std::array<double, 3>> lamp_mm = {};
  /// Angular diameter of the lamp, in arc minutes; > 0 and <= 600.
  double lamp_arcmin = 10.0;
  /// Angular diameter of the eye's pupil, in arc minutes; >= 0 and <= 600.
  double pupil_arcmin = 10.0;
  /// Illuminance by the lamp at the part, on a plane normal to the light; >= 0.
  double illuminance_lx = 10.0;
  /// Illuminance of the face by uniform light from the front; >= 0.
  double ambient_lx = 0.0;
  /// Illuminance by uniform light from behind and around the part; >= 0.
  double backlight_lx = 0.0;
  /// Columns and rows of the picture.
  std::size_t columns = 400;
  /// Columns and rows of the picture.
  std::size_t rows = 300;
  /// Width of the field of view at the part, in mm; > 0. Default: the part and a margin.
  std::optional<double> field_mm = {};
  /// Width and height of the sheet that shows an infinite design, in mm. Default: 100x100.
  std::optional<std::array<double, 2>> film_mm = {};
  /// Radius of the cylinder around which the sheet is bent, in mm; negative: the sheet is on the inside of the
  /// cylinder; >= -1e+09 and <= 1e+09. Default: plane.
  std::optional<double> cylinder_mm = {};
  /// Relative noise of the pixels at which the computation of the picture ends; > 0 and < 1.
  double noise = 0.02;
  /// Number of passes, each with four light paths per pixel; not together with the noise; a whole number >= 2 and <=
  /// 65536. Default: as many as the noise requires.
  std::optional<std::uint32_t> passes = {};
  /// IES or EULUMDAT file (.ies, .ldt) of the lamp or headlamps. Default: the same intensity in all directions.
  std::filesystem::path lamp = {};
  /// Downward tilt of the axis of a lamp from a file, in degrees; >= -45 and <= 45.
  double lamp_aim_deg = 0.0;
  /// Light of the lamp and the surroundings: CIE illuminant a or d65, weighted by the luminous efficiency of the eye,
  /// or design for the light in the design file.
  std::string light = "a";
  /// Dye of the part: none, red, amber (illustrative) or a file; none keeps the absorption in the design.
  std::string dye = "none";
  /// Add diffraction to the light of geometrical optics.
  bool diffraction = true;
  /// Exposure of the PNG file as an exposure value at ISO 100 (EV100); luminances of 1.2 x 2^EV cd/m2 are white; >= -30
  /// and <= 40. Default: such that the brightest thousandth of the pixels is white.
  std::optional<double> exposure_ev = {};
  /// Tone curve of the PNG file: reinhard (adaptation of the eye), linear, or log (four decades).
  std::string tone = "reinhard";
  /// Picture behind the part in the PNG file: a photograph (PNG, JPEG; white is the white of the exposure), or OpenEXR
  /// in cd/m2. Default: black.
  std::filesystem::path background = {};
  /// Seed of the random numbers; a whole number >= 0 and <= 4294967295.
  std::uint32_t seed = 1;
};

/// Settings for pictures of reflectors on a car ahead, or of a sign on a mast, as a driver sees them at night
/// (`retrace image --road`).
struct RoadRequest {
  /// Distances from the headlamps to the reflectors, along the road; 1 to 6 distances, each from 5 to 1000 m.
  std::vector<double> distance_m = {10.0, 30.0, 100.0};
  /// Object that carries the reflectors: car (two reflectors at the rear) or sign (on a mast).
  std::string mount = "car";
  /// Width and height of each reflector or of the sign, in mm; each > 0 and <= 5000. Default: the size of a finite
  /// design; for an infinite design, 120x25 on a car and 600x600 on a sign.
  std::optional<std::array<double, 2>> reflector_mm = {};
  /// Outline of each reflector or of the sign: rectangle, ellipse, triangle, octagon or auto; auto is the outline of a
  /// finite design; for an infinite design, it is a rectangle on a car and an ellipse on a sign.
  std::string outline = "auto";
  /// Height of the centre of the reflectors or of the sign above the road; > 0 and <= 20. Default: 0.6 on a car, 2.2 on
  /// a sign.
  std::optional<double> reflector_height_m = {};
  /// Lateral distance of each reflector from the centre of the car, or of the sign from the centre of the driver's
  /// lane; positive to the right; >= -20 and <= 20. Default: 0.72 on a car, 4 on a sign.
  std::optional<double> lateral_m = {};
  /// Height of the mast of a sign; at least the height of the sign's centre; > 0 and <= 25. Default: up to the upper
  /// edge of the sign.
  std::optional<double> mast_m = {};
  /// Opaque black symbol on a sign: arrow or none.
  std::string symbol = "arrow";
  /// Intensity of each headlamp, the same in all directions ahead; > 0 and <= 1e+06.
  double lamp_cd = 10'000.0;
  /// IES or EULUMDAT file (.ies, .ldt) of the lamp or headlamps. Default: the same intensity in all directions.
  std::filesystem::path lamp = {};
  /// Height of the centres of the headlamps; >= 0.2 and <= 3.
  double lamp_height_m = 0.65;
  /// Downward tilt of the axis of a lamp from a file, in degrees; >= -45 and <= 45.
  double lamp_aim_deg = 0.0;
  /// Height of the driver's eyes above the road; >= 0.3 and <= 5.
  double eye_height_m = 1.2;
  /// Coefficient of retroreflected luminance R_L of the asphalt in the 30 m geometry, in mcd/(lx m2); the default is
  /// illustrative; >= 0 and <= 1000.
  double asphalt_mcd = 15.0;
  /// Coefficient of retroreflected luminance R_L of the markings in the 30 m geometry, in mcd/(lx m2); the default is
  /// illustrative; >= 0 and <= 5000.
  double marking_mcd = 150.0;
  /// Dye of the reflectors: none, red, amber (illustrative) or a file.
  std::string dye = "none";
  /// Columns and rows of the picture.
  std::size_t columns = 640;
  /// Columns and rows of the picture.
  std::size_t rows = 440;
  /// Horizontal field of view of the picture, in degrees; >= 1 and <= 90.
  double field_deg = 13.0;
  /// Exposure of the PNG file as an exposure value at ISO 100 (EV100); luminances of 1.2 x 2^EV cd/m2 are white; >= -30
  /// and <= 40. Default: such that the brightest thousandth of the pixels is white.
  std::optional<double> exposure_ev = {};
  /// Tone curve of the PNG file: reinhard (adaptation of the eye), linear, or log (four decades).
  std::string tone = "reinhard";
  /// Seed of the random numbers; a whole number >= 0 and <= 4294967295.
  std::uint32_t seed = 1;
};

}  // namespace retrace
