#include "app/shared_arguments.h"

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

Words engine_words(bool with_cell) {
  Words words;
  for (const auto engine : {studies::Engine::automatic, studies::Engine::exact, studies::Engine::montecarlo,
                            studies::Engine::cell, studies::Engine::embree})
    if (with_cell || engine != studies::Engine::cell) words.emplace_back(studies::engine_name(engine));
  return words;
}

}  // namespace retrace::app
