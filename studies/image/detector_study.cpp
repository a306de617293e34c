#include "studies/image/detector_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/error.h"
#include "core/task_progress.h"
#include "raytrace/engines/wavelengths.h"
#include "requests/descriptions.h"

namespace retrace::studies {
namespace {

using geometry::Rectangle, geometry::Vec2;

// Maximum fraction of the power that remains untraced if light is traced as beams. It is too small to be visible in a
// picture.
constexpr double kTruncatedGoal = 1e-5;
// Maximum number of beams up to which the engine `auto` uses exact tracing. Tracing this number takes some seconds.
constexpr std::uint64_t kBeamsOfAutomatic = 1'000'000;

raytrace::Illumination illumination_of(const design::Design& design, const DetectorRequest& request) {
  return {Angle::from_deg(request.incidence_deg), Angle::from_deg(request.azimuth_deg), design.light.polarisation};
}

raytrace::ReturnFrame frame_of(const raytrace::Illumination& light) {
  raytrace::ReturnFrame frame;
  frame.to_source = raytrace::direction_to_source(light);
  frame.right = raytrace::source_axis(frame.to_source);
  frame.up = frame.to_source.cross(frame.right);
  return frame;
}

/// Returns a grid of square pixels over the face, with `longer` pixels along its longer side.
raytrace::PixelGrid face_grid(const geometry::Part& part, std::size_t longer) {
  const Rectangle bounds =
      part.period_mm ? Rectangle{Vec2::Zero(), *part.period_mm} : geometry::bounding_box(part.outline);
  const double pixel = bounds.size().maxCoeff() / static_cast<double>(longer);
  const auto count = [&](double length) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(length / pixel)));
  };
  return {bounds, count(bounds.size().x()), count(bounds.size().y())};
}

void add(std::vector<double>& sum, const std::vector<double>& more, double weight) {
  if (sum.empty()) sum.assign(more.size(), 0.0);
  for (std::size_t k = 0; k < more.size(); ++k) sum[k] += weight * more[k];
}

void add(raytrace::PixelValues& sum, const raytrace::PixelValues& more, double weight) {
  add(sum.value, more.value, weight);
  if (more.std_error.empty()) return;
  if (sum.std_error.empty()) sum.std_error.assign(more.value.size(), 0.0);
  for (std::size_t k = 0; k < more.std_error.size(); ++k)
    sum.std_error[k] = std::hypot(sum.std_error[k], weight * more.std_error[k]);
}

void add(raytrace::DetectorMaps& sum, const raytrace::DetectorMaps& more, double weight) {
  add(sum.leaving, more.leaving, weight);
  add(sum.entering, more.entering, weight);
  add(sum.per_sr, more.per_sr, weight);
  sum.outside += weight * more.outside;
  sum.rre += weight * more.rre;
  sum.truncated += weight * more.truncated;
  sum.std_error = std::hypot(sum.std_error, weight * more.std_error);
  sum.rays += more.rays;
  sum.complete = sum.complete && more.complete;
}

}  // namespace

DetectorStudy::DetectorStudy(design::Design design, DetectorRequest request)
    : design_(std::move(design)), request_(std::move(request)) {
  requests::check(request_);
  engine_ = raytrace::engine_from_name(request_.engine);
  model_ = design::make_model(design_, materials::MaterialLibrary::shipped());
  facts_ = design::engine_facts(design_, &model_.optics);
  if (const auto obstacle = raytrace::obstacle_for(raytrace::Engine::exact, facts_);
      obstacle && engine_ == raytrace::Engine::exact)
    throw InputError(design::position_of(design_, *obstacle),
                     fmt::format("{} cannot be traced exactly: use {} montecarlo", raytrace::subject_of(*obstacle),
                                 reference({"engine"})));
}

raytrace::DetectorMaps DetectorStudy::trace(const design::SpectralOptics& light,
                                            const raytrace::DetectorSetting& setting, std::size_t number, bool exact,
                                            Progress* progress, const Cancellation* cancel) const {
  const raytrace::Illumination illumination = illumination_of(design_, request_);
  if (!exact)
    return raytrace::sampled_detector_maps(
        model_.part, light.optics, illumination, setting,
        std::max<std::uint64_t>(1, request_.samples.value_or(kDefaultDetectorRays) / model_.spectral.size()),
        raytrace::seed_at(request_.seed, number), {}, progress, cancel);
  raytrace::BeamPolicy policy;
  policy.cutoff = request_.cutoff;
  policy.truncated_goal = kTruncatedGoal;
  if (engine_ == raytrace::Engine::automatic) policy.max_beams = kBeamsOfAutomatic;
  return raytrace::exact_detector_maps(model_.part, light.optics, illumination, setting, policy, cancel);
}

DetectorResult DetectorStudy::run(Progress* progress, const Cancellation* cancel) const {
  const auto start = std::chrono::steady_clock::now();
  DetectorResult result;
  result.design = design_;
  result.request = request_;
  result.warnings = model_.warnings;
  result.acceptance_half_angle_deg = design_.detector.acceptance_half_angle_deg.back();
  result.face = face_grid(model_.part, request_.pixels);
  result.is_period = model_.part.period_mm.has_value();
  const raytrace::DetectorSetting setting{
      result.face,
      {raytrace::DirectionGrid::Layout::square, Angle::from_deg(request_.window_deg).rad(), request_.angle_pixels,
       request_.angle_pixels},
      frame_of(illumination_of(design_, request_)),
      result.acceptance_half_angle_deg};
  bool exact = raytrace::is_exact(engine_, facts_);
  AttemptProgress attempt(progress);
  const auto trace_all = [&] {
    result.maps = {};
    const std::size_t wavelengths = model_.spectral.size();
    TaskProgress all(&attempt, wavelengths);
    raytrace::trace_wavelengths(1, wavelengths, false, all, [&](std::size_t, std::size_t k, Progress& task) {
      add(result.maps, trace(model_.spectral[k], setting, k, exact, &task, cancel), model_.spectral[k].weight);
      return result.maps.complete;
    });
  };
  try {
    trace_all();
  } catch (const BudgetError&) {
    if (!exact || engine_ == raytrace::Engine::exact) throw;
    exact = false;  // the exact engine needs too many beams
    attempt.begin_again();
    trace_all();
  }
  result.engine = exact ? "exact" : "embree";
  result.complete = result.maps.complete;
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace retrace::studies
