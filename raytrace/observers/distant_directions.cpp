#include "raytrace/observers/distant_directions.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include "raytrace/sampling/sobol.h"

namespace retrace::raytrace {
namespace {

// Number of points, and the key of their scramble.
constexpr std::uint32_t kTailPoints = 1U << 15;
constexpr std::uint64_t kTailKey = 0x2545f4914f6cdd1dU;
// Maximum distance of the points from the centre, in the plane of direction cosines.
constexpr double kFarthestCosine = 20.0;

}  // namespace

DistantDirections::DistantDirections(const geometry::Vec2& centre, double nearest) {
  const double decades = std::log(kFarthestCosine / nearest);
  if (!(decades > 0.0)) return;
  factor = 2.0 * std::numbers::pi * decades / kTailPoints;
  const SobolSquare square(kTailKey, ~kTailKey);
  for (std::uint32_t k = 0; k < kTailPoints; ++k) {
    const auto [u, v] = square(k);
    const double distance = nearest * std::exp(u * decades);
    cosines.push_back(
        centre + distance * geometry::Vec2(std::cos(2.0 * std::numbers::pi * v), std::sin(2.0 * std::numbers::pi * v)));
    areas.push_back(distance * distance);
  }
}

}  // namespace retrace::raytrace
