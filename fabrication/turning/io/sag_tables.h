#pragma once

#include <optional>

#include "core/toml_file.h"
#include "fabrication/turning/boundary.h"
#include "fabrication/turning/sag.h"

// Tables of a part file that describe a sag or a boundary.

namespace retrace::fabrication::turning {

inline constexpr NumberRange kLengthMm{.low = -1e4, .high = 1e4};
inline constexpr NumberRange kPositiveMm{.low = 0.0, .low_included = false, .high = 1e4};

/// The keys of a sag: kind and what belongs to it.
Sag read_sag(TomlTable& table, std::string_view kind_key);

/// A table [boundary]: circle, rectangle, points or formula.
Boundary read_boundary(TomlTable& table);

}  // namespace retrace::fabrication::turning
