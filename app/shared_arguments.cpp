#include "app/shared_arguments.h"

#include "fabrication/machine/io/machine_files.h"
#include "fabrication/read/nc_program.h"

namespace retrace::app {

Argument design_argument(std::string& design) {
  return {"DESIGN", "design file; - is standard input", &design, files(".toml")};
}

Argument job_argument(std::string& job, const std::string& help) {
  return {"JOB", help, &job, files(".toml")};
}

Argument part_argument(std::string& part) {
  return {"PART", "part file", &part, files(".toml")};
}

Argument dialect_argument(std::string& dialect) {
  return {"--dialect DIALECT", "rs274ngc, sinumerik, fanuc, pmac, a3200 or automation1", &dialect,
          one_of(words_of(fabrication::kNcDialectWords))};
}

Traits machine_traits() {
  const auto names = [] {
    Words words;
    for (const fabrication::Machine& machine : fabrication::shipped_machines()) words.push_back(machine.name);
    return words;
  };
  return one_of(names, ".toml");
}

std::vector<Argument> study_arguments(StudyOptions& options) {
  return {{"STUDY", "study file; - is standard input", &options.study, files(".toml")},
          {"--resume",
           "continue with the store in the output folder: finished points are not computed again",
           &options.resume,
           {.needs = {any_given({"--out"})}}},
          {"--overwrite",
           "replace the store in the output folder and compute all points again",
           &options.overwrite,
           {.excludes = "--resume", .needs = {any_given({"--out"})}}}};
}

compute::IfExists if_exists_of(const StudyOptions& options) {
  if (options.resume) return compute::IfExists::resume;
  return options.overwrite ? compute::IfExists::overwrite : compute::IfExists::refuse;
}

}  // namespace retrace::app
