#include "studies/fabrication/io/fabrication_files.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/csv.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "fabrication/job/tool_angles.h"

namespace retrace::studies {
namespace {

using fabrication::Plan, fabrication::TimeBreakdown;
using Json = nlohmann::ordered_json;

constexpr double kSecondsPerHour = 3600.0;

double per_element_s(const Plan& plan) {
  return plan.time.total_s() / static_cast<double>(plan.elements.size());
}

double area_rate(const Plan& plan) {
  return plan.aperture_area_mm2 / (plan.time.total_s() / kSecondsPerHour);
}

Json time_breakdown_json(const TimeBreakdown& time) {
  return {{"cutting_s", time.cutting_s},
          {"dwell_s", time.dwell_s},
          {"retract_s", time.retract_s},
          {"rapid_s", time.rapid_s},
          {"fixed_s", time.fixed_s}};
}

std::string hours_text(double seconds) {
  const auto minutes = static_cast<long>(std::lround(seconds / 60.0));
  return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

std::string_view word_of(fabrication::Strategy strategy) {
  return fabrication::kStrategyWords[static_cast<std::size_t>(strategy)];
}

/// Returns the key of the tilting axis.
std::string tilt_key(const fabrication::Machine& machine) {
  return machine.tilt == fabrication::Tilt::table ? "a_deg" : "b_deg";
}

Json poses_json(const FabricationResult& result) {
  Json poses = Json::array();
  for (const fabrication::CuttingPose& pose : result.plan.poses) {
    poses.push_back({{"facet", pose.facet.facet},
                     {"rotated", pose.facet.rotated},
                     {tilt_key(result.machine), pose.rounded.a_deg},
                     {"c_deg", pose.rounded.c_deg},
                     {"root_tilt_arcmin", 60.0 * pose.root_tilt.deg()},
                     {"lift_nm", 1e6 * pose.section.lift_mm}});
    if (result.job.substrate) poses.back()["orientation"] = pose.orientation + 1;
    if (!result.job.zones.empty()) poses.back()["zone"] = pose.facet.zone + 1;
  }
  return poses;
}

}  // namespace

std::string job_json(const GeneratedJob& made) {
  const fabrication::Job& job = made.job;
  const Json json = {{"elements", made.elements},
                     {"partial_elements", made.partial_elements},
                     {"machine", job.machine},
                     {"strategy", word_of(job.strategy)},
                     {"process", job.process.name},
                     {"process_source", job.process.source},
                     {"tool_width_mm", job.tool.width_mm},
                     {"workpiece", fabrication::kWorkpieceWords[static_cast<std::size_t>(job.workpiece.kind)]}};
  return result_text("retrace.job_summary/1", json, made.warnings);
}

std::string job_table(const GeneratedJob& made) {
  const fabrication::Job& job = made.job;
  std::string text;
  text +=
      fmt::format("  elements            {}{}\n", made.elements,
                  made.partial_elements > 0 ? fmt::format(", {} partial elements omitted", made.partial_elements) : "");
  text += fmt::format("  machine, strategy   {}, {}\n", printable(job.machine), word_of(job.strategy));
  text +=
      fmt::format("  process             {} ({})\n", printable(job.process.name), printable(job.process.source, 200));
  return text;
}

namespace {

/// Returns the path of the tool through one element: for each move, its kind and its start and end point in the
/// section, in mm.
Json section_path_json(const FabricationResult& result) {
  // Maximum number of moves. The limit allows web pages to draw the path. Only jobs with very thin layers have more
  // moves.
  constexpr std::size_t kMaxMoves = 2000;
  Json paths = Json::array();
  for (const bool roughing : {true, false}) {
    Json moves = Json::array();
    for (const SectionMove& m : section_moves(result, roughing))
      if (moves.size() < kMaxMoves)
        moves.push_back({fabrication::kMotionWords[static_cast<std::size_t>(m.motion)], m.from_u_mm, m.from_z_mm,
                         m.to_u_mm, m.to_z_mm});
    if (!moves.empty()) paths.push_back({{"name", roughing ? "roughing" : "finishing"}, {"moves", std::move(moves)}});
  }
  return paths;
}

}  // namespace

std::string fabrication_json(const FabricationResult& result, const Json& setup) {
  const Plan& plan = result.plan;
  Json programs = Json::array();
  for (std::size_t k = 0; k < plan.programs.size(); ++k) programs.push_back(result.program_file(k));
  Json stages = Json::array();
  for (const fabrication::Stage& stage : plan.stages) {
    const fabrication::CuttingPose& pose = plan.poses[stage.pose];
    stages.push_back({{"name", stage.name},
                      {tilt_key(result.machine), pose.rounded.a_deg},
                      {"c_deg", pose.rounded.c_deg},
                      {"elements", stage.visits},
                      {"time_s", stage.time.total_s()}});
  }
  const fabrication::CuttingAngles plunge = fabrication::plunge_angles(result.job.tool);
  const fabrication::CuttingAngles plough = fabrication::plough_angles(result.job.tool);
  Json json = {{"job", result.job.source},
               {"machine", result.machine.name},
               {"dialect", result.dialect},
               {"strategy", word_of(result.job.strategy)},
               {"process", result.job.process.name},
               {"elements", plan.elements.size()},
               {"cuts_per_facet", plan.cuts_per_facet},
               {"passes", plan.passes},
               {"c_rotations", plan.c_rotations},
               {"time_s", plan.time.total_s()},
               {"time_per_element_s", per_element_s(plan)},
               {"time_fixed_s", plan.time.fixed_s},
               {"area_mm2", plan.aperture_area_mm2},
               {"area_rate_mm2_per_h", area_rate(plan)},
               {"time_per_cm2_s", 100.0 * plan.time.total_s() / plan.aperture_area_mm2},
               {"time", time_breakdown_json(plan.time)},
               {"plunge_rake_deg", plunge.rake_deg},
               {"plough_rake_deg", plough.rake_deg},
               {"safe_z_mm", plan.safe_z_mm},
               {"poses", poses_json(result)},
               {"stages", stages},
               {"section_path", section_path_json(result)},
               {"programs", programs},
               {"program_times_s", plan.program_times_s}};
  if (result.job.tool.edge_life_mm) json["program_cuts_mm"] = plan.program_cuts_mm;
  // A V-shaped tool cuts in both directions with its leading edge and always has the same rake.
  if (!cuts_prisms(result.job)) json.erase("plough_rake_deg");
  if (!setup.is_null()) json["setup"] = setup;
  return result_text("retrace.fabrication/2", json, result.warnings);
}

std::string stages_csv(const FabricationResult& result) {
  CsvWriter csv("name," + tilt_key(result.machine) +
                ",c_deg,elements,time_s,cutting_s,dwell_s,retract_s,rapid_s,fixed_s");
  for (const fabrication::Stage& stage : result.plan.stages) {
    const fabrication::CuttingPose& pose = result.plan.poses[stage.pose];
    const TimeBreakdown& t = stage.time;
    csv.row(stage.name, pose.rounded.a_deg, pose.rounded.c_deg, stage.visits, t.total_s(), t.cutting_s, t.dwell_s,
            t.retract_s, t.rapid_s, t.fixed_s);
  }
  return csv.text();
}

std::string fabrication_table(const FabricationResult& result) {
  const Plan& plan = result.plan;
  const TimeBreakdown& t = plan.time;
  std::string text;
  text += fmt::format("  elements            {}, {} cuts per facet{}\n", plan.elements.size(), plan.cuts_per_facet,
                      plan.passes > 1 ? fmt::format(", {} passes side by side", plan.passes) : "");
  text += fmt::format("  machine, dialect    {}, {}\n", printable(result.machine.name), result.dialect);
  text += fmt::format("  rotations of C      {}\n", plan.c_rotations);
  text += fmt::format("  time                {}: {} s per element, {} mm2/h, {} h per cm2\n", hours_text(t.total_s()),
                      fixed(per_element_s(plan), 2), fixed(area_rate(plan), 1),
                      fixed(100.0 * t.total_s() / plan.aperture_area_mm2 / kSecondsPerHour, 2));
  text += fmt::format("  of which            cutting {} %, dwell {} %, retract {} %, rapid {} %, fixed {} %\n",
                      fixed(100.0 * t.cutting_s / t.total_s(), 1), fixed(100.0 * t.dwell_s / t.total_s(), 1),
                      fixed(100.0 * t.retract_s / t.total_s(), 1), fixed(100.0 * t.rapid_s / t.total_s(), 1),
                      fixed(100.0 * t.fixed_s / t.total_s(), 1));
  if (!plan.stops.empty()) text += fmt::format("  stops               {}\n", plan.stops.size());
  constexpr std::size_t kMaxStages = 20;
  for (std::size_t k = 0; k < plan.stages.size() && k < kMaxStages; ++k) {
    const fabrication::Stage& stage = plan.stages[k];
    const fabrication::CuttingPose& pose = plan.poses[stage.pose];
    text += fmt::format("  {:<28} {}{} C{}  {} elements, {}\n", stage.name, result.machine.tilt_letter(),
                        fixed(pose.rounded.a_deg, 4), fixed(pose.rounded.c_deg, 4), stage.visits,
                        hours_text(stage.time.total_s()));
  }
  if (plan.stages.size() > kMaxStages) text += fmt::format("  and {} more\n", plan.stages.size() - kMaxStages);
  return text;
}

}  // namespace retrace::studies
