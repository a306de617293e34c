#include "fabrication/turning/check/turning_check.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"

namespace retrace::fabrication::turning {
namespace {

/// Moves without cutting stay above the highest place of the part by what its file asks for, so do ends.
void check_free_moves(const TurnedPart& part, const TurningCuts& cuts, const TouchFigures& touch,
                      FindingList& findings) {
  constexpr double kHeightsMm = 5e-6;
  if (!touch.highest_mm) return;
  const double limit = *touch.highest_mm + part.path.clear_mm;
  for (const FreeMove& move : cuts.free_moves)
    if (move.lowest_mm < limit - kHeightsMm)
      findings.add(
          {"clearance", cuts.programs[move.program], move.line, -1,
           fmt::format("a rapid move at {} mm comes nearer to the part than clear_mm", fixed(move.lowest_mm, 6)),
           move.lowest_mm, limit, 1});
  for (std::size_t k = 0; k < cuts.programs.size(); ++k)
    if (cuts.end_mm[k] < limit - kHeightsMm)
      findings.add({"ends_low", cuts.programs[k], 0, -1,
                    "the program ends with the tool nearer to the part than clear_mm", cuts.end_mm[k], limit, 1});
}

void judge(double tolerance_nm, const Inspection& inspection, FindingList& findings) {
  const auto check = [&](const char* kind, const char* what, double value) {
    if (value > tolerance_nm)
      findings.add(
          kind, 0,
          fmt::format("{} of {} nm exceeds the tolerance of {} nm", what, fixed(value, 2), shortest(tolerance_nm)),
          value, tolerance_nm);
  };
  check("form", "a form error", inspection.form_error_nm);
  check("gouge", "a cut below the surface", inspection.interference_nm);
}

}  // namespace

TurningCheck check_turning(const TurnedPart& part, TurningCuts cuts, const std::optional<StrokeTable>& strokes,
                           FindingList& findings) {
  TurningCheck check;
  findings.begin("");
  if (strokes) add_strokes(cuts, strokes->text, strokes->file, findings);
  check.passes = cuts.passes.size();
  for (const CutPass& pass : cuts.passes) check.points += pass.size();
  check.motion = check_motion(part, cuts, findings);
  check.touch = check_touch(part, cuts, findings);
  check.coverage = check_coverage(part, cuts, findings);
  check_free_moves(part, cuts, check.touch, findings);
  if (!check.coverage.is_orderly || !check.coverage.is_whole) return check;
  try {
    check.envelope.emplace(part.tool, std::move(cuts.passes));
    check.inspection = inspect(*check.envelope, part.surface, part.tool, region_of(part.path), part.map_pixels);
    judge(part.form_tolerance_nm, check.inspection, findings);
  } catch (const InputError& error) {
    check.envelope.reset();
    findings.add("uncut", 0, error.what());
  }
  return check;
}

}  // namespace retrace::fabrication::turning
