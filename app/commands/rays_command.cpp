#include <fmt/format.h>

#include <array>
#include <memory>
#include <utility>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/request_options.h"
#include "app/shared_arguments.h"
#include "design/io/design_reader.h"
#include "requests/descriptions.h"
#include "studies/rays/io/ray_documents.h"
#include "studies/rays/io/ray_files.h"
#include "studies/rays/ray_study.h"

namespace retrace::app {
namespace {

struct RaysOptions {
  std::string design;
  FieldTexts fields;
};

std::vector<Argument> arguments(RaysOptions& options) {
  std::vector<Argument> all = {design_argument(options.design)};
  const std::array<CommandRequest, 1> of_command = {{{requests::description<RaysRequest>()}}};
  for (Argument& argument : field_arguments(of_command, options.fields)) all.push_back(std::move(argument));
  return all;
}

ExitCode run(const RaysOptions& options, const CommonOptions& common) {
  design::Design design = design::read_design(options.design, common.overrides);
  auto request = request_of<RaysRequest>(options.fields, common);
  request.out = common.out;
  const studies::RayRequest settings = studies::resolve(request);
  const studies::RayStudy study(std::move(design), settings);
  std::vector<std::string> inputs = files_read({study.design()});
  if (!request.source.empty()) inputs.push_back(request.source.string());
  ResultFiles files(without_folder(common), inputs);
  files.add_named("--out", common.out, {});
  if (!request.out.empty()) studies::check_ray_file(request.out, Field{"out"});
  std::optional<studies::Emitter> emitter;
  if (settings.emitter) emitter = study.emitter_of(*settings.emitter);
  const std::unique_ptr<studies::RaySource> source = emitter ? std::make_unique<studies::EmitterSource>(*emitter)
                                                             : studies::open_ray_file(request.source, Field{"source"});
  files.prepare();
  const OrderlyInterrupt interrupt;
  std::unique_ptr<studies::RaySink> sink;
  if (!request.out.empty()) sink = studies::make_ray_file(request.out, Field{"out"});
  studies::RayResult result;
  const Words to_shorten = {emitter ? fmt::format("give fewer --rays (now {})", emitter->rays)
                                    : "give a --source with fewer rays"};
  interrupt.run(common, {"tracing", to_shorten}, [&](Progress* bar, const Cancellation* cancel) {
    result = study.run(*source, sink.get(), bar, cancel);
  });
  result.source_name = request.source.string();
  result.emitter = emitter;
  result.out_name = common.out;
  const std::string wrote = common.out.empty() ? "" : wrote_line(common.out);
  return files.write(studies::rays_json(result), studies::rays_table(result) + wrote, result.warnings,
                     {.complete = result.complete, .interrupted = "the rays that were traced are written"});
}

}  // namespace

Command rays_command() {
  return {.name = "rays",
          .summary = "paths of the rays of a file or an emitter",
          .manual =
              "Traces the rays of a file (IES TM-25, or a table), or of an emitter. Writes every ray that leaves the "
              "part to the file of `--out`, with the term of the ledger to which it belongs. The extension of the file "
              "selects the format. Positions "
              "are in the frame of the part, in mm. A source is moved and rotated by `--at-mm` and `--aim-mm`, or by "
              "`--incidence`, `--azimuth` and `--distance-mm`.\n\nThe memory does not depend on the number of rays.",
          .reads = {"retrace.design/1", "rays (IES TM-25, CSV)"},
          .writes = {"retrace.rays/1", "rays (IES TM-25, CSV)"},
          .begin = begins<RaysOptions>(arguments, run)};
}

}  // namespace retrace::app
