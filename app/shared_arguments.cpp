#include "app/shared_arguments.h"

#include <utility>

#include "fabrication/read/nc_program.h"
#include "studies/rre/rre.h"

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
  return {"--dialect DIALECT", "rs274ngc, sinumerik, fanuc or pmac", &dialect,
          one_of(words_of(fabrication::kNcDialectWords))};
}

Argument engine_argument(std::string& engine, const std::string& help) {
  return {"--engine ENGINE", help, &engine, one_of([] { return engine_words(false); })};
}

Words engine_words(bool of_rre) {
  Words words;
  using studies::Engine;
  for (const auto engine :
       {Engine::automatic, Engine::exact, Engine::stochastic, Engine::montecarlo, Engine::cell, Engine::embree})
    if (of_rre || (engine != Engine::cell && engine != Engine::stochastic))
      words.emplace_back(studies::engine_name(engine));
  return words;
}

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
