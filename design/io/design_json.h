#pragma once

// Designs as JSON in results, and their short names for legends.

#include <nlohmann/json_fwd.hpp>

#include "design/design.h"
#include "design/optical_model.h"

namespace retrace::design {

/// Returns the design as JSON: the keys of the design file with defaults filled in, and the name of the file.
nlohmann::ordered_json to_json(const Design& design);

/// Returns the traced wavelengths of a spectrum: `centroid_nm`, and the lists `wavelengths_nm`, `weights` and
/// `refractive_index`.
nlohmann::ordered_json spectrum_json(const std::vector<SpectralOptics>& light);

/// Returns a short name for legends and tables: the title, or the kind of array and its size.
std::string short_name(const Design& design);

}  // namespace retrace::design
