#pragma once

// The rules between keys of design files, such as sizes that must fit into each other.

#include <span>

#include "core/schema/schema.h"

namespace retrace::studies {

/// What must hold between keys of a design file, by the document; those of parts are checked in this order, so that
/// each may rely on those before it.
std::span<const schema::Rule> design_rules();

}  // namespace retrace::studies
