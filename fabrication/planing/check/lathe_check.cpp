#include "fabrication/planing/check/lathe_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fabrication/planing/check/phase_profile.h"
#include "fabrication/planing/check/swept_nose.h"

namespace retrace::fabrication {
namespace {

/// Evenly spaced, the last one included.
std::vector<double> places_to(double end_mm, double spacing_mm) {
  const auto pieces = static_cast<std::size_t>(std::ceil(end_mm / spacing_mm));
  std::vector<double> places;
  for (std::size_t i = 0; i <= pieces; ++i)
    places.push_back(end_mm * static_cast<double>(i) / static_cast<double>(pieces));
  return places;
}

/// The part's section, walls with both ends.
SectionLine section_of(const PhaseProfile& profile, const std::vector<double>& places_mm) {
  SectionLine section;
  auto wall = profile.walls().begin();
  for (const double x : places_mm) {
    for (; wall != profile.walls().end() && wall->x_mm <= x; ++wall) {
      section.push_back({wall->x_mm, -wall->inner_depth_mm});
      section.push_back({wall->x_mm, -wall->outer_depth_mm});
    }
    if (section.empty() || section.back().x_mm < x) section.push_back({x, -profile.depth_mm(x)});
  }
  return section;
}

/// Places along a line, no farther apart.
SectionLine along(const SectionLine& line, double spacing_mm) {
  SectionLine places;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double dx = line[i].x_mm - line[i - 1].x_mm;
    const double dz = line[i].z_mm - line[i - 1].z_mm;
    const auto pieces = static_cast<int>(std::ceil(std::hypot(dx, dz) / spacing_mm));
    for (int k = 0; k < pieces; ++k)
      places.push_back({line[i - 1].x_mm + dx * k / pieces, line[i - 1].z_mm + dz * k / pieces});
  }
  if (!line.empty()) places.push_back(line.back());
  return places;
}

/// A PMAC is told by lines of the part's file, which say nothing of sense and speed that could be read.
ControlRule rule_of(const PlaningLathe& lathe, NcDialect dialect) {
  ControlRule rule;
  const bool is_clockwise = lathe.spindle_direction == SpindleDirection::clockwise;
  rule.spindle.rpm = static_cast<double>(lathe.spindle_rpm);
  rule.spindle.turns = is_clockwise ? NcSpindle::clockwise : NcSpindle::counterclockwise;
  if (dialect == NcDialect::pmac) rule.spindle.turns = NcSpindle::started_by_text;
  return rule;
}

bool goes_outwards(const std::vector<PathPlace>& path) {
  const auto falls = [](const PathPlace& a, const PathPlace& b) { return b.x_mm < a.x_mm; };
  return path.size() > 1 && std::adjacent_find(path.begin(), path.end(), falls) == path.end();
}

}  // namespace

LatheCheck::LatheCheck(const PlanedPart& part, NcDialect dialect, FindingList& findings, PlaningCheck& result)
    : part_(part), control_(findings, rule_of(*part.lathe, dialect)), result_(result) {}

void LatheCheck::motion(const NcMotion& motion, const NcSettings& settings) {
  if (motion.move == NcMove::rapid) {
    if (feeding_) last_ = std::move(now_);
    now_.clear();
    feeding_ = false;
    return;
  }
  control_.cut(settings, motion.place);
  if (now_.empty()) now_.push_back({motion.from.x_mm, motion.from.z_mm});
  now_.push_back({motion.to.x_mm, motion.to.z_mm});
  feeding_ = true;
  ++result_.frames.back();
  result_.time_s.back() += std::hypot(motion.to.x_mm - motion.from.x_mm, motion.to.z_mm - motion.from.z_mm) /
                           part_.lathe->feed_mm_per_min * 60.0;
}

std::vector<PathPlace> LatheCheck::last_pass() const {
  return last_.empty() ? last_ : std::vector<PathPlace>(last_.begin() + 1, last_.end());
}

void measure_turned(const PlanedPart& part, const std::vector<PathPlace>& path, FindingList& findings,
                    PlaningCheck& result) {
  const double nose = part.lathe->nose_radius_mm;
  const double end = part.lens.half_width_mm;
  // Finer than the planner's points: what lies between them counts too.
  double spacing = std::max(0.37 * part.tolerance_mm, end / 1e5);
  if (nose > 0.0) spacing = std::max({std::min(0.2 * part.tolerance_mm, nose / 40.0), nose / 400.0, end / 2e5});
  const std::vector<double> places = places_to(end, spacing);
  const SectionLine design = section_of(PhaseProfile(part.lens), places);
  SectionLine reachable = design;
  SectionLine left;
  for (const PathPlace& p : path) left.push_back({p.x_mm, p.z_mm + nose});
  double limit = part.tolerance_mm * (1.0 + 1e-3);  // rounding of the words is far below
  if (nose > 0.0) {
    // The rim is touched from beyond it.
    reachable = left_by_nose(lowest_centres(design, nose, places_to(end + nose, spacing)), nose, places);
    if (goes_outwards(path)) left = left_by_nose(left, nose, places);
    result.unreached_mm_max = largest_distance(design, reachable, 2.0 * nose);
    limit += spacing * spacing / (8.0 * nose);  // by which chords of a fillet stand off from it
  }
  const double reach = 2.0 * part.tolerance_mm + 2.0 * spacing;
  result.path_distance_mm_max = std::numeric_limits<double>::max();
  if (goes_outwards(path))
    result.path_distance_mm_max =
        std::max(largest_distance(reachable, left, reach),
                 largest_distance(nose > 0.0 ? left : along(left, spacing), reachable, reach));
  if (result.path_distance_mm_max > limit)
    findings.add("path", 0, "the last pass leaves the tube of tolerance", result.path_distance_mm_max,
                 part.tolerance_mm);
}

}  // namespace retrace::fabrication
