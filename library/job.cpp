#include "retrace/job.h"

#include <memory>

#include "fabrication/job/io/job_files.h"
#include "fabrication/post/post.h"
#include "library/content.h"
#include "library/drawing_content.h"
#include "report/results/result_plots.h"
#include "studies/fabrication/fabricate.h"
#include "studies/fabrication/io/fabrication_files.h"
#include "studies/fabrication/job_maker.h"
#include "studies/setup/io/setup_files.h"

namespace retrace {

Job make_job(const Design& design, const JobRequest& request) {
  const studies::GeneratedJob made = studies::make_job(design.content().design, request);
  return {fabrication::job_text(made.job), made.elements,           made.partial_elements, made.warnings,
          studies::job_json(made),         studies::job_table(made)};
}

Fabrication fabricate(const std::filesystem::path& job, const FabricationRequest& request) {
  const auto held = std::make_shared<const studies::FabricationResult>(studies::fabricate(job, request));
  const studies::FabricationResult& found = *held;
  Fabrication result;
  for (std::size_t k = 0; k < found.plan.programs.size(); ++k)
    result.programs.push_back({found.program_file(k), fabrication::nc_text(found.plan.programs[k], found.dialect)});
  result.warnings = found.warnings;
  result.json = studies::fabrication_json(found, studies::setup_json(found, studies::setup_sheet(found)));
  result.table = studies::fabrication_table(found);
  for (const auto& stage : found.plan.stages)
    (stage.roughs ? result.roughing : result.finishing) =
        drawing_of([held, roughs = stage.roughs] { return report::tool_path_plot(*held, roughs); });
  result.arrangement = drawing_of([held] { return report::arrangement_plot(*held); });
  return result;
}

}  // namespace retrace
