#pragma once

// Plans the programs of a flat lens, for a planing mill by strokes along the zones, for a lathe by chords.

#include <cstdint>
#include <string>
#include <vector>

#include "fabrication/planing/part.h"
#include "fabrication/planing/plan/chords.h"
#include "fabrication/planing/plan/zone_cuts.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// A program that a machine runs without a break.
struct PlannedProgram {
  Program program;
  std::string set;          ///< "odd zones", "even zones", "inner zones"; "passes" of a lathe
  std::int64_t frames = 0;  ///< moves
  std::int64_t cuts = 0;    ///< strokes, or chords
  double time_s = 0.0;
};

/// How a flat element is made. Of a milled lens the programs make one half: the part is turned by 180 degrees about Z,
/// and they run once more.
struct PlaningPlan {
  double flank_slope = 0.0;          ///< of the mill's tool, depth over distance
  double quantum_mm = 0.0;           ///< by which cuts of the first method deepen
  std::vector<ZoneCut> cuts;         ///< mill; by zone, outwards
  std::vector<bool> by_depths;       ///< by zone: first method
  Chords chords;                     ///< lathe
  Chords longest;                    ///< lathe: what the longest chords one after another would be
  std::vector<ProfilePoint> points;  ///< lathe: what the chords join
  std::int64_t passes = 0;           ///< lathe
  std::vector<PlannedProgram> programs;
  int runs = 1;  ///< of every program: 2 for the halves of a milled lens

  std::int64_t frames() const;  ///< of all programs, once
  double time_s() const;        ///< of all programs, once
};

/// \throw InputError for a tolerance, travel, time limit or number of programs that cannot be kept
PlaningPlan plan_planing(const PlanedPart& part);

}  // namespace retrace::fabrication
