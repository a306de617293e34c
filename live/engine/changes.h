#pragma once

// Applies changes that the form makes to a design.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/schema/document.h"

namespace retrace::live {

/// Text of a design file after changes of some keys.
struct ChangedText {
  std::string toml;
  std::vector<std::string> adapted;  ///< paths of keys that were removed or added because of the changes
};

/// Returns the changed text of a design.
/// \param changes values by the paths of keys; null removes a key
/// \param adapt true: keys without effect after the changes are removed, and required keys are added with the values of
///     `retrace init`
/// \throw InputError if the result is not a valid design
ChangedText changed(const schema::Document& document, const nlohmann::ordered_json& changes, bool adapt);

}  // namespace retrace::live
