#pragma once

// Reads the cuts from the programs of a turned part, and checks settings that would change their execution.

#include <cstdint>
#include <string>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/read/nc_program.h"
#include "fabrication/turning/check/envelope.h"
#include "fabrication/turning/part.h"

namespace retrace::fabrication::turning {

/// Move without cutting, with the lowest Z of the move.
struct FreeMove {
  double lowest_mm = 0.0;
  std::size_t program = 0;
  std::int32_t line = 0;
};

/// Downward move of only Z, with its end point.
struct DownMove {
  AxisPositions at;
  double stroke_mm = 0.0;  ///< stroke of a fast tool servo at the end point
  std::size_t program = 0;
  std::int32_t line = 0;
};

/// Moves of all programs, in the order of execution.
struct TurningCuts {
  std::vector<std::string> programs;  ///< file names of the programs
  std::vector<NcDialect> dialects;    ///< dialect of each program
  std::vector<double> end_mm;         ///< Z at the end of each program
  std::vector<CutPass> passes;
  std::vector<FreeMove> free_moves;  ///< moves without cutting, except vertical upward moves
  std::vector<DownMove> down_moves;
  double blend_mm = 0.0;                          ///< maximum path tolerance that the programs set for blending
  double lowest_travel_mm[3] = {0.0, 0.0, 0.0};   ///< minimum positions of X, Y and the slide Z
  double highest_travel_mm[3] = {0.0, 0.0, 0.0};  ///< maximum positions of X, Y and the slide Z
};

/// Reads the cuts of programs, and checks their settings, spindle, feeds and travel.
TurningCuts read_cuts(const TurnedPart& part, const std::vector<NcProgram>& programs, FindingList& findings);

/// Adds the strokes of a fast tool servo to the Z positions of the slide. The table has the columns `c_deg,stroke_mm`.
/// \throw InputError for a table that cannot be read
void add_strokes(TurningCuts& cuts, const std::string& table, const std::string& file, FindingList& findings);

}  // namespace retrace::fabrication::turning
