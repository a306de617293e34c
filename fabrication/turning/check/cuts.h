#pragma once

// Reads the programs of a turned part: their cuts, and what stands in the way of carrying them out as they are meant.

#include <cstdint>
#include <string>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/read/nc_program.h"
#include "fabrication/turning/check/envelope.h"
#include "fabrication/turning/part.h"

namespace retrace::fabrication::turning {

/// A move without cutting: its lowest place.
struct FreeMove {
  double lowest_mm = 0.0;
  std::size_t program = 0;
  std::int32_t line = 0;
};

/// A place that the tool goes down to by Z alone.
struct DownMove {
  AxisPositions at;
  double stroke_mm = 0.0;  ///< of a servo there
  std::size_t program = 0;
  std::int32_t line = 0;
};

/// What programs do, one after another.
struct TurningCuts {
  std::vector<std::string> programs;  ///< files
  std::vector<NcDialect> dialects;    ///< by program
  std::vector<double> end_mm;         ///< by program: Z at its end
  std::vector<CutPass> passes;
  std::vector<FreeMove> free_moves;  ///< but for those that rise straight up
  std::vector<DownMove> down_moves;
  double blend_mm = 0.0;  ///< by which a path may be left at most where its moves meet, as programs say
  double lowest_travel_mm[3] = {0.0, 0.0, 0.0};  ///< of X, Y and the slide's Z
  double highest_travel_mm[3] = {0.0, 0.0, 0.0};
};

/// Reads programs and looks at their settings, spindle, feeds and travel.
TurningCuts read_cuts(const TurnedPart& part, const std::vector<NcProgram>& programs, FindingList& findings);

/// Adds the strokes of the table of a fast tool servo, `c_deg,stroke_mm`, to the slide's heights.
/// \throw InputError for a table that cannot be read
void add_strokes(TurningCuts& cuts, const std::string& table, const std::string& file, FindingList& findings);

}  // namespace retrace::fabrication::turning
