#include "fabrication/turning/plan/path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/math/jets.h"
#include "core/math/partials.h"
#include "fabrication/turning/plan/polynomial_spiral.h"
#include "fabrication/turning/plan/spiral.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::FreeformSurface, geometry::Vec2;
using jets::Jet2;

/// Returns the angles of the spindle at the points of a spiral, in turns.
std::vector<double> spiral_turns(const PathOptions& o, const InputLocation& where) {
  const double start = o.radius_mm + o.overrun_mm;
  const double turns = start / o.feed_mm;
  const double mean_arc = std::numbers::pi * start;
  const double count = o.sampling == Sampling::angle ? turns * o.points_per_turn : turns * mean_arc / o.arc_mm;
  if (!(count < static_cast<double>(kMaxPathPoints)))
    throw InputError(
        where, fmt::format("must give a path of at most {} points, but gives {:.3g} points", kMaxPathPoints, count));
  std::vector<double> result;
  result.reserve(static_cast<std::size_t>(count) + 2);
  if (o.sampling == Sampling::angle) {
    const auto whole = static_cast<std::size_t>(std::floor(turns * o.points_per_turn + 1e-9));
    for (std::size_t i = 0; i <= whole; ++i) result.push_back(static_cast<double>(i) / o.points_per_turn);
    return result;
  }
  for (double turn = 0.0; turn < turns;) {
    result.push_back(turn);
    turn += turns_between_points(o, o.feed_mm * (turns - turn));
  }
  return result;
}

/// Predicts the angle of the next point of contact on the nose, by quadratic extrapolation of the last three angles.
class ContactExtrapolation {
 public:
  explicit ContactExtrapolation(double end_rad) : end_rad_(end_rad) {}
  double next() const { return std::clamp(3.0 * (angles_[0] - angles_[1]) + angles_[2], -end_rad_, end_rad_); }
  void add(double angle_rad) { angles_ = {angle_rad, angles_[0], angles_[1]}; }

 private:
  double end_rad_;
  std::array<double, 3> angles_{};  // the most recent angle is the first element
};

Pass spiral(const FreeformSurface& surface, const TurningTool& tool, const PathOptions& o, const InputLocation& where) {
  if (const auto pass = polynomial_spiral(surface, tool, o)) return *pass;
  const ToolSpiral places(surface, tool, o);
  Pass pass;
  ContactExtrapolation forecast(places.end_rad());
  double last = 0.0;
  const std::vector<double> all_turns = spiral_turns(o, where);
  pass.reserve(all_turns.size());
  for (const double turns : all_turns) {
    double angle = forecast.next();
    PathPoint p = places.at(turns, angle);
    p.seconds = (turns - last) * 60.0 / o.spindle_rpm;
    forecast.add(angle);
    last = turns;
    pass.push_back(p);
  }
  return pass;
}

std::vector<Pass> raster(const FreeformSurface& surface, const TurningTool& tool, const PathOptions& o,
                         const InputLocation& where) {
  // Number of lines. The last line is at most half a feed inside the border, so that the strip at the border is not
  // higher than the cusps.
  const double lines = std::ceil(o.height_mm / o.feed_mm - 0.5 - 1e-9) + 1.0;
  const double points = std::max(1.0, std::ceil(o.width_mm / o.arc_mm - 1e-9));
  if (!(lines * points < static_cast<double>(kMaxPathPoints)))
    throw InputError(where, fmt::format("must give a path of at most {} points, but gives {:.3g} points",
                                        kMaxPathPoints, lines * points));
  const NoseCompensation nose(surface, tool,
                              SingleContactMap(surface, tool, 0.5 * std::hypot(o.width_mm, o.height_mm)));
  // The rake face is perpendicular to machine Y. A skew rotates the part, and with it the lines, relative to the rake
  // face.
  const double cosine = std::cos(tool.skew_deg * kRadPerDeg);
  const double sine = std::sin(tool.skew_deg * kRadPerDeg);
  const Vec2 across(cosine, sine);
  const Vec2 cut(sine, -cosine);
  const double step = o.width_mm / points;
  std::vector<Pass> passes;
  for (int line = 0; line < static_cast<int>(lines); ++line) {
    Pass pass;
    ContactExtrapolation forecast(nose.end_rad());
    for (int i = 0; i <= static_cast<int>(points); ++i) {
      PathPoint p;
      const Vec2 tip(0.5 * o.height_mm - o.feed_mm * line, 0.5 * o.width_mm - step * i);
      p.x_mm = across.dot(tip);
      p.y_mm = -cut.dot(tip);
      p.c_deg = tool.skew_deg == 0.0 ? 0.0 : -tool.skew_deg;
      p.seconds = i == 0 ? 0.0 : 60.0 * step / o.cutting_mm_per_min;
      double angle = forecast.next();
      p.z_mm = nose.height_mm(tip.x(), tip.y(), across, cut, angle);
      forecast.add(angle);
      pass.push_back(p);
    }
    passes.push_back(std::move(pass));
  }
  return passes;
}

void spin_up_and_down(Pass& pass, double spindle_rpm, double acceleration_deg_per_s2) {
  const SpindleMotion times(pass.back().c_deg, 6.0 * spindle_rpm, acceleration_deg_per_s2);
  for (std::size_t i = 1; i < pass.size(); ++i)
    pass[i].seconds = times.time_s(pass[i].c_deg) - times.time_s(pass[i - 1].c_deg);
}

/// Divides Z of a spiral between slide and servo. The slide follows the mean over one turn centred at each point, and
/// the servo adds the difference. In the first and the last half turn, the slide moves linearly.
void split_with_servo(Pass& pass, int points_per_turn) {
  const std::size_t count = pass.size();
  const auto turn = static_cast<std::size_t>(points_per_turn);
  const std::size_t half = turn / 2;
  if (count < turn + 2) return;
  std::vector<double> sums(count + 1, 0.0);
  for (std::size_t i = 0; i < count; ++i) sums[i + 1] = sums[i] + pass[i].z_mm;
  const auto mean_from = [&](std::size_t first) {
    return (sums[first + turn] - sums[first]) / static_cast<double>(turn);
  };
  const std::size_t last = count - turn;  // first point of the last window of one turn
  for (std::size_t i = 0; i < count; ++i) {
    const double window = static_cast<double>(i) - static_cast<double>(half);
    double mean = 0.0;
    if (window < 0.0)
      mean = mean_from(0) + window * (mean_from(1) - mean_from(0));
    else if (window > static_cast<double>(last))
      mean = mean_from(last) + (window - static_cast<double>(last)) * (mean_from(last) - mean_from(last - 1));
    else
      mean = mean_from(i - half);
    pass[i].servo_mm = pass[i].z_mm - mean;
    pass[i].z_mm = mean;
  }
}

}  // namespace

NoseCompensation::NoseCompensation(const FreeformSurface& surface, const TurningTool& tool, SingleContactMap map)
    : surface_(surface),
      map_(std::move(map)),
      radius_mm_(tool.nose_radius_mm),
      sin_rake_(std::sin(tool.rake_deg * kRadPerDeg)),
      cos_rake_(std::cos(tool.rake_deg * kRadPerDeg)),
      end_rad_(0.5 * tool.window_deg * kRadPerDeg) {}

double NoseCompensation::sampled(double x_mm, double y_mm, const Vec2& across, const Vec2& cut, double angle) const {
  const double aside = radius_mm_ * std::sin(angle);
  const double lift = radius_mm_ * (1.0 - std::cos(angle));
  const Vec2 p = Vec2(x_mm, y_mm) + aside * across - lift * sin_rake_ * cut;
  return surface_.height_mm(p.x(), p.y()) - lift * cos_rake_;
}

NoseCompensation::SearchResult NoseCompensation::searched(double x_mm, double y_mm, const Vec2& across, const Vec2& cut,
                                                          double& angle) const {
  constexpr int kMaxSteps = 12;
  // The error of the height after a step is of third order in the step. For steps below this limit, it is less than
  // 1e-14 mm.
  constexpr double kSmallStep = 2e-5;
  SearchResult touch;
  for (int step = 0; step < kMaxSteps; ++step) {
    const double sine = std::sin(angle);
    const double cosine = std::cos(angle);
    const Jet2 aside(radius_mm_ * sine, radius_mm_ * cosine, -0.5 * radius_mm_ * sine);
    const Jet2 lift(radius_mm_ * (1.0 - cosine), radius_mm_ * sine, 0.5 * radius_mm_ * cosine);
    const Jet2 back = lift * sin_rake_;
    const Jet2 f =
        surface_.evaluate(aside * across.x() - back * cut.x() + x_mm, aside * across.y() - back * cut.y() + y_mm) -
        lift * cos_rake_;
    touch.height_mm = f[0];
    // If the surface is more concave than the nose, there is no maximum near this angle. Another start value is needed.
    if (!(f[2] < 0.0)) return touch;
    const double change = std::clamp(-0.5 * f[1] / f[2], -0.5, 0.5);
    const double next = std::clamp(angle + change, -end_rad_, end_rad_);
    const double done = next - angle;
    angle = next;
    touch.height_mm = f[0] + done * (f[1] + done * f[2]);
    touch.is_found = std::abs(done) < kSmallStep;
    if (touch.is_found) return touch;
  }
  return touch;
}

double NoseCompensation::height_mm(double x_mm, double y_mm, const Vec2& across, const Vec2& cut,
                                   double& start_rad) const {
  const SearchResult touch = searched(x_mm, y_mm, across, cut, start_rad);
  if (touch.is_found && map_.has_single_contact(x_mm, y_mm)) return touch.height_mm;
  double height = touch.height_mm;
  // Search the whole edge, because a distant point may touch a steep part of the surface first, for example a lenslet.
  constexpr int kPlaces = 8;
  double best = start_rad;
  double highest = height;
  for (int i = 0; i <= kPlaces; ++i) {
    const double angle = end_rad_ * (2.0 * i / kPlaces - 1.0);
    const double z = sampled(x_mm, y_mm, across, cut, angle);
    if (z > highest) {
      highest = z;
      best = angle;
    }
  }
  if (highest > height) {
    double angle = best;
    height = std::max(highest, searched(x_mm, y_mm, across, cut, angle).height_mm);
    start_rad = angle;
  }
  return height;
}

std::vector<Pass> make_path(const FreeformSurface& surface, const TurningTool& tool, const PathOptions& options,
                            const InputLocation& where) {
  if (options.strategy == Strategy::raster) return raster(surface, tool, options, where);
  std::vector<Pass> passes;
  passes.push_back(spiral(surface, tool, options, where));
  if (options.spin_deg_per_s2) spin_up_and_down(passes.front(), options.spindle_rpm, *options.spin_deg_per_s2);
  if (options.servo == Servo::fast) split_with_servo(passes.front(), options.points_per_turn);
  return passes;
}

}  // namespace retrace::fabrication::turning
