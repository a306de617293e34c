#pragma once

// Arguments that several commands have, each with one name and one help text: design, job and part files, engine, dye,
// and how a study treats an existing store.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/command.h"
#include "studies/rre/rre.h"
#include "studies/store/store.h"
#include "surface_models/io/height_map_reader.h"

namespace retrace::app {

/// DESIGN, a design file.
Argument design_argument(std::string& design);
/// JOB, a job file.
Argument job_argument(std::string& job, const std::string& help = "job file");
/// PART, the file of a turned or planed part.
Argument part_argument(std::string& part);
/// --dialect of the programs that are written.
Argument dialect_argument(std::string& dialect);
/// Traits of a machine: the name of a shipped one, or a file.
Traits machine_traits();
/// --engine of commands whose engines are auto, exact, montecarlo and embree.
Argument engine_argument(std::string& engine, const std::string& help);
/// Returns the requirement that --engine is one of `engines`.
Need engine_need(std::span<const studies::Engine> engines);
/// --dye: none, a shipped dye, or a file.
template <class Name>
Argument dye_argument(Name& dye, const std::string& help) {
  return {"--dye NAME|FILE", help, &dye, one_of(Words{"none", "red", "amber"}, ".csv")};
}

/// Names of the engines of `retrace rre`, or of those that pictures and photometry have as well.
Words engine_words(bool of_rre);

/// How height maps are read, where their files do not say it.
struct MapOptions {
  std::optional<std::string> pixel_um;  ///< one number, or two with a comma between
  std::optional<std::string> height_unit;
  std::optional<std::string> lateral_unit;
  std::optional<std::size_t> channel;
};
std::vector<Argument> map_arguments(MapOptions& options);
/// What they say. \throw InputError naming --pixel-um
surface_models::HeightMapOptions reading_of(const MapOptions& options);

/// Of commands that keep their points in a store.
struct StudyOptions {
  std::string study;
  bool resume = false;
  bool overwrite = false;
};

/// STUDY and what is done with a store that is there.
std::vector<Argument> study_arguments(StudyOptions& options);

/// What is done with a store that is there.
studies::IfExists if_exists_of(const StudyOptions& options);

}  // namespace retrace::app
