#include "studies/setup/setup_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/length_units.h"
#include "fabrication/chisel/plan/chiseling.h"
#include "fabrication/job/cube_corner.h"
#include "fabrication/job/substrate_cells.h"
#include "fabrication/job/tool_angles.h"
#include "fabrication/post/post.h"
#include "geometry/elements/element_cells.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using geometry::Vec3;

/// Returns the maximum or minimum Z of the machine bodies that move with the workpiece or with the tool (`carrier`).
std::optional<double> end_of_bodies(const Machine& machine, KinematicLink carrier, bool highest) {
  std::optional<double> end;
  for (const MachineBody& body : machine.bodies)
    if (body.link == carrier)
      for (const Vec3& p : body.points_mm.value)
        if (!end || (highest ? p.z() > *end : p.z() < *end)) end = p.z();
  return end;
}

/// Returns the maximum height that points of the workpiece's face, at a radius about the C axis, reach while the rotary
/// axes move.
double highest_mm(const FabricationResult& result, double radius_mm) {
  constexpr int kAzimuths = 72;
  constexpr int kTilts = 24;
  const Vec3 centre(result.machine.c.point_mm.value.x(), result.machine.c.point_mm.value.y(), 0.0);
  double low_deg = 0.0;
  double high_deg = 0.0;
  for (const CuttingPose& pose : result.plan.poses) {
    low_deg = std::min(low_deg, pose.rounded.a_deg);
    high_deg = std::max(high_deg, pose.rounded.a_deg);
  }
  double highest = 0.0;
  for (int i = 0; i <= kTilts; ++i)
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = 2.0 * std::numbers::pi * k / kAzimuths;
      const Vec3 p = centre + radius_mm * Vec3(std::cos(azimuth), std::sin(azimuth), 0.0);
      const double tilt_deg = low_deg + (high_deg - low_deg) * i / kTilts;
      highest = std::max(highest, machine_from_workpiece(result.machine, {tilt_deg, 0.0}).point(p).z());
    }
  return highest;
}

double free_radius_mm(const FabricationResult& result) {
  const double room_mm = result.plan.safe_z_mm - result.job.process.rotary_clearance_mm;
  double low_mm = 0.0;
  double high_mm = 1000.0;
  if (highest_mm(result, high_mm) <= room_mm) return high_mm;
  constexpr int kHalvings = 40;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle_mm = 0.5 * (low_mm + high_mm);
    (highest_mm(result, middle_mm) <= room_mm ? low_mm : high_mm) = middle_mm;
  }
  return low_mm;
}

BlankSetup blank_of(const FabricationResult& result) {
  BlankSetup blank;
  blank.array_mm = blank_extent_mm(result.job);
  for (std::size_t zone = 0; zone < zone_count(result.job); ++zone)
    blank.deepest_mm = std::max(blank.deepest_mm, geometry::element_depth_mm(blank_element(result.job, zone)));
  blank.deepest_mm += result.plan.stock_mm;
  blank.stock_mm = result.plan.stock_mm;
  if (result.job.substrate) blank.base = substrate_description(result.job);
  for (std::size_t zone = 0; zone < result.job.zones.size(); ++zone)
    blank.zones.push_back(zone_description(result.job, zone));
  if (const auto top = end_of_bodies(result.machine, KinematicLink::workpiece, true); top && *top < 0.0)
    blank.fixture_height_mm = -*top;
  if (result.machine.tilt == Tilt::table) blank.free_radius_mm = free_radius_mm(result);
  return blank;
}

ToolSetup tool_of(const FabricationResult& result) {
  ToolSetup tool;
  if (const auto low = end_of_bodies(result.machine, KinematicLink::tool, false); low && *low > 0.0)
    tool.free_length_mm = low;
  tool.plunge_rake_deg = plunge_angles(result.job.tool).rake_deg;
  if (cuts_prisms(result.job)) tool.plough_rake_deg = plough_angles(result.job.tool).rake_deg;
  return tool;
}

std::vector<AxisTravel> travel_of(const FabricationResult& result) {
  const Machine& m = result.machine;
  const std::array<std::pair<char, Interval>, kAxes> axes = {{{'X', m.x.limits_mm.value},
                                                              {'Y', m.y.limits_mm.value},
                                                              {'Z', m.z.limits_mm.value},
                                                              {m.tilt_letter(), m.a.limits_deg.value},
                                                              {'C', m.c.limits_deg.value}}};
  std::vector<AxisTravel> travel;
  for (const auto& [letter, limits] : axes) travel.push_back({letter, 1e300, -1e300, limits});
  for (const Program& program : result.plan.programs)
    for_each_move(program, [&](const PlannedMove& move) {
      for (std::size_t k = 0; k < kAxes; ++k) {
        if (!move.at[k]) continue;
        const double at = k < 3 ? millimetres(*move.at[k]) : degrees(*move.at[k]);
        travel[k].low = std::min(travel[k].low, at);
        travel[k].high = std::max(travel[k].high, at);
      }
    });
  return travel;
}

std::vector<int> optional_stops_of(const Plan& plan) {
  std::vector<int> stops;
  for (const Program& program : plan.programs)
    stops.push_back(static_cast<int>(std::count_if(program.items.begin(), program.items.end(), [](const Item& item) {
      return std::holds_alternative<OptionalStop>(item);
    })));
  return stops;
}

/// Tracks the thickness of the material that remains on the facets of one element. This element represents all elements
/// that are cut in the same way.
class Standing {
 public:
  Standing(const FabricationResult& result, std::size_t zone)
      : job_(result.job), zone_(zone), depth_mm_(geometry::element_depth_mm(blank_element(result.job, zone))) {}

  /// Updates the remaining material after a cut along `facet` (1 to 3). A cut that ploughs leaves the same thickness on
  /// the other facet of the groove.
  void cut(int facet, bool ploughs, double left_um) {
    left_um_[static_cast<std::size_t>(facet - 1)] = left_um;
    if (ploughs) left_um_[static_cast<std::size_t>(2 - facet)] = left_um;
  }
  /// Returns the current depth of the root (prism) or the apex (cube corner); 0 until all facets are cut.
  double root_depth_mm() const {
    const bool is_cube = !cuts_prisms(job_);
    const std::size_t facets = is_cube ? 3 : 2;
    double sum_um = 0.0;
    for (std::size_t f = 0; f < facets; ++f) {
      if (!left_um_[f]) return 0.0;
      sum_um += *left_um_[f];
    }
    if (is_cube) {
      const Vec3 left_mm = Vec3(*left_um_[0], *left_um_[1], *left_um_[2]) / kUmPerMm;
      return depth_mm_ - blank_corner(job_, zone_).apex_over(left_mm).z();
    }
    const double upright = 2.0 * std::sin(0.5 * Angle::from_deg(prism_of(job_).apex_angle_deg).rad());
    return depth_mm_ - sum_um / kUmPerMm / upright;
  }

 private:
  const Job& job_;
  std::size_t zone_;
  double depth_mm_;
  std::array<std::optional<double>, 3> left_um_;
};

/// Returns, for each stage (group of cuts in one pose), the last program that calls its subroutine.
std::map<std::string, std::size_t> last_programs(const Plan& plan) {
  std::map<std::string, std::size_t> last;
  for (std::size_t k = 0; k < plan.programs.size(); ++k)
    for (const Item& item : plan.programs[k].items)
      if (const auto* const visit = std::get_if<CycleCall>(&item))
        last[plan.programs[k].subroutines[visit->subroutine].title] = k;
  return last;
}

std::vector<StageCheck> checks_of(const FabricationResult& result) {
  const Plan& plan = result.plan;
  const std::map<std::string, std::size_t> programs = last_programs(plan);
  std::map<std::pair<bool, std::int32_t>, Standing> standing;
  std::vector<StageCheck> checks;
  double seconds = 0.0;
  // The time of rotary moves between stages is distributed equally over the stages.
  const double between_s = plan.time.fixed_s / static_cast<double>(std::max<std::size_t>(1, plan.stages.size()));
  for (const Stage& stage : plan.stages) {
    const CuttingPose& pose = plan.poses[stage.pose];
    seconds += stage.time.total_s() + between_s;
    const auto program = programs.find(plan.subroutines[stage.subroutine].title);
    if (program == programs.end()) continue;
    Standing& alike =
        standing.try_emplace({pose.facet.rotated, pose.orientation}, result, pose.facet.zone).first->second;
    StageCheck check;
    check.stage = stage.name;
    check.program = program->second;
    check.ends_s = seconds;
    check.remaining_um = kUmPerMm * stage.remaining_mm;
    alike.cut(pose.facet.facet, stage.roughs && cuts_prisms(result.job), check.remaining_um);
    check.root_depth_mm = alike.root_depth_mm();
    checks.push_back(std::move(check));
  }
  return checks;
}

}  // namespace

const PartLight* SetupSheet::change_of_light(const SetupQuantity& quantity, Tilt tilt) const {
  if (!light) return nullptr;
  return &light->changes[static_cast<std::size_t>(&quantity - setup_quantities(tilt).data())];
}

SetupSheet setup_sheet(const FabricationResult& result, bool light) {
  SetupSheet sheet;
  sheet.blank = blank_of(result);
  sheet.tool = tool_of(result);
  sheet.travel = travel_of(result);
  sheet.control_needs = control_needs(result.dialect, result.machine.control);
  sheet.optional_stops = optional_stops_of(result.plan);
  sheet.checks = checks_of(result);
  sheet.sensitivities = sensitivities(result.job, result.machine, result.plan);
  sheet.why_no_light = why_no_setup_light(result.job);
  if (!light || !sheet.why_no_light.empty()) return sheet;
  try {
    sheet.light = setup_light(result.job, result.job.source, result.machine, sheet.warnings);
  } catch (const Error& error) {
    // An error in the computation of the light, for example due to a changed design, must not prevent the programs
    // from being written.
    sheet.why_no_light = error.what();
  }
  return sheet;
}

}  // namespace retrace::studies
