#pragma once

// Plans a flat lens, writes its programs, and checks the text of programs. `retrace plane` runs this study, and so does
// `retrace verify` for planed parts.

#include <string>
#include <vector>

#include "core/warning.h"
#include "fabrication/planing/check/check.h"
#include "fabrication/planing/plan/plan.h"

namespace retrace::studies {

/// Planed or turned part: its programs as text, and the results of checking that text.
struct PlaningResult {
  fabrication::PlanedPart part;
  std::string dialect;
  fabrication::PlaningPlan plan;
  std::vector<fabrication::PlaningText> programs;  ///< names and texts of the files
  fabrication::PlaningCheck check;
  Warnings warnings;
};

/// Plans a part and writes its programs.
/// \param part_file file of the part
/// \param dialect dialect of fabrication::dialects()
/// \throw InputError for an invalid file or dialect
PlaningResult plane(const std::string& part_file, const std::string& dialect);

/// Programs from files, and the results of checking them.
struct PlaningVerification {
  fabrication::PlanedPart part;
  std::vector<fabrication::NcProgram> programs;  ///< programs as they were read
  fabrication::PlaningCheck check;

  bool passes() const { return check.passes(); }
  const Warnings& part_warnings() const { return part.warnings; }
};

/// Checks programs for a part.
/// \param programs files in the order in which they run
/// \param dialect dialect of all programs, or "auto"
/// \throw InputError that names the line, for a file that cannot be read or is invalid
PlaningVerification verify_planing(const std::string& part_file, const std::vector<std::string>& programs,
                                   const std::string& dialect);

}  // namespace retrace::studies
