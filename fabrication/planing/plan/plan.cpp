#include "fabrication/planing/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "core/error.h"
#include "core/number_format.h"
#include "fabrication/planing/plan/mill_moves.h"
#include "fabrication/planing/plan/nose_path.h"

namespace retrace::fabrication {
namespace {

// Spacing of the points on a lathe's profile, divided by the tolerance of the path.
constexpr double kPointsPerTolerance = 1.0;
constexpr std::size_t kMaxPoints = 40000;

void append(std::vector<PlannedProgram>& programs, std::vector<PlannedProgram> more) {
  for (PlannedProgram& program : more) programs.push_back(std::move(program));
}

/// Returns the programs of the first method: depth by depth, from the face downwards. At every depth, the inner zones
/// are cut before the outer ones.
std::vector<PlannedProgram> moves_by_depth(const PlanedPart& part, const std::vector<ZoneCut>& cuts,
                                           const std::string& set) {
  std::map<std::int64_t, std::vector<ZoneCut>> by_depth;
  for (const ZoneCut& cut : cuts) by_depth[cut.depth].push_back(cut);
  MillMoves moves(part, set);
  for (const auto& [depth, at_depth] : by_depth)
    moves.in_one_program([&, level = depth, &strokes = at_depth] {
      moves.lower_to(level);
      for (const ZoneCut& cut : strokes) {
        moves.across_to(cut.x);
        moves.stroke();
      }
      moves.return_to_centre();
    });
  return moves.finish();
}

std::vector<PlannedProgram> moves_one_after_another(const PlanedPart& part, const std::vector<ZoneCut>& cuts) {
  MillMoves moves(part, "inner zones");
  for (const ZoneCut& cut : cuts)
    moves.in_one_program([&] {
      moves.across_to(cut.x);
      moves.lower_to(cut.depth);
      moves.stroke();
    });
  return moves.finish();
}

/// Plans all zones with one depth increment (quantum). The second method is used for zones in which one cut at each
/// depth would leave more than the tolerance.
PlaningPlan plan_with(const PlanedPart& part, const ZoneProfile& profile, const ZoneCutter& cutter,
                      std::int64_t quantum) {
  PlaningPlan plan;
  plan.flank_slope = cutter.flank_slope();
  plan.quantum_mm = static_cast<double>(quantum) * cutter.grid_mm();
  std::vector<ZoneCut> odd, even, inner;
  for (std::size_t zone = 0; zone < profile.zones().size(); ++zone) {
    const auto by_depths = cutter.cuts_at_depths(zone, quantum);
    const std::vector<ZoneCut> cuts = by_depths ? *by_depths : cutter.sequential_cuts(zone);
    plan.uses_depth_method.push_back(by_depths.has_value());
    // Zone numbers start at 1 for users. Zone 0 therefore belongs to the odd zones.
    std::vector<ZoneCut>& set = !by_depths ? inner : (zone % 2 == 0 ? odd : even);
    set.insert(set.end(), cuts.begin(), cuts.end());
    plan.cuts.insert(plan.cuts.end(), cuts.begin(), cuts.end());
  }
  append(plan.programs, moves_by_depth(part, odd, "odd zones"));
  append(plan.programs, moves_by_depth(part, even, "even zones"));
  append(plan.programs, moves_one_after_another(part, inner));
  plan.runs = 2;
  return plan;
}

void name_programs(PlaningPlan& plan) {
  std::map<std::string, int> numbers;
  for (PlannedProgram& planned : plan.programs) {
    std::string name = planned.set;
    std::replace(name.begin(), name.end(), ' ', '_');
    planned.program.name = fmt::format("{}_{}", name, ++numbers[planned.set]);
    planned.program.header.insert(planned.program.header.begin(),
                                  fmt::format("retrace plane: {}, part {}", planned.set, numbers[planned.set]));
  }
}

/// Checks that the positions of all programs are within the travel of each axis.
void check_travel(const PlanedPart& part, const PlaningPlan& plan) {
  constexpr double kLargest = std::numeric_limits<double>::infinity();
  std::array<double, 3> low = {kLargest, kLargest, kLargest};
  std::array<double, 3> high = {-kLargest, -kLargest, -kLargest};
  for (const PlannedProgram& planned : plan.programs)
    for (const auto& item : planned.program.items) {
      const auto* const move = std::get_if<Move>(&item);
      if (move == nullptr) continue;
      for (const Axis k : {kX, kY, kZ}) {
        if (!move->to[k]) continue;
        low[k] = std::min(low[k], millimetres(*move->to[k]));
        high[k] = std::max(high[k], millimetres(*move->to[k]));
      }
    }
  const std::array travel = {part.mill->travel_x_mm, part.mill->travel_y_mm, part.mill->travel_z_mm};
  for (std::size_t k = 0; k < travel.size(); ++k)
    if (high[k] - low[k] > travel[k] + 1e-9)
      throw InputError(
          {part.source, 0, "mill.travel_mm"},
          fmt::format("must be at least {3} mm along {2}, because the programs move from {0} to {1} mm, got {4}",
                      fixed(low[k], 3), fixed(high[k], 3), std::string(1, "XYZ"[k]),
                      fixed_apart(high[k] - low[k], travel[k], 3), shortest(travel[k])));
}

PlaningPlan plan_mill(const PlanedPart& part) {
  const ZoneProfile profile(part.lens);
  const double grid = part.mill->grid_mm;
  const ZoneCutter cutter(profile, grid, part.tolerance_mm);
  // Try all depth increments that are smaller than the tolerance. Use the increment with the fewest moves. If several
  // increments need this number of moves, use the largest of these increments.
  std::optional<PlaningPlan> best;
  const auto most = static_cast<std::int64_t>(std::ceil(part.tolerance_mm / grid - 1e-9)) - 1;
  for (std::int64_t quantum = std::max<std::int64_t>(1, most); quantum >= 1; --quantum) {
    PlaningPlan plan = plan_with(part, profile, cutter, quantum);
    if (!best || plan.frames() < best->frames()) best = std::move(plan);
  }
  check_travel(part, *best);
  name_programs(*best);
  return std::move(*best);
}

/// Adds one pass: along the chords, raised by the thickness that the following passes will remove.
void add_pass(const PlanedPart& part, const PlaningPlan& plan, double raised_mm, PlannedProgram& planned) {
  const PlaningLathe& lathe = *part.lathe;
  Move out, in;
  out.to[kZ] = nanometres(lathe.clearance_mm);
  in.to[kX] = nanometres(plan.points.front().x_mm);
  planned.program.items.emplace_back(out);
  planned.program.items.emplace_back(in);
  ProfilePoint at = plan.points.front();
  for (const std::size_t k : plan.chords) {
    const ProfilePoint& to = plan.points[k];
    Move cut{Motion::plough, {}, lathe.feed_mm_per_min, 0.0};
    cut.to[kX] = nanometres(to.x_mm);
    cut.to[kZ] = nanometres(std::min(to.z_mm + raised_mm, lathe.clearance_mm));
    planned.program.items.emplace_back(cut);
    planned.time_s += std::hypot(to.x_mm - at.x_mm, to.z_mm - at.z_mm) / lathe.feed_mm_per_min * 60.0;
    ++planned.frames;
    at = to;
  }
  planned.program.items.emplace_back(out);
  planned.frames += 3;
}

Spindle spindle_of(const PlaningLathe& lathe) {
  return {lathe.spindle_rpm, lathe.spindle_direction == SpindleDirection::clockwise, lathe.spindle_start,
          lathe.spindle_stop, lathe.has_unchecked_lines};
}

PlaningPlan plan_lathe(const PlanedPart& part) {
  const ZoneProfile profile(part.lens);
  PlaningPlan plan;
  const double tolerance = path_tolerance_mm(profile, part.lathe->nose_radius_mm, part.tolerance_mm);
  const double spacing =
      std::max(kPointsPerTolerance * tolerance, part.lens.half_width_mm / static_cast<double>(kMaxPoints));
  plan.points = nose_points(profile, part.lathe->nose_radius_mm, spacing, tolerance);
  plan.chords = fewest_chords(plan.points, tolerance);
  plan.longest = longest_chords(plan.points, tolerance);
  plan.passes = static_cast<std::int64_t>(std::ceil(profile.step_mm() / part.lathe->depth_of_cut_mm));
  PlannedProgram planned;
  planned.set = "passes";
  planned.program.has_mist = false;
  planned.program.spindle = spindle_of(*part.lathe);
  planned.program.header = {"X is the radius"};
  if (part.lathe->nose_radius_mm > 0.0)
    planned.program.header.push_back(
        fmt::format("nose radius {} mm, X and Z are those of its lowest point", shortest(part.lathe->nose_radius_mm)));
  for (std::int64_t pass = plan.passes; pass-- > 0;)
    add_pass(part, plan, static_cast<double>(pass) * part.lathe->depth_of_cut_mm, planned);
  planned.cuts = static_cast<std::int64_t>(plan.chords.size()) - 1;
  plan.programs.push_back(std::move(planned));
  name_programs(plan);
  return plan;
}

}  // namespace

std::int64_t PlaningPlan::frames() const {
  std::int64_t sum = 0;
  for (const PlannedProgram& program : programs) sum += program.frames;
  return sum;
}

double PlaningPlan::time_s() const {
  double sum = 0.0;
  for (const PlannedProgram& program : programs) sum += program.time_s;
  return sum;
}

PlaningPlan plan_planing(const PlanedPart& part) {
  return part.mill ? plan_mill(part) : plan_lathe(part);
}

}  // namespace retrace::fabrication
