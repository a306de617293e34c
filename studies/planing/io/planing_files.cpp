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
#include "fabrication/check/io/finding_rows.h"
#include "fabrication/planing/plan/zone_profile.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using Json = nlohmann::ordered_json;

/// Published machining times per block (single move), in s, for the lens of E. D. Bulatov, S. A. Gridin and A. A.
/// Danilenko. The two programs of this lens have about 2500 blocks in 5 h and 3500 blocks in 8 h.
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
      zone["method"] = result.plan.uses_depth_method[k] ? "by_depths" : "one_after_another";
      zone["cuts"] = cuts[k];
    }
    zones.push_back(std::move(zone));
  }
  return zones;
}

Json planing_findings(const PlaningCheck& check) {
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

Totals totals_of(const PlaningCheck& check) {
  Totals totals;
  for (const std::int64_t frames : check.frames) totals.frames += frames;
  for (const double time_s : check.time_s) totals.time_s += time_s;
  return totals;
}

double flank_deg(double slope) {
  return Angle::from_rad(std::atan(slope)).deg();
}

double form_error_mm(const PlanedPart& part, const PlaningCheck& check) {
  return part.mill ? std::max(check.excess_mm_max, check.gouge_mm_max) : check.path_distance_mm_max;
}

/// Adds the data that are computed from a program's text.
void add_run(const PlaningCheck& check, std::size_t program, Json& json) {
  json["blocks"] = check.frames[program];
  json["hours"] = check.time_s[program] / 3600.0;
  json["seconds_per_block"] = per_frame(check.time_s[program], check.frames[program]);
}

Json programs_json(const PlaningResult& result) {
  Json programs = Json::array();
  for (std::size_t k = 0; k < result.programs.size(); ++k) {
    const PlannedProgram& planned = result.plan.programs[k];
    programs.push_back({{"program", result.programs[k].name}, {"set", planned.set}, {"cuts", planned.cuts}});
    add_run(result.check, k, programs.back());
  }
  return programs;
}

/// Adds the data of the machine and its checks.
/// \param plan plan of the programs; null for programs of unknown origin
void add_machine(const PlanedPart& part, const PlaningCheck& check, const PlaningPlan* plan, Json& json) {
  if (part.mill) {
    json["fast_feed_mm_per_min"] = part.mill->fast_feed_mm_per_min;
    json["tool_flank_deg"] = flank_deg(check.flank_slope);
    if (plan != nullptr) json["quantum_mm"] = plan->quantum_mm;
    json["form_error_mm_max"] = form_error_mm(part, check);
    json["excess_mm_max"] = check.excess_mm_max;
    json["gouge_mm_max"] = check.gouge_mm_max;
    json["off_grid_nm_max"] = check.off_grid_nm_max;
    json["shortest_move_mm"] = {check.shortest_x_mm, check.shortest_y_mm, check.shortest_z_mm};
    return;
  }
  json["feed_mm_per_min"] = part.lathe->feed_mm_per_min;
  json["spindle_rpm"] = part.lathe->spindle_rpm;
  json["spindle_direction"] = kSpindleDirectionWords[static_cast<std::size_t>(part.lathe->spindle_direction)];
  if (plan != nullptr) {
    json["passes"] = plan->passes;
    json["chords"] = plan->chords.size() - 1;
    json["longest_chords"] = plan->longest.size() - 1;
  }
  json["nose_radius_mm"] = part.lathe->nose_radius_mm;
  json["form_error_mm_max"] = form_error_mm(part, check);
  json["unreached_mm_max"] = check.unreached_mm_max;
  json["chip_mm_max"] = check.chip_mm_max;
}

}  // namespace

std::string planing_json(const PlaningResult& result) {
  const Totals totals = totals_of(result.check);
  Json json = {{"part", result.part.source},
               {"title", result.part.title},
               {"dialect", result.dialect},
               {"element", element_json(result.part)},
               {"tolerance_mm", result.part.tolerance_mm},
               {"verdict", result.check.passes() ? "pass" : "fail"},
               {"findings", planing_findings(result.check)}};
  add_machine(result.part, result.check, &result.plan, json);
  json["zones"] = zones_json(result);
  json["programs"] = programs_json(result);
  json["runs"] = result.plan.runs;
  json["blocks"] = result.plan.runs * totals.frames;
  json["hours"] = result.plan.runs * totals.time_s / 3600.0;
  json["seconds_per_block"] = per_frame(totals.time_s, totals.frames);
  if (result.part.mill) json["published_seconds_per_block"] = kPublishedSecondsPerFrame;
  return result_text("retrace.planing/2", json, result.warnings);
}

std::string planing_csv(const PlaningResult& result) {
  CsvWriter csv("x_mm,design_mm,machined_mm");
  for (const ProfileSample& s : result.check.profile)
    csv.row(fixed(s.x_mm, 6), fixed(s.design_mm, 6), fixed(s.machined_mm, 6));
  return csv.text();
}

std::string planing_table(const PlaningResult& result) {
  std::string text;
  if (!result.part.title.empty()) text += printable(result.part.title) + "\n";
  text += "program                 cuts  blocks   hours  s/block\n";
  for (std::size_t k = 0; k < result.programs.size(); ++k)
    text += fmt::format("{:<22} {:>5} {:>7} {:>7} {:>8}\n", printable(result.programs[k].name, std::string::npos),
                        result.plan.programs[k].cuts, result.check.frames[k], fixed(result.check.time_s[k] / 3600.0, 2),
                        fixed(per_frame(result.check.time_s[k], result.check.frames[k]), 2));
  const Totals totals = totals_of(result.check);
  text += fmt::format("total of {} run{} of each program: {} blocks, {} hours\n", result.plan.runs,
                      result.plan.runs > 1 ? "s" : "", result.plan.runs * totals.frames,
                      fixed(result.plan.runs * totals.time_s / 3600.0, 2));
  text += fmt::format("form error {} mm, tolerance {} mm", fixed(form_error_mm(result.part, result.check), 4),
                      shortest(result.part.tolerance_mm));
  if (result.part.mill)
    text += fmt::format("; tool flank {} degrees, depth quantum {} mm", shortest(flank_deg(result.plan.flank_slope)),
                        shortest(result.plan.quantum_mm));
  else
    text += fmt::format("; {} chords, {} passes", result.plan.chords.size() - 1, result.plan.passes);
  text += fmt::format("\n{}\n", result.check.passes() ? "pass" : "fail");
  for (const Finding& f : result.check.findings)
    text += fmt::format("  {}{}{}: {} ({}, limit {})\n", f.kind,
                        f.program.empty() ? "" : " " + printable(f.program, std::string::npos),
                        f.line > 0 ? fmt::format(":{}", f.line) : "", f.message, fixed(f.value, 6), shortest(f.limit));
  return text;
}

std::string verification_json(const PlaningVerification& run, double elapsed_s) {
  const PlaningCheck& check = run.check;
  Json json = {{"verdict", check.passes() ? "pass" : "fail"},
               {"part", run.part.source},
               {"title", run.part.title},
               {"process", "planing"}};
  Json programs = Json::array();
  for (std::size_t k = 0; k < run.programs.size(); ++k) {
    programs.push_back(program_json(run.programs[k]));
    add_run(check, k, programs.back());
  }
  json["programs"] = std::move(programs);
  json["findings"] = findings_json(check.findings);
  json["tolerance_mm"] = run.part.tolerance_mm;
  add_machine(run.part, check, nullptr, json);
  const Totals totals = totals_of(check);
  json["blocks"] = totals.frames;
  json["time_s"] = totals.time_s;
  json["elapsed_s"] = elapsed_s;
  return result_text("retrace.verification/2", json, {});
}

std::string verification_table(const PlaningVerification& run) {
  const PlaningCheck& check = run.check;
  const Totals totals = totals_of(check);
  std::string text =
      fmt::format("{}: {}\n", printable(run.part.source, std::string::npos), check.passes() ? "pass" : "fail");
  const auto row = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<28} {}\n", name, value);
  };
  const auto in_mm = [](double value) {
    return value < 1e6 ? fixed(value, 4) + " mm" : std::string("too large to measure");
  };
  row("form error", in_mm(form_error_mm(run.part, check)));
  row("tolerance", shortest(run.part.tolerance_mm) + " mm");
  if (run.part.lathe) row("largest depth of a pass", in_mm(check.chip_mm_max));
  row("blocks", std::to_string(totals.frames));
  row("time", fixed(totals.time_s / 3600.0, 2) + " h");
  return text + findings_table(check.findings);
}

}  // namespace retrace::studies
