#pragma once

// What errors of angle make of a composed part, in the document and on the terminal.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "studies/compose/compose.h"

namespace retrace::studies {

nlohmann::ordered_json error_effects_json(const ComposeRequest& request, const ErrorEffects& effects);

/// \param are_margins whether goals are margins to limits, in percent
std::string error_effects_text(const ComposeRequest& request, const ErrorEffects& effects, bool are_margins);

}  // namespace retrace::studies
