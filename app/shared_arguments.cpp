#include "app/shared_arguments.h"

#include <utility>

#include "core/error.h"
#include "core/message_text.h"
#include "core/text.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/read/nc_program.h"
#include "studies/rre/rre.h"

namespace retrace::app {
namespace {

double spacing_of(std::string_view text, const std::string& whole) {
  const std::optional<double> value = number_in(text);
  if (!value || !(*value > 0.0))
    throw InputError({"", 0, "--pixel-um"},
                     "must be one number > 0, or two for x and y as in 0.5,0.6, got " + printable(whole));
  return *value;
}

}  // namespace

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

Argument engine_argument(std::string& engine, const std::string& help) {
  return {"--engine ENGINE", help, &engine, one_of([] { return engine_words(false); })};
}

Need engine_need(std::span<const studies::Engine> engines) {
  Condition condition{Condition::Kind::value, "--engine"};
  for (const studies::Engine engine : engines) condition.values.emplace_back(studies::engine_name(engine));
  return {condition};
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
          {"--resume",
           "continue with the store in the output folder: finished points are not computed again",
           &options.resume,
           {.needs = {any_given({"--out"})}}},
          {"--overwrite",
           "replace the store in the output folder and compute all points again",
           &options.overwrite,
           {.excludes = "--resume", .needs = {any_given({"--out"})}}}};
}

studies::IfExists if_exists_of(const StudyOptions& options) {
  if (options.resume) return studies::IfExists::resume;
  return options.overwrite ? studies::IfExists::overwrite : studies::IfExists::refuse;
}

std::vector<Argument> map_arguments(MapOptions& options) {
  const Words units = {"m", "mm", "um", "nm", "pm"};
  return {{"--pixel-um P", "spacing of the points, or PX,PY [as in the file]", &options.pixel_um},
          {"--height-unit UNIT", "unit of the heights: m, mm, um, nm or pm [as in the file]", &options.height_unit,
           one_of(units)},
          {"--lateral-unit UNIT", "unit of lateral lengths without a unit: m, mm, um, nm or pm [as in the file]",
           &options.lateral_unit, one_of(units)},
          {"--channel N", "channel of a GWY file [the first]", &options.channel, whole(0, 999999)}};
}

surface_models::HeightMapOptions reading_of(const MapOptions& options) {
  surface_models::HeightMapOptions reading;
  reading.height_unit = options.height_unit;
  reading.lateral_unit = options.lateral_unit;
  reading.channel = options.channel;
  if (!options.pixel_um) return reading;
  const std::string& text = *options.pixel_um;
  const std::size_t comma = text.find(',');
  reading.x_pixel_um = spacing_of(std::string_view(text).substr(0, comma), text);
  reading.y_pixel_um =
      comma == std::string::npos ? *reading.x_pixel_um : spacing_of(std::string_view(text).substr(comma + 1), text);
  return reading;
}

}  // namespace retrace::app
