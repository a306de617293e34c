#pragma once

#include "geometry/part_spec.h"
#include "studies/design/table_reader.h"

namespace retrace::studies {

/// Most elements that one design may have; keeps element numbers within 32 bits and memory within reason.
inline constexpr double kMostElements = 1e8;

/// Checks what only element and array together can tell: room for one element between the margins, not more than
/// kMostElements, and square cells where a checker turns them. `array` and `element` say where the values were given.
/// \throw InputError
void check_array(const geometry::PartSpec& part, const TableReader& array, const TableReader& element);

}  // namespace retrace::studies
