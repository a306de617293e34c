#pragma once

// Keys of the table [substrate] in design and job files: shape of a substrate and orientation of the elements on it.

#include <span>
#include <string_view>

#include "core/schema/schema.h"
#include "geometry/substrate/substrate.h"

namespace retrace::geometry {

/// Returns the keys of `[substrate]` in jobs, as rows for an object of the type Substrate. The last row applies only to
/// pins (cube corners at the ends of pins).
std::span<const schema::Row> substrate_rows();

/// Returns the keys of `[substrate]` in designs. Designs also allow substrates below an entrance surface.
std::span<const schema::Row> design_substrate_rows();

/// Returns the key that determines the shape of a substrate, for error messages about the shape.
std::string_view substrate_shape_key(const Substrate& substrate);

}  // namespace retrace::geometry
