#pragma once

// Documents and tables of `retrace plane`, and of `retrace verify` of planed parts.

#include <string>

#include "studies/planing/planing_study.h"

namespace retrace::studies {

/// The document `retrace.planing/1` (docs/commands.md).
std::string planing_json(const PlaningResult& result);
/// x_mm,design_mm,left_mm of a milled profile.
std::string planing_csv(const PlaningResult& result);
std::string planing_table(const PlaningResult& result);

/// The document `retrace.verification/1` of a planed part (docs/commands.md).
std::string verification_json(const PlaningVerification& run, double elapsed_s);
std::string verification_table(const PlaningVerification& run);

}  // namespace retrace::studies
