#pragma once

// Requests for traces of rays: of rays from a file or an emitter, and of rays in memory.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace retrace {

/// Settings of a ray trace, as in `retrace rays`. The rays come either from the file `source` or from an emitter.
struct RaysRequest {
  std::filesystem::path source = {};
  std::string emitter = {};
  std::optional<double> disc_mm = {};
  std::optional<double> half_angle_deg = {};
  std::uint64_t rays = 1'000'000;
  double power = 1.0;
  std::optional<double> incidence_deg = {};
  std::optional<double> azimuth_deg = {};
  std::optional<double> distance_mm = {};
  std::optional<std::array<double, 3>> at_mm = {};
  std::optional<std::array<double, 3>> aim_mm = {};
  double split = 1.0;
  double cutoff = 1e-10;
  bool stokes = false;
  bool keep_missed = false;
  std::filesystem::path out = {};
  std::uint32_t seed = 1;
};

/// Settings of trace(), which traces rays in memory. Each member has the same meaning as the member of RaysRequest with
/// the same name.
struct TraceRequest {
  double split = 1.0;
  double cutoff = 1e-10;
  bool keep_missed = false;
  std::uint32_t seed = 1;
};

}  // namespace retrace
