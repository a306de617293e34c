#pragma once

// Changes that the form makes to a design.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/schema/document.h"

namespace retrace::live {

/// A design file with some keys changed.
struct ChangedText {
  std::string toml;
  std::vector<std::string> adapted;  ///< paths of keys that were taken back, or given, because of the changes
};

/// \param changes values by the paths of keys; null takes one back
/// \param adapt what means nothing beside the changes is taken back, and what they make necessary is given as
/// `retrace init` has it \throw InputError where the result is no design
ChangedText changed(const schema::Document& document, const nlohmann::ordered_json& changes, bool adapt);

}  // namespace retrace::live
