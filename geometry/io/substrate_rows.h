#pragma once

// The table [base] of design and job files as rows: the shape of a substrate and how elements stand on it.

#include <span>
#include <string_view>

#include "core/schema/schema.h"
#include "geometry/substrate/substrate.h"

namespace retrace::geometry {

/// The keys of `[base]` in designs and jobs, whose object is a Base. The last row is that of pins.
std::span<const schema::Row> substrate_rows();

/// The key that gives a base its shape, to be blamed for it.
std::string_view substrate_shape_key(const Substrate& substrate);

}  // namespace retrace::geometry
