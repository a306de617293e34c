#include "app/job_output.h"

#include <array>

#include "fabrication/job/io/job_files.h"
#include "requests/descriptions.h"

namespace retrace::app {
namespace fs = std::filesystem;

std::vector<Argument> making_arguments(MakingOptions& options, const std::string& needs) {
  const std::array<CommandRequest, 1> of_command = {{{requests::description<JobRequest>()}}};
  std::vector<Argument> all = field_arguments(of_command, options.fields);
  if (needs.empty()) return all;
  for (Argument& argument : all) {
    argument.traits.needs.push_back(any_given({needs}));
    argument.traits.required = false;
  }
  return all;
}

JobRequest job_request(const MakingOptions& options, const CommonOptions& common) {
  return request_of<JobRequest>(options.fields, common);
}

std::vector<std::string> files_of_making(const JobRequest& request) {
  std::vector<std::string> files;
  for (const std::string& name : {request.machine, request.process})
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

std::string job_text_at(studies::GeneratedJob& made, const fs::path& file) {
  const fs::path machine = made.job.machine;
  if (machine.has_extension() && !machine.is_absolute()) made.job.machine = name_from(file.parent_path(), machine);
  if (!file.empty() && !made.design_file.empty()) made.job.design = name_from(file.parent_path(), made.design_file);
  return fabrication::job_text(made.job);
}

}  // namespace retrace::app
