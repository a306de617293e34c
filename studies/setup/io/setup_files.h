#pragma once

// What fabrication.json says of the set-up.

#include <nlohmann/json.hpp>

#include "studies/setup/setup_sheet.h"

namespace retrace::studies {

/// The object `setup` of retrace.fabrication/1.
nlohmann::ordered_json setup_json(const FabricationResult& result, const SetupSheet& sheet);

}  // namespace retrace::studies
