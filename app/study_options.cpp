#include "app/study_options.h"

#include <utility>

#include "core/error.h"

namespace retrace::app {

void check_study_options(const CommandLine& line) {
  for (const auto& [given, option] : {std::pair{line.study.resume, "--resume"}, {line.study.overwrite, "--overwrite"}})
    if (given && line.common.out.empty()) throw InputError({"", 0, option}, "needs --out DIR, where the store is");
}

studies::IfExists if_exists_of(const StudyOptions& options) {
  if (options.resume) return studies::IfExists::resume;
  return options.overwrite ? studies::IfExists::overwrite : studies::IfExists::refuse;
}

}  // namespace retrace::app
