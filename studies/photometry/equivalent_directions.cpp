#include "studies/photometry/equivalent_directions.h"

#include <optional>

namespace retrace::studies {
namespace {

// Maximum difference of two unit vectors that count as one direction.
constexpr double kSameDirection = 1e-12;

/// Returns the signs of x and y that transform one direction into the other. Returns nothing if there are none.
std::optional<geometry::Vec2> signs_between(const geometry::Vec3& a, const geometry::Vec3& b,
                                            const std::array<bool, 2>& mirrors) {
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0}) {
      const SharedDirection other{0, {x, y}};
      const bool is_allowed = (x > 0.0 || mirrors[0]) && (y > 0.0 || mirrors[1]);
      if (is_allowed && (other.mirrored(a) - b).norm() < kSameDirection) return other.signs;
    }
  return std::nullopt;
}

}  // namespace

std::vector<EquivalentDirections> group_equivalent_directions(const std::vector<geometry::Vec3>& to_source,
                                                              const std::array<bool, 2>& mirrors) {
  std::vector<EquivalentDirections> all;
  for (std::size_t k = 0; k < to_source.size(); ++k) {
    bool is_known = false;
    for (EquivalentDirections& known : all) {
      const auto signs = signs_between(to_source[known.front().index], to_source[k], mirrors);
      is_known = signs.has_value();
      if (!is_known) continue;
      known.push_back({k, *signs});
      break;
    }
    if (!is_known) all.push_back({{k, geometry::Vec2::Ones()}});
  }
  return all;
}

}  // namespace retrace::studies
