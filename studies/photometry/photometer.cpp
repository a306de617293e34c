#include "studies/photometry/photometer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/task_progress.h"
#include "design/io/design_reader.h"
#include "design/light_symmetry.h"
#include "design/part_of_design.h"
#include "geometry/elements/ruled_pattern.h"
#include "materials/io/spectrum_reader.h"
#include "raytrace/engines/wavelengths.h"
#include "raytrace/observers/coefficients.h"

namespace retrace::studies {
namespace {

using geometry::Vec3, raytrace::PhotometricGeometry;

// Maximum power whose diffraction may be omitted because the budget of polygons is exhausted, as a fraction of the
// incident power. If more power is affected, the reading counts as lacking diffraction.
constexpr double kMaxUndiffractedFraction = 1e-4;

// Maximum norm of the difference of two orthogonal maps that count as one map.
constexpr double kSameMap = 1e-9;

Angle deg(double value) {
  return Angle::from_deg(value);
}

/// Returns the spectral absorption of a design's body. Empty if the absorption is a single number or is taken from the
/// data of the material.
materials::SpectralCurve absorption_per_mm(const design::Design& design) {
  materials::SpectralCurve curve;
  if (const auto* const given =
          std::get_if<std::vector<design::SpectralAbsorption>>(&design.substance.absorption_per_mm))
    for (const design::SpectralAbsorption& at : *given) {
      curve.wavelengths_nm.push_back(at.wavelength_nm);
      curve.values.push_back(at.per_mm);
    }
  return curve;
}

/// Returns the path length, inside a design, of light that enters, is reflected at the elements and leaves. The
/// absorption by a dye depends on this length.
double way_through_mm(const design::Design& design) {
  if (design.balls()) return 2.0 * design.balls()->diameter_mm;
  const geometry::Part part = design::part_of_design(design, nullptr);
  return 2.0 * (part.thickness_mm + part.element_depth_mm);
}

design::OpticalModel model_of(const design::Design& design, const materials::MaterialLibrary& library) {
  return design.balls() ? design::make_light_model(design, library) : design::make_model(design, library);
}

/// Checks a design of balls. R_A requires an area, which a single ball does not have.
void check_balls(const design::Design& design) {
  if (!design.balls()->pitch_mm)
    throw InputError(design.where("element.kind"),
                     "photometry is not available for a single ball: give array.arrangement = \"packed\"");
}

/// Refuses an engine that cannot trace a design. Textures and entrance faces that scatter are refused by
/// PhotometryStudy, because other studies measure them by rays.
void check_engine(const design::Design& design, const raytrace::EngineFacts& facts, raytrace::Engine engine) {
  using raytrace::Obstacle;
  const std::optional<Obstacle> obstacle = raytrace::obstacle_for(engine, facts);
  if (!obstacle) return;
  switch (*obstacle) {
    case Obstacle::balls: throw InputError(Field{"engine"}, "must be auto or montecarlo for element.kind = \"ball\"");
    case Obstacle::curved_entrance:
      throw InputError(Field{"engine"}, "must be auto, montecarlo or embree if the design has an [entrance_surface]");
    case Obstacle::deflecting_shells:
      throw InputError(Field{"engine"},
                       "must be auto, montecarlo or embree if a [[shell]] changes the direction of light");
    case Obstacle::unequal_backs:
      throw InputError(Field{"engine"}, "must be auto, montecarlo or embree for a [wet_back] behind some elements");
    case Obstacle::texture:
      if (!facts.has_form) return;
      [[fallthrough]];
    case Obstacle::form:
    case Obstacle::form_and_texture:
      throw InputError(design.where_form(), fmt::format("the exact engine traces facets with a form only with "
                                                        "diffraction and without a texture: use {} montecarlo",
                                                        reference({"engine"})));
    default: return;
  }
}

/// Allows the exact engine behind a curved entrance surface if beams can be traced through tangent planes of the
/// surface. For this purpose, clears the flag `has_curved_entrance`. Requires a finite part, a request with
/// diffraction, and an exact surface instead of a mesh.
/// \param model null if it is not known yet; the surface is then assumed to be exact
void allow_tangent_planes(const design::Design& design, const design::OpticalModel* model,
                          const PhotometrySettings& request, raytrace::EngineFacts& facts) {
  // Tangent planes are not used for a round cube corner with a chamfer or a mount, because the traced excerpt would not
  // contain them.
  const auto* const round =
      design.elements() != nullptr ? std::get_if<geometry::RoundCube>(&design.part().element) : nullptr;
  if (round != nullptr && (round->chamfer_mm > 0.0 || round->mount_diameter_mm > 0.0)) return;
  const bool is_mesh = model != nullptr && model->entrance &&
                       !std::holds_alternative<std::shared_ptr<const geometry::EntranceSurface>>(*model->entrance);
  if (!is_mesh && request.diffraction && !(model != nullptr && model->part.period_mm))
    facts.has_curved_entrance = false;
}

/// Returns the width of the cells at whose edges light is diffracted. Returns 0 if the width is unknown, for example
/// for meshes. Also returns 0 behind curved entrance faces and lenses, which divide the light into other cells.
double width_of_cells_mm(const design::Design& design) {
  if (design.balls()) return design.balls()->diameter_mm;
  if (!design.elements() || design.entrance || design.has_deflecting_shells()) return 0.0;
  if (const auto* prism = std::get_if<geometry::RtpElement>(&design.part().element))
    return std::min(prism->base_mm, prism->width_mm);
  if (const auto* cube = std::get_if<geometry::HexagonalCube>(&design.part().element)) return cube->aperture_mm;
  if (const auto* cube = std::get_if<geometry::RoundCube>(&design.part().element)) return cube->diameter_mm;
  if (const auto* ruled = std::get_if<geometry::RuledCells>(&design.part().element))
    return geometry::aperture_of_mean_cell_mm(*ruled->pattern);
  return std::get<geometry::TriangularCube>(design.part().element).aperture_mm;
}

/// Returns the design with the lamp of the photometer as its light.
design::Design lit(design::Design design, const PhotometrySettings& request, const materials::Spectrum& light) {
  design::LightSpectrum spectrum;
  spectrum.kind = design::LightSpectrum::Kind::lines;
  spectrum.photopic = false;
  for (const double w : light.wavelengths_nm) spectrum.lines.push_back({w, 1.0});
  design.light.colour = spectrum;
  if (!request.dye.empty()) set_where(design, "body.absorption_per_mm", {request.dye, 0, "absorption_per_mm"});
  return design;
}

/// Returns a map after averaging over the discs (apertures) of source and receiver. The kernel is evaluated at the
/// pixels of the map.
std::vector<double> blurred(const std::vector<double>& map, std::size_t columns, double step_rad,
                            const raytrace::ApertureKernel& kernel) {
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(kernel.reach_rad() / step_rad));
  struct Weight {
    std::ptrdiff_t i, j;
    double value;
  };
  std::vector<Weight> weights;
  double sum = 0.0;
  for (std::ptrdiff_t j = -reach; j <= reach; ++j)
    for (std::ptrdiff_t i = -reach; i <= reach; ++i) {
      const double value = kernel.per_sr(step_rad * std::hypot(static_cast<double>(i), static_cast<double>(j)));
      if (value > 0.0) weights.push_back({i, j, value});
      sum += value;
    }
  const auto n = static_cast<std::ptrdiff_t>(columns);
  std::vector<double> result(map.size(), 0.0);
  for (std::ptrdiff_t row = 0; row < n; ++row)
    for (std::ptrdiff_t column = 0; column < n; ++column)
      for (const Weight& w : weights) {
        const std::ptrdiff_t j = row + w.j;
        const std::ptrdiff_t i = column + w.i;
        if (i < 0 || j < 0 || i >= n || j >= n) continue;
        result[static_cast<std::size_t>(row * n + column)] += w.value / sum * map[static_cast<std::size_t>(j * n + i)];
      }
  return result;
}

}  // namespace

PhotometricGeometry geometry_of(const PhotometerSetting& setting, double observation_deg) {
  return raytrace::geometry_from({deg(setting.v_deg), deg(setting.h_deg)}, deg(observation_deg),
                                 deg(setting.rotation_deg));
}

PhotometerSetting setting_of(const raytrace::PhotometricDirections& directions, const Vec3& reference_axis) {
  const PhotometricGeometry geometry = raytrace::geometry_of(raytrace::in_reference_frame(directions, reference_axis));
  const raytrace::EntranceAngles entrance = raytrace::entrance_angles(geometry);
  PhotometerSetting setting;
  setting.v_deg = entrance.v.deg();
  setting.h_deg = entrance.h.deg();
  setting.rotation_deg = geometry.epsilon.deg();
  setting.observation_deg = {geometry.alpha.deg()};
  setting.reference_axis = reference_axis;
  return setting;
}

raytrace::ReturnFrame frame_of(const PhotometerSetting& setting) {
  return raytrace::in_part_frame(raytrace::return_frame(geometry_of(setting, 0.0)), setting.reference_axis);
}

design::Design with_dye(design::Design design, const materials::SpectralCurve& absorption_per_mm) {
  if (absorption_per_mm.values.empty()) return design;
  std::vector<design::SpectralAbsorption> curve;
  for (std::size_t k = 0; k < absorption_per_mm.values.size(); ++k)
    curve.push_back({absorption_per_mm.wavelengths_nm[k], absorption_per_mm.values[k]});
  design.substance.absorption_per_mm = std::move(curve);
  return design;
}

Photometer::Photometer(const design::Design& design, const PhotometrySettings& request, std::size_t parts,
                       PhotometricResponse response)
    : design_(with_dye(design, request.dye_absorption_per_mm)), request_(request), kernel_(request.apertures) {
  const materials::MaterialLibrary library = materials::MaterialLibrary::shipped();
  if (design_.balls()) check_balls(design_);
  raytrace::EngineFacts known = design::engine_facts(design_, nullptr);
  allow_tangent_planes(design_, nullptr, request, known);
  check_engine(design_, known, request.engine);
  if (request.light == PhotometricLight::of_design) {
    model_ = model_of(design_, library);
    for (const design::SpectralOptics& light : model_.spectral) weights_.push_back(light.weight);
  } else {
    lamp_ = Lamp{lamp_power(request.light), materials::shipped_colour_matching()[static_cast<std::size_t>(response)],
                 absorption_per_mm(design_), way_through_mm(design_), parts};
    const materials::Spectrum light = lamp_->light({});
    model_ = model_of(lit(design_, request, light), library);
    weights_ = light.weights;
  }
  facts_ = design::engine_facts(design_, &model_.optics);
  facts_.needs_phases = request.diffraction;
  allow_tangent_planes(design_, &model_, request, facts_);
  check_engine(design_, facts_, request.engine);
  if (raytrace::is_exact(request.engine, facts_)) tracing_ = Tracing::beams;
}

materials::SpectralCurve lamp_power(PhotometricLight light) {
  const materials::CieTable cie = materials::shipped_cie_table();
  return light == PhotometricLight::illuminant_d65 ? cie.illuminant_d65 : cie.illuminant_a;
}

std::optional<Photometer> Photometer::mean_field() const {
  const bool is_asked = request_.engine == raytrace::Engine::automatic && request_.diffraction;
  raytrace::EngineFacts of_mean_field = facts_;
  of_mean_field.has_texture = false;
  if (!is_asked || is_exact() || !facts_.has_texture || raytrace::obstacle_for(raytrace::Engine::exact, of_mean_field))
    return std::nullopt;
  Photometer bound = *this;
  bound.tracing_ = Tracing::mean_field;
  return bound;
}

std::string Photometer::engine_name() const {
  if (design_.balls()) return "balls";
  if (!is_exact()) return "embree";
  return resamples_weak() ? "stochastic" : "exact";
}

NoDiffraction Photometer::why_undiffracted() const {
  if (!request_.diffraction) return Undiffracted::not_requested;
  if (const auto obstacle = raytrace::obstacle_for(raytrace::Engine::exact, facts_)) return *obstacle;
  if (is_exact()) return model_.entrance ? Undiffracted::strong_curvature : Undiffracted::unequal_cells;
  if (request_.engine != raytrace::Engine::automatic) return Undiffracted::monte_carlo;
  return model_.entrance ? Undiffracted::strong_curvature : Undiffracted::too_many_beams;
}

void Photometer::ignore_diffraction() {
  request_.diffraction = false;
  facts_.needs_phases = false;
  facts_.has_curved_entrance = model_.entrance.has_value();
  if (tracing_ != Tracing::rays)
    tracing_ = raytrace::is_exact(request_.engine, facts_) ? Tracing::beams : Tracing::rays;
}

double Photometer::cell_width_mm() const {
  return width_of_cells_mm(design_);
}

double Photometer::min_undiffracted_mm() const {
  return kWidthsWithoutDiffraction * 1e-6 * model_.spectral.back().wavelength_nm / kernel_.reach_rad();
}

std::vector<double> Photometer::wavelengths_nm() const {
  std::vector<double> all;
  for (const design::SpectralOptics& light : model_.spectral) all.push_back(light.wavelength_nm);
  return all;
}

PhotometerReading Photometer::reading_of(const PhotometerSetting& setting, const std::vector<WavelengthReading>& pieces,
                                         const std::vector<double>& weights) const {
  PhotometerReading reading;
  const raytrace::SourceAngles source = raytrace::source_angles(frame_of(setting).to_source);
  PhotometricDirection& at = reading.direction;
  at.v_deg = setting.v_deg;
  at.h_deg = setting.h_deg;
  at.rotation_deg = setting.rotation_deg;
  at.incidence_deg = source.incidence.deg();
  at.azimuth_deg = source.azimuth.deg();
  std::vector<double> map(setting.map_columns * setting.map_columns, 0.0);
  double variance = 0.0;
  double beyond_budget = 0.0;
  for (std::size_t w = 0; w < pieces.size(); ++w) {
    at.rre += weights[w] * pieces[w].rre;
    at.truncated += weights[w] * pieces[w].truncated;
    variance += std::pow(weights[w] * pieces[w].std_error, 2.0);
    beyond_budget += weights[w] * pieces[w].beyond_budget;
    if (pieces[w].split) at.split = pieces[w].split;
    for (std::size_t k = 0; k < map.size(); ++k) map[k] += weights[w] * pieces[w].map_per_sr[k];
  }
  at.std_error = std::sqrt(variance);
  reading.lacks_diffraction =
      has_diffraction() ? beyond_budget > kMaxUndiffractedFraction : cell_width_mm() < min_undiffracted_mm();
  const double cos_beta = design_.inclination() == nullptr ? std::cos(source.incidence.rad())
                                                           : design_.incident_fraction(frame_of(setting).to_source);
  for (std::size_t k = 0; k < setting.observation_deg.size(); ++k) {
    double per_sr = 0.0;
    double squares = 0.0;
    // Linear sum instead of a root of squares, because the missing light is similar for all wavelengths.
    double missing = 0.0;
    for (std::size_t w = 0; w < pieces.size(); ++w) {
      per_sr += weights[w] * pieces[w].per_sr[k];
      if (!pieces[w].missing_per_sr.empty()) missing += weights[w] * pieces[w].missing_per_sr[k];
      squares += std::pow(weights[w] * pieces[w].error_per_sr[k], 2.0);
    }
    const PhotometricGeometry geometry = geometry_of(setting, setting.observation_deg[k]);
    reading.r_a.push_back(per_sr * cos_beta);
    reading.r_l.push_back(raytrace::coefficient_of_luminance(
        reading.r_a.back(), raytrace::viewing_angle(geometry, setting.reference_axis)));
    reading.r_a_error.push_back(cos_beta * std::hypot(std::sqrt(squares), missing));
  }
  if (map.empty()) return reading;
  const double step_rad = 2.0 * deg(request_.window_deg).rad() / static_cast<double>(setting.map_columns);
  reading.map_r_a = blurred(map, setting.map_columns, step_rad, kernel_);
  for (double& value : reading.map_r_a) value *= cos_beta;
  return reading;
}

std::array<bool, 2> Photometer::mirrors() const {
  std::array<bool, 2> mirrors{};
  const std::vector<Eigen::Matrix2d> maps = design::light_symmetries(design_, model_);
  for (const Eigen::Index axis : {0, 1}) {
    Eigen::Matrix2d reflection = Eigen::Matrix2d::Identity();
    reflection(axis, axis) = -1.0;
    mirrors[static_cast<std::size_t>(axis)] =
        std::ranges::any_of(maps, [&](const Eigen::Matrix2d& map) { return (map - reflection).norm() < kSameMap; });
  }
  return mirrors;
}

std::vector<EquivalentDirections> Photometer::group_equivalent_settings(
    const std::vector<PhotometerSetting>& settings) const {
  std::vector<Vec3> to_source;
  for (const PhotometerSetting& setting : settings) to_source.push_back(frame_of(setting).to_source);
  if (settings.size() < 2) return group_equivalent_directions(to_source, {Eigen::Matrix2d::Identity()});
  return group_equivalent_directions(
      to_source, shares_rotations_ ? design::light_symmetries(design_, model_) : reflections_of(mirrors()));
}

std::optional<std::vector<PhotometerReading>> Photometer::measure_in_one_light(
    const std::vector<PhotometerSetting>& settings, Progress* progress, const Cancellation* cancel) const {
  if (uses_tangent_planes()) return measure_behind_surface(settings, progress, cancel);
  const std::size_t wavelengths = model_.spectral.size();
  std::vector<std::vector<WavelengthReading>> pieces(settings.size(), std::vector<WavelengthReading>(wavelengths));
  if (is_exact()) {
    const raytrace::BeamTracer tracer = make_tracer();
    const std::vector<EquivalentDirections> traced = group_equivalent_settings(settings);
    TaskProgress all(progress, traced.size() * wavelengths);
    raytrace::trace_wavelengths(
        traced.size(), wavelengths, true, all, [&](std::size_t direction, std::size_t wavelength, Progress&) {
          const EquivalentDirections& alike = traced[direction];
          const std::vector<WavelengthReading> seen = measure_exactly(settings, alike, wavelength, tracer, cancel);
          for (std::size_t s = 0; s < alike.size(); ++s) pieces[alike[s].index][wavelength] = seen[s];
          return true;
        });
  } else if (!measure_by_rays(settings, progress, cancel, pieces)) {
    return std::nullopt;
  }
  std::vector<PhotometerReading> readings;
  for (std::size_t k = 0; k < settings.size(); ++k) {
    for (const WavelengthReading& piece : pieces[k])
      if (!piece.complete) return std::nullopt;
    readings.push_back(reading_of(settings[k], pieces[k], weights_));
  }
  return readings;
}

}  // namespace retrace::studies
