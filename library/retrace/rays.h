#pragma once

// Rays through a part: those of files or an emitter, and those of memory.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "retrace/design.h"
#include "retrace/running.h"

namespace retrace {

/// What is asked, as the options of `retrace rays` (docs/commands.md).
struct RaysRequest {
  std::filesystem::path source = {};  ///< .tm25ray or .csv; empty: the emitter
  std::string emitter = {};           ///< lambertian, gaussian or collimated; in place of a file
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
  std::filesystem::path out = {};  ///< .tm25ray or .csv; empty: rays are counted alone
  std::uint32_t seed = 1;
};

struct RaysResult {
  std::map<std::string, double> ledger;  ///< shares of the power of all rays by account; they add up to 1
  double power = 0.0;                    ///< of all rays
  Warnings warnings;
  bool complete = true;
  std::string json;   ///< document retrace.rays/1
  std::string table;  ///< for people
};

/// \throw InputError, OutputError, BudgetError
RETRACE_API RaysResult rays(const Design& design, const RaysRequest& request, const Running& running = {});

/// Rays in memory, in the part's frame: numbers of one ray after those of another.
struct RayArrays {
  std::vector<double> origins_mm;      ///< three a ray
  std::vector<double> directions;      ///< three a ray, of any length above 0
  std::vector<double> stokes;          ///< four a ray, the first its power; or four for all
  std::vector<double> axes;            ///< of the Stokes parameters, three a ray; empty: +x across each direction
  std::vector<double> wavelengths_nm;  ///< one a ray, or one for all; empty: those of the design's light
};

struct TraceRequest {
  double split = 1.0;  ///< as RaysRequest
  double cutoff = 1e-10;
  bool keep_missed = false;
  std::uint32_t seed = 1;
};

/// Every ray that leaves.
struct TracedRays {
  std::vector<double> origins_mm;       ///< where, three a ray
  std::vector<double> directions;       ///< three a ray, unit vectors
  std::vector<double> stokes;           ///< four a ray, the first its power
  std::vector<double> axes;             ///< three a ray: along the long axis of the polarisation ellipse
  std::vector<double> wavelengths_nm;   ///< one a ray
  std::vector<std::uint8_t> accounts;   ///< one a ray: a number of ray_accounts()
  std::vector<std::uint64_t> incident;  ///< one a ray: which ray it comes from, from 0
  std::map<std::string, double> ledger;
  double power = 0.0;
  Warnings warnings;
  bool complete = true;
  std::string json;
  std::string table;
};

/// The names of accounts, by number.
RETRACE_API std::vector<std::string> ray_accounts();

/// \throw InputError naming the array where it is at fault, BudgetError
RETRACE_API TracedRays trace(const Design& design, const RayArrays& rays, const TraceRequest& request = {},
                             const Running& running = {});

}  // namespace retrace
