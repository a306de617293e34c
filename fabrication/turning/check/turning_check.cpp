#include "fabrication/turning/check/turning_check.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"

namespace retrace::fabrication::turning {
namespace {

/// Checks that moves without cutting, and the ends of programs, keep the required clearance above the highest point of
/// the part.
void check_free_moves(const TurnedPart& part, const TurningCuts& cuts, const ContactFigures& touch,
                      FindingList& findings) {
  constexpr double kHeightsMm = 5e-6;
  if (!touch.highest_mm) return;
  const double limit = *touch.highest_mm + part.path.clearance_mm;
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

/// Returns the maximum deviation of a blended path from the corners between moves. If one move decelerates uniformly
/// while the next move accelerates uniformly, the blend is a parabola. It extends at most from the centre of one move
/// to the centre of the next move. Its distance from the corner is then a quarter of the corner's height above the
/// chord between its neighbours. C is converted to the path length at the tool.
double widest_blend_mm(const std::vector<CutPass>& passes) {
  using Place = Eigen::Vector4d;
  double highest = 0.0;
  for (const CutPass& pass : passes) {
    const auto place = [&](std::size_t i, double radius_mm) {
      return Place(pass.x_mm[i], pass.y_mm[i], pass.z_mm[i], radius_mm * pass.c_rad[i]);
    };
    for (std::size_t i = 1; i + 1 < pass.size(); ++i) {
      const double radius_mm = std::hypot(pass.x_mm[i], pass.y_mm[i]);
      const Place before = place(i - 1, radius_mm);
      const Place at = place(i, radius_mm);
      const Place behind = place(i + 1, radius_mm);
      const double to_mm = (at - before).norm();
      const double from_mm = (behind - at).norm();
      if (to_mm + from_mm > 0.0)
        highest = std::max(highest, (at - before - to_mm / (to_mm + from_mm) * (behind - before)).norm());
    }
  }
  return 0.25 * highest;
}

void judge(double tolerance_nm, double blend_nm, const Inspection& inspection, FindingList& findings) {
  const auto check = [&](const char* kind, const char* what, double value) {
    if (value > tolerance_nm)
      findings.add(kind, 0,
                   fmt::format("{} of {} nm exceeds the tolerance of {} nm", what, fixed_apart(value, tolerance_nm, 2),
                               shortest(tolerance_nm)),
                   value, tolerance_nm);
  };
  check("form", blend_nm > 0.0 ? "a form error (with blends)" : "a form error", inspection.form_error_nm + blend_nm);
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
  if (cuts.blend_mm > 0.0) check.blend_nm = 1e6 * std::min(cuts.blend_mm, widest_blend_mm(cuts.passes));
  check.motion = check_motion(part, cuts, findings);
  check.contact = check_contact(part, cuts, findings);
  check.coverage = check_coverage(part, cuts, findings);
  check_free_moves(part, cuts, check.contact, findings);
  if (!check.coverage.is_monotonic || !check.coverage.is_complete) return check;
  try {
    check.envelope.emplace(part.tool, std::move(cuts.passes));
    check_border(part, cuts, *check.envelope, check.contact, findings);
    check.inspection = inspect(*check.envelope, part.surface, part.tool, region_of(part.path), part.map_pixels);
    judge(part.form_tolerance_nm, check.blend_nm, check.inspection, findings);
  } catch (const InputError& error) {
    check.envelope.reset();
    findings.add("uncut", 0, error.what());
  }
  return check;
}

}  // namespace retrace::fabrication::turning
