#pragma once

// Request for a photometric test: coefficients of retroreflection at the test points of a standard.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace retrace {

/// Settings of a photometric test, as in `retrace photometry`. The standard defines the rotations and the diameters of
/// source and receiver if the request gives no values for them.
struct PhotometryRequest {
  /// Standard of the test: r150, j594, bicycle, d4956, iso20471, stvzvo, or a file with limits. Required.
  std::string standard = {};
  /// Class of the part in the standard, such as IA. Required if the standard has several classes.
  std::optional<std::string> part_class = {};
  /// Colour of the part: white, amber, red, yellow and so on. Required if the standard has several colours.
  std::optional<std::string> colour = {};
  /// Area of the whole part in cm2; the design can describe a section of the part; > 0 and <= 1e+06. Required.
  double area_cm2 = 0.0;
  /// Rotations of the part about its normal, in degrees; the smallest reading over all rotations is used. Default: the
  /// standard's.
  std::optional<std::vector<double>> rotation_deg = {};
  /// Dye of the part: none, red or amber (illustrative values), or a file with the absorption of a dye. Default: red or
  /// amber if this is the colour, unless the design has a spectral absorption; otherwise none.
  std::optional<std::string> dye = {};
  /// Angular diameter of the source, in arc minutes; >= 0 and <= 300. Default: the standard's.
  std::optional<double> source_arcmin = {};
  /// Angular diameter of the receiver, in arc minutes; >= 0 and <= 300. Default: the standard's.
  std::optional<double> receiver_arcmin = {};
  /// Half angle of the computed far field, in degrees; >= 0.05 and <= 10.
  double window_deg = 2.0;
  /// Light: CIE illuminant a or d65, weighted by the luminous efficiency of the eye, or design for the light in the
  /// design file.
  std::string light = "a";
  /// Tracing method: exact (beams), montecarlo or embree (rays), or auto (beams if possible).
  std::string engine = "auto";
  /// Minimum power of a beam that is followed exactly, as a fraction of the light on one element (weaker beams are
  /// resampled with auto and truncated with exact); > 0 and < 1. Default: 1e-5; finite parts with resampling: see
  /// docs/commands/photometry.md.
  std::optional<double> cutoff = {};
  /// Number of Monte Carlo rays for each direction of the incident light; a whole number >= 1 and <= 68719476736.
  /// Default: 1048576.
  std::optional<std::uint64_t> samples = {};
  /// Seed of the random numbers; a whole number >= 0 and <= 4294967295.
  std::uint32_t seed = 1;
  /// Add diffraction to the geometric far field.
  bool diffraction = true;
  /// Integrate the power inside and outside of the far field's window, as a check.
  bool window_power = false;
  /// Search for a changed design that passes, if a test point fails.
  bool advice = true;
  /// Compute a map of R_A over entrance and observation angle, or of R_I if the standard limits R_I.
  bool map = false;
  /// Entrance angles of the map, in degrees; at least two, from -85 to 85; negative angles are on the opposite side of
  /// the normal. Default: 0:60:5.
  std::vector<double> map_entrance_deg = {};
  /// Observation angles of the map, in degrees; at least two, from 0 to the half angle of the far field. Default: 41
  /// angles from 0 to the half angle of the far field.
  std::vector<double> map_observation_deg = {};
  /// Presentation angles of the map, in degrees; from -180 to 180; one map for each presentation angle and rotation; at
  /// 0, the observer is on the side of the normal, as seen from the source. Default: 0.
  std::vector<double> map_presentation_deg = {};
  /// Compute the maps and curves for the drawings "far_field" and "r_a".
  bool pictures = false;
};

}  // namespace retrace
