#include "fabrication/planing/check/lathe_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fabrication/planing/check/phase_profile.h"

namespace retrace::fabrication {
namespace {

/// Returns evenly spaced positions from 0 to `end_mm`, including both ends.
std::vector<double> places_to(double end_mm, double spacing_mm) {
  const auto pieces = static_cast<std::size_t>(std::ceil(end_mm / spacing_mm));
  std::vector<double> places;
  for (std::size_t i = 0; i <= pieces; ++i)
    places.push_back(end_mm * static_cast<double>(i) / static_cast<double>(pieces));
  return places;
}

/// Returns the cross-section of the part. It contains both end points of each wall.
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

/// Returns points along a line with distances of at most `spacing_mm`.
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

constexpr std::uint8_t kAxesXz = 0b101;
constexpr double kWordsMm = 2e-6;  // tolerance for positions that are rounded to whole nanometres

/// Returns the requirements on the programs. In some dialects, a line of the part file starts the spindle. Its
/// direction and speed cannot be determined from this line, so they are not checked.
ControlRule rule_of(const PlaningLathe& lathe, NcDialect dialect) {
  ControlRule rule;
  rule.axes = kAxesXz;
  rule.max_dwell_s = 0.0;
  rule.safe_z_mm = lathe.clearance_mm - kWordsMm;
  const bool is_clockwise = lathe.spindle_direction == SpindleDirection::clockwise;
  rule.spindle.rpm = static_cast<double>(lathe.spindle_rpm);
  rule.spindle.state = is_clockwise ? NcSpindle::clockwise : NcSpindle::counterclockwise;
  if (has_own_texts(dialect)) rule.spindle.state = NcSpindle::started_by_text;
  return rule;
}

bool goes_outwards(const std::vector<SectionPoint>& path) {
  const auto falls = [](const SectionPoint& a, const SectionPoint& b) { return b.x_mm < a.x_mm; };
  return path.size() > 1 && std::adjacent_find(path.begin(), path.end(), falls) == path.end();
}

/// Returns the spacing of the positions at which the surface is evaluated. It is smaller than the spacing of the
/// planner's points, so that the surface between these points is checked too.
double spacing_of(const PlanedPart& part) {
  const double nose = part.lathe->nose_radius_mm;
  const double end = part.lens.half_width_mm;
  if (nose > 0.0) return std::max({std::min(0.2 * part.tolerance_mm, nose / 40.0), nose / 400.0, end / 2e5});
  return std::max(0.37 * part.tolerance_mm, end / 1e5);
}

bool is_known(const NcMotion& motion, char axis) {
  return ((motion.known >> kNcAxisLetters.find(axis)) & 1U) != 0;
}

}  // namespace

LatheCheck::LatheCheck(const PlanedPart& part, FindingList& findings, PlaningCheck& result)
    : part_(part),
      spacing_mm_(spacing_of(part)),
      findings_(findings),
      result_(result),
      known_(findings, kAxesXz),
      stock_(part.lens.half_width_mm, spacing_mm_, part.lathe->nose_radius_mm),
      before_run_(stock_.heights_mm()) {}

void LatheCheck::begin(const NcProgram& program) {
  programs_.push_back(program.file);
  control_.emplace(findings_, rule_of(*part_.lathe, program.dialect));
  control_->begin(program);
}

std::int32_t LatheCheck::add_source(const NcMotion& motion) {
  sources_.push_back({programs_.size() - 1, motion.location.line});
  return static_cast<std::int32_t>(sources_.size() - 1);
}

void LatheCheck::add(const char* kind, std::int32_t who, const char* message, double value, double limit) {
  const Source& source = sources_[static_cast<std::size_t>(who)];
  findings_.add({kind, programs_[source.program], source.line, -1, message, value, limit, 1});
}

void LatheCheck::motion(const NcMotion& motion, const NcSettings& settings) {
  known_.motion(motion);
  control_->move(settings, motion);
  if (motion.move == NcMove::rapid) {
    end_run();
    follow_rapid(motion);
    return;
  }
  const PlaningLathe& lathe = *part_.lathe;
  control_->cut(settings, motion.location);
  control_->feed(motion, lathe.feed_mm_per_min);
  const SectionPoint from{motion.from.x_mm, motion.from.z_mm};
  const SectionPoint to{motion.to.x_mm, motion.to.z_mm};
  if (run_.empty()) run_.push_back(from);
  run_.push_back(to);
  stock_.cut(from, to, add_source(motion));
  ++result_.frames.back();
  if (const double feed = motion.path_speed_per_min(); feed > 0.0)
    result_.time_s.back() += std::hypot(to.x_mm - from.x_mm, to.z_mm - from.z_mm) / feed * 60.0;
}

/// Checks a rapid move. Its path is not always straight, so the nose may be anywhere in the box between both end
/// points.
void LatheCheck::follow_rapid(const NcMotion& motion) {
  const double clear_mm = part_.lathe->clearance_mm;
  const double from_z = is_known(motion, 'Z') ? motion.from.z_mm : motion.to.z_mm;
  const double from_x = is_known(motion, 'X') ? motion.from.x_mm : motion.to.x_mm;
  const double lowest = std::min(from_z, motion.to.z_mm);
  const bool only_rises = from_x == motion.to.x_mm && motion.to.z_mm >= from_z;
  if (!only_rises && lowest < clear_mm - kWordsMm)
    findings_.add("clearance", motion.location.line, "a rapid move goes below clear_mm", lowest, clear_mm);
  if (only_rises || lowest >= 0.0) return;
  const double taken = stock_.cut({from_x, lowest}, {motion.to.x_mm, lowest}, add_source(motion));
  if (taken > kWordsMm)
    findings_.add("rapid_in_material", motion.location.line, "a rapid move goes through remaining material", taken,
                  0.0);
  before_run_ = stock_.heights_mm();
}

/// Ends a run of feed moves and checks that its chip is at most as thick as the depth of cut. The tolerance is added to
/// this limit, because the path of each pass may deviate from the profile by the tolerance.
void LatheCheck::end_run() {
  if (run_.empty()) return;
  runs_.push_back(std::move(run_));
  run_.clear();
  const double limit = part_.lathe->depth_of_cut_mm;
  const std::vector<double>& heights = stock_.heights_mm();
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double taken = before_run_[i] - heights[i];
    result_.chip_mm_max = std::max(result_.chip_mm_max, taken);
    if (taken > limit + part_.tolerance_mm)
      add("chip_too_thick", stock_.who(i), "a pass removes more than the depth of cut", taken, limit);
  }
  before_run_ = heights;
}

void LatheCheck::dwell(double seconds, const NcLocation& place, const AxisPositions&) {
  result_.time_s.back() += seconds;
  if (!run_.empty()) control_->dwell(seconds, place);
}

void LatheCheck::stop(NcStop, const NcSettings&, const NcLocation& place) {
  if (!run_.empty()) control_->dwell(std::numeric_limits<double>::infinity(), place);
}

void LatheCheck::end(const NcEnd& end) {
  end_run();
  control_->spindle_at_end(end);
}

/// Returns the path of the last pass, without the move down to the profile. If the last run of feed moves does not
/// extend to the axis, the inner part of the path is taken from the runs before it. Gaps between the runs are closed at
/// the clearance height, because the tool was above the blank there.
std::vector<SectionPoint> LatheCheck::last_pass() const {
  std::vector<SectionPoint> path;
  for (auto run = runs_.rbegin(); run != runs_.rend() && (path.empty() || path.front().x_mm > 0.0); ++run) {
    const bool comes_down = (*run)[0].x_mm == (*run)[1].x_mm && (*run)[0].z_mm >= (*run)[1].z_mm;
    std::vector<SectionPoint> inner(run->begin() + (comes_down ? 1 : 0), run->end());
    if (!path.empty()) {
      const SectionPoint joint = path.front();
      const auto beyond =
          std::find_if(inner.begin(), inner.end(), [&](const SectionPoint& p) { return p.x_mm >= joint.x_mm; });
      if (beyond == inner.begin()) continue;
      if (beyond == inner.end()) {
        const double clear_mm = part_.lathe->clearance_mm;
        const double end_mm = inner.back().x_mm;
        inner.push_back({end_mm, clear_mm});
        inner.push_back({joint.x_mm, clear_mm});
      } else {
        const SectionPoint& before = *(beyond - 1);
        const double share = (joint.x_mm - before.x_mm) / (beyond->x_mm - before.x_mm);
        const SectionPoint at{joint.x_mm, before.z_mm + share * (beyond->z_mm - before.z_mm)};
        inner.erase(beyond, inner.end());
        inner.push_back(at);
      }
    }
    path.insert(path.begin(), inner.begin(), inner.end());
  }
  return path;
}

/// Finds moves before the last pass that went below the surface of the last pass by more than the tolerance.
void LatheCheck::find_gouges(const std::vector<SectionPoint>& path, const SectionLine& reachable, double limit_mm) {
  StockProfile last(part_.lens.half_width_mm, spacing_mm_, part_.lathe->nose_radius_mm);
  for (std::size_t i = 1; i < path.size(); ++i) last.cut(path[i - 1], path[i], 0);
  const std::vector<double>& heights = stock_.heights_mm();
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (heights[i] > last.heights_mm()[i] - kWordsMm) continue;
    const SectionPoint left{stock_.position_mm(i), heights[i]};
    const double distance = largest_distance({left}, reachable, 2.0 * part_.tolerance_mm + 2.0 * spacing_mm_);
    if (distance > limit_mm + spacing_mm_)
      add("gouge", stock_.who(i), "a move cuts below the surface of the last pass", last.heights_mm()[i] - heights[i],
          part_.tolerance_mm);
  }
}

void LatheCheck::measure() {
  const double nose = part_.lathe->nose_radius_mm;
  const double end = part_.lens.half_width_mm;
  const std::vector<SectionPoint> path = last_pass();
  const std::vector<double> places = places_to(end, spacing_mm_);
  const SectionLine design = section_of(PhaseProfile(part_.lens), places);
  SectionLine reachable = design;
  SectionLine left;
  for (const SectionPoint& p : path) left.push_back({p.x_mm, p.z_mm + nose});
  // The tolerance is increased by a thousandth, which is much more than the effect of rounded positions.
  double limit = part_.tolerance_mm * (1.0 + 1e-3);
  if (nose > 0.0) {
    // Include positions of the nose beyond the rim, because the nose also touches the rim from there.
    reachable = nose_envelope(lowest_centres(design, nose, places_to(end + nose, spacing_mm_)), nose, places);
    if (goes_outwards(path)) left = nose_envelope(left, nose, places);
    result_.unreached_mm_max = largest_distance(design, reachable, 2.0 * nose);
    limit += spacing_mm_ * spacing_mm_ / (8.0 * nose);  // maximum distance between a chord of a fillet and the fillet
  }
  const double reach = 2.0 * part_.tolerance_mm + 2.0 * spacing_mm_;
  result_.path_distance_mm_max = std::numeric_limits<double>::max();
  if (goes_outwards(path))
    result_.path_distance_mm_max =
        std::max(largest_distance(reachable, left, reach),
                 largest_distance(nose > 0.0 ? left : along(left, spacing_mm_), reachable, reach));
  if (result_.path_distance_mm_max > limit)
    findings_.add("path", 0, "the surface of the last pass is outside of the tolerance", result_.path_distance_mm_max,
                  part_.tolerance_mm);
  find_gouges(path, reachable, limit);
}

}  // namespace retrace::fabrication
