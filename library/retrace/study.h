#pragma once

// Studies that are defined in study files: sweeps, tolerances and optimisation (docs/studies.md).

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "core/warning.h"
#include "requests/study.h"
#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

/// Content of a study file. It is checked when the study is carried out.
struct Study {
  std::string text;
  std::string source;  ///< path of the study file, for messages; file names in the text are relative to its folder
  std::map<std::string, std::string> designs;  ///< texts of design files by file name, used instead of the files

  /// Reads a study file.
  /// \throw InputError if the file cannot be read
  RETRACE_API static Study load(const std::filesystem::path& file);
};

struct StudyResult {
  bool complete = true;  ///< false if the computation was cancelled
  /// False if the yield of a tolerance study is too low, or if an optimisation has found no feasible design.
  bool is_yes = true;
  Warnings warnings;
  std::string json;   ///< JSON document retrace.sweep/1, retrace.tolerance/2 or retrace.optimum/1
  std::string csv;    ///< one line per point; after an optimisation, the Pareto front
  std::string table;  ///< summary as text
  /// Plot of the study. For a tolerance study: the fraction of parts whose result is below a value, as a function of
  /// this value. For an optimisation: the objective of all evaluated designs. Empty for sweeps.
  Drawing drawing;
};

/// Computes the quantities of a study for all its designs and directions.
/// \throw InputError with the position in the study or in its design
/// \throw OutputError
RETRACE_API StudyResult sweep(const Study& study, const StudyRequest& request = {}, const Running& running = {});

/// Computes the effect of manufacturing errors on a design. Throws like sweep().
RETRACE_API StudyResult tolerance(const Study& study, const StudyRequest& request = {}, const Running& running = {});

/// Searches for the best design within constraints. Progress is not reported, because the number of designs that will
/// be computed is unknown. Throws like sweep().
RETRACE_API StudyResult optimize(const Study& study, const StudyRequest& request = {}, const Running& running = {});

}  // namespace retrace
