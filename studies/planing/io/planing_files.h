#pragma once

// Output documents and tables of `retrace plane`, and of `retrace verify` for planed parts.

#include <string>

#include "studies/planing/planing_study.h"

namespace retrace::studies {

/// Returns the document `retrace.planing/2` (docs/commands/plane.md).
std::string planing_json(const PlaningResult& result);
/// Returns the profile of a milled part as CSV with the columns x_mm, design_mm (height of the design) and machined_mm
/// (height of the machined surface).
std::string planing_csv(const PlaningResult& result);
std::string planing_table(const PlaningResult& result);

/// Returns the document `retrace.verification/2` of a planed part (docs/commands/verify.md).
std::string verification_json(const PlaningVerification& run, double elapsed_s);
std::string verification_table(const PlaningVerification& run);

}  // namespace retrace::studies
