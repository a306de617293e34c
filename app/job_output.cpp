#include "app/job_output.h"

#include "fabrication/job/io/job_files.h"

namespace retrace::app {
namespace fs = std::filesystem;

studies::JobRequest job_request(const JobOptions& options, double tool_width_mm) {
  studies::JobRequest request;
  request.machine = options.machine;
  request.tool_width_mm = tool_width_mm;
  request.strategy = options.strategy;
  request.process = options.process;
  request.workpiece = options.workpiece;
  request.shrinkage_percent = options.shrinkage_percent;
  return request;
}

std::vector<std::string> files_of_making(const JobOptions& options) {
  std::vector<std::string> files;
  for (const std::string& name : {options.machine, options.process})
    if (fs::path(name).has_extension()) files.push_back(name);
  return files;
}

std::string job_text_at(studies::MadeJob& made, const fs::path& file) {
  const fs::path machine = made.job.machine;
  const fs::path folder = file.parent_path();
  if (machine.has_extension() && !machine.is_absolute()) {
    std::error_code error;
    const fs::path relative = fs::relative(machine, folder.empty() ? fs::path(".") : folder, error);
    if (!error && !relative.empty()) made.job.machine = relative.string();
  }
  return fabrication::job_text(made.job);
}

}  // namespace retrace::app
