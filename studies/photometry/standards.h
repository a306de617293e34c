#pragma once

// The photometric standards whose limits are shipped, with their apertures and rotations.

#include <span>
#include <string_view>
#include <vector>

#include "raytrace/observers/aperture_kernel.h"

namespace retrace::studies {

/// A standard whose limits are shipped.
struct ShippedStandard {
  std::string_view name;      ///< on the command line
  std::string_view in_table;  ///< in data/photometry_limits.csv
  std::string_view description;
  raytrace::PhotometricApertures apertures;
  std::vector<double> rotation_deg;  ///< at which a part is measured unless the user says otherwise
  std::string_view conditions;       ///< where apertures and rotation come from
};

std::span<const ShippedStandard> shipped_standards();

/// Null for a name that is none of them.
const ShippedStandard* find_standard(std::string_view name);

/// The discs of CIE 54.2 for tests of materials and reflex reflectors: 10 minutes of arc each.
raytrace::PhotometricApertures default_apertures();

}  // namespace retrace::studies
