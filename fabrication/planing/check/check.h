#pragma once

// Checks the programs of flat lenses, for planing mills and lathes. The checks use only the text of the programs.

#include <cstdint>
#include <string>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/planing/part.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// Sample of the profile: depth of the design and depth of the machined surface, in mm below the face.
struct ProfileSample {
  double x_mm = 0.0;
  double design_mm = 0.0, machined_mm = 0.0;
};

/// Result of a check. It is computed from the part, the tool and the NC text, without the planner.
struct PlaningCheck {
  std::vector<Finding> findings;     ///< findings, with values in mm
  std::vector<double> time_s;        ///< run time of each program
  std::vector<std::int64_t> frames;  ///< number of moves (frames) in each program
  double excess_mm_max = 0.0;        ///< maximum height of remaining material above the design
  double gouge_mm_max = 0.0;         ///< maximum depth of cuts below the design
  double off_grid_nm_max = 0.0;      ///< maximum distance of a position from the machine's grid
  double shortest_x_mm = 0.0;        ///< shortest move of X; 0 if X does not move
  double shortest_y_mm = 0.0;
  double shortest_z_mm = 0.0;
  std::vector<ProfileSample> profile;  ///< mill: profile of the machined surface
  /// Lathe: maximum distance between the surface after the last pass and the surface that an exact path of the nose
  /// would produce.
  double path_distance_mm_max = 0.0;
  /// Mill: slope of the flank of the tool that the profile requires, as depth divided by distance.
  double flank_slope = 0.0;
  double chip_mm_max = 0.0;  ///< lathe: maximum thickness, along Z, of the material that a pass removes
  /// Lathe: maximum distance between the design and the surface that an exact path of the nose would produce. It is
  /// above 0 if a round nose does not reach into the corners of the profile.
  double unreached_mm_max = 0.0;

  bool passes() const { return findings.empty(); }
};

/// Program as text.
struct PlaningText {
  std::string name;
  std::string text;
};

/// Returns the program lines of a part file that start and stop the spindle. They are used in dialects that have no
/// codes of their own for the spindle.
NcTexts spindle_texts_of(const PlanedPart& part);

/// Checks programs in the order of their execution.
/// \throw InputError for programs that no control can execute
PlaningCheck check_planing(const PlanedPart& part, const std::vector<NcProgram>& programs);

/// Reads the text of programs and checks them.
/// \throw InputError for text that cannot be read
PlaningCheck check_planing(const PlanedPart& part, const std::vector<PlaningText>& programs, NcDialect dialect);

}  // namespace retrace::fabrication
