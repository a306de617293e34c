#include "studies/turning/io/turning_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/csv.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "fabrication/check/io/finding_rows.h"

namespace retrace::studies {
namespace {

namespace turning = fabrication::turning;
using Json = nlohmann::ordered_json;

Json axis_json(const turning::AxisFigures& f) {
  return {{"low_mm", f.low_mm},
          {"high_mm", f.high_mm},
          {"speed_mm_per_s", f.speed_mm_per_s},
          {"acceleration_mm_per_s2", f.acceleration_mm_per_s2},
          {"jerk_mm_per_s3", f.jerk_mm_per_s3},
          {"acceleration_jump_mm_per_s2", f.acceleration_jump_mm_per_s2}};
}

Json tool_json(const TurningResult& r) {
  const turning::TurningTool& tool = r.part.tool;
  return {{"nose_radius_mm", tool.nose_radius_mm},
          {"effective_radius_mm", turning::effective_radius_mm(tool)},
          {"window_deg", tool.window_deg},
          {"window_needed_deg", r.clearance.window_needed_deg},
          {"clearance_deg", tool.clearance_deg},
          {"clearance_needed_deg", r.clearance.clearance_needed_deg},
          {"clearance_at_x_mm", r.clearance.clearance_at_mm.x()},
          {"clearance_at_y_mm", r.clearance.clearance_at_mm.y()},
          {"rake_deg", tool.rake_deg},
          {"skew_deg", tool.skew_deg},
          {"skew_is_min", r.part.skew_is_min}};
}

/// Adds the results of the checks to a document: the contact between tool and surface along the blocks of the program,
/// and the machined surface if it was computed.
void add_judged(const turning::TurnedPart& part, const turning::TurningCheck& check, Json& json) {
  json["form_tolerance_nm"] = part.form_tolerance_nm;
  json["block_low_nm"] = check.contact.low_nm;
  json["block_high_nm"] = check.contact.high_nm;
  json["step_um_max"] = 1e3 * check.coverage.step_mm_max;
  json["blocks_per_s_max"] = check.motion.blocks_per_s;
  if (!check.envelope) return;
  const turning::Inspection& i = check.inspection;
  const Json surface = {{"blend_nm", check.blend_nm},
                        {"form_error_nm", i.form_error_nm},
                        {"interference_nm", i.interference_nm},
                        {"scallop_nm", i.scallop_nm},
                        {"scallop_nm_max", i.scallop_nm_max},
                        {"scallop_ratio_low", i.scallop_ratio_low},
                        {"scallop_ratio_high", i.scallop_ratio_high},
                        {"rms_nm", i.rms_nm},
                        {"profiles", i.cusps.size()},
                        {"profiles_compared", i.compared}};
  json.update(surface);
}

Json verification_of(const TurningResult& r) {
  Json findings = Json::array();
  for (const fabrication::Finding& finding : r.findings) findings.push_back(text_of(finding));
  Json json = {{"verdict", r.passes_inspection() ? "pass" : "fail"}, {"findings", std::move(findings)}};
  add_judged(r.part, r.check, json);
  return json;
}

Json motion_json(const turning::AxisMotion& m) {
  return {{"low_mm", m.low_mm},
          {"high_mm", m.high_mm},
          {"speed_mm_per_s", m.speed_mm_per_s},
          {"acceleration_mm_per_s2", m.acceleration_mm_per_s2},
          {"jerk_mm_per_s3", m.jerk_mm_per_s3}};
}

Json cubics_json(const TurningResult& r) {
  Json json = {{"moves", r.cubics->path.points.size() - 1},
               {"error_nm", r.cubics->path.error_nm},
               {"file", r.cubics->file},
               {"bytes", r.cubics->bytes},
               {"bytes_of_straight_moves", r.cubics->straight_bytes}};
  add_judged(r.part, r.cubics->check, json);
  return json;
}

}  // namespace

std::string turning_json(const TurningResult& r) {
  Json programs = Json::array();
  for (const TurningText& program : r.programs)
    programs.push_back({{"dialect", program.dialect}, {"file", program.file}});
  Json json = {{"part", r.file},
               {"title", r.part.title},
               {"lenslets", r.part.surface.lenslets().size()},
               {"points", r.points},
               {"passes", r.passes.size()},
               {"time_s", r.time_s},
               {"feed_um", 1e3 * r.part.path.feed_mm},
               {"tool", tool_json(r)},
               {"finish",
                {{"peak_to_valley_nm", r.finish.peak_to_valley_nm},
                 {"ra_nm", r.finish.ra_nm},
                 {"rq_nm", r.finish.rq_nm},
                 {"rq_of_paper_nm", r.finish.rq_of_paper_nm}}},
               {"axes", {{"x", axis_json(r.axes[0])}, {"y", axis_json(r.axes[1])}, {"z", axis_json(r.axes[2])}}}};
  if (!r.servo_csv.empty()) json["axes"]["servo"] = axis_json(r.axes[3]);
  json["programs"] = std::move(programs);
  if (r.cubics) json["cubics"] = cubics_json(r);
  json["verification"] = verification_of(r);
  return result_text("retrace.turning/2", json, r.part.warnings);
}

std::string turning_path_csv(const TurningResult& r) {
  constexpr std::size_t kMaxRows = 50000;
  const std::size_t stride = r.points / kMaxRows + 1;
  CsvWriter csv("time_s,x_mm,y_mm,z_mm,c_deg,servo_mm,z_speed_mm_per_s,z_acceleration_mm_per_s2,z_jerk_mm_per_s3");
  std::size_t count = 0;
  double start_s = 0.0;
  for (const turning::Pass& pass : r.passes) {
    const std::vector<turning::AxisState> z = turning::axis_states(pass, 2);
    for (std::size_t i = 0; i < pass.size(); ++i) {
      if (count++ % stride != 0) continue;
      const turning::PathPoint& p = pass[i];
      csv.row(fixed(start_s + z[i].time_s, 6), fixed(p.x_mm, 7), fixed(p.y_mm, 7), fixed(p.z_mm, 7), fixed(p.c_deg, 7),
              fixed(p.servo_mm, 7), fixed(z[i].speed_mm_per_s, 6), fixed(z[i].acceleration_mm_per_s2, 4),
              fixed(z[i].jerk_mm_per_s3, 2));
    }
    start_s += z.empty() ? 0.0 : z.back().time_s;
  }
  return csv.text();
}

std::string turning_cusps_csv(const TurningResult& r) {
  CsvWriter csv("x_mm,y_mm,scallop_nm,predicted_nm,valley_nm");
  for (const turning::CuspSample& s : r.check.inspection.cusps)
    csv.row(s.at_mm.x(), s.at_mm.y(), s.scallop_nm, s.predicted_nm, s.valley_nm);
  return csv.text();
}

std::string turning_table(const TurningResult& r) {
  const turning::TurningTool& tool = r.part.tool;
  std::string text = fmt::format("{}: {} points in {} s, feed {} um\n", printable(r.file, std::string::npos), r.points,
                                 fixed(r.time_s, 1), fixed(1e3 * r.part.path.feed_mm, 3));
  const auto row = [&](const char* name, double value, int digits, const char* unit) {
    text += fmt::format("  {:<34} {:>10} {}\n", name, fixed(value, digits), unit);
  };
  row("clearance required", r.clearance.clearance_needed_deg, 2, "deg");
  row("clearance of the tool", tool.clearance_deg, 2, "deg");
  row("window required", r.clearance.window_needed_deg, 2, "deg");
  row("skew", tool.skew_deg, 2, "deg");
  row("effective nose radius", turning::effective_radius_mm(tool), 4, "mm");
  row("Ra on a flat", r.finish.ra_nm, 3, "nm");
  row("Rq on a flat", r.finish.rq_nm, 3, "nm");
  row("Rq by Sohn and Naples (mean height)", r.finish.rq_of_paper_nm, 3, "nm");
  row("peak to valley on a flat", r.finish.peak_to_valley_nm, 3, "nm");
  row("Z acceleration", r.axes[2].acceleration_mm_per_s2, 3, "mm/s^2");
  row("largest jump of Z acceleration", r.axes[2].acceleration_jump_mm_per_s2, 3, "mm/s^2");
  row("form error of the programs", r.check.inspection.form_error_nm, 3, "nm");
  row("deepest cut below the surface", r.check.inspection.interference_nm, 3, "nm");
  row("scallops, mean", r.check.inspection.scallop_nm, 3, "nm");
  if (r.cubics) {
    const double share = static_cast<double>(r.cubics->bytes) / static_cast<double>(r.cubics->straight_bytes);
    row("cubic moves", static_cast<double>(r.cubics->path.points.size() - 1), 0, "");
    row("deviation of cubics from spiral", r.cubics->path.error_nm, 3, "nm");
    row("form error of cubic programs", r.cubics->check.inspection.form_error_nm, 3, "nm");
    row(("size of " + printable(r.cubics->file, std::string::npos)).c_str(), 100.0 * share, 1,
        "% of the size with straight moves");
  }
  text += fmt::format("  {:<34} {:>10}\n", "verdict", r.passes_inspection() ? "pass" : "fail");
  for (const fabrication::Finding& finding : r.findings)
    text += "  " + printable(text_of(finding), std::string::npos) + "\n";
  return text;
}

std::string verification_json(const TurningVerification& run, double elapsed_s) {
  const turning::MotionFigures& motion = run.check.motion;
  Json json = {{"verdict", run.passes() ? "pass" : "fail"},
               {"part", run.request.part},
               {"title", run.part.title},
               {"process", "turning"}};
  Json programs = Json::array();
  for (const fabrication::NcProgram& program : run.programs) programs.push_back(fabrication::program_json(program));
  json["programs"] = std::move(programs);
  json["findings"] = fabrication::findings_json(run.findings);
  json["points"] = run.check.points;
  json["passes"] = run.check.passes;
  json["feed_um"] = 1e3 * run.part.path.feed_mm;
  add_judged(run.part, run.check, json);
  json["axes"] = {
      {"x", motion_json(motion.axes[0])}, {"y", motion_json(motion.axes[1])}, {"z", motion_json(motion.axes[2])}};
  if (run.part.path.servo == turning::Servo::fast) json["axes"]["servo"] = motion_json(motion.axes[3]);
  json["spindle_rpm_max"] = motion.spindle_rpm;
  json["c_acceleration_deg_per_s2_max"] = motion.c_acceleration_deg_per_s2;
  json["time_s"] = motion.time_s;
  json["elapsed_s"] = elapsed_s;
  return result_text("retrace.verification/2", json, run.part.warnings);
}

std::string verification_table(const TurningVerification& run) {
  const turning::TurningCheck& check = run.check;
  std::string text =
      fmt::format("{}: {}\n", printable(run.request.part, std::string::npos), run.passes() ? "pass" : "fail");
  const auto row = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<28} {}\n", name, value);
  };
  row("points", std::to_string(check.points));
  row("time", fixed(check.motion.time_s, 1) + " s");
  row("deepest block", fixed(check.contact.low_nm, 2) + " nm");
  row("highest block", fixed(check.contact.high_nm, 2) + " nm");
  row("tolerance", shortest(run.part.form_tolerance_nm) + " nm");
  row("largest distance of cuts", fixed(1e3 * check.coverage.step_mm_max, 3) + " um");
  if (check.envelope) {
    row("form error", fixed(check.inspection.form_error_nm, 2) + " nm");
    row("scallops, mean", fixed(check.inspection.scallop_nm, 2) + " nm");
  }
  row("blocks per second", fixed(check.motion.blocks_per_s, 1));
  return text + fabrication::findings_table(run.findings);
}

}  // namespace retrace::studies
