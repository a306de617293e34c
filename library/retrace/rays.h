#pragma once

// Traces rays through a part. The rays come from a file, from an emitter or from arrays in memory.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/warning.h"
#include "requests/rays.h"
#include "retrace/design.h"
#include "retrace/running.h"

namespace retrace {

struct RaysResult {
  /// Fraction of the incident power for each account (fate of the light, such as absorption).
  std::map<std::string, double> ledger;
  double power = 0.0;  ///< incident power of all rays
  Warnings warnings;
  bool complete = true;
  std::string json;   ///< JSON document retrace.rays/1
  std::string table;  ///< summary as text
};

/// Traces the rays of a file or an emitter.
/// \throw InputError if the request is not allowed or a file of rays cannot be read
/// \throw OutputError if the file of rays cannot be written
/// \throw BudgetError if power is lost because a ray inside the part missed every face, or if a budget is exhausted
RETRACE_API RaysResult rays(const Design& design, const RaysRequest& request, const Running& running = {});

/// Rays in memory, in the frame of the part. Each array contains the numbers of ray 0, then those of ray 1, and so on.
struct RayArrays {
  std::vector<double> origins_mm;  ///< three numbers per ray
  std::vector<double> directions;  ///< three numbers per ray; vectors of any length > 0
  /// Stokes parameters: four for each ray, the first of which is its power; or four that apply to all rays.
  std::vector<double> stokes;
  /// Reference axes of the Stokes parameters, three numbers per ray. If the array is empty, each axis is the direction
  /// +x, projected onto the plane normal to the ray.
  std::vector<double> axes;
  /// Wavelengths: one for each ray, or one for all rays. If the array is empty, the wavelengths of the design are used.
  std::vector<double> wavelengths_nm;
};

/// All rays that leave the part.
struct TracedRays {
  std::vector<double> origins_mm;       ///< points at which the rays leave, three numbers per ray
  std::vector<double> directions;       ///< unit vectors, three numbers per ray
  std::vector<double> stokes;           ///< Stokes parameters: four for each ray, the first of which is its power
  std::vector<double> axes;             ///< long axes of the polarisation ellipses, three numbers per ray
  std::vector<double> wavelengths_nm;   ///< one per ray
  std::vector<std::uint8_t> accounts;   ///< one per ray: index in ray_accounts()
  std::vector<std::uint64_t> incident;  ///< one per ray: index of the incident ray, from 0
  std::map<std::string, double> ledger;
  double power = 0.0;
  Warnings warnings;
  bool complete = true;
  std::string json;
  std::string table;
};

/// Returns the names of all accounts (fates of the light). TracedRays::accounts contains indices in this list.
RETRACE_API std::vector<std::string> ray_accounts();

/// Traces rays in memory and returns the rays that leave the part.
/// \throw InputError if an array is invalid; the error names the array
/// \throw BudgetError if power is lost because a ray inside the part missed every face, or if a budget is exhausted
RETRACE_API TracedRays trace(const Design& design, const RayArrays& rays, const TraceRequest& request = {},
                             const Running& running = {});

}  // namespace retrace
