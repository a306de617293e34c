#include "studies/quantity/machine_plan.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "core/length_units.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/job/tool_limits.h"
#include "fabrication/machine/io/machine_files.h"
#include "studies/fabrication/job_maker.h"

namespace retrace::studies {
namespace {

/// Returns a job that cuts the prisms of a design according to [machining].
fabrication::Job job_of_process(const design::Design& design, const geometry::RtpElement& prism,
                                const MachiningProcess& process) {
  JobRequest request;
  request.machine = process.machine;
  request.strategy = fabrication::kStrategyWords[static_cast<std::size_t>(process.strategy)];
  request.tool_width_mm = process.tool_width_mm.value_or(std::min(prism.width_mm, fabrication::kMaxToolWidthMm));
  if (!process.process.empty()) request.process = process.process;
  fabrication::Job job = make_job(design, request).job;
  take_machining(process, job);
  // A plan that exceeds the tool life would be refused. The job therefore has a very large tool life, and its plan
  // contains the length of cut. The study compares this length with the actual tool life.
  if (process.edge_life_mm) job.tool.edge_life_mm = fabrication::kMaxEdgeLifeMm;
  fabrication::check_job(job, {design.source_name(), 0, ""});
  return job;
}

/// Returns the smallest distance between the position of a linear axis and a limit of this axis. The positions are
/// computed at the roots of all elements and at the clearance height above the roots.
double travel_of(const fabrication::Job& job, const fabrication::Machine& machine,
                 const std::vector<fabrication::CutElement>& elements) {
  using geometry::Vec3;
  double least = std::numeric_limits<double>::infinity();
  const double depth_mm = fabrication::root_depth_mm(fabrication::blank_prism(job));
  for (const bool rotated : {false, true}) {
    if (std::ranges::none_of(elements, [&](const auto& element) { return element.rotated == rotated; })) continue;
    for (const int facet : {1, 2}) {
      const fabrication::CuttingPose pose =
          fabrication::cutting_pose(job, machine, {.rotated = rotated, .facet = facet}, 0.0);
      const fabrication::RigidMotion to_machine = fabrication::machine_from_workpiece(machine, pose.rounded);
      for (const fabrication::CutElement& element : elements) {
        if (element.rotated != rotated) continue;
        for (const double z_mm : {-depth_mm, job.process.clearance_mm}) {
          const Vec3 point = to_machine.point(element.origin_mm + Vec3(0.0, 0.0, z_mm));
          const std::array<double, 3> words = fabrication::linear_words(machine, point, pose.rounded);
          const fabrication::LinearAxis* const axes[] = {&machine.x, &machine.y, &machine.z};
          for (std::size_t k = 0; k < words.size(); ++k) {
            const fabrication::Interval limits = axes[k]->limits_mm.value;
            least = std::min({least, words[k] - limits.low, limits.high - words[k]});
          }
        }
      }
    }
  }
  return least;
}

}  // namespace

void take_machining(const MachiningProcess& process, fabrication::Job& job) {
  job.tool.edge_radius_um = process.edge_radius_um;
  job.tool.edge_life_mm = process.edge_life_mm;
  job.process.finishing_cuts = process.finishing_cuts;
  for (const ProcessValue& value : kProcessValues) job.process.*value.process = process.*value.machining / value.factor;
}

MachinePlan plan_on_machine(const design::Design& design, const MachiningProcess& process) {
  MachinePlan plan;
  const auto& prism = std::get<geometry::RtpElement>(design.part().element);
  if (process.tool_width_mm && *process.tool_width_mm > prism.width_mm + fabrication::kFitToleranceMm) return plan;
  const fabrication::Job job = job_of_process(design, prism, process);
  const fabrication::Machine machine = fabrication::load_machine(job.machine, {});
  const std::vector<fabrication::CutElement> elements = fabrication::cut_elements(job);
  plan.elements = elements.size();
  try {
    plan.travel_mm = travel_of(job, machine, elements);
    const fabrication::Plan planned = fabrication::make_plan(job, machine);
    plan.time_s = planned.time.total_s();
    const double cut_mm = std::accumulate(planned.program_cuts_mm.begin(), planned.program_cuts_mm.end(), 0.0);
    plan.cut_per_element_mm = cut_mm / static_cast<double>(std::max<std::size_t>(1, elements.size()));
  } catch (const InputError&) {
    // The machine cannot reach a facet, or an axis would exceed a limit. The results remain empty, and an empty result
    // violates every limit.
  }
  return plan;
}

}  // namespace retrace::studies
