#pragma once

// The study behind `retrace plane`: plans a flat lens, writes its programs, and checks their text.

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

}  // namespace retrace::studies
