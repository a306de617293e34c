#pragma once

// Plans a turned part, writes its programs, and checks the text of programs. `retrace turn` runs this study, and so
// does `retrace verify` for turned parts.

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

/// Program in one dialect.
struct TurningText {
  std::string dialect;
  std::string file;  ///< name of the program's file
  std::string text;
};

/// Short stretches of the path and of the machined surface, for plots.
struct TurningStretch {
  /// States of the Z axis (or the servo) around the largest jump of its acceleration.
  std::vector<fabrication::turning::AxisState> z;
  /// Points of a profile over a few cuts: (distance along the radius in mm, deviation in nm).
  std::vector<geometry::Vec2> profile;
};

/// Tool path for controls that join points by cubics instead of straight moves.
struct CubicVariant {
  fabrication::turning::CubicPath path;
  fabrication::turning::TurningCheck check;
  std::string file;                ///< name of the first program that consists of cubics
  std::size_t bytes = 0;           ///< size of this program
  std::size_t straight_bytes = 0;  ///< size that this program would have with straight moves
};

struct TurningResult {
  std::string file;  ///< name of the part file
  fabrication::turning::TurnedPart part;
  std::vector<fabrication::turning::Pass> passes;
  std::size_t points = 0;
  double time_s = 0.0;
  fabrication::turning::ClearanceFigures clearance;
  fabrication::turning::FinishFigures finish;
  std::array<fabrication::turning::AxisFigures, 4> axes;  ///< X, Y, Z and the servo
  std::vector<TurningText> programs;
  /// STL file of a part that is moulded from the machined surface; empty unless the part file requests it.
  std::string machined_stl;
  std::string servo_csv;  ///< table of strokes of a fast tool servo; empty if the part has no such servo
  fabrication::turning::TurningCheck check;
  TurningStretch stretch;
  std::optional<CubicVariant> cubics;          ///< path with cubics; none unless the part file requests it
  std::vector<fabrication::Finding> findings;  ///< findings of the checks; empty if the programs pass

  bool passes_inspection() const { return findings.empty(); }
  /// Returns true if the program of this dialect consists of cubics.
  bool has_cubics(std::string_view dialect) const;
};

/// Plans the path of a part and writes its programs. Then reads the text of the programs back and checks the surface
/// that they machine.
/// \throw InputError for an invalid part file
TurningResult turn(const std::string& part_file);

/// Programs that are verified, and the part for which they were made.
struct TurningRequest {
  std::string part;                   ///< name of the part file
  std::vector<std::string> programs;  ///< program files, in the order in which they run
  std::string dialect = "auto";       ///< dialect of all programs; `auto`: determined from the text
  std::string servo;                  ///< file with the strokes of a fast tool servo; empty: none
};

/// Programs from files, and the results of checking them.
struct TurningVerification {
  TurningRequest request;
  fabrication::turning::TurnedPart part;
  std::vector<fabrication::NcProgram> programs;  ///< programs as they were read
  fabrication::turning::TurningCheck check;
  std::vector<fabrication::Finding> findings;

  bool passes() const { return findings.empty(); }
  const Warnings& part_warnings() const { return part.warnings; }
};

/// \throw InputError that names the line, for a file that cannot be read or is invalid. Also thrown if a table of
/// strokes is missing, or is given although the servo of the part needs none.
TurningVerification verify_turning(const TurningRequest& request);

}  // namespace retrace::studies
