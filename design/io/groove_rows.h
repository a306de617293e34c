#pragma once

// Rows of the table [grooves] of designs with ruled cells, and of its tables a to d. Internal to design/.

#include <span>
#include <string_view>

#include "core/schema/schema.h"

namespace retrace::design {

/// Names of the tables of groove sets in [grooves].
inline constexpr std::string_view kGrooveSets[] = {"a", "b", "c", "d"};

std::span<const schema::Row> groove_rows();
std::span<const schema::Row> groove_set_rows();

}  // namespace retrace::design
