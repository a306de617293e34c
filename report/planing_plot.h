#pragma once

#include "report/plot.h"
#include "studies/planing/planing_study.h"

namespace retrace::report {

/// Depth over the distance from the middle: the design, and what the programs leave (of a lathe: its chords).
LinePlot planing_profile_plot(const studies::PlaningResult& result);

/// Where the strokes of a mill go, by set of programs; of a lathe: the ends of its chords.
LinePlot planing_zones_plot(const studies::PlaningResult& result);

/// What is left above the design over the distance from the middle; mill only.
LinePlot planing_error_plot(const studies::PlaningResult& result);

}  // namespace retrace::report
