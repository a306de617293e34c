#pragma once

// Rules between several keys of design files, such as sizes that must fit into each other.

#include <span>

#include "core/schema/schema.h"

namespace retrace::design {

/// Returns the rules between keys of a design file. The rules of parts are checked in this order, so that each rule may
/// rely on the rules before it.
std::span<const schema::Rule> design_rules();

}  // namespace retrace::design
