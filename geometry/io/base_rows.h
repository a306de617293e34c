#pragma once

#include <span>
#include <string_view>

#include "core/schema/schema.h"
#include "geometry/base_shape.h"

namespace retrace::geometry {

/// The keys of `[base]` in designs and jobs, whose object is a Base. The last row is that of pins.
std::span<const schema::Row> base_rows();

/// The key that gives a base its shape, to be blamed for it.
std::string_view base_shape_key(const Base& base);

}  // namespace retrace::geometry
