#pragma once

// Output of the effects of angle errors on a composed part, as JSON and as text for the terminal.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "studies/compose/compose.h"

namespace retrace::studies {

/// Returns the effects of angle errors as a JSON object.
/// \param for_worst JSON list of the zones that are optimized for the worst parts; used only if there are any
nlohmann::ordered_json error_effects_json(const ComposeRequest& request, const ErrorEffects& effects,
                                          const nlohmann::ordered_json& for_worst);

/// Returns the effects of angle errors as text for the terminal.
/// \param for_worst text about the zones that are optimized for the worst parts; used only if there are any
/// \param are_margins true if the goals are margins to limits, in percent
std::string error_effects_text(const ComposeRequest& request, const ErrorEffects& effects, const std::string& for_worst,
                               bool are_margins);

}  // namespace retrace::studies
