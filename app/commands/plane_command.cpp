#include "app/commands.h"
#include "app/output.h"
#include "app/shared_arguments.h"
#include "report/results/result_plots.h"
#include "studies/planing/io/planing_files.h"
#include "studies/planing/planing_study.h"

namespace retrace::app {
namespace {

struct PlaneOptions {
  std::string part;
  std::string dialect = "rs274ngc";
};

std::vector<Argument> arguments(PlaneOptions& options) {
  return {part_argument(options.part), dialect_argument(options.dialect)};
}

ExitCode run(const PlaneOptions& options, const CommonOptions& common) {
  const studies::PlaningResult result = studies::plane(options.part, options.dialect);
  ResultFiles files(common, {options.part}, "planing.json");
  files.add_drawing("profile", [&] { return report::planing_profile_plot(result); });
  files.add_drawing("zones", [&] { return report::planing_zones_plot(result); });
  if (result.part.mill) {
    files.add("profile.csv", [&] { return studies::planing_csv(result); });
    files.add_drawing("form_error", [&] { return report::planing_error_plot(result); });
  }
  for (const fabrication::PlaningText& program : result.programs) files.add(program.name, [&] { return program.text; });
  files.prepare();
  return files.write(studies::planing_json(result), studies::planing_table(result), result.warnings,
                     {.is_yes = result.check.passes()});
}

}  // namespace

Command plane_command() {
  return {.name = "plane",
          .summary = "NC programs of a flat zone lens, planed or turned",
          .manual =
              "Writes NC programs of a flat zone lens, planed on a mill that moves one axis at a time or turned on a "
              "lathe, with the form error and the machining time. The programs are read back and compared with the "
              "profile; on a lathe, the spindle must rotate as the part's file requires. Exits with 1 if there are "
              "findings.",
          .reads = {"retrace.planed_part/1"},
          .writes = {"retrace.planing/2"},
          .refuses_set = "not allowed with plane, which reads no design; change the part file",
          .begin = begins<PlaneOptions>(arguments, run)};
}

}  // namespace retrace::app
