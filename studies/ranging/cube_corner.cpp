#include "studies/ranging/cube_corner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "design/engine_facts.h"
#include "design/light_symmetry.h"
#include "design/optical_model.h"
#include "geometry/polygon.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/observers/photometric_geometry.h"
#include "raytrace/observers/small_angle.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;

// Beams with less power than this fraction of the incident power are not traced.
constexpr double kCubeCutoff = 1e-8;
// Only beams within this angle from the direction to the source are diffracted. The angle is large enough for angle
// errors of some arc minutes.
constexpr double kDiffractedRad = 0.02;
// Threshold that identifies light with a reflection at the entrance face between two retroreflections. The trace of the
// linear part of ReturnedBeam::entry_from_exit is 2 for such light, and -2 for light that returns directly.
constexpr double kReflectedTrace = 1.0;
// Wavelength step of the numerical derivative of the refractive index. With this step, the error of the derivative is
// below 1e-11 per nm.
constexpr double kDispersionStepNm = 1.0;
// Two directions count as equal if their components differ by less than this value.
constexpr double kSameDirection = 1e-9;

/// Checks that a design is a single cube corner of a kind that ranging supports.
void check_design(const design::Design& design) {
  design::require_supported(design, {.what = "retrace ranging", .substrates = false});
  const geometry::PartSpec& spec = design.part();
  if (std::holds_alternative<geometry::RtpElement>(spec.element))
    throw InputError(design.where("element.kind"), "must be a cube corner for retrace ranging, got \"rtp\"");
  if (spec.array.arrangement != geometry::Arrangement::single)
    throw InputError(design.where("array.arrangement"),
                     "must be \"single\" for retrace ranging; give an array as a file of cubes");
  if (!design.surface.is_smooth())
    throw InputError(design.where_texture(),
                     "facets must be smooth for retrace ranging, which does not compute scattered light");
  if (design.surface.entrance.scatters())
    throw InputError(design.where_entrance_scatters(),
                     "must be 0 for retrace ranging, which does not compute scattered light");
}

design::Design with_wavelengths(design::Design design, const std::vector<double>& wavelengths_nm) {
  if (wavelengths_nm.empty()) return design;
  design::LightSpectrum spectrum;
  spectrum.kind = design::LightSpectrum::Kind::lines;
  spectrum.photopic = false;
  for (const double w : wavelengths_nm) spectrum.lines.push_back({w, 1.0});
  design.light.colour = spectrum;
  return design;
}

/// Returns the group index n - w dn/dw, where w is the vacuum wavelength. The derivative is a fourth-order finite
/// difference.
double group_index_at(const design::OpticsOfDesign& optics, double wavelength_nm) {
  const auto index = [&](int steps) { return optics.at(wavelength_nm + kDispersionStepNm * steps).index; };
  const double slope = (8.0 * (index(1) - index(-1)) - (index(2) - index(-2))) / (12.0 * kDispersionStepNm);
  return index(0) - wavelength_nm * slope;
}

}  // namespace

double range_correction_mm(double depth_mm, double index, double group_index, double sine) {
  const double s2 = sine * sine;
  return depth_mm * (index * group_index - s2) / std::sqrt(index * index - s2);
}

double usual_range_correction_mm(double depth_mm, double group_index, double sine) {
  return depth_mm * std::sqrt(group_index * group_index - sine * sine);
}

struct CubeCorner::Prepared {
  explicit Prepared(design::Design given) : design(std::move(given)) {}

  design::Design design;
  design::OpticalModel model;
  std::optional<raytrace::BeamTracer> tracer;
  std::vector<CubeIndex> indices;
  std::vector<Eigen::Matrix2d> symmetries;
  bool entrance_reflections = false;
};

CubeCorner::CubeCorner(design::Design design, const std::vector<double>& wavelengths_nm, bool entrance_reflections) {
  check_design(design);
  const auto prepared = std::make_shared<Prepared>(with_wavelengths(std::move(design), wavelengths_nm));
  Prepared& p = *prepared;
  const materials::MaterialLibrary library = materials::MaterialLibrary::shipped();
  p.model = design::make_model(p.design, library);
  p.entrance_reflections = entrance_reflections;
  raytrace::EngineFacts facts = design::engine_facts(p.design, &p.model.optics);
  facts.needs_phases = true;
  if (const auto obstacle = raytrace::obstacle_for(raytrace::Engine::exact, facts))
    throw InputError(design::position_of(p.design, *obstacle),
                     fmt::format("not available for retrace ranging: {}", traced_by(*obstacle, "rays")));
  p.tracer.emplace(p.model.part);
  Warnings ignored;
  const design::OpticsOfDesign optics(p.design, library, ignored);
  for (const design::SpectralOptics& at : p.model.spectral)
    p.indices.push_back({at.wavelength_nm, at.optics.index, group_index_at(optics, at.wavelength_nm)});
  design::Design unpolarised = p.design;
  unpolarised.light.polarisation = raytrace::kUnpolarised;
  p.symmetries = design::light_symmetries(unpolarised, p.model);
  prepared_ = prepared;
}

const design::Design& CubeCorner::design() const {
  return prepared_->design;
}
const std::vector<CubeIndex>& CubeCorner::indices() const {
  return prepared_->indices;
}
const Warnings& CubeCorner::warnings() const {
  return prepared_->model.warnings;
}
double CubeCorner::depth_mm() const {
  return prepared_->model.part.thickness_mm + prepared_->model.part.element_depth_mm;
}
double CubeCorner::entrance_mm2() const {
  return prepared_->model.part.entrance_area_mm2;
}
CubeField CubeCorner::field(const Vec3& to_source, std::size_t wavelength, const Cancellation* cancel) const {
  const design::SpectralOptics& light = prepared_->model.spectral[wavelength];
  const raytrace::SourceAngles source = raytrace::source_angles(to_source);
  const raytrace::Illumination illumination{source.incidence, source.azimuth, raytrace::kUnpolarised};
  raytrace::FarFieldPolicy far_field;
  far_field.wavelength_nm = light.wavelength_nm;
  far_field.window_rad = kDiffractedRad;
  far_field.cancel = cancel;
  if (!prepared_->design.surface.form.is_plane()) far_field.form = &light.optics.facet_form;
  raytrace::FarFieldCollector collector(prepared_->model.part, illumination, far_field);
  raytrace::BeamPolicy beams;
  beams.cutoff = kCubeCutoff;
  beams.separate_cells = true;
  const auto add = [&](const raytrace::ReturnedBeam& beam) {
    const bool is_reflection = beam.depth == 0 || beam.entry_from_exit.linear().trace() > kReflectedTrace;
    if (raytrace::small_angle_between(beam.direction, to_source) > kDiffractedRad) return;
    if (prepared_->entrance_reflections || !is_reflection) collector.add(beam);
  };
  const raytrace::BeamResult result = prepared_->tracer->trace(light.optics, illumination, {0.5}, beams, cancel, add);
  if (!result.complete) return {};
  const raytrace::FarField field = collector.finish();
  if (is_cancelled(cancel)) return {};
  return CubeField(field, light.wavelength_nm, prepared_->model.part.entrance_area_mm2 * to_source.z());
}

EquivalentLight CubeCorner::representative(const Vec3& to_source) const {
  EquivalentLight best;
  bool is_first = true;
  for (const Eigen::Matrix2d& symmetry : prepared_->symmetries) {
    EquivalentLight one;
    one.map.topLeftCorner<2, 2>() = symmetry;
    one.to_source = one.map * to_source;
    const Vec3 more = one.to_source - best.to_source;
    const bool is_better = more.x() > kSameDirection || (more.x() > -kSameDirection && more.y() > kSameDirection);
    if (is_first || is_better) best = one;
    is_first = false;
  }
  return best;
}

}  // namespace retrace::studies
