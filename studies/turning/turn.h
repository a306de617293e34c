#pragma once

// The study behind `retrace turn`: plans a turned part, writes its programs, and inspects what their text leaves.

#include <array>
#include <string>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/turning/check/inspection.h"
#include "fabrication/turning/finish.h"
#include "fabrication/turning/part.h"
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
  fabrication::turning::Inspection inspection;
  TurningStretch stretch;
  std::vector<fabrication::Finding> findings;  ///< none: the programs pass

  bool passes_inspection() const { return findings.empty(); }
};

/// Plans the path of a part, writes its programs, reads their text back and inspects what it leaves.
/// \throw InputError for a part file that makes no sense
TurningResult turn(const std::string& part_file);

}  // namespace retrace::studies
