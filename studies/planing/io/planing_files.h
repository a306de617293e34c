#pragma once

// Documents and tables of `retrace plane`.

#include <string>

#include "studies/planing/planing_study.h"

namespace retrace::studies {

/// The document `retrace.planing/1` (docs/commands.md).
std::string planing_json(const PlaningResult& result);
/// x_mm,design_mm,left_mm of a milled profile.
std::string planing_csv(const PlaningResult& result);
std::string planing_table(const PlaningResult& result);

}  // namespace retrace::studies
