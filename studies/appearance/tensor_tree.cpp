#include "studies/appearance/tensor_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;

constexpr int kFinestLevel = 8;
constexpr int kCoarsestLevel = 3;
// Minimum number of grid steps of the table across a leaf.
constexpr double kStepsPerLeaf = 4.0;
// Number of sampled directions of light along each side of a leaf. The value of the leaf is their mean.
constexpr int kLightsAcross = 3;

/// Maps the unit square to the unit disc (Shirley and Chiu).
Vec2 disc_from_square(const Vec2& square) {
  const double a = 2.0 * square.x() - 1.0;
  const double b = 2.0 * square.y() - 1.0;
  if (a == 0.0 && b == 0.0) return Vec2::Zero();
  constexpr double kEighth = std::numbers::pi / 4.0;
  const bool is_wide = std::abs(a) > std::abs(b);
  const double radius = is_wide ? a : b;  // a negative radius rotates the point by 180 degrees
  const double angle = is_wide ? kEighth * b / a : kEighth * (2.0 - a / b);
  return radius * Vec2(std::cos(angle), std::sin(angle));
}

Vec2 square_from_disc(const Vec2& disc) {
  const double radius = std::min(disc.norm(), 1.0 - 1e-12);
  if (radius == 0.0) return Vec2::Constant(0.5);
  constexpr double kEighth = std::numbers::pi / 4.0;
  const bool is_wide = std::abs(disc.x()) > std::abs(disc.y());
  // Angle of the point from the nearest coordinate axis, between minus and plus 45 degrees.
  const double across = is_wide ? std::atan(disc.y() / disc.x()) : std::atan(disc.x() / disc.y());
  const double along = std::copysign(radius, is_wide ? disc.x() : disc.y());
  const Vec2 ab = is_wide ? Vec2(along, along * across / kEighth) : Vec2(along * across / kEighth, along);
  return 0.5 * (ab + Vec2::Ones());
}

std::uint64_t leaf_number(const std::array<std::uint32_t, 4>& place, int level) {
  std::uint64_t number = 0;
  for (int bit = level - 1; bit >= 0; --bit)
    for (int dimension = 3; dimension >= 0; --dimension)
      number = (number << 1) | ((place[static_cast<std::size_t>(dimension)] >> bit) & 1U);
  return number;
}

std::uint32_t cell_of(double place, int level) {
  const double cells = std::ldexp(1.0, level);
  return static_cast<std::uint32_t>(std::clamp(std::floor(place * cells), 0.0, cells - 1.0));
}

}  // namespace

double TensorTree::leaf_width() const {
  return std::sqrt(std::numbers::pi) * std::ldexp(1.0, -level);
}

TensorTree tensor_tree_of(const ReflectionTable& table) {
  TensorTree tree;
  const double finest = std::floor(std::log2(2.0 / (kStepsPerLeaf * table.step())));
  tree.level = static_cast<int>(std::clamp<double>(finest, kCoarsestLevel, kFinestLevel));
  const std::uint32_t cells = 1U << tree.level;
  const double projected_sr = std::numbers::pi / (static_cast<double>(cells) * cells);
  const double most_sine = std::sin(table.max_entrance.rad());
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      std::map<std::uint64_t, double> power;
      for (int sub = 0; sub < kLightsAcross * kLightsAcross; ++sub) {
        const Vec2 within((sub % kLightsAcross + 0.5) / kLightsAcross, (sub / kLightsAcross + 0.5) / kLightsAcross);
        const Vec2 light = -disc_from_square((Vec2(x, y) + within) / cells);
        if (light.norm() > most_sine) continue;
        const Vec3 to_source(light.x(), light.y(), std::sqrt(1.0 - light.squaredNorm()));
        table.for_each_power(to_source, [&](const Vec2& to_observer, double share) {
          const Vec2 view = square_from_disc(to_observer);
          power[leaf_number({x, y, cell_of(view.x(), tree.level), cell_of(view.y(), tree.level)}, tree.level)] += share;
        });
      }
      for (const auto& [leaf, share] : power)
        if (share > 0.0) tree.leaves.emplace_back(leaf, share / (kLightsAcross * kLightsAcross * projected_sr));
    }
  std::sort(tree.leaves.begin(), tree.leaves.end());
  return tree;
}

}  // namespace retrace::studies
