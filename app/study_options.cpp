#include "app/study_options.h"

#include <utility>

#include "core/error.h"

namespace retrace::app {

std::vector<Argument> study_arguments(StudyOptions& options) {
  return {{"STUDY", "study file; - is standard input", &options.study, files(".toml")},
          {"--resume", "go on with the store that is in the output folder", &options.resume},
          {"--overwrite", "replace the store that is in the output folder", &options.overwrite, not_with("--resume")}};
}

void check_study_options(const StudyOptions& options, const CommonOptions& common) {
  for (const auto& [given, option] : {std::pair{options.resume, "--resume"}, {options.overwrite, "--overwrite"}})
    if (given && common.out.empty()) throw InputError({"", 0, option}, "needs --out DIR, where the store is");
}

studies::IfExists if_exists_of(const StudyOptions& options) {
  if (options.resume) return studies::IfExists::resume;
  return options.overwrite ? studies::IfExists::overwrite : studies::IfExists::refuse;
}

}  // namespace retrace::app
