#include "studies/closed_loop/io/verification_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "fabrication/check/io/finding_rows.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using Json = nlohmann::ordered_json;

Json programs_json(const VerificationRun& run) {
  Json programs = Json::array();
  for (std::size_t k = run.unchecked_programs; k < run.programs.size(); ++k)
    programs.push_back(program_json(run.programs[k]));
  return programs;
}

Json poses_json(const Verification& result, const Machine& machine) {
  Json poses = Json::array();
  const char* const tilt = machine.tilt == Tilt::table ? "a_deg" : "b_deg";
  for (const RotaryPose& pose : result.poses) poses.push_back({{tilt, pose.a_deg}, {"c_deg", pose.c_deg}});
  return poses;
}

}  // namespace

std::string verification_json(const VerificationRun& run, double elapsed_s) {
  const Verification& r = run.result;
  const Json json = {{"verdict", r.verdict()},
                     {"job", run.request.job.string()},
                     {"machine", run.machine.name},
                     {"programs", programs_json(run)},
                     {"findings", findings_json(r.findings)},
                     {"tolerance_nm", r.tolerance_nm},
                     {"elements", r.elements.size()},
                     {"elements_cut", r.elements_cut},
                     {"facet_distance_nm_max", r.facet_distance_nm_max},
                     {"facet_angle_arcmin_max", r.facet_angle_arcmin_max},
                     {"facet_angle_arcmin_predicted", r.facet_angle_arcmin_predicted},
                     {"apex_error_arcmin_max", r.apex_error_arcmin_max},
                     {"root_residual_nm_max", r.root_residual_nm_max},
                     {"root_residual_nm_predicted", r.root_residual_nm_predicted},
                     {"chip_um_max", r.chip_um_max},
                     {"chip_ratio_max", r.chip_ratio_max},
                     {"root_radius_um", r.root_radius_um},
                     {"root_chamfer_um", r.root_chamfer_um},
                     {"root_ridge_um", r.root_ridge_um},
                     {"wall_overcut_nm_max", r.wall_overcut_nm_max},
                     {"wall_overcut_nm_predicted", r.wall_overcut_nm_predicted},
                     {"removed_volume_mm3", r.removed_volume_mm3},
                     {"border_overcut_mm3", r.border_overcut_mm3},
                     {"rim_overcut_um_max", r.rim_overcut_um_max},
                     {"zone_overcut_mm2", r.zone_overcut_mm2},
                     {"zone_overcut_um_max", r.zone_overcut_um_max},
                     {"elements_overcut", r.elements_overcut},
                     {"free_tool_length_mm", r.free_tool_length_mm},
                     {"poses", poses_json(r, run.machine)},
                     {"time_s", r.time.total_s()},
                     {"time_feed_s", r.time.feed_s},
                     {"time_rapid_s", r.time.rapid_s},
                     {"time_rotary_s", r.time.rotary_s},
                     {"time_dwell_s", r.time.dwell_s},
                     {"elapsed_s", elapsed_s}};
  return result_text("retrace.verification/2", json, run.warnings);
}

std::string verification_table(const VerificationRun& run) {
  const Verification& r = run.result;
  std::string text = fmt::format("{} on machine {}: {}\n", printable(run.request.job.string(), std::string::npos),
                                 printable(run.machine.name), r.verdict());
  const auto row = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<28} {}\n", name, value);
  };
  row("elements cut", fmt::format("{} of {}", r.elements_cut, r.elements.size()));
  row("facet distance", fmt::format("{} nm, {} allowed", fixed(r.facet_distance_nm_max, 2), shortest(r.tolerance_nm)));
  row("facet angle", fmt::format("{} arcmin, {} unavoidable", fixed(r.facet_angle_arcmin_max, 4),
                                 fixed(r.facet_angle_arcmin_predicted, 4)));
  row("apex error", fixed(r.apex_error_arcmin_max, 4) + " arcmin");
  row("remaining at the root",
      fmt::format("{} nm, {} unavoidable", fixed(r.root_residual_nm_max, 1), fixed(r.root_residual_nm_predicted, 1)));
  row("cut into walls",
      fmt::format("{} nm, {} unavoidable", fixed(r.wall_overcut_nm_max, 1), fixed(r.wall_overcut_nm_predicted, 1)));
  row("thickest chip", fixed(r.chip_um_max, 3) + " um");
  row("removed volume", fixed(r.removed_volume_mm3, 6) + " mm3");
  if (r.border_overcut_mm3 > 0.0)
    row("removed outside apertures", fixed(r.border_overcut_mm3, 6) + " mm3, unavoidable with triangular cavities");
  if (r.elements_overcut > 0)
    row("overcut of other elements",
        fmt::format("{} elements at borders, {} mm2 of their apertures, at most {} um deep", r.elements_overcut,
                    fixed(r.zone_overcut_mm2, 4), fixed(r.zone_overcut_um_max, 3)));
  if (r.rim_overcut_um_max > 0.0)
    row("removed below rims", fixed(r.rim_overcut_um_max, 3) + " um, unavoidable next to neighbours at other heights");
  row("free tool length", fixed(r.free_tool_length_mm, 2) + " mm required");
  row("time", fixed(r.time.total_s(), 1) + " s");
  return text + findings_table(r.findings);
}

}  // namespace retrace::studies
