#pragma once

// What errors of angle make of a composed part, in the document and on the terminal.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "studies/compose/compose.h"

namespace retrace::studies {

/// \param for_worst file text of the zones that are optimal for the worst parts; empty: there are none
nlohmann::ordered_json error_effects_json(const ComposeRequest& request, const ErrorEffects& effects,
                                          const nlohmann::ordered_json& for_worst);

/// \param for_worst file text of the zones that are optimal for the worst parts; empty: there are none
/// \param are_margins true if the goals are margins to limits, in percent
std::string error_effects_text(const ComposeRequest& request, const ErrorEffects& effects, const std::string& for_worst,
                               bool are_margins);

}  // namespace retrace::studies
