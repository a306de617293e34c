#pragma once

// Verifies NC programs: compares the surface that they cut with the fabrication job.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/warning.h"
#include "requests/verify.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

/// A fault of a program.
struct Finding {
  std::string kind;     ///< kind of fault, such as "gouge"; docs/commands/verify.md lists all kinds
  std::string program;  ///< program file; empty if the finding concerns no file or all files together
  int line = 0;         ///< line of the NC text; 0 if the finding concerns no line
  std::string message;
  double value = 0.0;  ///< measured value, in the unit that the message contains
  double limit = 0.0;  ///< limit of the value, in the same unit
};

struct Verification {
  bool passes = false;
  std::string verdict;  ///< pass, incomplete or fail
  std::vector<Finding> findings;
  Warnings warnings;
  std::string json;   ///< JSON document retrace.verification/2
  std::string table;  ///< summary as text
  Drawing map;        ///< plan of the array, coloured by the deviation of the machined surface

  struct Content;
  std::shared_ptr<Content> content;  ///< data of the verification, for write_as_machined()
};

/// Verifies NC programs.
/// \throw InputError with file and line if a file cannot be read or contains an error
/// \throw OutputError
RETRACE_API Verification verify(const VerificationRequest& request, const Running& running = {});

/// Writes the machined part as a design file, such as part.toml. If its facets have individual planes, the table of
/// these planes is written to the same folder, such as part_facets.csv.
/// \throw InputError if no facet could be measured
/// \throw OutputError
RETRACE_API void write_as_machined(const Verification& verification, const std::filesystem::path& design);

}  // namespace retrace
