#pragma once

// Names in a study: quantities by their name, and the title of the study.

#include <optional>
#include <string>
#include <string_view>

#include "studies/quantity/study.h"

namespace retrace::studies {

/// Returns the index of the quantity with a name in Study::quantities. Returns nothing if the study has no such
/// quantity.
std::optional<std::size_t> quantity_index(const Study& study, std::string_view name);

/// Returns the quantity with a name, or null if the study has no such quantity.
const Quantity* quantity_named(const Study& study, std::string_view name);

/// Returns the title of a study. A study without a title has the name of its file.
std::string shown_title(const Study& study);

}  // namespace retrace::studies
