#pragma once

// Judges programs of a turned part by their text: what the machine is asked to do, and what the tool leaves.

#include <optional>
#include <string>

#include "fabrication/turning/check/coverage.h"
#include "fabrication/turning/check/inspection.h"
#include "fabrication/turning/check/motion_check.h"
#include "fabrication/turning/check/touch_check.h"

namespace retrace::fabrication::turning {

/// What programs were found to do, from the part's file and their text alone. The findings are in the list that was
/// given.
struct TurningCheck {
  MotionFigures motion;
  TouchFigures touch;
  CoverageFigures coverage;
  std::size_t points = 0;  ///< of cuts
  /// By which a control that blends moves leaves the path at most: what the programs allow, or, if that is less, what
  /// parabolas between the middles of the moves leave of their corners. Part of the form error that is judged.
  double blend_nm = 0.0;
  std::size_t passes = 0;
  /// What is left; nothing where cuts that do not go on or leave places out make it impossible to find.
  std::optional<Envelope> envelope;
  Inspection inspection;
};

/// A table of strokes of a fast tool servo.
struct StrokeTable {
  std::string file;
  std::string text;
};

/// \param cuts as read_cuts() gave them \param strokes where the part's servo is fast
/// \throw InputError for a table of strokes that cannot be read
TurningCheck check_turning(const TurnedPart& part, TurningCuts cuts, const std::optional<StrokeTable>& strokes,
                           FindingList& findings);

}  // namespace retrace::fabrication::turning
