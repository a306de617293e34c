#include "fabrication/chisel/plan/program_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include "core/number_format.h"
#include "fabrication/job/substrate_cells.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Returns the common name of all programs, without their numbers. The name of a program that restarts at an element
/// also contains this element.
std::string base_name(const PlanOptions& options) {
  std::string name = options.phase == "all" ? "program" : options.phase;
  if (name.ends_with('+')) name.replace(name.size() - 1, 1, "_and_after");
  if (options.from_element) name += fmt::format("_from_element_{}", *options.from_element);
  return options.from_pass ? fmt::format("{}_pass_{}", name, *options.from_pass) : name;
}

/// Returns a header line that states which stages must have been cut before this program.
std::string restart_text(const PlanOptions& options, const Stage& first) {
  std::string from = options.from_element ? fmt::format(" from element {}", *options.from_element) : "";
  if (options.from_pass) from += fmt::format(", pass {}", *options.from_pass);
  return plain(fmt::format("A part of the job: begins with stage {}{}. All that comes before it must have been cut",
                           first.name, from));
}

}  // namespace

std::string plain(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const bool fits = c >= 0x20 && c < 0x7f && std::string_view("()[]{}\"';%").find(c) == std::string_view::npos;
    result += fits ? c : '_';
  }
  return result;
}

std::vector<std::string> program_header(const Job& job, const Machine& machine, const PlanOptions& options,
                                        const ProcessFacts& facts, const Plan& plan, double seconds) {
  const geometry::Vec2 extent = blank_extent_mm(job);
  const Process& p = job.process;
  const char tilt = machine.tilt_letter();
  std::vector<std::string> lines = {
      job.title.empty() ? facts.array_title : plain(job.title),
      plain("Job " + std::filesystem::path(job.source).filename().string() + ", machine " + machine.name),
      fmt::format("Blank: {}, array of {} x {} mm along X and Y at {}0 C0",
                  kWorkpieceWords[static_cast<std::size_t>(job.workpiece.kind)], fixed(extent.x(), 3),
                  fixed(extent.y(), 3), tilt)};
  if (job.substrate) lines.push_back(plain(substrate_description(job)));
  for (const std::string& line : facts.description) lines.push_back(line);
  lines.push_back(plain(fmt::format("Process {}: roughing {} um, finishing {} x {} um, clearance {} mm", p.name,
                                    shortest(p.roughing_depth_um), has_finishing_cuts(job) ? p.finishing_cuts : 0,
                                    shortest(p.finishing_depth_um), shortest(p.clearance_mm))));
  constexpr std::size_t kMaxPoses = 24;
  for (const CuttingPose& pose : std::span(plan.poses).first(std::min(kMaxPoses, plan.poses.size())))
    lines.push_back(fmt::format("Pose: facet {}{}{} {}{:.7f} C{:.7f}", pose.facet.facet,
                                pose.facet.rotated ? " of turned elements" : "",
                                job.zones.empty() ? "" : fmt::format(" of zone {}", pose.facet.zone + 1), tilt,
                                pose.rounded.a_deg, pose.rounded.c_deg));
  if (plan.poses.size() > kMaxPoses)
    lines.push_back(fmt::format("And {} poses more, each where it begins", plan.poses.size() - kMaxPoses));
  const auto point = [](const RotaryAxis& axis) {
    const Vec3& at = axis.point_mm.value;
    return fmt::format("X{} Y{} Z{}", shortest(at.x()), shortest(at.y()), shortest(at.z()));
  };
  lines.push_back(fmt::format(
      "{} is taken to turn about a line through {} from {}, C about one through {} from the work zero", tilt,
      point(machine.a), machine.tilt == Tilt::table ? "the work zero" : "the tool reference point", point(machine.c)));
  if (job.tool.edge_life_mm)
    lines.push_back(
        fmt::format("Begins with an edge that cuts {} mm, and has cut nothing yet", shortest(*job.tool.edge_life_mm)));
  if (options.phase != "all" || options.from_element) lines.push_back(restart_text(options, plan.stages.front()));
  const auto minutes = static_cast<std::int64_t>(std::ceil(seconds / 60.0));
  lines.push_back(fmt::format("Expected time: {} h {} min", minutes / 60, minutes % 60));
  return lines;
}

Item stage_text(const Stage& stage, const CuttingPose& pose) {
  if (stage.roughs) return Comment{plain("Stage " + stage.name)};
  const auto c_deg = static_cast<long>(std::lround(pose.rounded.c_deg));
  const std::string what = stage.name.starts_with("layer") ? "Layer" : "Finishing cut";
  return Message{fmt::format("{} {} of {} C-axis at {}", what, stage.cut, stage.cuts, c_deg)};
}

void name_programs(const PlanOptions& options, std::vector<Program>& programs) {
  const std::string name = base_name(options);
  if (programs.size() == 1) {
    programs.front().name = name;
    return;
  }
  for (std::size_t k = 0; k < programs.size(); ++k) {
    programs[k].name = fmt::format("{}_{:03}", name, k + 1);
    programs[k].header.insert(
        programs[k].header.begin(),
        fmt::format("Part {} of {}{}", k + 1, programs.size(), k == 0 ? "" : ", to run when those before it have run"));
  }
}

}  // namespace retrace::fabrication
