#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/command.h"

namespace retrace::app {

/// Writes a text that is the result itself: to the file of --out, else to standard output, which --quiet does not take
/// away. \param document of --json, to which the text is added \throw InputError, OutputError
ExitCode write_text(const CommonOptions& common, nlohmann::ordered_json document, const std::string& text);

}  // namespace retrace::app
