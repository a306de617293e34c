#include "retrace/rays.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/threads.h"
#include "library/content.h"
#include "studies/rays/io/ray_documents.h"
#include "studies/rays/io/ray_files.h"
#include "studies/rays/ray_accounts.h"
#include "studies/rays/ray_arrays.h"
#include "studies/rays/ray_study.h"

namespace retrace {
namespace {

/// Fills the members that the results of rays() and trace() have in common.
template <class Result>
void tell(const studies::RayResult& found, Result& result) {
  const double whole = found.ledger.incident > 0.0 ? found.ledger.incident : 1.0;
  for (std::size_t k = 0; k < raytrace::kAccountCount; ++k)
    if (raytrace::is_listed(static_cast<raytrace::Account>(k), found.ledger.ledger.power[k]))
      result.ledger.emplace(raytrace::kAccountNames[k], found.ledger.ledger.power[k] / whole);
  result.ledger.emplace(studies::kRayAccounts[studies::kMissedAccount], found.ledger.missed / whole);
  result.power = found.ledger.incident;
  result.warnings = found.warnings;
  result.complete = found.complete;
  result.json = studies::rays_json(found);
  result.table = studies::rays_table(found);
}

}  // namespace

RaysResult rays(const Design& design, const RaysRequest& request, const Running& running) {
  const studies::RayRequest settings = studies::resolve(request);
  const studies::RayStudy study(design.content().design, settings);
  std::optional<studies::Emitter> emitter;
  if (settings.emitter) emitter = study.emitter_of(*settings.emitter);
  if (!request.out.empty()) studies::check_ray_file(request.out, Field{"out"});
  const std::unique_ptr<studies::RaySource> source = emitter ? std::make_unique<studies::EmitterSource>(*emitter)
                                                             : studies::open_ray_file(request.source, Field{"source"});
  std::unique_ptr<studies::RaySink> sink;
  if (!request.out.empty()) sink = studies::make_ray_file(request.out, Field{"out"});
  studies::RayResult found;
  run_with_threads(running.threads,
                   [&] { found = study.run(*source, sink.get(), running.progress, running.cancellation); });
  found.source_name = request.source.string();
  found.emitter = emitter;
  found.out_name = request.out.string();
  RaysResult result;
  tell(found, result);
  return result;
}

std::vector<std::string> ray_accounts() {
  return {studies::kRayAccounts.begin(), studies::kRayAccounts.end()};
}

TracedRays trace(const Design& design, const RayArrays& rays, const TraceRequest& request, const Running& running) {
  const studies::RayStudy study(design.content().design, studies::resolve(request));
  studies::ArraySource source({rays.origins_mm, rays.directions, rays.stokes, rays.axes, rays.wavelengths_nm});
  studies::ArraySink sink(rays.origins_mm.size() / 3);
  studies::RayResult found;
  run_with_threads(running.threads, [&] { found = study.run(source, &sink, running.progress, running.cancellation); });
  TracedRays result;
  result.origins_mm = std::move(sink.origins_mm);
  result.directions = std::move(sink.directions);
  result.stokes = std::move(sink.stokes);
  result.axes = std::move(sink.axes);
  result.wavelengths_nm = std::move(sink.wavelengths_nm);
  result.accounts = std::move(sink.accounts);
  result.incident = std::move(sink.incident);
  tell(found, result);
  return result;
}

}  // namespace retrace
