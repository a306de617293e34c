#pragma once

#include <string>
#include <vector>

#include "geometry/part.h"
#include "materials/io/material_library.h"
#include "raytrace/optics.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// A design made ready to trace.
struct OpticalModel {
  geometry::Part part;
  raytrace::Optics optics;
  std::vector<std::string> warnings;  ///< what the user should know, such as an index outside its data
};

/// Builds the part and looks up the material. \throw InputError naming file and line for an unknown material
OpticalModel make_model(const Design& design, const materials::MaterialLibrary& library);

/// The optics alone. Warnings are appended to `warnings`.
raytrace::Optics make_optics(const Design& design, const materials::MaterialLibrary& library,
                             std::vector<std::string>& warnings);

}  // namespace retrace::studies
