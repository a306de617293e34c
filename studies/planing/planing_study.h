#pragma once

// The studies behind `retrace plane` and `retrace verify` of planed parts: plans a flat lens, writes its programs, and
// judges the text of programs.

#include <string>
#include <vector>

#include "fabrication/planing/check/check.h"
#include "fabrication/planing/plan/plan.h"

namespace retrace::studies {

/// A planed or turned part: its programs, as text, and what that text was found to do.
struct PlaningResult {
  fabrication::PlanedPart part;
  std::string dialect;
  fabrication::PlaningPlan plan;
  std::vector<fabrication::PlaningText> programs;  ///< file names and texts
  fabrication::PlaningCheck check;
  std::vector<std::string> warnings;
};

/// \param part_file \param dialect of fabrication::dialects() \throw InputError
PlaningResult plane(const std::string& part_file, const std::string& dialect);

/// Programs from files, and what they were found to do.
struct PlaningVerification {
  fabrication::PlanedPart part;
  std::vector<fabrication::NcProgram> programs;  ///< as they were read
  fabrication::PlaningCheck check;

  bool passes() const { return check.passes(); }
  std::vector<std::string> part_warnings() const { return {}; }
};

/// \param programs files, in the order in which they run \param dialect of all of them, or "auto"
/// \throw InputError for a file that cannot be read or understood, with its line
PlaningVerification verify_planing(const std::string& part_file, const std::vector<std::string>& programs,
                                   const std::string& dialect);

}  // namespace retrace::studies
