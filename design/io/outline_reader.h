#pragma once

// Reads the table [outline] of a design.

#include <string_view>

#include "core/schema/document.h"
#include "design/design.h"
#include "geometry/outline/plan_region.h"

namespace retrace::design {

bool has_outline(const schema::Document& document);

/// Returns the key that contains the border of the outline.
std::string_view outline_key(const schema::Document& document);

/// Returns the keys that describe the outline. Returns an object without keys if the part has no outline.
OutlineKeys outline_keys(const schema::Document& document);

/// Reads the outline of a part, including its DXF or STEP file if there is one.
/// \pre has_outline()
/// \throw InputError if the outline is open or crosses itself, if a hole is not inside the outline, or if a radius or
///     the margin is too large
geometry::PlanRegion read_outline(const schema::Document& document);

}  // namespace retrace::design
