#include "studies/fabrication/fabricate.h"

#include <set>

#include "core/file_texts.h"
#include "fabrication/job/cube_corner.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "geometry/elements/element_cells.h"
#include "requests/descriptions.h"

namespace retrace::studies {
namespace {

using geometry::Vec3;

fabrication::PlanOptions plan_options(const FabricationRequest& request) {
  return {.phase = request.phase,
          .from_element = request.from_element,
          .from_pass = request.from_pass,
          .stop_every = request.stop_every,
          .split_hours = request.split_hours,
          .before = {}};
}

/// Returns the position of the tool tip in the section of an element, in the coordinates of SectionMove.
geometry::Vec2 in_section(const FabricationResult& result, const fabrication::CutElement& element,
                          const fabrication::AxisWords& at) {
  const auto mm = [&](fabrication::Axis axis) { return 1e-6 * static_cast<double>(at[axis].value_or(0)); };
  const auto deg = [&](fabrication::Axis axis) { return 1e-7 * static_cast<double>(at[axis].value_or(0)); };
  fabrication::AxisPositions axes{mm(fabrication::kX), mm(fabrication::kY), mm(fabrication::kZ), 0.0,
                                  deg(fabrication::kC)};
  (result.machine.tilt == fabrication::Tilt::table ? axes.a_deg : axes.b_deg) = deg(fabrication::kTilt);
  const Vec3 tip = fabrication::forward(result.machine, axes).reference_mm;
  const Vec3 root(0.0, 0.0, -geometry::element_depth_mm(fabrication::blank_element(result.job, element.zone)));
  const Vec3 from_root = element.workpiece_from_element.transpose() * (tip - element.origin_mm) - root;
  if (!cuts_prisms(result.job)) {
    const fabrication::CubeCorner corner = fabrication::blank_corner(result.job, element.zone, element.rotated);
    const auto& [first, second, third] = corner.edges;
    return {(second - first).normalized().dot(from_root), (second + first).normalized().dot(from_root)};
  }
  // The wall of facet 1 is on the side of +y in the workpiece frame, or +x for rotated elements.
  return {element.rotated ? -from_root.x() : -from_root.y(), from_root.z()};
}

}  // namespace

FabricationResult fabricate(const std::filesystem::path& job, const FabricationRequest& request) {
  requests::check(request);
  FabricationResult result;
  result.dialect = request.dialect;
  result.file_ending = fabrication::ending_of(request.dialect);
  FileTexts texts;
  if (request.job_text) texts[job.string()] = *request.job_text;
  result.job = fabrication::read_job(job, texts);
  result.machine = fabrication::load_machine(result.job.machine, result.job.where("machine"));
  result.warnings = result.job.warnings;
  append(result.warnings, result.machine.warnings);
  result.machine.increments = fabrication::position_increments(result.dialect, result.machine.control);
  result.machine.shortest_axes = fabrication::shortest_axes(result.dialect, result.machine.control);
  result.plan = fabrication::make_plan(result.job, result.machine, plan_options(request));
  for (const fabrication::Program& program : result.plan.programs)
    fabrication::check_supported(program, result.dialect);
  return result;
}

std::vector<SectionMove> section_moves(const FabricationResult& result, bool roughing) {
  const bool is_dmc = !cuts_prisms(result.job);
  // Subroutines are identified by their titles, because each program has its own numbers for the subroutines that it
  // calls.
  std::set<std::string> wanted;
  for (const fabrication::Stage& stage : result.plan.stages)
    if (stage.roughs == roughing && (!is_dmc || result.plan.poses[stage.pose].facet.facet == 1))
      wanted.insert(result.plan.subroutines[stage.subroutine].title);
  std::vector<SectionMove> moves;
  for (const fabrication::Program& program : result.plan.programs) {
    fabrication::Program first_only;
    first_only.subroutines = program.subroutines;
    std::optional<std::int32_t> element;
    std::set<std::uint32_t> seen;
    for (const fabrication::Item& item : program.items) {
      const auto* const move = std::get_if<fabrication::Move>(&item);
      if (move != nullptr && move->to[fabrication::kC]) first_only.items.push_back(item);
      const auto* const visit = std::get_if<fabrication::CycleCall>(&item);
      if (visit == nullptr || !wanted.contains(program.subroutines[visit->subroutine].title)) continue;
      const bool rotated = result.plan.elements[static_cast<std::size_t>(visit->element)].rotated;
      if (!element && !rotated) element = visit->element;
      // Passes that are side by side along the root have the same section. Therefore, only the first of them is kept.
      if (element == visit->element && seen.insert(visit->subroutine).second) first_only.items.push_back(item);
    }
    if (!element) continue;
    const fabrication::CutElement& cut = result.plan.elements[static_cast<std::size_t>(*element)];
    geometry::Vec2 at = geometry::Vec2::Zero();
    fabrication::for_each_move(first_only, [&](const fabrication::PlannedMove& move) {
      if (move.is_rotary()) return;
      const geometry::Vec2 to = in_section(result, cut, move.at);
      if (!move.is_rapid()) moves.push_back({move.move.motion, at.x(), at.y(), to.x(), to.y()});
      at = to;
    });
    break;
  }
  return moves;
}

std::vector<std::int64_t> cutting_order_numbers(const FabricationResult& result) {
  std::vector<std::int64_t> places(result.plan.elements.size(), 0);
  std::int64_t next = 0;
  for (const fabrication::Program& program : result.plan.programs)
    for (const fabrication::Item& item : program.items)
      if (const auto* const visit = std::get_if<fabrication::CycleCall>(&item)) {
        std::int64_t& place = places[static_cast<std::size_t>(visit->element)];
        if (place == 0) place = ++next;
      }
  return places;
}

}  // namespace retrace::studies
