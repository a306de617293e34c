#pragma once

// Rows, ranges and conditions that the descriptions of several requests use.

#include <string_view>

#include "core/schema/access.h"
#include "requests/row.h"

namespace retrace::requests {

using schema::File, schema::Flag, schema::Number, schema::NumberOrNumbers, schema::NumberRows, schema::Numbers,
    schema::Text, schema::Texts, schema::Integer, schema::Word, schema::WordOrFile;

inline constexpr NumberRange kIncidence{.low = -90.0, .low_included = false, .high = 90.0, .high_included = false};
/// Allowed azimuths, in degrees. Larger azimuths are refused, because a floating-point number of large magnitude has
/// fewer digits after the decimal point.
inline constexpr NumberRange kAzimuth{.low = -360.0, .high = 360.0};
inline constexpr NumberRange kCutoff{.low = 0.0, .low_included = false, .high = 1.0, .high_included = false};
inline constexpr NumberRange kSamples{.low = 1.0, .high = 0x1p36};
/// Maximum coordinate, distance and diameter, in mm, of lamps, eyes and ray sources. At larger distances, double
/// precision is too coarse for rays to hit the part, and the squares of coordinates overflow in Embree.
inline constexpr double kFarthestMm = 1e9;
inline constexpr NumberRange kPlaceMm{.low = -kFarthestMm, .high = kFarthestMm};
inline constexpr NumberRange kUnsigned32{.low = 0.0, .high = 4294967295.0};

/// Engines that can trace any part. The engines "stochastic" and "cell" cannot.
inline constexpr std::string_view kEnginesOfParts[] = {"auto", "exact", "montecarlo", "embree"};
inline constexpr std::string_view kExactEngines[] = {"auto", "exact"};
inline constexpr std::string_view kRayEngines[] = {"auto", "montecarlo", "embree"};

inline constexpr schema::Condition kIsExact[] = {schema::is("engine", kExactEngines)};
inline constexpr schema::Condition kIsByRays[] = {schema::is("engine", kRayEngines)};
inline constexpr Need kNeedExact[] = {kIsExact};
inline constexpr Need kNeedRays[] = {kIsByRays};

/// Names of the illuminants for photometric computations.
inline constexpr std::string_view kPhotometricLights[] = {"a", "d65", "design"};

/// Names of the dyes that are shipped with the program. The name "none" means no dye.
inline constexpr std::string_view kDyes[] = {"none", "red", "amber"};
inline constexpr WordOrFile kDye{kDyes, ".csv", "none, red, amber or a file"};

/// Returns the row of the field `seed`. The row creates no option, because all commands have the common option --seed.
template <class Type>
constexpr Row seed_row() {
  return {"seed",
          Integer{kUnsigned32},
          "seed of the random numbers",
          schema::access<&Type::seed>,
          {.value = "S", .is_no_option = true}};
}

}  // namespace retrace::requests
