#include "studies/planing/io/planing_files.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/angle.h"
#include "core/csv.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "fabrication/planing/plan/zone_profile.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using Json = nlohmann::ordered_json;

/// Of the lens of E. D. Bulatov, S. A. Gridin and A. A. Danilenko, by its two programs: about 2500 frames in 5 h, 3500
/// in 8 h.
constexpr double kPublishedSecondsPerFrame[] = {7.2, 8.2};

double per_frame(double time_s, std::int64_t frames) {
  return frames > 0 ? time_s / static_cast<double>(frames) : 0.0;
}

Json element_json(const PlanedPart& part) {
  Json json = {{"kind", part.mill ? "zone_lens" : "round_zone_lens"},
               {"focal_length_mm", part.lens.focal_length_mm},
               {"wavelength_mm", part.lens.wavelength_mm},
               {"refractive_index", part.lens.refractive_index},
               {"width_mm", 2.0 * part.lens.half_width_mm}};
  if (part.mill) json["length_mm"] = part.length_mm;
  return json;
}

Json zones_json(const PlaningResult& result) {
  const ZoneProfile profile(result.part.lens);
  std::map<std::size_t, int> cuts;
  for (const ZoneCut& cut : result.plan.cuts) ++cuts[cut.zone];
  Json zones = Json::array();
  for (std::size_t k = 0; k < profile.zones().size(); ++k) {
    Json zone = {{"zone", k + 1}, {"from_mm", profile.zones()[k].from_mm}, {"to_mm", profile.zones()[k].to_mm}};
    if (result.part.mill) {
      zone["method"] = result.plan.by_depths[k] ? "by_depths" : "one_after_another";
      zone["cuts"] = cuts[k];
    }
    zones.push_back(std::move(zone));
  }
  return zones;
}

Json programs_json(const PlaningResult& result) {
  Json programs = Json::array();
  for (std::size_t k = 0; k < result.programs.size(); ++k) {
    const PlannedProgram& planned = result.plan.programs[k];
    programs.push_back({{"program", result.programs[k].name},
                        {"set", planned.set},
                        {"cuts", planned.cuts},
                        {"frames", result.check.frames[k]},
                        {"hours", result.check.time_s[k] / 3600.0},
                        {"seconds_per_frame", per_frame(result.check.time_s[k], result.check.frames[k])}});
  }
  return programs;
}

Json findings_json(const PlaningCheck& check) {
  Json findings = Json::array();
  for (const Finding& f : check.findings) {
    Json finding = {{"kind", f.kind}, {"message", f.message}, {"value", f.value}, {"limit", f.limit}};
    if (!f.program.empty()) finding["program"] = f.program;
    if (f.line > 0) finding["line"] = f.line;
    findings.push_back(std::move(finding));
  }
  return findings;
}

struct Totals {
  std::int64_t frames = 0;
  double time_s = 0.0;
};

Totals totals_of(const PlaningResult& result) {
  Totals totals;
  for (const std::int64_t frames : result.check.frames) totals.frames += frames;
  for (const double time_s : result.check.time_s) totals.time_s += time_s;
  return totals;
}

double flank_deg(const PlaningResult& result) {
  return Angle::from_rad(std::atan(result.plan.flank_slope)).deg();
}

void add_machine(const PlaningResult& result, Json& json) {
  const PlaningCheck& check = result.check;
  if (result.part.mill) {
    json["fast_feed_mm_per_min"] = result.part.mill->fast_feed_mm_per_min;
    json["tool_flank_deg"] = flank_deg(result);
    json["quantum_mm"] = result.plan.quantum_mm;
    json["form_error_mm_max"] = std::max(check.standing_mm_max, check.gouge_mm_max);
    json["standing_mm_max"] = check.standing_mm_max;
    json["gouge_mm_max"] = check.gouge_mm_max;
    json["off_grid_nm_max"] = check.off_grid_nm_max;
    json["shortest_move_mm"] = {check.shortest_x_mm, check.shortest_y_mm, check.shortest_z_mm};
    return;
  }
  json["feed_mm_per_min"] = result.part.lathe->feed_mm_per_min;
  json["spindle_rpm"] = result.part.lathe->spindle_rpm;
  json["spindle_direction"] = kSpindleDirectionWords[static_cast<std::size_t>(result.part.lathe->spindle_direction)];
  json["passes"] = result.plan.passes;
  json["chords"] = result.plan.chords.size() - 1;
  json["longest_chords"] = result.plan.longest.size() - 1;
  json["nose_radius_mm"] = result.part.lathe->nose_radius_mm;
  json["form_error_mm_max"] = check.path_distance_mm_max;
  json["unreached_mm_max"] = check.unreached_mm_max;
}

}  // namespace

std::string planing_json(const PlaningResult& result) {
  const Totals totals = totals_of(result);
  Json json = {{"part", result.part.source},
               {"title", result.part.title},
               {"dialect", result.dialect},
               {"element", element_json(result.part)},
               {"tolerance_mm", result.part.tolerance_mm},
               {"verdict", result.check.passes() ? "pass" : "fail"},
               {"findings", findings_json(result.check)}};
  add_machine(result, json);
  json["zones"] = zones_json(result);
  json["programs"] = programs_json(result);
  json["runs"] = result.plan.runs;
  json["frames"] = result.plan.runs * totals.frames;
  json["hours"] = result.plan.runs * totals.time_s / 3600.0;
  json["seconds_per_frame"] = per_frame(totals.time_s, totals.frames);
  if (result.part.mill) json["published_seconds_per_frame"] = kPublishedSecondsPerFrame;
  return result_text("retrace.planing/1", json, result.warnings);
}

std::string planing_csv(const PlaningResult& result) {
  CsvWriter csv("x_mm,design_mm,left_mm");
  for (const ProfileSample& s : result.check.profile)
    csv.row(fixed(s.x_mm, 6), fixed(s.design_mm, 6), fixed(s.left_mm, 6));
  return csv.text();
}

std::string planing_table(const PlaningResult& result) {
  std::string text;
  if (!result.part.title.empty()) text += printable(result.part.title) + "\n";
  text += "program                 cuts  frames   hours  s/frame\n";
  for (std::size_t k = 0; k < result.programs.size(); ++k)
    text += fmt::format("{:<22} {:>5} {:>7} {:>7} {:>8}\n", result.programs[k].name, result.plan.programs[k].cuts,
                        result.check.frames[k], fixed(result.check.time_s[k] / 3600.0, 2),
                        fixed(per_frame(result.check.time_s[k], result.check.frames[k]), 2));
  const Totals totals = totals_of(result);
  text += fmt::format("in all, {} run{} each: {} frames, {} hours\n", result.plan.runs, result.plan.runs > 1 ? "s" : "",
                      result.plan.runs * totals.frames, fixed(result.plan.runs * totals.time_s / 3600.0, 2));
  const double error = result.part.mill ? std::max(result.check.standing_mm_max, result.check.gouge_mm_max)
                                        : result.check.path_distance_mm_max;
  text += fmt::format("form error {} mm, tolerance {} mm", fixed(error, 4), shortest(result.part.tolerance_mm));
  if (result.part.mill)
    text += fmt::format("; tool flank {} degrees, depth quantum {} mm", shortest(flank_deg(result)),
                        shortest(result.plan.quantum_mm));
  else
    text += fmt::format("; {} chords, {} passes", result.plan.chords.size() - 1, result.plan.passes);
  text += fmt::format("\n{}\n", result.check.passes() ? "pass" : "fail");
  for (const Finding& f : result.check.findings)
    text += fmt::format("  {}{}{}: {} ({}, limit {})\n", f.kind, f.program.empty() ? "" : " " + f.program,
                        f.line > 0 ? fmt::format(":{}", f.line) : "", f.message, fixed(f.value, 6), shortest(f.limit));
  return text;
}

}  // namespace retrace::studies
