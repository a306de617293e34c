#pragma once

// Requests for ray tracing: of rays from a file or an emitter (RaysRequest), and of rays in memory (TraceRequest).

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace retrace {

/// Settings of a ray trace, as in `retrace rays`. The rays come either from the file `source` or from an emitter.
struct RaysRequest {
  /// File with the rays to trace: IES TM-25 (.tm25ray) or a table (.csv). Default: rays of an emitter.
  std::filesystem::path source = {};
  /// Light distribution of a disc that emits the rays: lambertian, gaussian or collimated. Default: rays of a file.
  std::string emitter = {};
  /// Emitter: diameter of its disc, in mm; >= 0 and <= 1e+09. Default: 0 (a point); collimated: the size of the part or
  /// of one period.
  std::optional<double> disc_mm = {};
  /// Emitter: half angle of its cone of light, in degrees; gaussian: angle at which its intensity falls to exp(-2) of
  /// the maximum; >= 0 and <= 90. Default: lambertian: 90, others: 0.
  std::optional<double> half_angle_deg = {};
  /// Emitter: number of rays; a whole number >= 1 and <= 1099511627776.
  std::uint64_t rays = 1'000'000;
  /// Emitter: total power of its rays, in W, or in lm if the design's light is weighted by the luminous efficiency of
  /// the eye; > 0 and <= 1e+150.
  double power = 1.0;
  /// Angle between the part's normal and the direction to the source, in degrees; the source is aimed at the centre of
  /// the entrance face; > -90 and < 90. Default: 0.
  std::optional<double> incidence_deg = {};
  /// Azimuth of the source, in degrees; >= -360 and <= 360. Default: 0.
  std::optional<double> azimuth_deg = {};
  /// Distance of the source from the centre of the entrance face, in mm; > 0 and <= 1e+09. Default: 10.
  std::optional<double> distance_mm = {};
  /// Position of the source's origin in the part frame, in mm; it is given instead of angles and distance. Default: for
  /// a file of rays, the origin of the part.
  std::optional<std::array<double, 3>> at_mm = {};
  /// Point, in the part frame, at which the source's +z axis is aimed, in mm. Default: for a file of rays, none: the +z
  /// axes of source and part are parallel.
  std::optional<std::array<double, 3>> aim_mm = {};
  /// The reflected and the refracted branch are both followed if each has at least this fraction of the power of the
  /// launched ray; otherwise, one branch is chosen at random; 1: always one branch; >= 0 and <= 1.
  double split = 1.0;
  /// Minimum power of a branch that is followed, as a fraction of the power of the launched ray; >= 0 and <= 1.
  double cutoff = 1e-10;
  /// Write the polarisation of the rays, even if the source has none.
  bool stokes = false;
  /// Also write rays that miss the part.
  bool keep_missed = false;
  /// File for the rays that leave the part, .tm25ray or .csv. Default: rays are not written.
  std::filesystem::path out = {};
  /// Seed of the random numbers; a whole number >= 0 and <= 4294967295.
  std::uint32_t seed = 1;
};

/// Settings of trace(), which traces rays in memory. Each member has the same meaning as the member of RaysRequest with
/// the same name.
struct TraceRequest {
  /// The reflected and the refracted branch are both followed if each has at least this fraction of the power of the
  /// launched ray; otherwise, one branch is chosen at random; 1: always one branch; >= 0 and <= 1.
  double split = 1.0;
  /// Minimum power of a branch that is followed, as a fraction of the power of the launched ray; >= 0 and <= 1.
  double cutoff = 1e-10;
  /// Also return rays that miss the part.
  bool keep_missed = false;
  /// Seed of the random numbers; a whole number >= 0 and <= 4294967295.
  std::uint32_t seed = 1;
};

}  // namespace retrace
