#pragma once

// Plans the programs of a flat lens: strokes along the zones for a planing mill, and chords for a lathe.

#include <cstdint>
#include <string>
#include <vector>

#include "fabrication/planing/part.h"
#include "fabrication/planing/plan/chords.h"
#include "fabrication/planing/plan/zone_cuts.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Program that a machine executes without interruption.
struct PlannedProgram {
  Program program;
  std::string set;          ///< "odd zones", "even zones", "inner zones"; "passes" of a lathe
  std::int64_t frames = 0;  ///< number of moves
  std::int64_t cuts = 0;    ///< number of strokes (mill) or chords (lathe)
  double time_s = 0.0;
};

/// Plan of a flat element. The programs of a mill produce one half of a lens. The part is then rotated by 180 degrees
/// about Z, and the programs run a second time. docs/theory/planing.md describes the two methods of milling.
struct PlaningPlan {
  double flank_slope = 0.0;             ///< slope of the flank of the mill's tool, as depth divided by distance
  double quantum_mm = 0.0;              ///< depth increment of the cuts of the first method
  std::vector<ZoneCut> cuts;            ///< mill: cuts, sorted by zone and outwards
  std::vector<bool> uses_depth_method;  ///< for each zone: true if the first method is used
  Chords chords;                        ///< lathe: chords with which the programs approximate the profile
  Chords longest;                       ///< lathe: result of longest_chords(), for comparison
  std::vector<ProfilePoint> points;     ///< lathe: points that the chords connect
  std::int64_t passes = 0;              ///< lathe: number of passes
  std::vector<PlannedProgram> programs;
  int runs = 1;  ///< number of runs of every program: 2 for a milled lens, which is made in two halves

  std::int64_t frames() const;  ///< total number of moves of all programs, for one run
  double time_s() const;        ///< total time of all programs, for one run
};

/// Plans the programs of a part.
/// \throw InputError if the zones do not fit between lens and focus, or if the tolerance, the travel or the time limit
///        cannot be kept
PlaningPlan plan_planing(const PlanedPart& part);

}  // namespace retrace::fabrication
