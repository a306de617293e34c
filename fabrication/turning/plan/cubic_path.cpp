#include "fabrication/turning/plan/cubic_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/angle.h"
#include "core/length_units.h"
#include "core/number_format.h"
#include "fabrication/turning/plan/spiral.h"

namespace retrace::fabrication::turning {
namespace {

/// Spiral as a function of time.
class TimedSpiral {
 public:
  /// \param unit_s time unit; the durations of the ramps and of the motion between them are multiples of it
  TimedSpiral(const geometry::FreeformSurface& surface, const TurningTool& tool, const PathOptions& o, double unit_s)
      : options_(o),
        places_(surface, tool, o),
        spin_(SpindleMotion(360.0 * places_.total_turns(), 6.0 * o.spindle_rpm, *o.spin_deg_per_s2)
                  .in_whole_steps(unit_s)) {}

  /// Returns the times at which the acceleration of C changes. Cubic moves must end at these times.
  std::array<double, 3> corners_s() const {
    return {spin_.ramp_s(), spin_.total_s() - spin_.ramp_s(), spin_.total_s()};
  }
  double turns_at(double time_s) const { return spin_.c_deg(time_s) / 360.0; }

  PathPoint place_at(double time_s) { return places_.at(turns_at(time_s), touch_rad_); }

  CubicPoint point_at(double time_s) {
    CubicPoint point;
    point.point = place_at(time_s);
    const double turns_per_s = spin_.speed_deg_per_s(time_s) / 360.0;
    // X and Y change linearly with the angle of the spindle.
    const double turns = turns_at(time_s);
    const double left = places_.total_turns() - turns;
    const double share = left > 0.0 ? turns_per_s / left : 0.0;
    point.velocities[kX] = -share * point.point.x_mm;
    point.velocities[kY] = -share * point.point.y_mm;
    point.velocities[kZ] = turns_per_s * rise_at(turns);
    point.velocities[kC] = 360.0 * turns_per_s;
    return point;
  }

  /// Returns the maximum distance, at the tool, between a cubic move and the spiral. Also determines the highest Z of
  /// the move.
  double error_mm(const CubicPoint& from, CubicPoint& to, double from_s, double to_s) {
    const double turns = turns_at(to_s) - turns_at(from_s);
    const double radius_mm = std::max(places_.radius_mm(turns_at(to_s)), 0.5 * options_.feed_mm);
    constexpr double kFewest = 8.0;
    const int parts = static_cast<int>(std::max(kFewest, std::ceil(turns / turns_between_points(options_, radius_mm))));
    double worst = 0.0;
    to.highest_mm = std::max(from.point.z_mm, to.point.z_mm);
    for (int k = 1; k < parts; ++k) {
      const double t = static_cast<double>(k) / parts;
      const PathPoint is = on_cubic(from, to, to_s - from_s, t);
      const PathPoint is_meant = place_at(from_s + t * (to_s - from_s));
      to.highest_mm = std::max(to.highest_mm, is.z_mm);
      const double arm_mm = std::hypot(is_meant.x_mm, is_meant.y_mm);
      worst = std::max(worst,
                       std::hypot(std::hypot(is.x_mm - is_meant.x_mm, is.y_mm - is_meant.y_mm, is.z_mm - is_meant.z_mm),
                                  arm_mm * kRadPerDeg * (is.c_deg - is_meant.c_deg)));
    }
    return worst;
  }

 private:
  /// Returns the derivative of Z, in mm per turn, by a difference quotient of fourth order.
  double rise_at(double turns) {
    constexpr double h = 2e-4;
    const auto z = [&](double at) { return places_.at(at, touch_rad_).z_mm; };
    return (8.0 * (z(turns + h) - z(turns - h)) - (z(turns + 2.0 * h) - z(turns - 2.0 * h))) / (12.0 * h);
  }

  static PathPoint on_cubic(const CubicPoint& from, const CubicPoint& to, double seconds, double t) {
    const auto along = [&](double begin, double end, Axis axis) {
      return begin + t * t * (3.0 - 2.0 * t) * (end - begin) +
             t * (1.0 - t) * seconds * ((1.0 - t) * from.velocities[axis] - t * to.velocities[axis]);
    };
    PathPoint p;
    p.x_mm = along(from.point.x_mm, to.point.x_mm, kX);
    p.y_mm = along(from.point.y_mm, to.point.y_mm, kY);
    p.z_mm = along(from.point.z_mm, to.point.z_mm, kZ);
    p.c_deg = along(from.point.c_deg, to.point.c_deg, kC);
    return p;
  }

  const PathOptions& options_;
  ToolSpiral places_;
  SpindleMotion spin_;
  double touch_rad_ = 0.0;
};

/// Returns the factor by which the duration of a move can be increased to reach the maximum error. The error of a cubic
/// move is of fourth order in its duration.
double growth(double most_mm, double error_mm) {
  constexpr double kCare = 0.9;
  constexpr double kMost = 2.0;
  return error_mm > 0.0 ? std::min(kMost, kCare * std::pow(most_mm / error_mm, 0.25)) : kMost;
}

}  // namespace

CubicPath cubic_path(const geometry::FreeformSurface& surface, const TurningTool& tool, const PathOptions& options,
                     double min_block_s, const InputLocation& where) {
  // All durations are multiples of the shortest duration.
  const double unit_s = kCubicStepS * std::max(1.0, std::ceil(min_block_s / kCubicStepS - 1e-9));
  TimedSpiral spiral(surface, tool, options, unit_s);
  const double most_mm = *options.cubic_error_nm / kNmPerMm;
  const auto units_in = [&](double seconds) { return static_cast<std::int64_t>(std::llround(seconds / unit_s)); };
  // At least two moves per turn are used, so that the angle of C is unique.
  const std::int64_t longest = std::max<std::int64_t>(1, units_in(30.0 / options.spindle_rpm));
  CubicPath path;
  path.points.push_back(spiral.point_at(0.0));
  path.points.front().highest_mm = path.points.front().point.z_mm;
  std::int64_t guess = 1;
  std::int64_t at = 0;
  for (const double corner_s : spiral.corners_s()) {
    const std::int64_t corner = units_in(corner_s);
    while (at < corner) {
      const std::int64_t units = std::min({guess, longest, corner - at});
      const double from_s = unit_s * static_cast<double>(at);
      const double to_s = unit_s * static_cast<double>(at + units);
      CubicPoint point = spiral.point_at(to_s);
      const double error_mm = spiral.error_mm(path.points.back(), point, from_s, to_s);
      guess =
          std::max<std::int64_t>(1, static_cast<std::int64_t>(static_cast<double>(units) * growth(most_mm, error_mm)));
      if (error_mm > most_mm && units == 1)
        throw InputError(
            where, fmt::format("is too small: a cubic move of {} ms at a radius of {} mm has an error of {} nm. Use a "
                               "lower spindle_rpm",
                               fixed_visible(1e3 * unit_s, 3), fixed(std::hypot(point.point.x_mm, point.point.y_mm), 4),
                               fixed(kNmPerMm * error_mm, 2)));
      if (error_mm > most_mm) {
        guess = std::min(guess, units - 1);
        continue;
      }
      point.point.seconds = to_s - from_s;
      path.error_nm = std::max(path.error_nm, kNmPerMm * error_mm);
      path.points.push_back(point);
      if (path.points.size() > kMaxPathPoints)
        throw InputError(where, fmt::format("must give a path of at most {} points", kMaxPathPoints));
      at += units;
    }
  }
  return path;
}

}  // namespace retrace::fabrication::turning
