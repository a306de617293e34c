#include "fabrication/planing/verify/check.h"

#include "fabrication/planing/verify/lathe_check.h"
#include "fabrication/planing/verify/mill_check.h"

namespace retrace::fabrication {
namespace {

NcSpindleTexts spindle_texts_of(const PlanedPart& part) {
  if (!part.lathe) return {};
  return {part.lathe->spindle_start, part.lathe->spindle_stop};
}

}  // namespace

PlaningCheck check_planing(const PlanedPart& part, double flank_slope, const std::vector<PlaningText>& programs,
                           NcDialect dialect) {
  PlaningCheck result;
  MillCheck mill(part, flank_slope, result);
  std::vector<PathPlace> path;
  for (const PlaningText& program : programs) {
    const NcProgram nc = parse_nc(program.text, program.name, dialect, spindle_texts_of(part));
    NcEnd end;
    if (part.mill) {
      mill.begin(program.name);
      end = run_nc(nc, mill);
      mill.end();
    } else {
      result.time_s.push_back(0.0);
      result.frames.push_back(0);
      LatheCheck lathe(part, dialect, program.name, result);
      end = run_nc(nc, lathe);
      lathe.end(end);
      path = lathe.last_pass();
    }
    if (!end.is_complete) result.findings.push_back({"truncated", program.name, end.line, end.reason, 0.0, 0.0});
  }
  if (part.mill)
    mill.measure();
  else
    measure_turned(part, path, result);
  return result;
}

}  // namespace retrace::fabrication
