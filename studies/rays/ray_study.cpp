#include "studies/rays/ray_study.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/memory_budget.h"
#include "core/number_format.h"
#include "core/version.h"
#include "raytrace/light/light_setup.h"
#include "requests/descriptions.h"
#include "studies/rays/ray_accounts.h"
#include "studies/rays/ray_limits.h"
#include "studies/rays/ray_wavelengths.h"

namespace retrace::studies {
namespace {

// Number of rays that are read and traced together. It limits the memory, because about as many rays leave the part as
// enter it.
constexpr std::size_t kRaysAtATime = 16384;
// Minimum number of rays that are traced together.
constexpr std::size_t kFewestAtATime = 1024;
// Maximum number of surfaces that a branch of a ray hits, and maximum number of segments of all branches of a ray.
constexpr std::uint32_t kMaxSurfaces = 10'000;
constexpr std::uint64_t kMaxSegments = 1'000'000;

std::u32string wide_text(std::string_view ascii) {
  return {ascii.begin(), ascii.end()};
}

/// Returns the light of a ray in the part frame.
/// \param of_design polarisation of the design, for rays of sources without polarisation
raytrace::Light light_of(const SetRay& ray, double power, bool has_stokes, const raytrace::Stokes& of_design) {
  if (has_stokes) return {{power, power * ray.stokes[0], power * ray.stokes[1], power * ray.stokes[2]}, ray.axis};
  const bool is_along_x = ray.direction.cross(Vec3::UnitX()).squaredNorm() < raytrace::Light::kNormalIncidence;
  if (is_along_x || (of_design.q == 0.0 && of_design.u == 0.0 && of_design.v == 0.0))
    return {{power, 0.0, 0.0, 0.0}, ray.direction.unitOrthogonal()};
  raytrace::Light light = raytrace::light_of_beam(of_design, -ray.direction);
  light.scale(power);
  return light;
}

/// Sets the axis of a ray to the long axis of the polarisation ellipse, so that S2 is 0.
void settle_polarisation(const raytrace::Light& light, AccountedRay& ray) {
  const raytrace::Stokes& s = light.stokes;
  ray.axis = light.s_axis;
  if (!(s.i > 0.0)) return;
  const double along = std::hypot(s.q, s.u);
  ray.stokes = {along / s.i, 0.0, s.v / s.i};
  if (!(along > 0.0)) return;
  const double turn = 0.5 * std::atan2(s.u, s.q);
  ray.axis = (std::cos(turn) * light.s_axis + std::sin(turn) * ray.direction.cross(light.s_axis)).normalized();
}

/// Returns the distance from the centre of the entrance face to the corner farthest from it.
/// \pre the part is finite
double radius_of_face(const geometry::Part& part) {
  const geometry::Vec2 middle = centre_of_face(part).head<2>();
  double reach2 = 0.0;
  for (const geometry::Vec2& corner : part.outline) reach2 = std::max(reach2, (corner - middle).squaredNorm());
  return std::sqrt(reach2);
}

/// Sets the size of the emitter to that of the entrance face. For an infinite part, the emitter is a parallelogram that
/// is congruent to one period and parallel to the face. Parallel rays from the emitter cover one period evenly for
/// every direction of the rays.
void cover_face(const geometry::Part& part, const RayPlacement& placement, Emitter& emitter) {
  if (!part.period_mm) {
    emitter.disc_mm = 2.0 * radius_of_face(part);
    return;
  }
  const Eigen::Matrix3d source_from_part = placement.part_from_source.transpose();
  emitter.period_mm = {part.period_mm->x() * source_from_part.col(0), part.period_mm->y() * source_from_part.col(1)};
}

/// Returns the height above the entrance face that must remain free below an emitter at the default distance. It
/// includes the shells and a margin for emitters that illuminate the shells at oblique incidence. Returns 0 if there
/// are no shells.
double height_of_shells(const design::OpticalModel& model) {
  const raytrace::Shells& shells = model.optics.shells;
  if (shells.empty()) return 0.0;
  const double radius_mm = model.part.period_mm ? model.part.period_mm->norm() : radius_of_face(model.part);
  return shells.front().outer.vertex_mm.z() + radius_mm;
}

/// Checks a request, and returns the settings that both kinds of requests contain.
/// \param stokes true if rays carry Stokes parameters
template <class Request>
RayRequest settings_of(const Request& request, bool stokes) {
  requests::check(request);
  return {.placement = {},
          .split = request.split,
          .cutoff = request.cutoff,
          .keep_missed = request.keep_missed,
          .stokes = stokes,
          .seed = request.seed};
}

}  // namespace

struct RayStudy::Impl {
  Impl(design::Design d, RayRequest r)
      : design(std::move(d)),
        request(std::move(r)),
        library(materials::MaterialLibrary::shipped()),
        model(design::make_model(design, library)),
        optics(design, library, ignored),
        placement(placement_of(request.placement, model.part, height_of_shells(model))) {}

  design::Design design;
  RayRequest request;
  materials::MaterialLibrary library;
  design::OpticalModel model;
  Warnings ignored;  ///< warnings of `optics`; `model` contains the same warnings
  design::OpticsOfDesign optics;
  RayPlacement placement;
};

RayRequest resolve(const RaysRequest& request) {
  RayRequest settings = settings_of(request, request.stokes);
  settings.placement = {request.at_mm, request.aim_mm, request.incidence_deg, request.azimuth_deg, request.distance_mm};
  if (!request.emitter.empty()) {
    settings.placement.face_part();
    settings.emitter = {emitter_from_name(request.emitter), request.disc_mm, request.half_angle_deg, request.rays,
                        request.power};
  }
  return settings;
}

RayRequest resolve(const TraceRequest& request) {
  return settings_of(request, true);
}

RayStudy::RayStudy(design::Design design, RayRequest request)
    : impl_(std::make_unique<const Impl>(std::move(design), std::move(request))) {}
RayStudy::~RayStudy() = default;

const geometry::Part& RayStudy::part() const {
  return impl_->model.part;
}

const design::Design& RayStudy::design() const {
  return impl_->design;
}

Emitter RayStudy::emitter_of(const EmitterRequest& request) const {
  const design::LightSpectrum* const spectrum = impl_->design.light.spectrum();
  Emitter emitter;
  emitter.kind = request.kind;
  emitter.disc_mm = request.disc_mm.value_or(0.0);
  if (request.kind == EmitterKind::collimated && !request.disc_mm)
    cover_face(impl_->model.part, impl_->placement, emitter);
  emitter.half_angle_deg = request.half_angle_deg.value_or(request.kind == EmitterKind::lambertian ? 90.0 : 0.0);
  emitter.rays = request.rays;
  emitter.power = request.power;
  emitter.is_luminous = spectrum != nullptr && spectrum->photopic;
  emitter.seed = impl_->request.seed;
  return emitter;
}

/// Traces one source through one part.
class RayStudy::Run {
 public:
  Run(const Impl& hidden, RaySource& source, RaySink* sink)
      : hidden_(hidden),
        source_(source),
        sink_(sink),
        is_luminous_(!source.info().has_radiant),
        tracer_(hidden.model.part, hidden.model.entrance ? &*hidden.model.entrance : nullptr,
                hidden.design.detector.acceptance_half_angle_deg.back(), policy_of(hidden.request),
                hidden.request.seed),
        wavelengths_(source.info(), hidden.model.spectral, is_luminous_, hidden.request.seed,
                     [this](double nm) { return add_optics(nm); }) {}

  RayResult run(Progress* progress, const Cancellation* cancel) {
    begin();
    std::size_t most = kRaysAtATime;
    while (result_.complete && source_.read(most, rays_)) {
      const std::size_t leaving = trace(cancel);
      if (!result_.complete) break;
      most = std::clamp(kRaysAtATime * rays_.size() / std::max<std::size_t>(leaving, 1), kFewestAtATime, kRaysAtATime);
      if (progress != nullptr) progress->at(source_.fraction_read());
      result_.complete = !is_cancelled(cancel);
    }
    end();
    return std::move(result_);
  }

 private:
  static raytrace::PathPolicy policy_of(const RayRequest& request) {
    raytrace::PathPolicy policy;
    policy.cutoff = request.cutoff;
    policy.split_power = request.split;
    policy.max_events = kMaxSurfaces;
    policy.max_segments = kMaxSegments;
    return policy;
  }

  std::uint32_t add_optics(double wavelength_nm) {
    if (!hidden_.optics.has_index_data_at(wavelength_nm)) extrapolated_nm_.push_back(wavelength_nm);
    return tracer_.add(hidden_.optics.at(wavelength_nm, hidden_.model.wet_elements));
  }

  void begin() {
    result_.design = hidden_.design;
    result_.request = hidden_.request;
    result_.source = source_.info();
    result_.placement = hidden_.placement;
    result_.acceptance_half_angle_deg = hidden_.design.detector.acceptance_half_angle_deg.back();
    result_.power = is_luminous_ ? RayPower::luminous_lm : RayPower::radiant_w;
    layout_ = layout();
    if (sink_ != nullptr) sink_->begin(layout_);
  }

  /// Returns the kinds of data that the leaving rays have.
  RaySinkLayout layout() const {
    RaySinkLayout layout{source_.info(), wavelengths_.has_several()};
    RaySetInfo& info = layout.info;
    const raytrace::Stokes& light = hidden_.design.light.polarisation;
    info.has_stokes = info.has_stokes || hidden_.request.stokes || light.q != 0.0 || light.u != 0.0 || light.v != 0.0;
    if (!info.tables.empty() && info.has_radiant) info.has_luminous = info.has_tristimulus = false;
    info.tables.clear();
    if (!layout.has_wavelengths && info.spectrum == RaySpectrum::unknown) {
      info.spectrum = RaySpectrum::one_wavelength;
      info.wavelength_nm = hidden_.model.spectral.front().wavelength_nm;
    }
    info.text(RayText::file_creator) = U"retrace";
    info.text(RayText::equipment) = wide_text(std::string("retrace ") + kVersion);
    info.text(RayText::more) = U"Light that has left a part";
    info.text(RayText::geometry) = U"mm in the frame of the part: the entrance face looks along +z";
    return layout;
  }

  double power_of(const SetRay& ray) const { return is_luminous_ ? ray.luminous_lm : ray.radiant_w; }

  /// Traces all rays that have been read.
  /// \return number of rays that leave the part
  std::size_t trace(const Cancellation* cancel) {
    incident_.clear();
    for (std::size_t k = 0; k < rays_.size(); ++k) {
      SetRay& ray = rays_[k];
      hidden_.placement.apply(ray);
      const std::uint32_t optics = wavelengths_.assign(ray, read_ + k);
      incident_.push_back({ray.position_mm, ray.direction,
                           light_of(ray, power_of(ray), source_.info().has_stokes, hidden_.design.light.polarisation),
                           optics});
    }
    const std::size_t leaving = trace(0, incident_.size(), cancel);
    read_ += rays_.size();
    return leaving;
  }

  /// Traces the rays from `begin` to `end`. If the leaving rays exceed the memory budget, traces both halves of the
  /// range one after the other.
  /// \return number of rays that leave the part
  std::size_t trace(std::size_t begin, std::size_t end, const Cancellation* cancel) {
    std::optional<raytrace::TracedRays> traced;
    try {
      traced = tracer_.trace(std::span(incident_).subspan(begin, end - begin), read_ + begin, cancel);
    } catch (const TraceBudgetError&) {
      if (end - begin <= 1) throw;
    }
    result_.complete = result_.complete && !is_cancelled(cancel);
    if (!result_.complete) return 0;
    if (!traced) {
      const std::size_t middle = begin + (end - begin) / 2;
      const std::size_t leaving = trace(begin, middle, cancel);
      return leaving + trace(middle, end, cancel);
    }
    result_.ledger.add(traced->ledger);
    if (sink_ != nullptr) write(*traced, begin);
    return traced->leaving.size();
  }

  /// Writes the traced rays in the order of the rays of the source.
  /// \param begin number of the first traced ray in `rays_`
  void write(const raytrace::TracedRays& traced, std::size_t begin) {
    out_.clear();
    auto missed = hidden_.request.keep_missed ? traced.missed.begin() : traced.missed.end();
    const auto add_missed_before = [&](std::uint32_t incident) {
      for (; missed != traced.missed.end() && *missed < incident; ++missed) out_.push_back(missed_ray(begin + *missed));
    };
    for (const raytrace::LeavingRay& ray : traced.leaving) {
      add_missed_before(ray.incident);
      out_.push_back(leaving_ray(ray, begin + ray.incident));
    }
    add_missed_before(UINT32_MAX);
    sink_->write(out_);
    result_.rays_out += out_.size();
  }

  AccountedRay missed_ray(std::size_t incident) const {
    AccountedRay out{rays_[incident], read_ + incident + 1, kMissedAccount};
    const SetRay& ray = rays_[incident];
    const bool has_stokes = source_.info().has_stokes;
    if (layout_.info.has_stokes)
      settle_polarisation(light_of(ray, power_of(ray), has_stokes, hidden_.design.light.polarisation), out);
    return out;
  }

  AccountedRay leaving_ray(const raytrace::LeavingRay& ray, std::size_t incident) const {
    const SetRay& source = rays_[incident];
    AccountedRay out{source, read_ + incident + 1, static_cast<std::size_t>(ray.account)};
    out.position_mm = ray.position_mm;
    out.direction = ray.direction;
    const double share = ray.light.power() / power_of(source);
    out.radiant_w *= share;
    out.luminous_lm *= share;
    out.tristimulus_x *= share;
    out.tristimulus_z *= share;
    if (layout_.info.has_stokes) settle_polarisation(ray.light, out);
    return out;
  }

  void end() {
    if (sink_ != nullptr) sink_->finish();
    result_.shortest_nm = wavelengths_.shortest_nm();
    result_.longest_nm = wavelengths_.longest_nm();
    result_.warnings = hidden_.model.warnings;
    if (source_.info().spectrum != RaySpectrum::unknown && !extrapolated_nm_.empty()) {
      const auto [least, most] = std::minmax_element(extrapolated_nm_.begin(), extrapolated_nm_.end());
      const materials::Material& material = hidden_.optics.material();
      result_.warnings.push_back(
          {"index_extrapolated", fmt::format("{}: the data of {} cover {} to {} nm; its index is extrapolated for "
                                             "wavelengths of rays from {} to {} nm",
                                             hidden_.design.source_name(), material.name, material.valid_from_nm,
                                             material.valid_to_nm, shortest(*least), shortest(*most))});
    }
    for (Warning& warning : source_.warnings()) result_.warnings.push_back(std::move(warning));
    if (result_.ledger.rays > 0 && result_.ledger.rays_missed == result_.ledger.rays)
      result_.warnings.push_back(
          {"no_ray_meets_part", "no ray meets the part: change the position or the direction of the source"});
  }

  const Impl& hidden_;
  RaySource& source_;
  RaySink* sink_;
  bool is_luminous_;
  std::vector<double> extrapolated_nm_;
  raytrace::RayTracer tracer_;
  RayWavelengths wavelengths_;
  RaySinkLayout layout_;
  std::vector<SetRay> rays_;
  std::vector<raytrace::IncidentRay> incident_;
  std::vector<AccountedRay> out_;
  std::uint64_t read_ = 0;
  RayResult result_;
};

RayResult RayStudy::run(RaySource& source, RaySink* sink, Progress* progress, const Cancellation* cancel) const {
  const auto start = std::chrono::steady_clock::now();
  RayResult result = Run(*impl_, source, sink).run(progress, cancel);
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace retrace::studies
