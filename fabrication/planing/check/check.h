#pragma once

// Judges programs of flat lenses by their text, for planing mills and lathes.

#include <cstdint>
#include <string>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/planing/part.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// A sample of the profile: the design's depth and that which programs leave, in mm below the face.
struct ProfileSample {
  double x_mm = 0.0;
  double design_mm = 0.0;
  double left_mm = 0.0;
};

/// What the text of programs does, found without the planner: from the part, the tool and the NC text alone.
struct PlaningCheck {
  std::vector<Finding> findings;     ///< values in mm
  std::vector<double> time_s;        ///< by program
  std::vector<std::int64_t> frames;  ///< moves, by program
  double standing_mm_max = 0.0;      ///< left above the design
  double gouge_mm_max = 0.0;         ///< cut below it
  double off_grid_nm_max = 0.0;      ///< of positions, from the machine's grid
  double shortest_x_mm = 0.0;        ///< moves of single axes; 0: none
  double shortest_y_mm = 0.0;
  double shortest_z_mm = 0.0;
  std::vector<ProfileSample> profile;  ///< mill
  double path_distance_mm_max = 0.0;   ///< lathe: of what the last pass leaves from what its nose can leave
  double flank_slope = 0.0;            ///< mill: of the tool that the profile asks for, depth over distance
  double chip_mm_max = 0.0;            ///< lathe: most that a pass takes along Z
  double unreached_mm_max = 0.0;       ///< lathe: what a perfect pass leaves below the walls, as the nose is round

  bool passes() const { return findings.empty(); }
};

/// One program as text.
struct PlaningText {
  std::string name;
  std::string text;
};

/// The lines of a part's file that start and stop the spindle, for dialects that have no words of their own for it.
NcTexts spindle_texts_of(const PlanedPart& part);

/// Judges programs, in the order in which they run, as they were read.
/// \throw InputError for programs that no control can carry out
PlaningCheck check_planing(const PlanedPart& part, const std::vector<NcProgram>& programs);

/// The same of text. \throw InputError for text that cannot be read
PlaningCheck check_planing(const PlanedPart& part, const std::vector<PlaningText>& programs, NcDialect dialect);

}  // namespace retrace::fabrication
