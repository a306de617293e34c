#pragma once

// Reads the zones of a design from its document: regions of the part, and what their elements differ in.

#include <string_view>

#include "core/schema/document.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// \pre has_zones(document)
/// \throw InputError for zones that do not cover the part once, regions that are no convex polygons, and changes that
/// are none or make no array
ZonedPart read_zones(const schema::Document& document);

/// Whether the design is a part of zones.
bool has_zones(const schema::Document& document);

/// Whether zones may differ in a key of the design.
bool may_set_in_zone(std::string_view key);

/// The rule of designs that they can be read, where there are any.
void check_zones(const schema::Document& document);

}  // namespace retrace::studies
