#pragma once

// Checks the programs of a turned part: the motion of the machine, and the machined surface.

#include <optional>
#include <string>

#include "fabrication/turning/check/contact_check.h"
#include "fabrication/turning/check/coverage.h"
#include "fabrication/turning/check/inspection.h"
#include "fabrication/turning/check/motion_check.h"

namespace retrace::fabrication::turning {

/// Result of the check of programs. It depends only on the part file and on the text of the programs.
struct TurningCheck {
  MotionFigures motion;
  ContactFigures contact;
  CoverageFigures coverage;
  std::size_t points = 0;  ///< number of points of all cuts
  /// Maximum deviation from the path due to blending. It is the tolerance that the programs allow, or the deviation of
  /// parabolas between the centres of the moves, whichever is smaller. It is added to the form error.
  double blend_nm = 0.0;
  std::size_t passes = 0;
  /// Machined surface. Empty if it cannot be computed, because cuts do not move forward or leave parts of the region
  /// uncut.
  std::optional<Envelope> envelope;
  Inspection inspection;
};

/// Table with the strokes of a fast tool servo.
struct StrokeTable {
  std::string file;
  std::string text;
};

/// Checks the cuts of a turned part.
/// \param cuts result of read_cuts()
/// \param strokes table of strokes, for a part with a fast tool servo
/// \throw InputError for a table of strokes that cannot be read
TurningCheck check_turning(const TurnedPart& part, TurningCuts cuts, const std::optional<StrokeTable>& strokes,
                           FindingList& findings);

}  // namespace retrace::fabrication::turning
