#include "report/page/setup_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "core/number_format.h"

namespace retrace::report {
namespace {

using namespace fabrication;
using geometry::Vec3;
using studies::FabricationResult, studies::SetupSheet, studies::Sensitivity;

/// Additional style of the set-up sheet, for printing on A4 paper and for ticking off steps by hand.
constexpr const char* kPrintStyle =
    "ol.steps{padding-left:1.4rem}ol.steps li{margin:.35rem 0;padding-right:2.2rem;position:relative}"
    "ol.steps li:after{content:\"\";position:absolute;right:.2rem;top:.15rem;width:1rem;height:1rem;border:1px solid "
    "var(--quiet);border-radius:.15rem}.table-box{max-height:none}td{overflow-wrap:break-word}"
    "@media print{@page{size:A4;margin:12mm 11mm}body{padding:0;font-size:10px}h2{font-size:13px;"
    "break-after:avoid}table{font-size:8.6px}td{overflow-wrap:anywhere}th,td{padding:.15rem "
    ".35rem}.facts{grid-template-columns:repeat(4,1fr);gap:"
    ".3rem}.facts>div{padding:.25rem .4rem}.facts dt{font-size:9px}.facts dd{font-size:11px}.facts "
    "dd.long{font-size:10px}"
    "section{break-inside:auto}figure,tr,li{break-inside:avoid}.pictures{display:grid;grid-template-columns:1fr "
    "1fr;gap:0 6mm}figcaption{font-size:9px}h1{font-size:17px}header p{font-size:10px}details{display:none}}";

std::string hours(double seconds) {
  const auto minutes = static_cast<long>(std::ceil(seconds / 60.0));
  return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

std::string mm(double value, int digits = 4) {
  return fixed(value, digits) + " mm";
}

std::string triple(const Vec3& v, int digits) {
  return fmt::format("{}, {}, {}", fixed(v.x(), digits), fixed(v.y(), digits), fixed(v.z(), digits));
}

std::string tilt_word(const FabricationResult& result) {
  return std::string(1, result.machine.tilt_letter());
}

/// Returns a text about a quantity that the operator sets, such as the height of the tool. The text states the maximum
/// geometric errors of the part if this quantity is wrong by one unit.
/// \param key key of the quantity, such as "tool_z_um"
std::string cost(const SetupSheet& sheet, std::string_view key) {
  for (const Sensitivity& row : sheet.sensitivities.rows)
    if (row.quantity->key == key)
      return fmt::format(
          "An error of 1 {} causes errors of up to {} nm on facets, {} nm at roots, {} nm in walls and {} nm in chip "
          "thickness",
          row.quantity->unit(), fixed(row.farthest_nm(), 0), fixed(std::max(row.root_residual_nm, row.root_cut_nm), 0),
          fixed(row.wall_nm, 0), fixed(row.chip_nm, 0));
  return {};
}

PageSection section(std::string id, std::string title, std::string paragraph = {}) {
  PageSection result = titled(std::move(title), paragraph);
  result.id = std::move(id);
  return result;
}

PageSection overview(const FabricationResult& result) {
  PageSection s = section("job", "Job");
  const Job& job = result.job;
  s.facts = {{"Job", std::filesystem::path(job.source).filename().string()},
             {"Machine", result.machine.name},
             {"Dialect", result.dialect},
             {"Strategy", std::string(kStrategyWords[static_cast<std::size_t>(job.strategy)])},
             {"Process", job.process.name},
             {"Elements", std::to_string(result.plan.elements.size())},
             {"Programs", std::to_string(result.plan.programs.size())},
             {"Time", hours(result.plan.time.total_s())}};
  return s;
}

PageSection blank_section(const FabricationResult& result, const SetupSheet& sheet) {
  const studies::BlankSetup& blank = sheet.blank;
  PageSection s = section("blank", "1. Blank and fixture");
  s.facts = {{"Blank", std::string(kWorkpieceWords[static_cast<std::size_t>(result.job.workpiece.kind)])},
             {fmt::format("Array along X and Y at {}0 C0", tilt_word(result)),
              fmt::format("{} x {} mm", fixed(blank.array_mm.x(), 3), fixed(blank.array_mm.y(), 3))},
             {"Deepest cut below the face", mm(blank.deepest_mm, 6)}};
  if (blank.fixture_height_mm)
    s.facts.push_back({"Table to face, blank with its fixture", mm(*blank.fixture_height_mm, 3)});
  if (blank.free_radius_mm > 0.0)
    s.facts.push_back({"Maximum radius of face and clamps about C", mm(blank.free_radius_mm, 2)});
  if (!blank.base.empty()) s.paragraphs.push_back(blank.base);
  for (const std::string& zone : blank.zones) s.paragraphs.push_back(zone);
  const double tilt_nm = 1e6 * 0.5 * blank.array_mm.maxCoeff() * std::tan(Angle::from_deg(1.0 / 3600.0).rad());
  s.steps = {fmt::format("Clamp the blank on its lower face, against two edges, so that roof edges are parallel to X "
                         "at {}0 C0. Nothing may project above the face{}.",
                         tilt_word(result),
                         blank.free_radius_mm > 0.0
                             ? fmt::format(", and at its height nothing may extend beyond {} mm from the C axis, "
                                           "because the table rotates under the tool at Z {}",
                                           fixed(blank.free_radius_mm, 2), fixed(result.plan.safe_z_mm, 3))
                             : std::string()),
             fmt::format("At {}0 C0, align the face along X and along Y with an indicator. Each arcsec of tilt shifts "
                         "the rims at the border of the array by {} nm, and does not change the angles between facets.",
                         tilt_word(result), fixed(tilt_nm, 1))};
  return s;
}

/// Returns the steps for mounting and checking the tool, a chisel or a V-shaped diamond.
std::vector<std::string> tool_steps(const FabricationResult& result, const SetupSheet& sheet) {
  const bool is_dmc = !cuts_prisms(result.job);
  std::vector<std::string> steps;
  steps.push_back(
      fmt::format("Mount the diamond so that its clearance face is at {} degrees to the facet that it cuts. Check this "
                  "angle along X with a microscope.",
                  shortest(result.job.tool.clearance_deg)));
  if (is_dmc) {
    steps.push_back(
        fmt::format("Its leading edge must be at {} degrees to the horizontal line of the facet, and the bisector of "
                    "its nose angle of {} degrees must be in the YZ plane. Rotation about Z: {}.",
                    shortest(90.0 - 0.5 * result.job.tool.nose_angle_deg), shortest(result.job.tool.nose_angle_deg),
                    cost(sheet, "tool_rotation_z_arcsec")));
  } else {
    steps.push_back(fmt::format("Align the edge with X: traverse it along X under a probe. {}.",
                                cost(sheet, "tool_rotation_z_arcsec")));
    steps.push_back(fmt::format("Make the edge horizontal: both ends must be at the same height. {}.",
                                cost(sheet, "tool_rotation_y_arcsec")));
  }
  steps.push_back(
      "Inspect the edge under a microscope before and after the job: a chip in the edge leaves a ridge on every "
      "facet.");
  return steps;
}

PageSection tool_section(const FabricationResult& result, const SetupSheet& sheet) {
  const Tool& tool = result.job.tool;
  PageSection s = section("tool", "2. Tool");
  const bool is_dmc = !cuts_prisms(result.job);
  s.facts = {{is_dmc ? "Width of the V across its edges" : "Width of the chisel's edge", mm(tool.width_mm)},
             {"Wedge angle", shortest(tool.wedge_deg) + " degrees"},
             {"Clearance angle as mounted", shortest(tool.clearance_deg) + " degrees"},
             {"Rake angle during the plunge", fixed(sheet.tool.plunge_rake_deg, 2) + " degrees"},
             {is_dmc ? "Nose radius" : "Edge radius", shortest(tool.edge_radius_um) + " um"}};
  if (is_dmc) s.facts.push_back({"Angle between its edges", shortest(tool.nose_angle_deg) + " degrees"});
  if (sheet.tool.free_length_mm) s.facts.push_back({"Free length below the holder", mm(*sheet.tool.free_length_mm, 2)});
  const ToolMount& mount = result.machine.mount;
  if (mount.offset_mm.value != Vec3::Zero() || mount.rotation_deg.value != Vec3::Zero())
    s.paragraphs.push_back(fmt::format(
        "Programs compensate a tool that is mounted {} mm off its nominal position along X, Y, Z and is rotated "
        "by {} degrees about these axes ({}).",
        triple(mount.offset_mm.value, 6), triple(mount.rotation_deg.value, 6), mount.rotation_deg.source));
  s.steps = tool_steps(result, sheet);
  return s;
}

PageSection zero_section(const FabricationResult& result, const SetupSheet& sheet) {
  const bool is_dmc = !cuts_prisms(result.job);
  PageSection s = section("zero", "3. Zero");
  s.paragraphs.push_back(fmt::format(
      "The work zero is the centre of the array on the face of the blank{}, at {}0 C0. The tool reference point is {}.",
      result.job.substrate ? ", at the height of its highest point" : "", tilt_word(result),
      is_dmc ? "the tip"
             : "the centre of the edge's width, at the intersection of its clearance side and its lowest line"));
  s.steps = {
      fmt::format("Move to {}0 C0, stop the spindle and switch off the coordinate transformation of the control. The "
                  "tool must be mounted and aligned: if it is rotated in its holder later, touch it off again.",
                  tilt_word(result)),
      fmt::format(
          "Z: lower the edge onto the face next to the array until it leaves a mark, and set this height as Z0. {}.",
          cost(sheet, "tool_z_um")),
      fmt::format("Y: move the clearance side to a reference edge of the blank, or cut a mark and measure it, and set "
                  "the centre of the array as Y0. {}.",
                  cost(sheet, "tool_y_um")),
      fmt::format("X: use the same method with the centre of the edge, and set the centre of the array as X0. {}.",
                  cost(sheet, "tool_x_um")),
      fmt::format("C: rotate C to 180 degrees, touch off the same point again, and halve the difference. The resulting "
                  "distance of the C axis from the zero must agree with the table below. {}.",
                  cost(sheet, "c_y_um"))};
  return s;
}

std::string basis(const auto& sourced) {
  return fmt::format("{}: {}", sourced.basis == Basis::measured ? "measured" : "assumed", sourced.source);
}

PageSection axes_section(const FabricationResult& result, const SetupSheet& sheet) {
  const Machine& m = result.machine;
  PageSection s = section(
      "axes", "4. Positions of the axes in the programs",
      "The programs are computed for these axes: if the real axes differ, the facets are displaced and tilted. "
      "Positions are relative to the work zero at A0 C0; those of a tilting head are relative to the tool tip.");
  PageTable table;
  table.caption = "Axes";
  table.csv_name = "axes.csv";
  table.columns = {"axis", "point X, Y, Z (mm)", "direction X, Y, Z", "source"};
  for (const auto& [name, axis] : {std::pair{tilt_word(result), &m.a}, std::pair{std::string("C"), &m.c}})
    table.rows.push_back({name, triple(axis->point_mm.value, 6), triple(axis->direction.value, 8),
                          basis(axis->point_mm) + "; " + basis(axis->direction)});
  for (const auto& [name, axis] : {std::pair{"X", &m.x}, std::pair{"Y", &m.y}, std::pair{"Z", &m.z}})
    table.rows.push_back({name, "", triple(axis->direction.value, 8), basis(axis->direction)});
  s.tables.push_back(std::move(table));
  const std::string height = m.tilt == Tilt::table ? "a_z_um" : "b_z_um";
  s.paragraphs.push_back(fmt::format("Centre of C: {}. {}: {}.", cost(sheet, "c_y_um"),
                                     m.tilt == Tilt::table ? "Height of A" : "Length to the pivot of B",
                                     cost(sheet, height)));
  return s;
}

PageSection control_section(const FabricationResult& result, const SetupSheet& sheet) {
  PageSection s = section("control", "5. Control");
  s.steps.push_back(fmt::format("{}", fmt::join(sheet.control_needs, " ")));
  s.steps.push_back(
      fmt::format("Set G54, or the work offset of the control, to the zero of section 3. Switch off tool offsets and "
                  "all transformations. Every program repeats this at its beginning ({}).",
                  result.dialect));
  s.steps.push_back(result.job.process.mist ? "Keep the mist ready: programs switch it on for cuts and off for stops."
                                            : "No mist is needed: the process does not use it.");
  s.steps.push_back(fmt::format(
      "Nothing on the table may be higher than Z {}: the first move of every program moves only Z, to this height.",
      fixed(result.machine.first_z_mm(), 3)));
  return s;
}

/// Returns the table of stops at which programs wait for the operator.
PageTable stops_table(const FabricationResult& result) {
  PageTable table;
  table.caption = "Stops";
  table.csv_name = "stops.csv";
  table.columns = {"program", "after", "why", "continues with", "edge has cut (mm)", "done by"};
  for (const fabrication::PlannedStop& stop : result.plan.stops)
    table.rows.push_back({result.program_file(stop.program), hours(stop.at_s),
                          std::string(fabrication::kStopReasonWords[static_cast<std::size_t>(stop.reason)]),
                          fmt::format("element {} of {}", stop.element, result.plan.stages[stop.stage].name),
                          result.job.tool.edge_life_mm ? fixed(stop.wear.cut_mm, 1) : std::string(),
                          "_________________"});
  return table;
}

PageSection programs_section(const FabricationResult& result, const SetupSheet& sheet) {
  PageSection s = section("programs", "6. Programs, in this order");
  PageTable table;
  table.caption = "Programs";
  table.csv_name = "programs.csv";
  table.columns = {"", "program", "time", "begins after", "optional stops", "run (date, name)"};
  double before_s = 0.0;
  for (std::size_t k = 0; k < result.plan.programs.size(); ++k) {
    const double seconds = result.plan.program_times_s[k];
    table.rows.push_back({std::to_string(k + 1), result.program_file(k), hours(seconds), hours(before_s),
                          std::to_string(sheet.optional_stops[k]), "_________________"});
    before_s += seconds;
  }
  s.tables.push_back(std::move(table));
  if (!result.plan.stops.empty()) s.tables.push_back(stops_table(result));
  PageTable travel;
  travel.caption = "Travel of the axes in the programs";
  travel.csv_name = "travel.csv";
  travel.columns = {"axis", "from", "to", "limits", ""};
  for (const studies::AxisTravel& axis : sheet.travel)
    travel.rows.push_back({std::string(1, axis.axis), fixed(axis.low, 4), fixed(axis.high, 4),
                           fmt::format("{} to {}", shortest(axis.limits.low), shortest(axis.limits.high)),
                           axis.axis == 'X' || axis.axis == 'Y' || axis.axis == 'Z' ? "mm" : "degrees"});
  s.tables.push_back(std::move(travel));
  if (result.machine.warm_up_s.value > 0.0)
    s.paragraphs.push_back(fmt::format(
        "X and Y move to and fro for {} s before the first cut of a program and after a stop: keep their travel clear.",
        shortest(result.machine.warm_up_s.value)));
  if (result.job.tool.edge_life_mm)
    s.paragraphs.push_back(fmt::format(
        "Every program begins with an unused edge that can cut {} mm; {}.", shortest(*result.job.tool.edge_life_mm),
        result.job.tool.next_edge == fabrication::NextEdge::stop ? "so does every program that continues after a stop"
                                                                 : "the edge is not changed at stops"));
  s.paragraphs.push_back(
      fmt::format("Rotary axes rotate only while the tool is at Z {} or higher. Before the first program, do a dry run "
                  "high above the table.",
                  fixed(result.plan.safe_z_mm, 3)));
  return s;
}

PageSection checks_section(const FabricationResult& result, const SetupSheet& sheet) {
  PageSection s = section("checks", "7. What to measure, and when",
                          "Measure depths with a stylus instrument or an AFM, and angles with an autocollimator. If a "
                          "depth differs by more than the process allows, or if facets differ in angle, measure again "
                          "before the next stage removes the remaining material.");
  PageTable table;
  table.caption = "After each stage";
  table.csv_name = "checks.csv";
  table.columns = {"stage",   "program", "ends after", "remaining on the facets (um)", "root below the rims (mm)",
                   "measured"};
  constexpr std::size_t kMost = 60;
  for (const studies::StageCheck& check : sheet.checks) {
    if (table.rows.size() == kMost) break;
    table.rows.push_back(
        {check.stage, result.program_file(check.program), hours(check.ends_s), fixed(check.remaining_um, 3),
         check.root_depth_mm > 0.0 ? fixed(check.root_depth_mm, 6) : std::string("-"), "_________________"});
  }
  table.omitted_rows = sheet.checks.size() - table.rows.size();
  s.tables.push_back(std::move(table));
  return s;
}

std::string effect_text(const studies::FacetEffect& effect) {
  const auto angle = [](double arcmin) { return std::abs(arcmin) < 5e-5 ? std::string("0") : fixed(arcmin, 4); };
  return fmt::format("{} nm; {}; {}", fixed(effect.distance_nm, 1), angle(effect.up_arcmin),
                     angle(effect.along_arcmin));
}

/// Returns the change relative to `of`, in percent.
/// \param least minimum magnitude of the relative change; for smaller changes, the result is "<" followed by this
/// magnitude in percent
std::string change_text(double change, double of, double least) {
  if (!(of > 0.0)) return "-";
  const double share = change / of;
  return std::abs(share) < least ? fmt::format("< {}", shortest(100.0 * least)) : fmt::format("{:+.2g}", 100.0 * share);
}

PageTable sensitivity_table(const FabricationResult& result, const SetupSheet& sheet) {
  PageTable table;
  table.caption =
      "Effects of one um or one arcsec, the largest first. For each facet: displacement of its centroid; tilt up its "
      "slope and along its root in arcmin";
  table.csv_name = "sensitivities.csv";
  table.columns = {"quantity, unit"};
  for (const studies::FacetKind& kind : sheet.sensitivities.kinds) table.columns.push_back(kind.name());
  table.columns.insert(table.columns.end(), {"facets, maximum (nm)", "chip thickness (nm)",
                                             "material left at root (nm)", "cut into root (nm)"});
  const bool has_walls = result.machine.tilt == Tilt::table;
  if (has_walls) table.columns.emplace_back("cut into walls (nm)");
  if (sheet.light) table.columns.insert(table.columns.end(), {"RRE (%)", "R_A (%)"});
  for (const Sensitivity& row : sheet.sensitivities.rows) {
    std::vector<PageCell> cells = {fmt::format("{}, {}", row.quantity->description, row.quantity->unit())};
    for (const studies::FacetEffect& effect : row.facets) cells.push_back(effect_text(effect));
    for (const double nm : {row.farthest_nm(), row.chip_nm, row.root_residual_nm, row.root_cut_nm})
      cells.push_back(fixed(nm, 1));
    if (has_walls) cells.push_back(fixed(row.wall_nm, 1));
    if (const studies::PartLight* const change = sheet.change_of_light(*row.quantity, result.machine.tilt)) {
      cells.push_back(
          change_text(change->rre.back(), sheet.light->nominal.rre.back(), studies::SetupLight::kMinRreChange));
      cells.push_back(change_text(change->r_a, sheet.light->nominal.r_a, studies::SetupLight::kMinRaChange));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

PageSection sensitivity_section(const FabricationResult& result, const SetupSheet& sheet) {
  PageSection s = section(
      "sensitivities", "8. Effects of set-up errors",
      "An error is a difference between the real machine and sections 2 to 4. A positive displacement leaves material. "
      "At the root, a cut either ends before the other facet and leaves material, or cuts into the other facet.");
  s.tables.push_back(sensitivity_table(result, sheet));
  if (sheet.light)
    s.paragraphs.push_back(
        fmt::format("RRE within {} degrees at normal incidence: {} %. R_A at an observation angle of {} degrees and an "
                    "entrance angle of {} degrees: {} cd/(lx m2). Both are computed exactly with diffraction, for "
                    "smooth facets and {} elements at the centre of the array.",
                    shortest(sheet.light->cones_deg.back()), fixed(100.0 * sheet.light->nominal.rre.back(), 3),
                    shortest(studies::SetupLight::kObservationDeg), shortest(studies::SetupLight::kEntranceDeg),
                    fixed(sheet.light->nominal.r_a, 2), sheet.light->elements));
  else
    s.paragraphs.push_back("RRE and R_A are not computed: " + sheet.why_no_light + ".");
  return s;
}

}  // namespace

Page setup_page(const FabricationResult& result, const SetupSheet& sheet, std::vector<PageFigure> drawings) {
  Page page;
  page.title = "Set-up: " + (result.job.title.empty() ? std::filesystem::path(result.job.source).filename().string()
                                                      : result.job.title);
  page.subtitle =
      fmt::format("{} on machine {}, {}. Set up by ____________________  on ____________________",
                  std::filesystem::path(result.job.source).filename().string(), result.machine.name, result.dialect);
  page.sections = {overview(result),
                   blank_section(result, sheet),
                   tool_section(result, sheet),
                   zero_section(result, sheet),
                   axes_section(result, sheet),
                   control_section(result, sheet),
                   programs_section(result, sheet),
                   checks_section(result, sheet),
                   sensitivity_section(result, sheet)};
  PageSection figures = section("drawings", "9. Drawings");
  figures.figures = std::move(drawings);
  page.sections.push_back(std::move(figures));
  return page;
}

std::string setup_html(const Page& page) {
  PageAssets assets = shipped_page_assets();
  return page_html(page, {"", assets.style + kPrintStyle, ""});
}

}  // namespace retrace::report
