#include "studies/image/camera_study.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

#include "core/error.h"
#include "core/number_format.h"
#include "core/task_progress.h"
#include "design/engine_facts.h"
#include "design/io/design_reader.h"
#include "materials/io/spectrum_reader.h"
#include "requests/descriptions.h"
#include "studies/image/camera_setup.h"
#include "studies/image/io/background_reader.h"
#include "studies/image/io/dye_reader.h"
#include "studies/image/io/lamp_reader.h"
#include "studies/image/pass_ledger.h"

namespace retrace::studies {
namespace {

using geometry::Vec3;

// Number of spans of the spectrum for the light of the lamp, with two wavelengths each.
constexpr std::size_t kSpans = 2;
// Number of spans for the light of the surroundings in coloured parts. The paths of this light have different lengths,
// so that no small number of wavelengths represents all of them.
constexpr std::size_t kSpansOfSurroundings = 12;
// Range of the half angle around the lamp in which the returned light is diffracted, in degrees.
constexpr double kMinWindow_deg = 2.0, kMaxWindow_deg = 10.0;
// Part of the progress that the computation of the returned light takes.
constexpr double kProgressOfLight = 0.3;

std::optional<PhotometricLamp> lamp_of(const CameraRequest& r) {
  if (r.lamp.empty()) return std::nullopt;
  return read_lamp(r.lamp, Field{"lamp"});
}

PhotometrySettings photometry_of(const CameraRequest& r, const raytrace::CameraScene& scene) {
  PhotometrySettings settings;
  settings.area_cm2 = 1.0;
  settings.apertures = {scene.lamp.diameter, scene.view.pupil};
  settings.window_deg = std::clamp(angle_deg(to_eye(scene), to_lamp(scene)) + 1.0, kMinWindow_deg, kMaxWindow_deg);
  settings.light = light_from_name(r.light);
  settings.diffraction = r.diffraction;
  settings.seed = r.seed;
  return settings;
}

bool is_unpolarised(const raytrace::Stokes& s) {
  return s.q == 0.0 && s.u == 0.0 && s.v == 0.0;
}

}  // namespace

std::shared_ptr<const Background> background_of(const CameraRequest& request) {
  if (request.background.empty()) return nullptr;
  return std::make_shared<const Background>(read_background(request.background, Field{"background"}));
}

CameraStudy::CameraStudy(design::Design design, CameraRequest request, raytrace::DiscAverage discs,
                         std::shared_ptr<const Background> background)
    : design_(std::move(design)), request_(std::move(request)), background_(std::move(background)) {
  requests::check(request_);
  design::require_supported(design_, {.what = "a camera image",
                                      .balls = true,
                                      .solids = true,
                                      .entrances = true,
                                      .shells = true,
                                      .wet_backs = true,
                                      .cell_spreads = false});
  if (!design_.shells.empty() && design_.is_infinite())
    throw InputError(design_.where("array.extent"), "must be \"finite\" for camera images of a part behind shells");
  lamp_ = lamp_of(request_);
  const materials::SpectralCurve dye = read_dye(request_.dye);
  if (!background_) background_ = background_of(request_);
  if (!is_unpolarised(design_.light.polarisation))
    throw InputError({design_.source, 0, "light.polarisation"},
                     "camera images support only unpolarised light in this version: leave this key out");
  if (design_.surface.entrance.scatters())
    throw InputError(design_.where_entrance_scatters(),
                     "camera images do not support entrance faces that scatter light: use retrace rre, photometry or "
                     "image --detector");
  check_film(request_, design_.is_infinite());
  dyed_ = with_dye(design_, dye);
  if (!dye.values.empty()) set_where(dyed_, "body.absorption_per_mm", {request_.dye, 0, "absorption_per_mm"});
  model_ = design::make_model(dyed_, materials::MaterialLibrary::shipped());
  scene_ = scene_of(request_, lamp_, model_, design_.reference_axis());
  scene_.discs = discs;
  check_position(model_, scene_, scene_.view.eye_mm, {request_.eye_mm ? "eye_mm" : "observation_deg"}, "camera");
  check_position(model_, scene_, scene_.lamp.position_mm, {request_.lamp_mm ? "lamp_mm" : "v_deg"}, "lamp");
  const Vec3 view = (scene_.view.target_mm - scene_.view.eye_mm).normalized();
  if (view.cross(scene_.view.up).norm() < 1e-6) scene_.view.up = view.unitOrthogonal();
  check_luminances(scene_, lamp_.has_value());
  using enum PhotometricResponse;
  const PhotometrySettings photometry = photometry_of(request_, scene_);
  const bool has_colours = dyed_.substance.is_coloured() && photometry.light != PhotometricLight::of_design;
  for (const PhotometricResponse response : {y_bar, x_bar, z_bar})
    if (response == y_bar || has_colours)
      lights_.push_back(std::make_shared<const CameraLight>(dyed_, photometry, kSpans, response));
}

/// Tracers of all layers of a picture. The picture of a response is the sum of one or two layers: the light of the
/// lamp, and that of the surroundings if the part is coloured.
struct CameraStudy::Tracers {
  /// Tracers of the responses y, x and z, and then those of the surroundings for the same responses.
  std::vector<std::unique_ptr<const raytrace::CameraTracer>> layers;
  std::size_t responses = 1;  ///< number of responses: 1 or 3
  std::optional<NoDiffraction> no_diffraction;
  std::optional<double> r_a;
  double r_a_error = 0.0;

  /// Traces a pass of each response. Returns the passes one after the other, or nothing if tracing was cancelled.
  std::optional<std::vector<double>> pass(std::uint32_t number, const Cancellation* cancel) const {
    std::vector<double> all;
    for (std::size_t k = 0; k < responses; ++k) {
      std::optional<raytrace::CameraPass> sum = layers[k]->pass(number, cancel);
      if (!sum) return std::nullopt;
      if (layers.size() > responses) {
        const std::optional<raytrace::CameraPass> more = layers[responses + k]->pass(number, cancel);
        if (!more) return std::nullopt;
        const std::size_t pixels = sum->size() / 3;
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
          (*sum)[pixel] += (*more)[pixel];
          (*sum)[2 * pixels + pixel] += (*more)[2 * pixels + pixel];
        }
        sum->back() += more->back();
      }
      all.insert(all.end(), sum->begin(), sum->end());
    }
    return all;
  }
  /// Returns the result of pass() as the result of a task.
  std::optional<std::string> pass_bytes(std::uint64_t number, const Cancellation* cancel) const {
    const auto passes = pass(static_cast<std::uint32_t>(number), cancel);
    return passes ? std::optional(bytes_of(*passes)) : std::nullopt;
  }
};

namespace {

/// Returns the optics at wavelengths that represent the light of the surroundings for one response.
std::vector<raytrace::WeightedOptics> optics_of_surroundings(const design::Design& design, PhotometricLight light,
                                                             PhotometricResponse response,
                                                             const design::OpticalModel& model) {
  const materials::SpectralCurve seen = materials::shipped_colour_matching()[static_cast<std::size_t>(response)];
  const materials::Spectrum spectrum =
      materials::traced_spectrum(materials::resolved_spectrum(lamp_power(light), &seen), kSpansOfSurroundings);
  Warnings ignored;
  const materials::MaterialLibrary library = materials::MaterialLibrary::shipped();
  const design::OpticsOfDesign optics(design, library, ignored);
  std::vector<raytrace::WeightedOptics> all;
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    all.push_back({optics.at(spectrum.wavelengths_nm[k], model.wet_elements), spectrum.weights[k]});
  return all;
}

}  // namespace

std::shared_ptr<const CameraStudy::Tracers> CameraStudy::tracers(Progress* progress, const Cancellation* cancel) const {
  const auto tracers = std::make_shared<Tracers>();
  const bool by_cells = !raytrace::obstacle_for(raytrace::Engine::cell, design::engine_facts(dyed_, &model_.optics));
  const auto add = [&](const std::vector<raytrace::WeightedOptics>& optics, const raytrace::CameraScene& scene,
                       std::uint32_t seed) {
    tracers->layers.push_back(std::make_unique<const raytrace::CameraTracer>(
        model_.part, optics, scene, raytrace::kCameraPolicy, seed,
        by_cells ? raytrace::CameraEngine::fastest : raytrace::CameraEngine::embree, model_.curved_entrance()));
  };
  tracers->responses = lights_.size();
  const bool is_separate = lights_.size() > 1 && scene_.surroundings.has_light();
  const bool is_by_kernel = scene_.discs == raytrace::DiscAverage::kernel;
  for (std::size_t k = 0; k < lights_.size(); ++k) {
    const CameraLight& light = *lights_[k];
    const auto count = static_cast<double>(lights_.size());
    PartProgress part(progress, static_cast<double>(k) / count, static_cast<double>(k + 1) / count);
    std::optional<CameraLight::Returned> returned = light.without_diffraction();
    if (model_.entrance || !design_.shells.empty()) {
      tracers->no_diffraction = !request_.diffraction ? NoDiffraction(Undiffracted::not_requested)
                                : model_.entrance     ? NoDiffraction(raytrace::Obstacle::curved_entrance)
                                                      : NoDiffraction(Undiffracted::shells);
    } else if (!light.has_diffraction()) {
      tracers->no_diffraction = light.photometer().why_undiffracted();
    } else if (is_by_kernel && !tracers->no_diffraction) {
      try {
        returned = light.returned(model_.part, scene_, &part, cancel);
      } catch (const BudgetError&) {
        tracers->no_diffraction = Undiffracted::too_many_beams;
      }
    }
    if (!returned) return nullptr;
    if (returned->is_incomplete) tracers->no_diffraction = Undiffracted::unequal_cells;
    if (k == 0) {
      tracers->r_a = returned->r_a;
      tracers->r_a_error = returned->r_a_error;
    }
    raytrace::CameraScene scene = scene_;
    scene.correction = returned->correction;
    if (is_separate) scene.surroundings = {};
    add(light.optics(), scene, request_.seed);
  }
  if (!is_separate) return tracers;
  raytrace::CameraScene scene = scene_;
  scene.lamp.illuminance_lx = 0.0;
  using enum PhotometricResponse;
  for (const PhotometricResponse response : {y_bar, x_bar, z_bar})
    add(optics_of_surroundings(dyed_, light_from_name(request_.light), response, model_), scene, ~request_.seed);
  return tracers;
}

ComputeTask CameraStudy::passes() const {
  /// Tracers that the first pass makes. Thus, they are made where the process can be cancelled.
  struct Shared {
    std::mutex mutex;
    std::shared_ptr<const Tracers> tracers;
  };
  return [this, shared = std::make_shared<Shared>()](std::uint64_t number,
                                                     const Cancellation* cancel) -> std::optional<std::string> {
    std::shared_ptr<const Tracers> tracers;
    {
      const std::lock_guard lock(shared->mutex);
      if (!shared->tracers) shared->tracers = this->tracers(nullptr, cancel);
      tracers = shared->tracers;
    }
    return tracers ? tracers->pass_bytes(number, cancel) : std::nullopt;
  };
}

namespace {

/// Ledger of a process that was cancelled before its first pass.
class NoPasses : public TaskLedger {
 public:
  std::optional<std::uint64_t> take() override { return std::nullopt; }
  void give_back(std::uint64_t) override {}
  void finish(std::uint64_t, const std::string&) override {}
  bool is_finished() override { return false; }
};

/// Leaves a run of several processes without tracing a pass, so that the other processes can continue.
void leave(const DistributeTasks& distribute) {
  NoPasses none;
  distribute([](std::uint64_t, const Cancellation*) { return std::optional<std::string>(); }, none);
}

/// Adds the warnings of a complete picture.
void add_warnings(CameraResult& result) {
  const std::string name = result.design.source_name();
  const CameraRequest& request = result.request;
  const raytrace::CameraImage& image = result.image;
  if (!request.passes && image.relative_noise() > request.noise)
    result.warnings.push_back(
        {"noise_above_target",
         fmt::format("{}: the noise of {} is above the target of {} after {} passes. The target requires about {:.2g} "
                     "passes, but at most {} are made unless you set the number of passes",
                     name, fixed(image.relative_noise(), 4), shortest(request.noise), image.passes,
                     passes_needed(image, request), CameraStudy::kMaxPasses)});
  if (result.no_diffraction && request.diffraction)
    result.warnings.push_back(
        {"no_diffraction", fmt::format("{}: the light of the lamp is computed without diffraction: {}", name,
                                       text_of(*result.no_diffraction))});
  const double illuminance_lx = result.scene.lamp.illuminance_lx;
  const double returned = result.r_a ? *result.r_a / std::max(1e-9, to_eye(result.scene).normalized().z())
                                     : image.part_mean() / std::max(1e-300, illuminance_lx);
  // Without R_A, the returned light is taken from the picture, which also contains the light of the surroundings.
  const bool is_known = result.r_a || !result.scene.surroundings.has_light();
  if (illuminance_lx > 0.0 && is_known && returned < kMinRetroreflected)
    result.warnings.push_back(
        {"no_retroreflected_light",
         fmt::format(
             "{}: no retroreflected light reaches this eye: the luminance of the returned light is {} cd/m2 per "
             "lux at the centre, and that of a white wall is 0.32. Choose a smaller observation angle, or "
             "another direction of the lamp",
             name, fixed_visible(returned, 3))});
}

}  // namespace

CameraResult CameraStudy::empty_result() const {
  CameraResult result;
  result.design = design_;
  result.request = request_;
  result.lamp = lamp_;
  result.scene = scene_;
  result.background = background_;
  result.warnings = model_.warnings;
  result.observation_deg = angle_deg(to_eye(scene_), to_lamp(scene_));
  result.entrance_deg = angle_deg(to_lamp(scene_), Vec3::UnitZ());
  result.viewing_deg = angle_deg(to_eye(scene_), Vec3::UnitZ());
  return result;
}

CameraResult CameraStudy::result_with(const Numbers& numbers) const {
  CameraResult result = empty_result();
  result.no_diffraction = numbers.no_diffraction;
  result.r_a = numbers.r_a;
  result.r_a_error = numbers.r_a_error;
  result.complete = numbers.complete;
  result.elapsed_s = numbers.elapsed_s;
  if (numbers.images.empty()) return result;
  result.engine = numbers.is_by_cells ? "cell" : "embree";
  result.image = numbers.images.front();
  if (numbers.images.size() > 1)
    result.colours = colours_of(numbers.images, lamp_colour(light_from_name(request_.light)));
  if (result.complete) add_warnings(result);
  return result;
}

CameraStudy::Numbers CameraStudy::compute(Progress* progress, const Cancellation* cancel,
                                          const std::function<void(const CameraResult&)>& after_pass,
                                          const DistributeTasks& distribute) const {
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  Numbers numbers;
  PartProgress of_light(progress, 0.0, kProgressOfLight);
  const std::shared_ptr<const Tracers> tracers = this->tracers(&of_light, cancel);
  if (!tracers) {
    if (distribute) leave(distribute);
    numbers.elapsed_s = seconds();
    return numbers;
  }
  numbers.no_diffraction = tracers->no_diffraction;
  numbers.r_a = tracers->r_a;
  numbers.r_a_error = tracers->r_a_error;
  numbers.is_by_cells = tracers->layers.front()->is_by_cells();
  numbers.images.assign(tracers->responses, tracers->layers.front()->empty_image());
  const std::function<void()> preview = [&] {
    if (after_pass) after_pass(result_with(numbers));
  };
  PartProgress of_passes(progress, kProgressOfLight, 1.0);
  PassLedger ledger(request_, numbers.images, &of_passes, preview);
  if (distribute) {
    distribute([tracers](std::uint64_t number, const Cancellation* stop) { return tracers->pass_bytes(number, stop); },
               ledger);
  } else {
    while (!ledger.is_finished()) {
      const auto pass = tracers->pass(numbers.images.front().passes, cancel);
      if (!pass) break;
      ledger.add(*pass);
    }
  }
  numbers.complete = ledger.is_finished();
  numbers.elapsed_s = seconds();
  return numbers;
}

CameraResult CameraStudy::run(Progress* progress, const Cancellation* cancel,
                              const std::function<void(const CameraResult&)>& after_pass,
                              const DistributeTasks& distribute) const {
  return result_with(compute(progress, cancel, after_pass, distribute));
}

std::optional<std::string> CameraStudy::run_to_bytes(const Cancellation* cancel) const {
  const Numbers numbers = compute(nullptr, cancel, {}, {});
  if (!numbers.complete) return std::nullopt;
  const auto* undiffracted = numbers.no_diffraction ? std::get_if<Undiffracted>(&*numbers.no_diffraction) : nullptr;
  const auto* obstacle = numbers.no_diffraction ? std::get_if<raytrace::Obstacle>(&*numbers.no_diffraction) : nullptr;
  // Missing numbers are stored as -1.
  std::vector<double> all = {numbers.r_a.value_or(-1.0),
                             numbers.r_a_error,
                             undiffracted != nullptr ? static_cast<double>(*undiffracted) : -1.0,
                             obstacle != nullptr ? static_cast<double>(*obstacle) : -1.0,
                             numbers.is_by_cells ? 1.0 : 0.0,
                             numbers.elapsed_s};
  for (const raytrace::CameraImage& image : numbers.images) {
    all.insert(all.end(), {static_cast<double>(image.passes), static_cast<double>(image.part_means.size())});
    for (const auto* values : {&image.part_means, &image.luminance, &image.squares, &image.coverage, &image.paths})
      all.insert(all.end(), values->begin(), values->end());
  }
  return bytes_of(all);
}

CameraResult CameraStudy::result_of(const std::string& bytes) const {
  const std::vector<double> all = numbers_of(bytes);
  auto at = all.begin();
  const auto next = [&] { return *at++; };
  Numbers numbers;
  numbers.complete = true;
  if (const double r_a = next(); r_a >= 0.0) numbers.r_a = r_a;
  numbers.r_a_error = next();
  if (const double reason = next(); reason >= 0.0)
    numbers.no_diffraction = static_cast<Undiffracted>(static_cast<int>(reason));
  if (const double obstacle = next(); obstacle >= 0.0)
    numbers.no_diffraction = static_cast<raytrace::Obstacle>(static_cast<int>(obstacle));
  numbers.is_by_cells = next() > 0.0;
  numbers.elapsed_s = next();
  const std::size_t pixels = request_.columns * request_.rows;
  while (at != all.end()) {
    raytrace::CameraImage image;
    image.columns = request_.columns;
    image.rows = request_.rows;
    image.passes = static_cast<std::uint32_t>(next());
    const auto means = static_cast<std::size_t>(next());
    const auto take = [&](std::vector<double>& values, std::size_t count) {
      values.assign(at, at + static_cast<std::ptrdiff_t>(count));
      at += static_cast<std::ptrdiff_t>(count);
    };
    take(image.part_means, means);
    for (auto* values : {&image.luminance, &image.squares, &image.coverage, &image.paths}) take(*values, pixels);
    numbers.images.push_back(std::move(image));
  }
  return result_with(numbers);
}

}  // namespace retrace::studies
