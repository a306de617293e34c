#include "raytrace/balls/ball_lattice.h"

#include <array>
#include <cmath>
#include <numbers>

namespace retrace::raytrace {
namespace {

constexpr double kRowOverPitch = 0.5 * std::numbers::sqrt3;
// Maximum number of steps for which a ray between the balls is followed. Each step is half a pitch long, measured along
// the plane. A nearly horizontal ray that needs more steps is not traced further.
constexpr int kMaxSteps = 4096;
/// Index offsets of a ball and its six neighbours.
constexpr std::array<BallIndex, 7> kAround = {{{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}}};

}  // namespace

Vec3 BallLattice::centre_mm(const BallIndex& ball) const {
  if (!pitch_mm_) return Vec3::Zero();
  const auto along = static_cast<double>(ball.along);
  const auto row = static_cast<double>(ball.row);
  return *pitch_mm_ * Vec3(along + 0.5 * row, kRowOverPitch * row, 0.0);
}

Vec2 BallLattice::period_mm() const {
  return *pitch_mm_ * Vec2(1.0, 2.0 * kRowOverPitch);
}

BallIndex BallLattice::nearest(const Vec2& point_mm) const {
  const double row = point_mm.y() / (kRowOverPitch * *pitch_mm_);
  const double along = point_mm.x() / *pitch_mm_ - 0.5 * row;
  const double third = -along - row;
  double r_along = std::round(along);
  double r_row = std::round(row);
  const double r_third = std::round(third);
  // The three hexagonal coordinates of a ball add up to 0. After rounding, the coordinate with the largest rounding
  // error is therefore computed from the other two.
  const double off_along = std::abs(r_along - along);
  const double off_row = std::abs(r_row - row);
  const double off_third = std::abs(r_third - third);
  if (off_along > off_row && off_along > off_third)
    r_along = -r_row - r_third;
  else if (off_row > off_third)
    r_row = -r_along - r_third;
  return {static_cast<std::int64_t>(r_along), static_cast<std::int64_t>(r_row)};
}

std::optional<double> BallLattice::distance_to(const BallIndex& ball, const Vec3& origin_mm,
                                               const Vec3& direction) const {
  const Vec3 from = origin_mm - centre_mm(ball);
  const double towards = -from.dot(direction);
  if (towards <= 0.0) return std::nullopt;
  const double miss2 = (from + towards * direction).squaredNorm();
  const double half2 = radius_mm_ * radius_mm_ - miss2;
  if (half2 <= 0.0) return std::nullopt;
  const double distance = towards - std::sqrt(half2);
  const bool is_above = from.z() + distance * direction.z() > 0.0;
  return is_above && distance >= 0.0 ? std::optional(distance) : std::nullopt;
}

BallLattice::SearchResult BallLattice::follow(const Vec3& origin_mm, const Vec3& direction,
                                              const BallIndex* leaving) const {
  SearchResult way;
  way.is_rising = direction.z() > 0.0;
  const auto hit_at = [&](const BallIndex& ball, double distance) {
    const Vec3 from_centre = origin_mm + distance * direction - centre_mm(ball);
    return Hit{ball, from_centre * (radius_mm_ / from_centre.norm())};
  };
  if (!pitch_mm_) {
    if (leaving != nullptr) return way;
    if (const auto distance = distance_to({}, origin_mm, direction)) way.hit = hit_at({}, *distance);
    return way;
  }
  const double level = direction.head<2>().norm();
  const double to_end = way.is_rising ? (radius_mm_ - origin_mm.z()) / direction.z() : origin_mm.z() / -direction.z();
  const double step = 0.5 * *pitch_mm_ / std::max(level, 1e-12);
  double begin = 0.0;
  for (int k = 0; k < kMaxSteps; ++k, begin += step) {
    const double end = std::min(begin + step, to_end);
    // The balls that the segment may meet are the ball nearest to its midpoint and the neighbours of this ball.
    const BallIndex middle = nearest((origin_mm + 0.5 * (begin + end) * direction).head<2>());
    std::optional<double> first;
    for (const BallIndex& around : kAround) {
      const BallIndex ball{middle.along + around.along, middle.row + around.row};
      if (leaving != nullptr && ball == *leaving) continue;
      const auto distance = distance_to(ball, origin_mm, direction);
      if (!distance || *distance > end || (first && *distance >= *first)) continue;
      first = distance;
      way.hit = hit_at(ball, *distance);
    }
    if (way.hit || end >= to_end) return way;
  }
  way.is_abandoned = true;
  return way;
}

}  // namespace retrace::raytrace
