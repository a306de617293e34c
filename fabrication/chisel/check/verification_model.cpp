#include "fabrication/chisel/check/verification_model.h"

#include <map>
#include <utility>

#include "core/length_units.h"
#include "fabrication/job/substrate_cells.h"

namespace retrace::fabrication {

VerificationModel verification_model_of(const Job& job, const Machine& machine, double tolerance_nm) {
  VerificationModel workpiece;
  workpiece.job = &job;
  workpiece.machine = &machine;
  workpiece.tolerance_mm = tolerance_nm / kNmPerMm;
  workpiece.elements = cut_elements(job);
  const double stock = stock_mm(job, workpiece.elements);
  const ToolWedge wedge = wedge_of(job, machine);
  std::map<std::pair<bool, std::int32_t>, std::size_t> groups;
  for (const CutElement& element : workpiece.elements) {
    workpiece.cavities.push_back(groove_of(element, job, stock));
    const auto [group, is_new] = groups.try_emplace({element.rotated, element.orientation}, groups.size());
    if (is_new) workpiece.predictions.push_back(predict(machine, workpiece.cavities.back(), wedge));
    workpiece.groups.push_back(group->second);
  }
  return workpiece;
}

ToolWedge wedge_of(const Job& job, const Machine& machine) {
  if (!cuts_prisms(job)) return v_tool_wedge(job.tool, machine);
  return tool_wedge(job.tool, machine, Angle::from_deg(prism_of(job).apex_angle_deg));
}

}  // namespace retrace::fabrication
