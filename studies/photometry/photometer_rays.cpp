// Members of Photometer that measure by tracing rays (Monte Carlo).
#include <algorithm>

#include "core/task_progress.h"
#include "raytrace/balls/ball_tracer.h"
#include "raytrace/engines/wavelengths.h"
#include "raytrace/paths/monte_carlo.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {

Photometer::WavelengthReading Photometer::measure_by_rays(const PhotometerSetting& setting, std::size_t wavelength,
                                                          const raytrace::MonteCarlo* tracer, Progress& progress,
                                                          const Cancellation* cancel) const {
  const design::SpectralOptics& light = model_.spectral[wavelength];
  const raytrace::ReturnFrame frame = frame_of(setting);
  const raytrace::SourceAngles source = raytrace::source_angles(frame.to_source);
  raytrace::DirectionScore score{frame, kernel_, {}, {}};
  for (const double observation_deg : setting.observation_deg)
    score.receivers.push_back(frame.direction({0.0, Angle::from_deg(observation_deg).rad()}));
  if (setting.map_columns > 0)
    score.grid.emplace(raytrace::DirectionGrid::Layout::square, Angle::from_deg(request_.window_deg).rad(),
                       setting.map_columns, setting.map_columns);
  raytrace::Sampling sampling;
  sampling.seed = raytrace::seed_at(request_.seed, wavelength);
  sampling.rays = std::max<std::uint64_t>(1, request_.rays.value_or(kDefaultRaysPerDirection) / model_.spectral.size());
  const raytrace::Illumination illumination{source.incidence, source.azimuth, design_.light.polarisation};
  const std::vector<double>& cones = design_.detector.acceptance_half_angle_deg;
  raytrace::MonteCarloResult traced =
      tracer != nullptr ? tracer->trace(light.optics, illumination, cones, sampling, {}, cancel, &score, &progress)
                        : raytrace::BallTracer(*design_.balls())
                              .trace(light.optics, illumination, cones, sampling, {}, cancel, &score, &progress);
  WavelengthReading piece;
  if (!traced.complete) return piece;
  const auto receivers = static_cast<std::ptrdiff_t>(score.receivers.size());
  // Intensities refer to the power on the area of the part. Behind lenses, this power differs from the incident power.
  for (std::vector<double>* const sums : {&traced.score, &traced.score_error})
    for (double& value : *sums) value *= traced.beam_area_ratio;
  piece.rre = traced.cones.back().rre;
  piece.std_error = traced.cones.back().std_error;
  piece.truncated = traced.cones.back().ledger[raytrace::Account::truncated];
  piece.per_sr.assign(traced.score.begin(), traced.score.begin() + receivers);
  piece.error_per_sr.assign(traced.score_error.begin(), traced.score_error.begin() + receivers);
  // The standard error from the spread of the replicates does not cover light on paths that no ray has taken.
  // with_unsampled_paths() adds an allowance for this light. A single ray contributes at most its power times the
  // maximum of the receiver's kernel.
  for (double& error : piece.error_per_sr)
    error = raytrace::with_unsampled_paths(raytrace::student_factor(raytrace::Sampling::kReplicates) * error,
                                           static_cast<double>(traced.rays), kernel_.per_sr(0.0));
  if (score.grid)
    for (std::size_t bin = 0; bin < score.grid->size(); ++bin)
      piece.map_per_sr.push_back(traced.score[score.receivers.size() + bin] / score.grid->solid_angle_sr(bin));
  piece.complete = true;
  return piece;
}

bool Photometer::measure_by_rays(const std::vector<PhotometerSetting>& settings, Progress* progress,
                                 const Cancellation* cancel,
                                 std::vector<std::vector<WavelengthReading>>& pieces) const {
  std::optional<raytrace::MonteCarlo> tracer;
  if (!design_.balls())
    tracer.emplace(model_.part, raytrace::MonteCarlo::Engine::embree, model_.entrance ? &*model_.entrance : nullptr);
  const std::size_t wavelengths = model_.spectral.size();
  TaskProgress all(progress, settings.size() * wavelengths);
  return raytrace::trace_wavelengths(
      settings.size(), wavelengths, false, all, [&](std::size_t setting, std::size_t wavelength, Progress& task) {
        if (is_cancelled(cancel)) return false;
        pieces[setting][wavelength] =
            measure_by_rays(settings[setting], wavelength, tracer ? &*tracer : nullptr, task, cancel);
        return true;
      });
}

}  // namespace retrace::studies
