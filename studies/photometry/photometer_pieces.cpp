// Members of Photometer that trace light exactly at one wavelength.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/memory_budget.h"
#include "raytrace/engines/wavelengths.h"
#include "raytrace/exact/element_memory.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {
namespace {

using raytrace::ReturnFrame;

// Default cut-off power of beams, as a fraction of the power that falls on one element. Light below it, which is
// truncated or does not interfere, changes readings by up to 5e-4 of their value. The choice of wavelengths changes
// them by up to 1e-3.
constexpr double kCutoff = 1e-5;
// Default cut-off power for finite parts whose weak beams are resampled. It is higher than kCutoff, because tracing
// many elements takes much time.
constexpr double kCutoffOfFinite = 5e-5;
// Minimum default cut-off power for finite parts whose weak beams are resampled, as a fraction of all light. It applies
// to parts with very many elements.
constexpr double kCutoffOfAll = 5e-7;
constexpr std::uint32_t kReplicates = 16;
// Number of replicates for a photometer that only guides a search. Such readings have relative errors of about 1e-3
// unless almost no light returns, and take two thirds of the usual time.
constexpr std::uint32_t kReplicatesOfGuide = 4;
// Ratio of the cut-off power of a photometer that only guides a search to the usual one.
constexpr double kCutoffOfGuide = 3.0;
// Ratio of the cut-off power for preliminary values to the usual one.
constexpr double kCutoffOfFirstAnswer = 10.0;
// Maximum number of beams per direction and wavelength. If more beams are needed, the engine `auto` uses Monte Carlo.
constexpr std::uint64_t kMaxBeams = 4'000'000;
// Minimum trace of the matrix ReturnedBeam::entry_from_exit (entry position as a function of exit position) for which a
// beam counts as mirror image of the light. The trace is 2 for a plane mirror and at most 0 for retroreflection.
constexpr double kMinMirrorTrace = 1.0;
// Maximum number of grid points at which the far field is evaluated to integrate the power inside the window of
// directions. If more points are needed, this power is not computed.
constexpr double kMaxLatticePoints = 300'000.0;

// Maximum truncated power, as a fraction of the incident power, that is neglected. If more power is truncated,
// WavelengthReading::missing_per_sr is computed.
constexpr double kMaxNeglectedPower = 1e-9;
// Factor of the cut-off power for the coarse trace in estimate_missing().
constexpr double kCoarseness = 20.0;
// Memory, in bytes, that FarFieldCollector needs for each cell of a finite part.
constexpr double kBytesPerCell = 200.0;
// Memory, in bytes, that FarFieldCollector needs for each returned beam of each cell.
constexpr double kBytesPerBeamOfCell = 8.0;
// Assumed number of returned beams per cell, a lower bound, with which the required memory is estimated before tracing.
constexpr double kMinBeamsPerCell = 10.0;

[[noreturn]] void fail_on_memory() {
  throw TraceBudgetError(
      fmt::format("the far field of all elements exceeds {}: give a larger budget, compute without diffraction, or use "
                  "{} montecarlo",
                  memory_budget_text(), reference({"engine"})));
}

/// Memory that a far field needs while its beams are collected. A beam that represents several equal elements is
/// counted one time for each element.
class FarFieldMemory {
 public:
  /// Adds the memory of a returned beam.
  /// \throw TraceBudgetError if this far field exceeds the memory budget
  /// \throw SharedMemoryExceeded in the same cases as BeamMemory::require_shared()
  void add(const raytrace::ReturnedBeam& beam) {
    const double count = beam.instance_count();
    const double new_cells = std::max(0.0, count - cells_);
    cells_ += new_cells;
    memory_.add(static_cast<std::uint64_t>(kBytesPerCell * new_cells + kBytesPerBeamOfCell * count));
    if (memory_.is_exceeded()) fail_on_memory();
    memory_.require_shared();
  }

 private:
  BeamMemory memory_;
  double cells_ = 0.0;
};

/// Returns the frame of a setting in the coordinates of the traced light. Settings with mirror-symmetric directions
/// share the traced light. For some of them, the frame is therefore mirrored.
ReturnFrame shared_frame(const PhotometerSetting& setting, const SharedDirection& shared) {
  ReturnFrame frame = frame_of(setting);
  for (geometry::Vec3* axis : {&frame.to_source, &frame.right, &frame.up}) *axis = shared.mapped(*axis);
  return frame;
}

geometry::Vec3 receiver_in(const ReturnFrame& frame, double observation_deg) {
  return frame.direction({0.0, Angle::from_deg(observation_deg).rad()});
}

/// Returns the power that rough facets scatter out of a beam whose random phases are recorded (TexturedHit).
double scattered_power(const raytrace::ReturnedBeam& beam) {
  double variance = 0.0;
  for (const raytrace::TexturedHit& hit : beam.hits) variance += hit.phase.variance();
  return -std::expm1(-variance) * beam.stokes.i;
}

}  // namespace

/// Returns true if beams below the cut-off power are resampled instead of truncated. This requires the engine `auto`,
/// light that is traced as beams, plane facets and a plane entrance face.
bool Photometer::resamples_weak() const {
  return tracing_ == Tracing::beams && request_.engine == raytrace::Engine::automatic && !facts_.has_form &&
         !model_.entrance;
}

double Photometer::element_count() const {
  return std::max(1.0, static_cast<double>(model_.part.period_mm ? 1 : model_.part.elements_full));
}

double Photometer::cutoff_of_element() const {
  return element_count() * cutoff();
}

/// Returns the cut-off power as a fraction of all incident light.
double Photometer::cutoff() const {
  const double elements = element_count();
  const double given = request_.cutoff.value_or(0.0) / elements;
  const bool is_first_answer = effort_ == Effort::first_answer;
  if (request_.cutoff && !is_first_answer) return given;
  const bool is_finite = !model_.part.period_mm && resamples_weak();
  const double usual = is_finite ? std::max(kCutoffOfFinite / elements, kCutoffOfAll) : kCutoff / elements;
  if (is_first_answer) return std::max(given, kCutoffOfFirstAnswer * usual);
  return is_finite && effort_ == Effort::search ? kCutoffOfGuide * usual : usual;
}

std::uint32_t Photometer::replicates() const {
  return effort_ == Effort::full ? kReplicates : kReplicatesOfGuide;
}

raytrace::FarFieldPolicy Photometer::far_field_policy(const design::SpectralOptics& light,
                                                      const Cancellation* cancel) const {
  raytrace::FarFieldPolicy policy;
  policy.diffraction = request_.diffraction;
  policy.wavelength_nm = light.wavelength_nm;
  policy.window_rad = 1.5 * Angle::from_deg(request_.window_deg).rad();
  policy.finest_detail_rad = kernel_.reach_rad() / kWidthsWithoutDiffraction;
  if (facts_.has_form) policy.form = &light.optics.facet_form;
  if (resamples_weak()) policy.replicates = replicates();
  policy.cancel = cancel;
  return policy;
}

raytrace::BeamPolicy Photometer::beam_policy(std::size_t wavelength, double coarseness) const {
  raytrace::BeamPolicy beams;
  if (resamples_weak())
    beams.population_control =
        raytrace::PopulationControl{.seed = raytrace::seed_at(request_.seed, wavelength), .replicates = replicates()};
  beams.cutoff = coarseness * cutoff();
  beams.separate_cells = request_.diffraction;
  beams.keeps_phases = keeps_phases();
  if (request_.engine != raytrace::Engine::exact) beams.max_beams = kMaxBeams;
  return beams;
}

raytrace::BeamTracer Photometer::make_tracer() const {
  const double cells = model_.part.period_mm ? 0.0 : static_cast<double>(model_.part.elements_full);
  const double bytes = cells * (kBytesPerCell + kMinBeamsPerCell * kBytesPerBeamOfCell);
  if (request_.diffraction && bytes > static_cast<double>(beam_memory_bytes())) fail_on_memory();
  if (effort_ == Effort::first_answer &&
      2.0 * raytrace::element_cost(model_.part).bytes > static_cast<double>(element_memory_bytes()))
    throw TraceBudgetError("preliminary values do not fit into memory next to the measurement itself");
  return raytrace::BeamTracer(model_.part, raytrace::BeamTracer::Elements::instanced);
}

std::optional<Photometer::Traced> Photometer::traced(const geometry::Vec3& to_source, std::size_t wavelength,
                                                     const raytrace::BeamTracer& tracer, const Cancellation* cancel,
                                                     double coarseness) const {
  const design::SpectralOptics& light = model_.spectral[wavelength];
  const raytrace::SourceAngles source = raytrace::source_angles(to_source);
  const raytrace::Illumination illumination{source.incidence, source.azimuth, design_.light.polarisation};
  raytrace::FarFieldPolicy far_field = far_field_policy(light, cancel);
  far_field.interference = cell_interference(wavelength);
  raytrace::FarFieldCollector collector(model_.part, illumination, far_field);
  const std::vector<double>& cones = design_.detector.acceptance_half_angle_deg;
  FarFieldMemory memory;
  Traced traced;
  traced.beams = tracer.trace(light.optics, illumination, cones, beam_policy(wavelength, coarseness), cancel,
                              [&](const raytrace::ReturnedBeam& beam) {
                                const double trace = beam.entry_from_exit.linear().trace();
                                if (request_.diffraction && !model_.part.period_mm) memory.add(beam);
                                const bool is_counted = (trace < kMinMirrorTrace || has_mirror_image_) &&
                                                        (beam.depth > 0 || has_front_reflection_);
                                if (is_counted) collector.add(beam);
                                if (beam.cone < cones.size())
                                  traced.scattered_from_cone += beam.instance_count() * scattered_power(beam) /
                                                                (beam.replicate ? replicates() : 1.0);
                              });
  if (!traced.beams.complete) return std::nullopt;
  traced.field = collector.finish();
  return traced;
}

std::optional<std::vector<Photometer::WeightedField>> Photometer::far_fields(const geometry::Vec3& to_source,
                                                                             const raytrace::BeamTracer& tracer,
                                                                             const Cancellation* cancel) const {
  std::vector<WeightedField> fields;
  for (std::size_t wavelength = 0; wavelength < model_.spectral.size(); ++wavelength) {
    std::optional<Traced> one = traced(to_source, wavelength, tracer, cancel);
    if (!one) return std::nullopt;
    fields.push_back({std::move(one->field), weights_[wavelength]});
  }
  return fields;
}

std::vector<Photometer::WavelengthReading> Photometer::measure_exactly(const std::vector<PhotometerSetting>& settings,
                                                                       const EquivalentDirections& directions,
                                                                       std::size_t wavelength,
                                                                       const raytrace::BeamTracer& tracer,
                                                                       const Cancellation* cancel) const {
  const ReturnFrame frame = frame_of(settings[directions.front().index]);
  const std::optional<Traced> traced = this->traced(frame.to_source, wavelength, tracer, cancel);
  if (!traced) return std::vector<WavelengthReading>(directions.size());
  const raytrace::FarField& field = traced->field;
  WavelengthReading common;
  common.beyond_budget = field.beyond_budget_power();
  common.rre = traced->beams.ledgers.back()[raytrace::Account::retroreflected];
  common.std_error = traced->beams.std_error.back();
  common.truncated = traced->beams.ledgers.back()[raytrace::Account::truncated];
  if (keeps_phases()) {
    // Adds the scattered power that falls into the acceptance cone, and subtracts the power that rough facets scatter
    // out of the beams in the cone.
    const Angle widest = Angle::from_deg(design_.detector.acceptance_half_angle_deg.back());
    common.rre += field.scattered_within(frame, widest.rad()) - traced->scattered_from_cone;
    common.truncated += field.unplaced_power();
  }
  std::vector<WavelengthReading> pieces(directions.size(), common);
  for (std::size_t k = 0; k < directions.size() && !is_cancelled(cancel); ++k)
    read_far_field(settings[directions[k].index], directions[k], field, wavelength, pieces[k]);
  // After a cancellation, some contributions have no intensities. Empty contributions are therefore returned.
  if (is_cancelled(cancel)) return std::vector<WavelengthReading>(directions.size());
  if (tracing_ == Tracing::beams) estimate_missing(settings, directions, wavelength, *traced, tracer, cancel, pieces);
  for (WavelengthReading& piece : pieces) piece.complete = !is_cancelled(cancel);
  return pieces;
}

/// Sets WavelengthReading::missing_per_sr to the sum of three estimates: (1) Truncated light is assumed to return with
/// the angular distribution of the other returned light. (2) The intensity that truncated beams would add is
/// extrapolated from a coarse trace with a higher cut-off power. The middle wavelength represents all wavelengths. This
/// estimate is omitted if weak beams are resampled, because hardly any light is then truncated. (3) Scattered light of
/// unknown direction is assumed to have the angular distribution of the other scattered light.
void Photometer::estimate_missing(const std::vector<PhotometerSetting>& settings,
                                  const EquivalentDirections& directions, std::size_t wavelength, const Traced& traced,
                                  const raytrace::BeamTracer& tracer, const Cancellation* cancel,
                                  std::vector<WavelengthReading>& pieces) const {
  const auto truncated_in = [](const Traced& t) { return t.beams.ledgers.back()[raytrace::Account::truncated]; };
  const raytrace::FarField& field = traced.field;
  const double truncated = truncated_in(traced);
  const double unplaced = field.scattered_power() > 0.0 ? field.unplaced_power() / field.scattered_power() : 0.0;
  if (truncated <= kMaxNeglectedPower && unplaced <= kMaxNeglectedPower) return;
  std::optional<Traced> coarse;
  if (truncated > kMaxNeglectedPower && !resamples_weak() && wavelength == model_.nearest_wavelength()) {
    coarse =
        this->traced(frame_of(settings[directions.front().index]).to_source, wavelength, tracer, cancel, kCoarseness);
    if (!coarse) return;
  }
  const double difference = coarse ? truncated_in(*coarse) - truncated : 0.0;
  const double all_weights = std::accumulate(weights_.begin(), weights_.end(), 0.0);
  const double returned = pieces.front().rre;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const PhotometerSetting& setting = settings[directions[k].index];
    const ReturnFrame frame = shared_frame(setting, directions[k]);
    for (std::size_t angle = 0; angle < setting.observation_deg.size(); ++angle) {
      const geometry::Vec3 receiver = receiver_in(frame, setting.observation_deg[angle]);
      const double seen = pieces[k].per_sr[angle];
      double missing = unplaced * field.scattered_per_sr(receiver, kernel_);
      if (returned > 0.0) missing += truncated / returned * seen;
      if (difference > 0.0) {
        const double change = std::abs(seen - coarse->field.intensity(receiver, kernel_).per_sr);
        missing += truncated / difference * change * all_weights / weights_[wavelength];
      }
      pieces[k].missing_per_sr.push_back(missing);
    }
  }
}

/// Evaluates the far field for one of the settings that share it.
void Photometer::read_far_field(const PhotometerSetting& setting, const SharedDirection& shared,
                                const raytrace::FarField& field, std::size_t wavelength,
                                WavelengthReading& piece) const {
  const ReturnFrame frame = shared_frame(setting, shared);
  for (const double observation_deg : setting.observation_deg) {
    const raytrace::FarFieldIntensity seen = field.intensity(receiver_in(frame, observation_deg), kernel_);
    piece.per_sr.push_back(seen.per_sr);
    piece.error_per_sr.push_back(seen.error_per_sr);
  }
  const double window_rad = Angle::from_deg(request_.window_deg).rad();
  if (setting.map_columns > 0) {
    const raytrace::DirectionGrid grid(raytrace::DirectionGrid::Layout::square, window_rad, setting.map_columns,
                                       setting.map_columns);
    piece.map_per_sr = field.binned(frame, grid);
    piece.map_per_sr.pop_back();
    for (std::size_t bin = 0; bin < grid.size(); ++bin) piece.map_per_sr[bin] /= grid.solid_angle_sr(bin);
  }
  const double points = std::numbers::pi * std::pow(1.5 * window_rad / field.detail_rad(), 2.0);
  if (setting.split && wavelength == model_.nearest_wavelength() && points < kMaxLatticePoints) {
    const raytrace::FarField::Split parts = field.split(frame, window_rad);
    piece.split = {model_.spectral[wavelength].wavelength_nm, parts.inside, parts.outside, field.total_power()};
  }
}

}  // namespace retrace::studies
