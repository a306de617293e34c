// Members of Photometer that measure behind a curved entrance surface. The light of each sampled element is traced as
// beams through a tangent plane of the surface (docs/theory/fronts.md).
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/error.h"
#include "core/task_progress.h"
#include "core/within_memory.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/observers/element_light.h"
#include "raytrace/observers/surface_reflection.h"
#include "studies/photometry/element_sample.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {
namespace {

using geometry::Vec3, raytrace::ReturnFrame;

// Maximum number of pairs of an element and a wavelength that are traced for one direction of light.
constexpr std::size_t kSamples = 96;
// Maximum number of pairs in preliminary measurements and in searches, where kSamples would take too long.
constexpr std::size_t kFewSamples = 32;
// Minimum number of pairs. It applies to maps and to settings with many observation angles, for which each pair takes
// long.
constexpr std::size_t kMinSamples = 24;
// Number of observation angles that take as much computing time as the map of one direction.
constexpr double kAnglesOfMap = 8.0;
// Maximum number of observation angles for which the full number of pairs is traced.
constexpr double kAnglesOfSamples = 8.0;
// Maximum number of samples for which the light that rough facets scatter is computed. A sample is a pair of element
// and wavelength. Scattered light varies slowly from element to element, but its computation takes several times as
// long as the mean field.
constexpr std::size_t kScatterSamples = 24;
// Every kComparedSamples-th sample is compared with rays.
constexpr std::size_t kComparedSamples = 6;
// Minimum power of beams that are compared with rays. It is relative to the light that an element would return if
// absorption in the body were the only loss.
constexpr double kMinComparedPower = 1e-3;
// Maximum angle between exact rays and the tangent-plane model, as a fraction of the sum of the radii of source and
// receiver. At this limit, readings are wrong by less than about 1 %.
constexpr double kMaxAngleFraction = 0.1;
// Minimum trace of ReturnedBeam::entry_from_exit for beams that belong to a mirror image.
constexpr double kMinTraceOfMirror = 1.0;
// Number of points along each axis at which the reflection at the outer side of the surface is sampled, for maps and
// RRE.
constexpr std::size_t kReflectionColumns = 256;

/// Returns the frame of a setting, mapped to the equivalent direction of light that is traced.
ReturnFrame traced_frame(const PhotometerSetting& setting, const SharedDirection& shared) {
  const ReturnFrame frame = frame_of(setting);
  return {shared.mapped(frame.to_source), shared.mapped(frame.right), shared.mapped(frame.up)};
}

Vec3 towards_receiver(const ReturnFrame& frame, double observation_deg) {
  return frame.direction({0.0, Angle::from_deg(observation_deg).rad()});
}

raytrace::DirectionGrid grid_of_map(const PhotometerSetting& setting, double window_deg) {
  return {raytrace::DirectionGrid::Layout::square, Angle::from_deg(window_deg).rad(), setting.map_columns,
          setting.map_columns};
}

/// Returns true if a direction is inside the cone about another direction.
bool is_within(const Vec3& direction, const Vec3& axis, double half_angle_deg) {
  return (direction - axis).norm() <= 2.0 * std::sin(0.5 * Angle::from_deg(half_angle_deg).rad()) * (1.0 + 1e-9);
}

/// Estimates the sum of a quantity over all elements and wavelengths.
/// \param value returns the quantity for the reading of one sample
template <class Readings, class Value>
SampledSum sum_of(const ElementSample& sample, const Readings& readings, const Value& value) {
  std::vector<double> values;
  for (const auto& reading : readings) values.push_back(value(reading));
  return sample.sum(values);
}

/// Power of returned beams in an acceptance cone.
struct ConePower {
  double returned = 0.0;
  double scattered_out = 0.0;  ///< power that rough facets scatter out of the beams in the cone

  /// Adds the power of a beam, spread over its directions.
  void add(const raytrace::ReturnedBeam& beam, const Vec3& axis, double half_angle_deg) {
    double variance = 0.0;
    for (const raytrace::TexturedHit& hit : beam.hits) variance += hit.phase.variance();
    for (const raytrace::DirectionSample& sample : spread_directions(beam))
      if (is_within(sample.direction, axis, half_angle_deg)) {
        returned += sample.power_fraction * beam.stokes.i;
        scattered_out -= std::expm1(-variance) * sample.power_fraction * beam.stokes.i;
      }
  }
};

}  // namespace

double Photometer::body_transmittance(std::size_t wavelength) const {
  const double path_mm = 2.0 * (model_.part.thickness_mm + model_.part.element_depth_mm);
  return std::exp(-model_.spectral[wavelength].optics.absorption_per_mm * path_mm);
}

std::size_t Photometer::max_element_samples(const std::vector<PhotometerSetting>& settings) const {
  double angles = 0.0;
  for (const PhotometerSetting& setting : settings)
    angles = std::max(
        angles, static_cast<double>(setting.observation_deg.size()) + (setting.map_columns > 0 ? kAnglesOfMap : 0.0));
  const std::size_t usual = effort_ == Effort::full ? kSamples : kFewSamples;
  const double wanted = static_cast<double>(usual) * std::min(1.0, kAnglesOfSamples / std::max(1.0, angles));
  return std::max(kMinSamples, static_cast<std::size_t>(wanted));
}

void Photometer::add_surface_reflection(const PhotometerSetting& setting, const SharedDirection& shared,
                                        const raytrace::ElementLight& elements, WavelengthReading& sum) const {
  if (!has_front_reflection_ || !has_mirror_image_ || design_.idealisation.lossless_entrance) return;
  const ReturnFrame frame = traced_frame(setting, shared);
  const auto reflectance = [&](const Vec3& normal) {
    const Vec3 reflected = raytrace::mirrored(-frame.to_source, normal);
    double power = 0.0;
    for (std::size_t w = 0; w < model_.spectral.size(); ++w) {
      const raytrace::Optics& optics = model_.spectral[w].optics;
      raytrace::Light light = raytrace::light_of_beam(design_.light.polarisation, frame.to_source);
      pass_plates(optics.shells, raytrace::ShellPassage::to_part, -frame.to_source, light);
      light.rotate_basis_to_interface(-frame.to_source, normal);
      light = light.reflected(fresnel_at_entrance(optics, false, normal.dot(frame.to_source)));
      pass_plates(optics.shells, raytrace::ShellPassage::from_part, reflected, light);
      power += weights_[w] * light.power();
    }
    return power;
  };
  const geometry::Polygon& outline = model_.part.outline;
  for (std::size_t k = 0; k < setting.observation_deg.size(); ++k)
    sum.per_sr[k] += reflected_per_sr(elements.surface(), outline, elements.beam_plane(), frame.to_source,
                                      towards_receiver(frame, setting.observation_deg[k]), kernel_, reflectance);
  std::optional<raytrace::DirectionGrid> grid;
  if (setting.map_columns > 0) grid = grid_of_map(setting, request_.window_deg);
  raytrace::visit_reflected(
      elements.surface(), outline, elements.beam_plane(), frame.to_source, kReflectionColumns, reflectance,
      [&](const Vec3& direction, double power) {
        if (is_within(direction, frame.to_source, design_.detector.acceptance_half_angle_deg.back())) sum.rre += power;
        if (!grid) return;
        const std::optional<std::size_t> bin = grid->bin_of(frame.angles_rad(direction));
        if (bin) sum.map_per_sr[*bin] += power / grid->solid_angle_sr(*bin);
      });
}

/// Measurement of settings behind a curved entrance surface. Beams are traced at a sample of the elements.
class Photometer::SurfaceMeasurement {
 public:
  /// Selects the elements and wavelengths that are traced. All arguments must outlive this object.
  SurfaceMeasurement(const Photometer& photometer, const std::vector<PhotometerSetting>& settings,
                     const Cancellation* cancel);

  /// Traces the samples of all directions.
  /// \throw BudgetError if the engine is `auto` and the tangent-plane model deviates too much from rays
  void trace(Progress* progress);
  /// Returns the readings of all settings, or nothing if the measurement was cancelled.
  std::optional<std::vector<PhotometerReading>> readings() const;

 private:
  /// Reading of one sampled element at one wavelength, for all settings with the same direction of light.
  struct ElementReading {
    std::vector<WavelengthReading> pieces;  ///< one for each setting, divided by the light on the element
    raytrace::TangentError error;
    bool is_complete = false;
  };
  /// Traced samples for one direction of light and their readings. A sample is a pair of element and wavelength.
  struct SampledReadings {
    std::unique_ptr<const ElementSample> sample;
    std::vector<ElementReading> readings;
  };
  /// Settings that have the same direction of light, and the samples that are traced for this direction.
  struct Direction {
    EquivalentDirections alike;
    std::size_t lit_elements = 0;
    SampledReadings mean;       ///< light that rough facets do not scatter
    SampledReadings scattered;  ///< light that rough facets scatter; no samples if all facets are smooth
  };
  /// Sample that is traced for one direction of light.
  struct SampleTask {
    std::size_t direction = 0;  ///< index of the direction
    std::size_t sample = 0;     ///< index of the sample of this direction
    bool is_scattered = false;  ///< true: the sample belongs to Direction::scattered

    /// Returns true if the tangent-plane model is compared with rays for this sample.
    bool compares_rays() const { return !is_scattered && sample % kComparedSamples == 0; }
  };
  /// Portion of an element's light that is measured.
  enum class MeasuredLight {
    mean,     ///< only light that rough facets do not scatter (the mean field)
    complete  ///< all light, including the light that rough facets scatter
  };
  /// Far field of one element, and the ratios that estimate the light that is missing in it.
  struct ElementField {
    const raytrace::FarField& field;
    double truncated = 0.0;  ///< truncated power, divided by the returned power
    double unplaced = 0.0;   ///< scattered power of unknown direction, divided by all scattered power
    /// Factor that converts powers of the excerpt to fractions of the light on the element, divided by the
    /// transmittance of the body.
    double factor = 0.0;
  };

  /// Adds the settings of one direction of light, and selects the sample that is traced for them.
  void add_direction(EquivalentDirections alike);
  /// Traces the tasks from index `from` to index `to`, exclusive, in parallel.
  void trace_tasks(std::size_t from, std::size_t to, TaskProgress& all);
  /// Measures one sample.
  /// \param compares_rays true: the tangent-plane model is compared with rays
  ElementReading measure_element(const EquivalentDirections& directions, const SampledElement& sampled,
                                 MeasuredLight measured, bool compares_rays) const;
  /// Measures the light that rough facets scatter, as the difference between all light and the mean field.
  ElementReading measure_scattered(const EquivalentDirections& directions, const SampledElement& sampled) const;
  /// Returns readings without light, one for each setting.
  std::vector<WavelengthReading> dark_pieces(const EquivalentDirections& directions) const;
  /// Evaluates the far field of an element for one setting.
  /// \param piece reading that contains the powers of all directions, not yet multiplied by ElementField::factor
  WavelengthReading read_element(const SharedDirection& shared, const raytrace::ElementScene& scene,
                                 const ElementField& element, WavelengthReading piece) const;
  /// Estimates the reading of one setting, for all elements and wavelengths.
  /// \param s index of the setting in Direction::alike
  WavelengthReading sum_of_samples(const Direction& one, std::size_t s) const;
  /// Describes the tangent-plane model of the settings of one direction.
  EntranceModel entrance_model(const Direction& one, const raytrace::TangentError& error) const;
  /// Returns the maximum allowed angle between rays and the tangent-plane model.
  double allowed_rad() const { return kMaxAngleFraction * photometer_.kernel_.reach_rad(); }

  const Photometer& photometer_;
  const std::vector<PhotometerSetting>& settings_;
  const Cancellation* cancel_;
  raytrace::ElementLight elements_;
  std::vector<Direction> directions_;
  std::vector<SampleTask> tasks_;
};

Photometer::SurfaceMeasurement::SurfaceMeasurement(const Photometer& photometer,
                                                   const std::vector<PhotometerSetting>& settings,
                                                   const Cancellation* cancel)
    : photometer_(photometer),
      settings_(settings),
      cancel_(cancel),
      elements_(photometer.model_.part, std::get<0>(*photometer.model_.entrance)) {
  for (EquivalentDirections& alike : photometer_.group_equivalent_settings(settings_)) add_direction(std::move(alike));
}

void Photometer::SurfaceMeasurement::add_direction(EquivalentDirections alike) {
  const design::OpticalModel& model = photometer_.model_;
  std::vector<double> weights = photometer_.weights_;
  for (std::size_t w = 0; w < weights.size(); ++w) weights[w] *= photometer_.body_transmittance(w);
  Direction& one = directions_.emplace_back();
  one.alike = std::move(alike);
  std::vector<PhotometerSetting> own;
  for (const SharedDirection& shared : one.alike) own.push_back(settings_[shared.index]);
  const double index = model.spectral[model.nearest_wavelength()].optics.index;
  const std::vector<raytrace::ElementPortion> portions = elements_.portions(frame_of(own.front()).to_source, index);
  one.lit_elements = static_cast<std::size_t>(std::count_if(
      portions.begin(), portions.end(), [](const raytrace::ElementPortion& p) { return p.fraction > 0.0; }));
  const auto add_sample = [&](SampledReadings& into, std::size_t max_count, bool is_scattered) {
    into.sample = std::make_unique<const ElementSample>(portions, weights, max_count);
    into.readings.resize(into.sample->samples().size());
    for (std::size_t k = 0; k < into.readings.size(); ++k) tasks_.push_back({directions_.size() - 1, k, is_scattered});
  };
  const std::size_t count = photometer_.max_element_samples(own);
  add_sample(one.mean, count, false);
  if (photometer_.keeps_phases()) add_sample(one.scattered, std::min(count, kScatterSamples), true);
}

void Photometer::SurfaceMeasurement::trace(Progress* progress) {
  // Samples that are compared with rays come first. If the comparison fails for one of them, no further samples are
  // traced.
  const auto first_other =
      std::stable_partition(tasks_.begin(), tasks_.end(), [](const SampleTask& task) { return task.compares_rays(); });
  TaskProgress all(progress, std::max<std::size_t>(1, tasks_.size()));
  const auto checked = static_cast<std::size_t>(first_other - tasks_.begin());
  trace_tasks(0, checked, all);
  for (const Direction& one : directions_)
    for (const ElementReading& reading : one.mean.readings)
      if (photometer_.request_.engine == raytrace::Engine::automatic &&
          !(reading.error.max_angle_rad() <= allowed_rad()))
        throw BudgetError(text_of(Undiffracted::strong_curvature));
  trace_tasks(checked, tasks_.size(), all);
}

void Photometer::SurfaceMeasurement::trace_tasks(std::size_t from, std::size_t to, TaskProgress& all) {
  for_each_within_memory(to - from, [&](std::size_t k) {
    if (is_cancelled(cancel_)) return;
    TaskProgress::Task task(all);
    const SampleTask& traced = tasks_[from + k];
    Direction& one = directions_[traced.direction];
    if (traced.is_scattered)
      one.scattered.readings[traced.sample] =
          measure_scattered(one.alike, one.scattered.sample->samples()[traced.sample]);
    else
      one.mean.readings[traced.sample] = measure_element(one.alike, one.mean.sample->samples()[traced.sample],
                                                         MeasuredLight::mean, traced.compares_rays());
    task.finish();
  });
}

Photometer::SurfaceMeasurement::ElementReading Photometer::SurfaceMeasurement::measure_scattered(
    const EquivalentDirections& directions, const SampledElement& sampled) const {
  ElementReading complete = measure_element(directions, sampled, MeasuredLight::complete, false);
  const ElementReading mean = measure_element(directions, sampled, MeasuredLight::mean, false);
  complete.is_complete = complete.is_complete && mean.is_complete;
  if (!complete.is_complete) return complete;
  for (std::size_t s = 0; s < complete.pieces.size(); ++s) {
    WavelengthReading& piece = complete.pieces[s];
    const WavelengthReading& without = mean.pieces[s];
    for (std::size_t k = 0; k < piece.per_sr.size(); ++k) piece.per_sr[k] -= without.per_sr[k];
    for (std::size_t k = 0; k < piece.map_per_sr.size(); ++k) piece.map_per_sr[k] -= without.map_per_sr[k];
    piece.rre -= without.rre;
    piece.beyond_budget -= without.beyond_budget;
  }
  return complete;
}

Photometer::SurfaceMeasurement::ElementReading Photometer::SurfaceMeasurement::measure_element(
    const EquivalentDirections& directions, const SampledElement& sampled, MeasuredLight measured,
    bool compares_rays) const {
  ElementReading reading;
  const bool keeps_phases = measured == MeasuredLight::complete && photometer_.keeps_phases();
  const design::SpectralOptics& light = photometer_.model_.spectral[sampled.wavelength];
  const double transmittance = photometer_.body_transmittance(sampled.wavelength);
  const Vec3 to_source = frame_of(settings_[directions.front().index]).to_source;
  const std::vector<double>& cones = photometer_.design_.detector.acceptance_half_angle_deg;
  WavelengthReading common;
  const std::unique_ptr<const raytrace::ElementScene> scene =
      elements_.scene(sampled.element, to_source, light.optics.index);
  if (!scene || !scene->is_lit) {
    reading.pieces = dark_pieces(directions);
    // If an element has no tangent plane, its light is missing in the reading.
    if (!scene) reading.error.add_failure();
    reading.is_complete = true;
    return reading;
  }
  const raytrace::Illumination illumination =
      illumination_of(*scene, to_source, photometer_.design_.light.polarisation);
  raytrace::FarFieldCollector collector(scene->excerpt.part, illumination,
                                        photometer_.far_field_policy(light, cancel_));
  raytrace::BeamPolicy policy;
  policy.cutoff = photometer_.cutoff_of_element();
  policy.separate_cells = true;
  policy.keeps_phases = keeps_phases;
  ConePower cone;
  const raytrace::BeamResult beams = trace_element(
      *scene, light.optics, illumination, cones, policy, cancel_, [&](const raytrace::ReturnedBeam& beam) {
        if (!photometer_.has_mirror_image_ && beam.entry_from_exit.linear().trace() >= kMinTraceOfMirror) return;
        collector.add(beam);
        cone.add(beam, scene->to_source, cones.back());
        const bool is_in_window = is_within(beam.direction, scene->to_source, 1.5 * photometer_.request_.window_deg) &&
                                  beam.stokes.i > kMinComparedPower * transmittance;
        if (compares_rays && is_in_window) reading.error.add(elements_.surface(), *scene, beam);
      });
  if (!beams.complete) return reading;
  const raytrace::FarField field = collector.finish();
  // A trace of the mean field behind rough facets adds the scattered light to `truncated`. The truncated light is
  // therefore taken from the trace of all light.
  const bool is_mean_of_rough = photometer_.keeps_phases() && !keeps_phases;
  const double truncated = is_mean_of_rough ? 0.0 : beams.ledgers.back()[raytrace::Account::truncated];
  common.rre = cone.returned;
  common.truncated = truncated;
  if (keeps_phases) {
    common.rre += field.scattered_within(scene->frame(traced_frame(settings_[directions.front().index], {})),
                                         Angle::from_deg(cones.back()).rad()) -
                  cone.scattered_out;
    common.truncated += field.unplaced_power();
  }
  common.beyond_budget = field.beyond_budget_power();
  const ElementField element = {
      .field = field,
      .truncated = common.rre > 0.0 ? truncated / common.rre : 0.0,
      .unplaced = field.scattered_power() > 0.0 ? field.unplaced_power() / field.scattered_power() : 0.0,
      .factor = scene->power_factor / (scene->fraction * transmittance)};
  for (const SharedDirection& one : directions) reading.pieces.push_back(read_element(one, *scene, element, common));
  reading.is_complete = !is_cancelled(cancel_);
  return reading;
}

std::vector<Photometer::WavelengthReading> Photometer::SurfaceMeasurement::dark_pieces(
    const EquivalentDirections& directions) const {
  std::vector<WavelengthReading> pieces;
  for (const SharedDirection& one : directions) {
    const PhotometerSetting& setting = settings_[one.index];
    WavelengthReading& piece = pieces.emplace_back();
    piece.per_sr.assign(setting.observation_deg.size(), 0.0);
    piece.missing_per_sr = piece.per_sr;
    piece.map_per_sr.assign(setting.map_columns * setting.map_columns, 0.0);
  }
  return pieces;
}

Photometer::WavelengthReading Photometer::SurfaceMeasurement::read_element(const SharedDirection& shared,
                                                                           const raytrace::ElementScene& scene,
                                                                           const ElementField& element,
                                                                           WavelengthReading piece) const {
  const PhotometerSetting& setting = settings_[shared.index];
  const raytrace::ApertureKernel& kernel = photometer_.kernel_;
  const ReturnFrame frame = scene.frame(traced_frame(setting, shared));
  for (const double observation_deg : setting.observation_deg) {
    const Vec3 receiver = towards_receiver(frame, observation_deg);
    const double seen = element.field.intensity(receiver, kernel).per_sr;
    const double missing =
        element.truncated * seen + element.unplaced * element.field.scattered_per_sr(receiver, kernel);
    piece.per_sr.push_back(element.factor * seen);
    piece.missing_per_sr.push_back(element.factor * missing);
  }
  if (setting.map_columns > 0) {
    const raytrace::DirectionGrid grid = grid_of_map(setting, photometer_.request_.window_deg);
    piece.map_per_sr = element.field.binned(frame, grid);
    piece.map_per_sr.pop_back();
    for (std::size_t bin = 0; bin < grid.size(); ++bin)
      piece.map_per_sr[bin] *= element.factor / grid.solid_angle_sr(bin);
  }
  for (double* const power : {&piece.rre, &piece.truncated, &piece.beyond_budget}) *power *= element.factor;
  return piece;
}

std::optional<std::vector<PhotometerReading>> Photometer::SurfaceMeasurement::readings() const {
  std::vector<PhotometerReading> readings(settings_.size());
  for (const Direction& one : directions_) {
    raytrace::TangentError error;
    for (const ElementReading& reading : one.scattered.readings)
      if (!reading.is_complete) return std::nullopt;
    for (const ElementReading& reading : one.mean.readings) {
      if (!reading.is_complete) return std::nullopt;
      error.add(reading.error);
    }
    const EntranceModel model = entrance_model(one, error);
    for (std::size_t s = 0; s < one.alike.size(); ++s) {
      const PhotometerSetting& setting = settings_[one.alike[s].index];
      WavelengthReading sum = sum_of_samples(one, s);
      photometer_.add_surface_reflection(setting, one.alike[s], elements_, sum);
      PhotometerReading& reading = readings[one.alike[s].index];
      reading = photometer_.reading_of(setting, {sum}, {1.0});
      reading.entrance_model = model;
      reading.lacks_diffraction = reading.lacks_diffraction || !(error.max_angle_rad() <= allowed_rad());
    }
  }
  return readings;
}

Photometer::WavelengthReading Photometer::SurfaceMeasurement::sum_of_samples(const Direction& one,
                                                                             std::size_t s) const {
  const PhotometerSetting& setting = settings_[one.alike[s].index];
  const auto estimate = [&](const auto& value) {
    SampledSum all;
    for (const SampledReadings* const light : {&one.mean, &one.scattered}) {
      if (!light->sample) continue;
      const SampledSum own =
          sum_of(*light->sample, light->readings, [&](const ElementReading& r) { return value(r.pieces[s]); });
      all = {all.value + own.value, std::hypot(all.std_error, own.std_error)};
    }
    return all;
  };
  WavelengthReading sum;
  for (std::size_t k = 0; k < setting.observation_deg.size(); ++k) {
    const SampledSum seen = estimate([k](const WavelengthReading& r) { return r.per_sr[k]; });
    sum.per_sr.push_back(std::max(0.0, seen.value));
    sum.error_per_sr.push_back(seen.std_error);
    sum.missing_per_sr.push_back(estimate([k](const WavelengthReading& r) { return r.missing_per_sr[k]; }).value);
  }
  for (std::size_t bin = 0; bin < setting.map_columns * setting.map_columns; ++bin)
    sum.map_per_sr.push_back(
        std::max(0.0, estimate([bin](const WavelengthReading& r) { return r.map_per_sr[bin]; }).value));
  const SampledSum rre = estimate([](const WavelengthReading& r) { return r.rre; });
  sum.rre = rre.value;
  sum.std_error = rre.std_error;
  sum.truncated = std::max(0.0, estimate([](const WavelengthReading& r) { return r.truncated; }).value);
  sum.beyond_budget = estimate([](const WavelengthReading& r) { return r.beyond_budget; }).value;
  return sum;
}

EntranceModel Photometer::SurfaceMeasurement::entrance_model(const Direction& one,
                                                             const raytrace::TangentError& error) const {
  std::vector<std::size_t> traced;
  for (const SampledElement& sampled : one.mean.sample->samples()) traced.push_back(sampled.element);
  std::sort(traced.begin(), traced.end());
  const auto distinct = std::unique(traced.begin(), traced.end()) - traced.begin();
  const design::OpticalModel& optics = photometer_.model_;
  EntranceModel model;
  model.elements = one.lit_elements;
  model.traced_elements = static_cast<std::size_t>(distinct);
  model.path_rms_waves = error.path_rms_mm() / (1e-6 * optics.spectral[optics.nearest_wavelength()].wavelength_nm);
  model.angle_rms_arcmin = 60.0 * Angle::from_rad(error.angle_rms_rad()).deg();
  model.max_angle_arcmin = 60.0 * Angle::from_rad(error.max_angle_rad()).deg();
  model.allowed_angle_arcmin = 60.0 * Angle::from_rad(allowed_rad()).deg();
  return model;
}

std::optional<std::vector<PhotometerReading>> Photometer::measure_behind_surface(
    const std::vector<PhotometerSetting>& settings, Progress* progress, const Cancellation* cancel) const {
  SurfaceMeasurement measurement(*this, settings, cancel);
  measurement.trace(progress);
  return measurement.readings();
}

}  // namespace retrace::studies
