#pragma once

// Set-up data in the output document fabrication.json.

#include <nlohmann/json.hpp>

#include "studies/setup/setup_sheet.h"

namespace retrace::studies {

/// Returns the object `setup` of the document `retrace.fabrication/2`.
nlohmann::ordered_json setup_json(const FabricationResult& result, const SetupSheet& sheet);

}  // namespace retrace::studies
