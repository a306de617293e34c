#pragma once

// The studies behind `retrace turn` and `retrace verify` of turned parts: plans a turned part, writes its programs, and
// judges the text of programs.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/warning.h"
#include "fabrication/check/findings.h"
#include "fabrication/turning/check/turning_check.h"
#include "fabrication/turning/finish.h"
#include "fabrication/turning/part.h"
#include "fabrication/turning/plan/cubic_path.h"
#include "fabrication/turning/plan/path.h"

namespace retrace::studies {

/// A program of one dialect.
struct TurningText {
  std::string dialect;
  std::string file;  ///< its name
  std::string text;
};

/// One point of a short stretch of the path, for plots.
struct TurningStretch {
  std::vector<fabrication::turning::AxisState> z;  ///< round the largest jump of its acceleration
  std::vector<geometry::Vec2> profile;             ///< (distance along the radius mm, deviation nm) of a few cuts
};

/// What controls that join points by cubics get in place of straight moves.
struct TurnedByCubics {
  fabrication::turning::CubicPath path;
  fabrication::turning::TurningCheck check;
  std::string file;                ///< the first of the programs by cubics
  std::size_t bytes = 0;           ///< of it
  std::size_t straight_bytes = 0;  ///< that it would have of straight moves
};

struct TurningResult {
  std::string file;  ///< of the part
  fabrication::turning::TurnedPart part;
  std::vector<fabrication::turning::Pass> passes;
  std::size_t points = 0;
  double time_s = 0.0;
  fabrication::turning::ClearanceFigures clearance;
  fabrication::turning::FinishFigures finish;
  std::array<fabrication::turning::AxisFigures, 4> axes;  ///< X, Y, Z, servo
  std::vector<TurningText> programs;
  std::string machined_stl;  ///< what is moulded in the surface that is left; empty unless the part asks for it
  std::string servo_csv;     ///< strokes of a fast tool servo; empty without
  fabrication::turning::TurningCheck check;
  TurningStretch stretch;
  std::optional<TurnedByCubics> cubics;        ///< where the part asks for them
  std::vector<fabrication::Finding> findings;  ///< none: the programs pass

  bool passes_inspection() const { return findings.empty(); }
  /// Whether the program of a dialect goes by cubics.
  bool has_cubics(std::string_view dialect) const;
};

/// Plans the path of a part, writes its programs, reads their text back and inspects what it leaves.
/// \throw InputError for a part file that makes no sense
TurningResult turn(const std::string& part_file);

/// What to verify.
struct TurningRequest {
  std::string part;                   ///< file
  std::vector<std::string> programs;  ///< files, in the order in which they run
  std::string dialect = "auto";       ///< of all of them, or told from the text
  std::string servo;                  ///< table of strokes of a fast tool servo; empty: none
};

/// Programs from files, and what they were found to do.
struct TurningVerification {
  TurningRequest request;
  fabrication::turning::TurnedPart part;
  std::vector<fabrication::NcProgram> programs;  ///< as they were read
  fabrication::turning::TurningCheck check;
  std::vector<fabrication::Finding> findings;

  bool passes() const { return findings.empty(); }
  const Warnings& part_warnings() const { return part.warnings; }
};

/// \throw InputError for a file that cannot be read or understood, with its line, and for a table of strokes that the
/// part's servo does not take, or does without
TurningVerification verify_turning(const TurningRequest& request);

}  // namespace retrace::studies
