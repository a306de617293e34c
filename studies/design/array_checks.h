#pragma once

#include "core/schema/document.h"
#include "geometry/part_spec.h"

namespace retrace::studies {

/// Most elements that one design may have; keeps element numbers within 32 bits and memory within reason.
inline constexpr double kMostElements = 1e8;

/// Checks what only element and array together can tell: room for one element between the margins, not more than
/// kMostElements, and square cells where a checker turns them.
/// \throw InputError
void check_array(const geometry::PartSpec& part, const schema::Document& document);

}  // namespace retrace::studies
