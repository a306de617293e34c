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

/// Settings for cross sections and range corrections of cube corners, as in `retrace ranging`.
struct RangingRequest {
  /// File with the positions and axes of the cubes of an array, .toml or .csv; every cube has the shape and the
  /// material of the design. Default: a single cube.
  std::filesystem::path cubes;
  /// Wavelengths of the light in vacuum, in nm. Default: as in the design.
  std::vector<double> wavelength_nm = {};
  /// Angles between +z and the direction to the source, in degrees; without an array, > -90 and < 90.
  std::vector<double> incidence_deg = {0.0};
  /// Azimuths of the source, in degrees.
  std::vector<double> azimuth_deg = {0.0};
  /// Polarisation of the transmitted light: as in the design, or unpolarised, linear, right or left (circular).
  std::string polarisation = "design";
  /// Direction of linear polarisation, from the projection of +x, as seen from the source, in degrees; >= -180 and <=
  /// 180.
  double polarisation_deg = 0.0;
  /// Smallest and largest velocity aberration, in arc seconds; cross sections are averaged over the annulus between
  /// these angles. Default: from the orbit, if it is given; otherwise none.
  std::optional<std::array<double, 2>> aberration_arcsec = {};
  /// Height of a circular orbit around the Earth, from which the velocity aberration is computed, in km; > 0 and <=
  /// 1e+07. Default: none.
  std::optional<double> orbit_km = {};
  /// Smallest elevation at which a station observes the satellite, in degrees; >= 0 and <= 90.
  double elevation_deg = 20.0;
  /// Half width of the map of the far field, in arc seconds; > 0 and <= 36000. Default: chosen so that the annulus and
  /// the spots are inside.
  std::optional<double> window_arcsec = {};
  /// Number of points of the map along each axis; a whole number >= 3 and <= 1001.
  std::size_t map_points = 81;
  /// Angular diameter of the source, as seen from the cube, in arc seconds; >= 0 and <= 36000.
  double source_arcsec = 0.0;
  /// Angular diameter of the receiver, as seen from the cube, in arc seconds; >= 0 and <= 36000.
  double receiver_arcsec = 0.0;
  /// Add the light that the entrance face reflects at its outer side, or at its inner side between two
  /// retroreflections.
  bool entrance_reflections = false;
  /// Duration of the Gaussian pulse (full width at half maximum), in ps; > 0 and <= 1e+09. Default: continuous light.
  std::optional<double> pulse_ps = {};
  /// Number of single shots, in which the fields of the cubes are added with random phases; a whole number >= 0 and <=
  /// 1e+06.
  std::size_t shots = 0;
  /// Direction of the receiver for single shots and for the pulse: angles to the right and up from the direction to the
  /// source, in arc seconds. Default: to the right, in the middle of the annulus.
  std::optional<std::array<double, 2>> observation_arcsec = {};
  /// Seed of the random numbers; a whole number >= 0 and <= 4294967295.
  std::uint32_t seed = 1;
};

}  // namespace retrace
