#pragma once

// Designs as results quote them in JSON, and their short names for legends.

#include <nlohmann/json_fwd.hpp>

#include "studies/design/design.h"
#include "studies/design/optical_model.h"

namespace retrace::studies {

/// The design as results quote it: the keys of the design file, defaults filled in, and the file it came from.
nlohmann::ordered_json to_json(const Design& design);

/// The wavelengths that stand for a spectrum: `centroid_nm` and, as lists, `wavelengths_nm`, `weights`,
/// `refractive_index`.
nlohmann::ordered_json spectrum_json(const std::vector<SpectralOptics>& light);

/// A short name for legends and tables: the title, or what kind of array it is and its size.
std::string short_name(const Design& design);

}  // namespace retrace::studies
