#pragma once

// What NC programs really cut, against their fabrication job.

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

/// As the options of `retrace verify`.
struct VerificationRequest {
  std::filesystem::path job = {};  ///< file
  std::vector<std::string> programs =
      {};                        ///< files in the order in which they run; FILE@LINE: stopped behind that line
  std::string dialect = "auto";  ///< rs274ngc, sinumerik, fanuc, pmac, a3200, automation1, or told from the text
  /// That facet planes may differ from the design by. By default 10, or what a Fanuc's increments leave if that is
  /// more.
  std::optional<double> tolerance_nm = {};
  std::string standing = {};                      ///< stage before which all has been cut; empty: the blank stands
  std::filesystem::path as_machined = {};         ///< design file to write of the part that is left; empty: none
  std::map<std::string, std::string> texts = {};  ///< of job and programs, by name, in place of files
};

/// Something that a program does and should not, or does not and should.
struct Finding {
  std::string kind;     ///< such as "gouge"; docs/commands.md lists them
  std::string program;  ///< file; empty: of none, or of all together
  int line = 0;         ///< of the NC text; 0: of no line
  std::string message;
  double value = 0.0;  ///< in the unit that the message names
  double limit = 0.0;
};

struct Verification {
  bool passes = false;
  std::string verdict;  ///< pass, incomplete or fail
  std::vector<Finding> findings;
  Warnings warnings;
  std::string json;   ///< document retrace.verification/1
  std::string table;  ///< for people
  Drawing map;        ///< the array from above, coloured by what the programs leave

  struct Content;
  std::shared_ptr<Content> content;  ///< the run itself
};

/// \throw InputError for a file that cannot be read or understood, with its line; OutputError
RETRACE_API Verification verify(const VerificationRequest& request, const Running& running = {});

/// Writes the part that programs leave as a design file and, where its facets have planes of their own, a table of them
/// beside it: part.toml and part_facets.csv. \throw InputError if none could be measured, OutputError
RETRACE_API void write_as_machined(const Verification& verification, const std::filesystem::path& design);

}  // namespace retrace
