#include "fabrication/chisel/plan/tool_life.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/limit_error.h"
#include "core/number_format.h"
#include "fabrication/machine/edge_cut.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

constexpr double kSecondsPerMinute = 60.0;

bool cuts(const Job& job, Motion motion) {
  const bool goes_up_edge = !cuts_prisms(job) && motion == Motion::retract;
  return motion == Motion::plunge || motion == Motion::plough || goes_up_edge;
}

/// Returns the fraction of a straight path that is below height 0.
/// \param from_mm height of the first end
/// \param to_mm height of the second end
double fraction_below(double from_mm, double to_mm) {
  const double low = std::min(from_mm, to_mm);
  const double high = std::max(from_mm, to_mm);
  if (high <= 0.0) return 1.0;
  return low >= 0.0 ? 0.0 : low / (low - high);
}

}  // namespace

double length_of_cut_mm(const Job& job, const Machine& machine, const CutElement& element, const CuttingPose& pose,
                        const CycleCall& visit, const Subroutine& routine, double stock_mm) {
  // Distance from the tool reference point down to the intersection of two tangents of the edge circle (the rounded
  // edge). The tangents are in the planes of the two facets (docs/theory/verification.md).
  const double below_mm = cuts_prisms(job) ? pose.section.edge_mm / std::sin(pose.section.apex.rad()) : 0.0;
  const Vec3 tip = edge_frame(machine) * Vec3(0.0, 0.0, -below_mm);
  const auto height_mm = [&](const Vec3& words) {
    AxisPositions axes{words.x(), words.y(), words.z(), 0.0, pose.rounded.c_deg};
    (machine.tilt == Tilt::table ? axes.a_deg : axes.b_deg) = pose.rounded.a_deg;
    const ToolPose tool = forward(machine, axes);
    return element.workpiece_from_element.col(2).dot(tool.reference_mm + tool.workpiece_from_machine * tip -
                                                     element.origin_mm) -
           stock_mm;
  };
  // In one pose of the rotary axes, heights are linear functions of the linear axis positions.
  const Vec3 start = millimetres(visit.start);
  const double start_mm = height_mm(start);
  const Vec3 rise(height_mm(start + Vec3::UnitX()) - start_mm, height_mm(start + Vec3::UnitY()) - start_mm,
                  height_mm(start + Vec3::UnitZ()) - start_mm);
  double from_mm = start_mm;
  double length_mm = 0.0;
  for (const Step& step : routine.steps) {
    const auto* const move = std::get_if<Move>(&step);
    if (move == nullptr) continue;
    const Vec3 by =
        millimetres(LinearPosition(move->to[kX].value_or(0), move->to[kY].value_or(0), move->to[kZ].value_or(0)));
    const double to_mm = from_mm + rise.dot(by);
    if (cuts(job, move->motion)) length_mm += by.norm() * fraction_below(from_mm, to_mm);
    from_mm = to_mm;
  }
  return length_mm;
}

void ToolLife::stop() {
  wear_.seconds = 0.0;
  if (job_.tool.next_edge == NextEdge::stop) wear_.cut_mm = 0.0;
}

bool ToolLife::exceeds_tool_life(const ToolWear& visit) const {
  return job_.tool.edge_life_mm && wear_.cut_mm + visit.cut_mm > *job_.tool.edge_life_mm;
}

std::optional<StopReason> ToolLife::stop_before(const ToolWear& visit) const {
  const auto& most_min = job_.process.stop_every_min;
  if (job_.tool.next_edge == NextEdge::stop && exceeds_tool_life(visit)) return StopReason::edge;
  if (most_min && wear_.seconds + visit.seconds > kSecondsPerMinute * *most_min) return StopReason::time;
  return std::nullopt;
}

bool ToolLife::needs_program(const ToolWear& visit) const {
  return job_.tool.next_edge == NextEdge::program && exceeds_tool_life(visit);
}

void ToolLife::check(const ToolWear& visit, std::int32_t element) const {
  const auto& life_mm = job_.tool.edge_life_mm;
  if (life_mm && visit.cut_mm > *life_mm)
    throw LimitError(
        job_.where("tool.edge_life_mm"),
        fmt::format("must be at least {} mm, the length of all cuts of one visit of the tool to element {}, got {}",
                    fixed(visit.cut_mm, 3), element, shortest(*life_mm)),
        visit.cut_mm);
  const auto& most_min = job_.process.stop_every_min;
  const double minutes = (wear_.seconds + visit.seconds) / kSecondsPerMinute;
  if (most_min && minutes > *most_min)
    throw InputError(job_.where("process.stop_every_min"),
                     fmt::format("must be at least {} min, the time for the warm-up, the move to element {} and the "
                                 "cuts of one visit of the tool to this element, got {}",
                                 fixed(std::ceil(minutes * 1e3) * 1e-3, 3), element, shortest(*most_min)));
}

std::string stop_text(const Job& job, StopReason reason, int number) {
  const bool keeps_edge = job.tool.edge_life_mm && job.tool.next_edge == NextEdge::program;
  const std::string_view why[] = {"the edge has cut its life, change it", "inspect part and edge",
                                  "roughing is done, inspect it"};
  return fmt::format("Stop {} - {}{}", number, why[static_cast<std::size_t>(reason)],
                     keeps_edge ? ", keep the edge" : ", touch off again");
}

}  // namespace retrace::fabrication
