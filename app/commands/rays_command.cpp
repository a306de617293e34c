#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/shared_arguments.h"
#include "core/message_text.h"
#include "core/text.h"
#include "studies/design/io/design_reader.h"
#include "studies/rays/io/ray_documents.h"
#include "studies/rays/io/ray_files.h"
#include "studies/rays/ray_study.h"

namespace retrace::app {
namespace {

struct RaysOptions {
  std::string design;
  std::optional<std::string> source;
  std::optional<std::string> emitter;
  std::optional<double> disc_mm;
  std::optional<double> half_angle_deg;
  std::optional<std::uint64_t> rays;
  std::optional<double> power;
  std::optional<std::string> at_mm;
  std::optional<std::string> aim_mm;
  studies::RayRequest request;
};

constexpr std::uint64_t kUsualRays = 1'000'000;

std::vector<Argument> arguments(RaysOptions& o) {
  const Words emitters(studies::kEmitterNames.begin(), studies::kEmitterNames.end());
  const auto of_emitter = [](Traits traits = {}) {
    traits.needs = {any_given({"--emitter"})};
    return traits;
  };
  const Traits of_file = {.needs = {any_given({"--out"})}};
  Traits no_file = one_of(emitters);
  no_file.excludes = "--source";
  return {
      design_argument(o.design),
      {"--source FILE", "rays to trace: IES TM-25 (.tm25ray) or a table (.csv)", &o.source, files("")},
      {"--emitter KIND", "disc that emits rays, instead of --source", &o.emitter, no_file},
      {"--rays N", fmt::format("emitter: number of rays [{}]", kUsualRays), &o.rays,
       of_emitter(whole(1, studies::kMaxEmitterRays))},
      {"--disc-mm D",
       "diameter of the emitter [default: 0, a point; collimated light: the size of the part or of one period]",
       &o.disc_mm, of_emitter()},
      {"--half-angle-deg A",
       "emitter: half angle of its cone; gaussian: where its light falls to exp(-2) [lambertian: 90, others: 0]",
       &o.half_angle_deg, of_emitter()},
      {"--power P", "emitter: total power of its rays, in W, or in lm if the design's light is weighted by the eye [1]",
       &o.power, of_emitter()},
      {"--incidence T", "angle between the part's normal and the source, which is aimed at the centre of the face",
       &o.request.placement.incidence_deg},
      {"--azimuth P", "azimuth of the source", &o.request.placement.azimuth_deg},
      {"--distance-mm D", "distance of the source from the centre of the face [10]", &o.request.placement.distance_mm},
      {"--at-mm X,Y,Z", "position of the source's origin, instead of angles and distance [files: the part's origin]",
       &o.at_mm},
      {"--aim-mm X,Y,Z", "point at which the source's +z axis is aimed [files: parallel to the part's +z axis]",
       &o.aim_mm},
      {"--split W", "minimum power, as a fraction of the launched ray, for following both branches; 1: never",
       &o.request.split},
      {"--cutoff W", "minimum power of a branch that is followed, as a fraction of the launched ray",
       &o.request.cutoff},
      {"--stokes", "write polarisation even if the source has none", &o.request.stokes, of_file},
      {"--keep-missed", "also write rays that miss the part", &o.request.keep_missed, of_file}};
}

std::optional<std::array<double, 3>> place_of(const std::optional<std::string>& text, const char* option) {
  if (!text) return std::nullopt;
  std::array<double, 3> place{};
  const std::vector<std::string_view> parts = split(*text, ',');
  for (std::size_t k = 0; k < place.size() && parts.size() == 3; ++k) place[k] = number_in(parts[k]).value_or(NAN);
  if (parts.size() != 3 || !std::isfinite(place[0] + place[1] + place[2]))
    throw InputError({"", 0, option}, fmt::format("must be three numbers X,Y,Z in mm, got {}", in_quotes(*text)));
  return place;
}

studies::RayRequest request_of(const RaysOptions& options, const CommonOptions& common) {
  studies::RayRequest request = options.request;
  request.placement.at_mm = place_of(options.at_mm, "--at-mm");
  request.placement.aim_mm = place_of(options.aim_mm, "--aim-mm");
  request.seed = common.seed;
  if (options.emitter) request.placement.face_part();
  return request;
}

studies::EmitterRequest emitter_request(const RaysOptions& options) {
  studies::EmitterRequest request;
  request.kind = studies::emitter_from_name(*options.emitter);
  request.disc_mm = options.disc_mm;
  request.half_angle_deg = options.half_angle_deg;
  request.power = options.power.value_or(1.0);
  request.rays = options.rays.value_or(kUsualRays);
  return request;
}

ExitCode run(const RaysOptions& options, const CommonOptions& common) {
  if (!options.source && !options.emitter)
    throw InputError("rays: one of --source and --emitter is required; see retrace rays --help");
  const studies::RayStudy study(studies::read_design(options.design, common.overrides), request_of(options, common));
  std::vector<std::string> inputs = files_read({study.design()});
  if (options.source) inputs.push_back(*options.source);
  ResultFiles files(without_folder(common), inputs);
  files.add_named("--out", common.out, {});
  if (!common.out.empty()) studies::check_ray_file(common.out, "--out");
  std::optional<studies::Emitter> emitter;
  if (options.emitter) emitter = study.emitter_of(emitter_request(options));
  const std::unique_ptr<studies::RaySource> source = emitter ? std::make_unique<studies::EmitterSource>(*emitter)
                                                             : studies::open_ray_file(*options.source, "--source");
  files.prepare();
  const OrderlyInterrupt interrupt;
  std::unique_ptr<studies::RaySink> sink;
  if (!common.out.empty()) sink = studies::make_ray_file(common.out, "--out");
  studies::RayResult result;
  const Words to_shorten = {emitter ? fmt::format("give fewer --rays (now {})", emitter->rays)
                                    : "give a --source with fewer rays"};
  interrupt.run(common, {"tracing", to_shorten}, [&](Progress* bar, const Cancellation* cancel) {
    result = study.run(*source, sink.get(), bar, cancel);
  });
  result.source_name = options.source.value_or("");
  result.emitter = emitter;
  result.out_name = common.out;
  const std::string wrote = common.out.empty() ? "" : wrote_line(common.out);
  return files.write(studies::rays_json(result), studies::rays_table(result) + wrote, result.warnings,
                     {.complete = result.complete, .interrupted = "the rays that were traced are written"});
}

}  // namespace

Command rays_command() {
  return {
      .name = "rays",
      .summary = "what becomes of the rays of a file or an emitter",
      .manual =
          "Traces the rays of a file (IES TM-25, or a table), or of an emitter, and writes every ray that leaves the "
          "part with its account to the file of `--out`, in the format of its ending. Places are those of the "
          "part's frame, in mm; a source is moved and turned by `--at-mm` and `--aim-mm`, or by `--incidence`, "
          "`--azimuth` and `--distance-mm`.\n\nMemory does not grow with the number of rays.",
      .reads = {"retrace.design/1", "rays (IES TM-25, CSV)"},
      .writes = {"retrace.rays/1", "rays (IES TM-25, CSV)"},
      .begin = begins<RaysOptions>(arguments, run)};
}

}  // namespace retrace::app
