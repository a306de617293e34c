#include "fabrication/planing/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fabrication/planing/chords.h"
#include "fabrication/planing/mill_check.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {
namespace {

/// Keeps the feed moves of a lathe since the last rapid move, which is those of the last pass at the end.
class LathePath : public NcSink {
 public:
  LathePath(const PlanedPart& part, PlaningCheck& result) : part_(part), result_(result) {}

  void motion(const NcMotion& motion, const NcSettings&) override {
    if (motion.move == NcMove::rapid) {
      if (feeding_) last_ = std::move(now_);
      now_.clear();
      feeding_ = false;
      return;
    }
    if (now_.empty()) now_.push_back({motion.from.x_mm, motion.from.z_mm});
    now_.push_back({motion.to.x_mm, motion.to.z_mm});
    feeding_ = true;
    ++result_.frames.back();
    result_.time_s.back() += std::hypot(motion.to.x_mm - motion.from.x_mm, motion.to.z_mm - motion.from.z_mm) /
                             part_.lathe->feed_mm_per_min * 60.0;
  }
  void dwell(double seconds, const NcPlace&, const AxisPositions&) override { result_.time_s.back() += seconds; }
  /// Without the way down to the profile.
  std::vector<ProfilePoint> last_pass() const {
    return last_.empty() ? last_ : std::vector<ProfilePoint>(last_.begin() + 1, last_.end());
  }

 private:
  const PlanedPart& part_;
  PlaningCheck& result_;
  std::vector<ProfilePoint> now_;
  std::vector<ProfilePoint> last_;
  bool feeding_ = false;
};

double distance_to_piece(const ProfilePoint& p, const ProfilePoint& a, const ProfilePoint& b) {
  const double dx = b.x_mm - a.x_mm;
  const double dz = b.z_mm - a.z_mm;
  const double length2 = dx * dx + dz * dz;
  const double along = length2 > 0.0 ? ((p.x_mm - a.x_mm) * dx + (p.z_mm - a.z_mm) * dz) / length2 : 0.0;
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(p.x_mm - a.x_mm - t * dx, p.z_mm - a.z_mm - t * dz);
}

/// Largest distance of points from a line of pieces that goes the same way.
double largest_distance(const std::vector<ProfilePoint>& points, const std::vector<ProfilePoint>& line) {
  if (line.size() < 2) return std::numeric_limits<double>::max();
  double largest = 0.0;
  std::size_t near = 1;
  for (const ProfilePoint& p : points) {
    double best = std::numeric_limits<double>::max();
    // Pieces whose span holds the point, and one on either side.
    while (near + 1 < line.size() && line[near].x_mm < p.x_mm) ++near;
    while (near > 1 && line[near - 1].x_mm >= p.x_mm) --near;
    for (std::size_t k = near > 3 ? near - 3 : 1; k < std::min(line.size(), near + 4); ++k)
      best = std::min(best, distance_to_piece(p, line[k - 1], line[k]));
    largest = std::max(largest, best);
  }
  return largest;
}

void check_lathe(const PlanedPart& part, const std::vector<ProfilePoint>& path, PlaningCheck& result) {
  const ZoneProfile profile(part.lens);
  // Finer than the planner's points: what lies between them counts too.
  const std::vector<ProfilePoint> points =
      points_of(profile, std::max(0.37 * part.tolerance_mm, part.lens.half_width_mm / 100000.0));
  result.path_distance_mm_max = largest_distance(points, path);
  // Rounding of the words, and curvature between the planner's points, are far below.
  if (result.path_distance_mm_max > part.tolerance_mm * (1.0 + 1e-3))
    result.findings.push_back(
        {"path", "", 0, "the last pass leaves the tube of tolerance", result.path_distance_mm_max, part.tolerance_mm});
}

}  // namespace

PlaningCheck check_planing(const PlanedPart& part, double flank_slope, const std::vector<PlaningText>& programs,
                           NcDialect dialect) {
  PlaningCheck result;
  MillCheck mill(part, flank_slope, result);
  std::vector<ProfilePoint> path;
  for (const PlaningText& program : programs) {
    const NcProgram nc = parse_nc(program.text, program.name, dialect);
    NcEnd end;
    if (part.mill) {
      mill.begin(program.name);
      end = run_nc(nc, mill);
      mill.end();
    } else {
      result.time_s.push_back(0.0);
      result.frames.push_back(0);
      LathePath lathe(part, result);
      end = run_nc(nc, lathe);
      path = lathe.last_pass();
    }
    if (!end.is_complete) result.findings.push_back({"truncated", program.name, end.line, end.reason, 0.0, 0.0});
  }
  if (part.mill)
    mill.measure();
  else
    check_lathe(part, path, result);
  return result;
}

}  // namespace retrace::fabrication
