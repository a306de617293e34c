#pragma once

#include <span>

#include "core/schema/schema.h"

// The rules of design files.

namespace retrace::studies {

/// What must hold between keys of a design file, by the document; those of parts are checked in this order, so that
/// each may rely on those before it.
std::span<const schema::Rule> design_rules();

}  // namespace retrace::studies
