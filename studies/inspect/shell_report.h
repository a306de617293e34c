#pragma once

// Report on the shells of a design: separate lenses in front of the part.

#include <vector>

#include "design/optical_model.h"
#include "design/shells_of_design.h"
#include "geometry/vec.h"

namespace retrace::studies {

/// Properties of one shell.
struct ShellReport {
  double refractive_index = 1.0;  ///< index at the wavelength that represents the light
  /// Fraction of the light that the shell transmits at its middle, averaged over the spectrum. The light crosses the
  /// shell once at normal incidence. Multiple reflections are neglected.
  double transmittance = 1.0;
  design::ShellClearance clearance;
};

/// Section through the part and its shells. Its plane contains the middle of the part and is parallel to z.
struct ShellSection {
  bool is_along_y = false;  ///< true: the section shows y; false: it shows x
  /// Closed line around each shell, in the order of the design. Coordinates are (x, z) or (y, z) in the part frame.
  std::vector<std::vector<geometry::Vec2>> shells;
  std::vector<geometry::Vec2> part;  ///< closed line around the part; its back is drawn as the plane z = 0
};

/// Properties of all shells, and a section through them.
struct ShellsReport {
  std::vector<ShellReport> shells;
  ShellSection section;
};

/// \pre the design has shells, and `model` was made from it
ShellsReport report_shells(const design::Design& design, const design::OpticalModel& model);

}  // namespace retrace::studies
