#include "app/job_output.h"

#include "app/shared_arguments.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/job/io/process_files.h"

namespace retrace::app {
namespace fs = std::filesystem;

std::vector<Argument> making_arguments(MakingOptions& options, const std::string& needs) {
  const auto processes = [] {
    Words names;
    for (const fabrication::Process& process : fabrication::shipped_processes()) names.push_back(process.name);
    return names;
  };
  std::vector<Argument> all = {
      {"--machine MACHINE", "ideal, paper, thesis, ideal-dmc or a file", &options.request.machine, machine_traits()},
      {"--tool-width-mm W",
       "width of the cutting edge, 0.1 to 2; with the strategy dmc 0.01 to 10",
       &options.tool_width_mm,
       {.required = needs.empty()}},
      {"--strategy STRATEGY", "unidirectional, bidirectional or two-step; dmc for cube corners",
       &options.request.strategy, one_of(words_of(fabrication::kStrategyWords))},
      {"--process PROCESS", "depths, feeds and dwells: a shipped process or a file", &options.request.process,
       one_of(processes, ".toml")},
      {"--workpiece KIND", "mould, or direct if the optic itself is cut", &options.request.workpiece,
       one_of(words_of(fabrication::kWorkpieceWords))},
      {"--shrinkage-percent S", "shrinkage of the part, by which the mould is larger",
       &options.request.shrinkage_percent}};
  if (!needs.empty())
    for (Argument& argument : all) argument.traits.needs = {any_given({needs})};
  return all;
}

studies::JobRequest job_request(const MakingOptions& options, double tool_width_mm) {
  studies::JobRequest request = options.request;
  request.tool_width_mm = tool_width_mm;
  return request;
}

std::vector<std::string> files_of_making(const MakingOptions& options) {
  std::vector<std::string> files;
  for (const std::string& name : {options.request.machine, options.request.process})
    if (fs::path(name).has_extension()) files.push_back(name);
  return files;
}

std::string name_from(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path base = folder.empty() ? fs::path(".") : folder;
  const fs::path direct =
      fs::absolute(file).lexically_normal().lexically_relative(fs::absolute(base / "").lexically_normal());
  // `direct` is computed from the names of the folders only. It is wrong if a folder is a symbolic link, because ".."
  // then leads to the parent of the link's target.
  if (!direct.empty() && fs::equivalent(base / direct, file, error)) return direct.string();
  const fs::path followed = fs::relative(file, base, error);
  return error || followed.empty() ? fs::absolute(file).string() : followed.string();
}

std::string job_text_at(studies::MadeJob& made, const fs::path& file) {
  const fs::path machine = made.job.machine;
  if (machine.has_extension() && !machine.is_absolute()) made.job.machine = name_from(file.parent_path(), machine);
  if (!file.empty() && !made.design_file.empty()) made.job.design = name_from(file.parent_path(), made.design_file);
  return fabrication::job_text(made.job);
}

}  // namespace retrace::app
