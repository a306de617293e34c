#pragma once

// Studies: sweeps, tolerances, optima, as study files tell them (docs/studies.md).

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/warning.h"
#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

/// A study file, read and not yet checked.
struct Study {
  std::string text;
  std::string source;  ///< file, or what stands for it; files that the text names are sought from its folder
  std::map<std::string, std::string> designs;  ///< texts of design files by name, in place of files

  /// \throw InputError if it cannot be read
  RETRACE_API static Study load(const std::filesystem::path& file);
};

/// How a study is carried out, as the options of `retrace sweep`.
struct StudyRequest {
  std::vector<std::string> overrides = {};  ///< `key=value`, of designs, [analysis] and [machining]
  std::uint32_t seed = 1;
  std::filesystem::path store = {};  ///< SQLite file in which finished points are kept; empty: none
  std::string if_exists = "refuse";  ///< what is done with a store that is there: refuse, resume or overwrite
};

struct StudyResult {
  bool complete = true;
  bool is_yes = true;  ///< the answer to what was asked: yield is enough, a design is feasible
  Warnings warnings;
  std::string json;   ///< document retrace.sweep/1, retrace.tolerance/1 or retrace.optimum/1
  std::string csv;    ///< one line a point; of an optimum, its front
  std::string table;  ///< for people
  Drawing drawing;    ///< of a tolerance study: the share of parts below a value
};

/// Designs and directions over ranges. \throw InputError with its place in the study or its design, OutputError
RETRACE_API StudyResult sweep(const Study& study, const StudyRequest& request = {}, const Running& running = {});

/// What becomes of a design in manufacture. \throw likewise
RETRACE_API StudyResult tolerance(const Study& study, const StudyRequest& request = {}, const Running& running = {});

/// The best design within constraints. Progress is not told: nobody knows how many designs will be looked at.
/// \throw likewise
RETRACE_API StudyResult optimize(const Study& study, const StudyRequest& request = {}, const Running& running = {});

}  // namespace retrace
