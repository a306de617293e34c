#include "fabrication/planing/check/check.h"

#include "fabrication/planing/check/lathe_check.h"
#include "fabrication/planing/check/mill_check.h"

namespace retrace::fabrication {
namespace {

NcTexts spindle_texts_of(const PlanedPart& part) {
  if (!part.lathe) return {};
  return {part.lathe->spindle_start, part.lathe->spindle_stop, "", "", ""};
}

}  // namespace

PlaningCheck check_planing(const PlanedPart& part, double flank_slope, const std::vector<PlaningText>& programs,
                           NcDialect dialect) {
  PlaningCheck result;
  FindingList findings;
  MillCheck mill(part, flank_slope, findings, result);
  std::vector<PathPlace> path;
  for (const PlaningText& program : programs) {
    findings.begin(program.name);
    result.time_s.push_back(0.0);
    result.frames.push_back(0);
    const NcProgram nc = parse_nc(program.text, program.name, dialect, spindle_texts_of(part));
    NcEnd end;
    if (part.mill) {
      mill.begin();
      end = run_nc(nc, mill);
      mill.end();
    } else {
      LatheCheck lathe(part, dialect, findings, result);
      end = run_nc(nc, lathe);
      lathe.end(end);
      path = lathe.last_pass();
    }
    if (!end.is_complete) findings.add("truncated", end.line, end.reason);
  }
  findings.begin("");
  if (part.mill)
    mill.measure();
  else
    measure_turned(part, path, findings, result);
  result.findings = findings.take();
  return result;
}

}  // namespace retrace::fabrication
