#pragma once

// Photometric standards whose limits are shipped, with their apertures and rotations.

#include <span>
#include <string_view>
#include <vector>

#include "raytrace/light/aperture_kernel.h"

namespace retrace::studies {

/// Standard whose limits are shipped.
struct ShippedStandard {
  std::string_view name;        ///< name on the command line
  std::string_view table_name;  ///< name in data/photometry_limits.csv
  std::string_view description;
  raytrace::PhotometricApertures apertures;
  std::vector<double> rotation_deg;  ///< default rotations at which a part is measured
  std::string_view conditions;       ///< source of the apertures and rotations
};

std::span<const ShippedStandard> shipped_standards();

/// Returns the standard with this name, or null if there is none.
const ShippedStandard* find_standard(std::string_view name);

/// Returns the apertures of CIE 54.2 for tests of materials and reflex reflectors: discs of 10 minutes of arc each.
raytrace::PhotometricApertures default_apertures();

}  // namespace retrace::studies
