#include "fabrication/planing/check/check.h"

#include "fabrication/planing/check/lathe_check.h"
#include "fabrication/planing/check/mill_check.h"

namespace retrace::fabrication {
namespace {

/// Executes programs, one after the other, and passes their moves to `check`.
template <class Check, class Begin, class End>
void follow(const std::vector<NcProgram>& programs, FindingList& findings, PlaningCheck& result, Check& check,
            const Begin& begin, const End& end) {
  for (const NcProgram& program : programs) {
    findings.begin(program.file);
    result.time_s.push_back(0.0);
    result.frames.push_back(0);
    begin(program);
    const NcEnd how = run_nc(program, check);
    end(how);
    if (!how.is_complete) findings.add("truncated", how.line, how.reason);
  }
  findings.begin("");
  check.measure();
}

}  // namespace

NcTexts spindle_texts_of(const PlanedPart& part) {
  if (!part.lathe) return {};
  return {part.lathe->spindle_start, part.lathe->spindle_stop, "", "", ""};
}

PlaningCheck check_planing(const PlanedPart& part, const std::vector<NcProgram>& programs) {
  PlaningCheck result;
  FindingList findings;
  if (part.mill) {
    MillCheck mill(part, findings, result);
    follow(
        programs, findings, result, mill, [&](const NcProgram& program) { mill.begin(program); },
        [&](const NcEnd& end) { mill.end(end); });
  } else {
    LatheCheck lathe(part, findings, result);
    follow(
        programs, findings, result, lathe, [&](const NcProgram& program) { lathe.begin(program); },
        [&](const NcEnd& end) { lathe.end(end); });
  }
  result.findings = findings.take();
  return result;
}

PlaningCheck check_planing(const PlanedPart& part, const std::vector<PlaningText>& programs, NcDialect dialect) {
  std::vector<NcProgram> read;
  const NcTexts spindle = spindle_texts_of(part);
  for (const PlaningText& program : programs) read.push_back(parse_nc(program.text, program.name, dialect, spindle));
  return check_planing(part, read);
}

}  // namespace retrace::fabrication
