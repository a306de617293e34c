#pragma once

// Reads the zones of a design from its document: regions of the part, and changes of their elements.

#include <string_view>

#include "core/schema/document.h"
#include "design/design.h"

namespace retrace::design {

/// Reads the zones of a design.
/// \pre has_zones(document)
/// \throw InputError if zones overlap or do not cover the whole part, if regions are not convex polygons, and for
/// invalid changes
ZonedPart read_zones(const schema::Document& document);

/// Returns true if the design is a part with zones.
bool has_zones(const schema::Document& document);

/// Returns true if the value of this key of the design may differ between zones.
bool may_vary_between_zones(std::string_view key);

/// Checks that the zones of a design, if there are any, can be read.
void check_zones(const schema::Document& document);

}  // namespace retrace::design
