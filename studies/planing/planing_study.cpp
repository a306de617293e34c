#include "studies/planing/planing_study.h"

#include "core/error.h"
#include "fabrication/check/io/program_files.h"
#include "fabrication/planing/io/part_files.h"
#include "fabrication/post/post.h"

namespace retrace::studies {
namespace {

/// Checks that a lathe gives `spindle_start` if the dialect has no words that start the spindle.
/// \throw InputError if `spindle_start` is missing
void check_spindle(const fabrication::PlanedPart& part, const std::string& dialect) {
  if (!part.lathe || !fabrication::has_own_texts(fabrication::dialect_of(dialect, {}, {}))) return;
  if (part.lathe->spindle_start.empty())
    throw InputError(part.lathe->spindle_start_at,
                     "is missing; it must be the line that starts the spindle, because dialect " + dialect +
                         " has no standard code for it");
}

}  // namespace

PlaningResult plane(const std::string& part_file, const std::string& dialect) {
  using namespace fabrication;
  PlaningResult result;
  const std::string ending(fabrication::ending_of(dialect));  // refuses unknown dialects before the planning begins
  result.part = read_planed_part(part_file);
  result.warnings = result.part.warnings;
  check_spindle(result.part, dialect);
  result.dialect = dialect;
  try {
    result.plan = plan_planing(result.part);
  } catch (const InputError& error) {
    const std::string text = error.what();
    throw text.starts_with(part_file) ? error : InputError({part_file, 0, ""}, text);
  }
  for (const PlannedProgram& planned : result.plan.programs)
    result.programs.push_back({planned.program.name + ending, nc_text(planned.program, dialect)});
  result.check = check_planing(result.part, result.programs, dialect_of(dialect, {}, {}));
  return result;
}

PlaningVerification verify_planing(const std::string& part_file, const std::vector<std::string>& programs,
                                   const std::string& dialect) {
  using namespace fabrication;
  PlaningVerification result;
  result.part = read_planed_part(part_file);
  result.programs = read_programs(programs, dialect, spindle_texts_of(result.part));
  result.check = check_planing(result.part, result.programs);
  return result;
}

}  // namespace retrace::studies
