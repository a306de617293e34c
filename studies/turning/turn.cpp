#include "studies/turning/turn.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "core/atomic_file.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/number_format.h"
#include "fabrication/check/io/program_files.h"
#include "fabrication/post/post.h"
#include "fabrication/turning/check/machined_mesh.h"
#include "fabrication/turning/io/part_files.h"
#include "fabrication/turning/plan/turning_program.h"
#include "geometry/io/stl_file.h"

namespace retrace::studies {
namespace {

namespace turning = fabrication::turning;

/// Returns the first 60 characters of a text. Spaces replace all characters except ASCII letters, digits and commas, so
/// that the text is valid in a comment of every dialect.
std::string comment_of(const std::string& text) {
  std::string result;
  for (const char c : text.substr(0, 60))
    result += (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == ',' ? c : ' ';
  return result;
}

std::vector<std::string> header_of(const TurningResult& r, std::size_t points, double time_s) {
  const turning::TurningTool& tool = r.part.tool;
  return {comment_of(r.part.title.empty() ? "turned part" : r.part.title),
          fmt::format("nose radius {} mm, rake {} deg, skew {} deg", shortest(tool.nose_radius_mm),
                      shortest(tool.rake_deg), shortest(tool.skew_deg)),
          fmt::format("{} points, {} s", points, fixed(time_s, 1))};
}

void write_programs(TurningResult& r) {
  const std::string name = std::filesystem::path(r.file).stem().string();
  const auto straight = turning::turning_program(r.passes, r.part.path, name, header_of(r, r.points, r.time_s));
  fabrication::Program by_cubics;
  if (r.cubics) {
    const std::vector<turning::CubicPoint>& points = r.cubics->path.points;
    double time_s = 0.0;
    for (const turning::CubicPoint& point : points) time_s += point.point.seconds;
    by_cubics = turning::turning_program(r.cubics->path, r.part.path, name, header_of(r, points.size(), time_s));
  }
  for (const fabrication::Dialect& dialect : fabrication::dialects()) {
    const bool has_cubics = r.has_cubics(dialect.name);
    const fabrication::Program& program = has_cubics ? by_cubics : straight;
    r.programs.push_back(
        {std::string(dialect.name), "part" + std::string(dialect.ending), fabrication::nc_text(program, dialect.name)});
    if (!has_cubics || r.cubics->bytes > 0) continue;
    r.cubics->file = r.programs.back().file;
    r.cubics->bytes = r.programs.back().text.size();
    r.cubics->straight_bytes = fabrication::nc_text(straight, dialect.name).size();
  }
  if (r.part.path.servo != turning::Servo::fast) return;
  CsvWriter csv("c_deg,stroke_mm");
  for (const turning::PathPoint& p : r.passes.front())
    csv.row(fmt::format("{:.7f}", p.c_deg), fmt::format("{:.6f}", p.servo_mm));
  r.servo_csv = csv.text();
}

/// Tolerances within which the positions of two programs are equal. Sums of increments differ in their last digits, and
/// the C axis has one digit less in Fanuc programs than in those of other dialects.
constexpr double kSameMm = 1e-9;
constexpr double kSameRad = 1e-8;

bool near(const std::vector<double>& a, const std::vector<double>& b, double most) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [most](double one, double other) { return std::abs(one - other) <= most; });
}

/// Returns the values at the ends of blocks. Other points are ignored, because the number of segments into which a
/// cubic is divided depends on rounded velocities.
std::vector<double> at_ends(const turning::CutPass& pass, const std::vector<double>& values) {
  std::vector<double> ends;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (i == 0 || pass.block_s[i] > 0.0) ends.push_back(values[i]);
  return ends;
}

bool same_cuts(const std::vector<turning::CutPass>& a, const std::vector<turning::CutPass>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& one, const auto& other) {
    const auto same = [&](std::vector<double> turning::CutPass::*values, double most) {
      return near(at_ends(one, one.*values), at_ends(other, other.*values), most);
    };
    return same(&turning::CutPass::x_mm, kSameMm) && same(&turning::CutPass::y_mm, kSameMm) &&
           same(&turning::CutPass::z_mm, kSameMm) && same(&turning::CutPass::c_rad, kSameRad);
  });
}

/// Checks the programs that consist of cubics (`by_cubics`), or those that consist of straight moves. Only the first
/// program is checked in full. The cuts of all further programs must be equal to its cuts.
turning::TurningCheck check_text(const TurningResult& r, bool by_cubics, fabrication::FindingList& findings) {
  std::optional<turning::TurningCuts> reference;
  std::string file;
  for (std::size_t d = 0; d < r.programs.size(); ++d) {
    const TurningText& program = r.programs[d];
    if (r.has_cubics(program.dialect) != by_cubics) continue;
    turning::TurningCuts cuts = turning::read_cuts(
        r.part, {fabrication::parse_nc(program.text, program.file, static_cast<fabrication::NcDialect>(d))}, findings);
    if (!reference) {
      reference = std::move(cuts);
      file = program.file;
    } else if (!same_cuts(reference->passes, cuts.passes)) {
      findings.add(
          {"differs", program.file, 0, -1, fmt::format("the moves differ from the moves of {}", file), 0.0, 0.0, 1});
    }
  }
  std::optional<turning::StrokeTable> strokes;
  if (!r.servo_csv.empty()) strokes = {"servo.csv", r.servo_csv};
  return turning::check_turning(r.part, std::move(*reference), strokes, findings);
}

/// Stores the motion of Z, or of the fast tool servo, around the largest jump of its acceleration. The stretch is two
/// revolutions long for spirals, and the whole pass otherwise.
void find_stretch(TurningResult& r) {
  const turning::Pass& pass = r.passes[r.passes.size() / 2];
  const std::vector<turning::AxisState> states =
      turning::axis_states(pass, r.part.path.servo == turning::Servo::fast ? 3 : 2);
  std::size_t at = 0;
  double most = -1.0;
  for (std::size_t i = 2; i + 2 < states.size(); ++i) {
    const double jump = std::abs(states[i].acceleration_mm_per_s2 - states[i - 1].acceleration_mm_per_s2);
    if (jump > most) {
      most = jump;
      at = i;
    }
  }
  const double half_s =
      r.part.path.strategy == turning::Strategy::spiral ? 60.0 / r.part.path.spindle_rpm : states.back().time_s;
  for (std::size_t i = 1; i + 1 < states.size(); ++i)
    if (std::abs(states[i].time_s - states[at].time_s) <= half_s) r.stretch.z.push_back(states[i]);
}

/// Stores the deviation of the machined surface along the x axis over eight cuts, halfway between the center and the
/// rim.
void find_profile(TurningResult& r, const turning::Envelope& envelope) {
  constexpr int kPoints = 400;
  const double extent =
      r.part.path.strategy == turning::Strategy::spiral ? r.part.path.radius_mm : 0.5 * r.part.path.height_mm;
  for (int i = 0; i <= kPoints; ++i) {
    const double x = 0.5 * extent + 8.0 * r.part.path.feed_mm * (static_cast<double>(i) / kPoints - 0.5);
    const auto z = envelope.height_mm(x, 0.0);
    if (z) r.stretch.profile.emplace_back(x, (*z - r.part.surface.height_mm(x, 0.0)) * 1e6);
  }
}

}  // namespace

bool TurningResult::has_cubics(std::string_view dialect) const {
  return cubics && fabrication::supports_cubics(dialect);
}

TurningResult turn(const std::string& part_file) {
  TurningResult r{part_file, turning::parse_turned_part(read_file(part_file), part_file),
                  {},        0,
                  0.0,       {},
                  {},        {},
                  {},        "",
                  "",        {},
                  {},        {},
                  {}};
  const turning::TurnedPart& part = r.part;
  r.passes = turning::make_path(part.surface, part.tool, part.path, {part_file, 0, "path"});
  for (const turning::Pass& pass : r.passes) r.points += pass.size();
  r.time_s = turning::path_seconds(r.passes);
  r.clearance = turning::clearance_figures(part.tool, turning::slopes_along(part.surface, part.path));
  r.finish = turning::finish_figures(turning::effective_radius_mm(part.tool), part.path.feed_mm);
  for (int axis = 0; axis < 4; ++axis) r.axes[static_cast<std::size_t>(axis)] = turning::axis_figures(r.passes, axis);
  if (part.path.cubic_error_nm)
    r.cubics = {turning::cubic_path(part.surface, part.tool, part.path, 1.0 / part.machine.blocks_per_s.value_or(1e9),
                                    {part_file, 0, "path.cubic_error_nm"}),
                {},
                {}};
  fabrication::FindingList findings;
  write_programs(r);
  r.check = check_text(r, false, findings);
  if (r.cubics) r.cubics->check = check_text(r, true, findings);
  r.findings = findings.take();
  find_stretch(r);
  if (!r.check.envelope) return r;
  const turning::Envelope& envelope = *r.check.envelope;
  if (part.mesh_thickness_mm)
    r.machined_stl = geometry::stl_text(turning::machined_mesh(envelope, part.surface, turning::region_of(part.path),
                                                               part.mesh_rings, *part.mesh_thickness_mm),
                                        "what is moulded in a turned surface");
  find_profile(r, envelope);
  return r;
}

TurningVerification verify_turning(const TurningRequest& request) {
  TurningVerification run{request, turning::parse_turned_part(read_file(request.part), request.part), {}, {}, {}};
  const bool is_fast = run.part.path.servo == turning::Servo::fast;
  if (is_fast && request.servo.empty())
    throw InputError(Field{"servo"}, "must be the name of the file with the table of strokes, because " + request.part +
                                         " has a fast tool servo");
  if (!is_fast && !request.servo.empty())
    throw InputError(Field{"servo"}, request.part + " has no fast tool servo, so a table of strokes is not allowed");
  run.programs = fabrication::read_programs(request.programs, request.dialect);
  std::optional<turning::StrokeTable> strokes;
  if (is_fast) strokes = {request.servo, read_file(request.servo, kMaxDataBytes)};
  fabrication::FindingList findings;
  turning::TurningCuts cuts = turning::read_cuts(run.part, run.programs, findings);
  run.check = turning::check_turning(run.part, std::move(cuts), strokes, findings);
  run.findings = findings.take();
  return run;
}

}  // namespace retrace::studies
