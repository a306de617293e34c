#pragma once

#include "fabrication/planing/part.h"

namespace retrace::fabrication::test {

/// Returns a round lens that is turned on a lathe.
/// \param nose_mm nose radius of the tool
inline PlanedPart turned_lens(const ZoneLens& lens, double tolerance_mm, double depth_of_cut_mm, double nose_mm) {
  PlanedPart part;
  part.source = "part.toml";
  part.lens = lens;
  part.tolerance_mm = tolerance_mm;
  part.lathe = PlaningLathe{};
  part.lathe->feed_mm_per_min = 200.0;
  part.lathe->depth_of_cut_mm = depth_of_cut_mm;
  part.lathe->nose_radius_mm = nose_mm;
  part.lathe->spindle_rpm = 800;
  part.lathe->spindle_start = "M103";
  part.lathe->spindle_stop = "M105";
  return part;
}

}  // namespace retrace::fabrication::test
