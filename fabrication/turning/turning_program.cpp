#include "fabrication/turning/turning_program.h"

#include <algorithm>
#include <cmath>

namespace retrace::fabrication::turning {
namespace {

/// Down to the first point from the height at which the tool moves freely.
constexpr double kApproachMmPerMin = 5.0;

Nanometres nanometres(double mm) {
  return std::llround(mm * kNanometresPerMm);
}

}  // namespace

Program turning_program(const std::vector<Pass>& passes, const PathOptions& options, const std::string& name,
                        const std::vector<std::string>& header) {
  Program program;
  program.name = name;
  program.header = header;
  double highest = -1e300;
  for (const Pass& pass : passes)
    for (const PathPoint& p : pass) highest = std::max(highest, p.z_mm);
  const Raise raise{nanometres(highest + options.clear_mm)};
  for (const Pass& pass : passes) {
    Trace trace;
    trace.approach_feed_mm_per_min = kApproachMmPerMin;
    trace.points.reserve(pass.size());
    for (const PathPoint& p : pass)
      trace.points.push_back({nanometres(p.x_mm), nanometres(p.y_mm), nanometres(p.z_mm),
                              std::llround(p.c_deg * kRotaryUnitsPerDeg), p.seconds});
    program.items.emplace_back(raise);
    program.items.emplace_back(std::move(trace));
  }
  program.items.emplace_back(raise);
  return program;
}

}  // namespace retrace::fabrication::turning
