#include "studies/image/camera_study.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string_view>

#include "core/error.h"
#include "core/number_format.h"
#include "design/engine_facts.h"
#include "raytrace/observers/photometric_geometry.h"
#include "requests/descriptions.h"
#include "studies/image/io/lamp_reader.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;

// Ratio of the width that the picture shows to the width of the part.
constexpr double kMargin = 1.15;

std::array<double, 2> film_of(const CameraRequest& r) {
  return r.film_mm.value_or(kDefaultFilmMm);
}

/// Checks the size of the sheet and the radius of the cylinder on which the sheet is mounted. The sheet may cover at
/// most half of the circumference. Both values are allowed only for infinite parts.
void check_film(const CameraRequest& r, bool is_infinite) {
  if (!is_infinite) {
    constexpr std::string_view need = "requires a design with array.extent = \"infinite\": ";
    if (r.cylinder_mm)
      throw InputError(Field{"cylinder_mm"}, fmt::format("{}finite parts are always plane in this version", need));
    if (r.film_mm) throw InputError(Field{"film_mm"}, fmt::format("{}a finite part is shown in its own size", need));
    return;
  }
  const double least = film_of(r)[0] / std::numbers::pi;
  if (r.cylinder_mm && std::abs(*r.cylinder_mm) < least)
    throw InputError(
        Field{"cylinder_mm"},
        fmt::format(
            "must be at least {0} or at most -{0}, so that the sheet covers at most half of the cylinder, got {1}",
            shortest(least), shortest(*r.cylinder_mm)));
}

std::optional<PhotometricLamp> lamp_of(const CameraRequest& r) {
  if (r.lamp.empty()) return std::nullopt;
  return read_lamp(r.lamp, Field{"lamp"});
}

Vec3 to_vec(const std::array<double, 3>& a) {
  return {a[0], a[1], a[2]};
}

std::string text_of(const Vec3& p) {
  return fmt::format("{},{},{}", shortest(p.x()), shortest(p.y()), shortest(p.z()));
}

bool is_inside(const geometry::Part& part, const Vec3& p) {
  if (p.z() > part.thickness_mm || p.z() < -part.element_depth_mm) return false;
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  const Vec2 at = p.head<2>() + box.centre();
  for (std::size_t k = 0; k < part.outline.size(); ++k) {
    const Vec2& a = part.outline[k];
    const Vec2 along = part.outline[(k + 1) % part.outline.size()] - a;
    if (along.x() * (at.y() - a.y()) - along.y() * (at.x() - a.x()) < 0.0) return false;
  }
  return true;
}

/// Returns true if a point is on the side of the sheet where the body of the part is.
bool is_behind(const raytrace::Film& film, double thickness_mm, const Vec3& p) {
  if (!film.radius_mm) return p.z() <= thickness_mm;
  const double from_axis = std::hypot(p.x(), p.z() - thickness_mm + *film.radius_mm);
  return *film.radius_mm > 0.0 ? from_axis <= *film.radius_mm : from_axis >= -*film.radius_mm;
}

void check_place(const geometry::Part& part, const raytrace::CameraScene& scene, const Vec3& place, Field field,
                 const char* what) {
  const bool bad = scene.film ? is_behind(*scene.film, part.thickness_mm, place) : is_inside(part, place);
  if (bad)
    throw InputError(field, fmt::format("the {} must be outside the {}, got {} mm", what,
                                        scene.film ? "body, in front of the entrance face" : "part", text_of(place)));
  if (place == scene.view.target_mm) throw InputError(field, "must differ from the point that the camera looks at");
}

double shown_width(const CameraRequest& r, const geometry::Part& part) {
  if (r.field_mm) return *r.field_mm;
  const auto [film_x_mm, film_y_mm] = film_of(r);
  const Vec2 size = part.period_mm ? Vec2(film_x_mm, film_y_mm) : geometry::bounding_box(part.outline).size();
  const double aspect = static_cast<double>(r.columns) / static_cast<double>(r.rows);
  return kMargin * std::max(size.x(), size.y() * aspect);
}

raytrace::CameraScene scene_of(const CameraRequest& r, const std::optional<PhotometricLamp>& lamp,
                               const geometry::Part& part) {
  raytrace::CameraScene scene;
  const raytrace::PhotometricGeometry geometry =
      raytrace::geometry_from({Angle::from_deg(r.v_deg), Angle::from_deg(r.h_deg)}, Angle::from_deg(r.observation_deg),
                              Angle::from_deg(r.rotation_deg));
  const raytrace::PhotometricDirections towards = raytrace::directions_of(geometry);
  const Vec3 target(0.0, 0.0, part.thickness_mm);
  const double distance_mm = 1e3 * r.distance_m;
  scene.view.target_mm = target;
  scene.view.eye_mm = r.eye_mm ? to_vec(*r.eye_mm) : Vec3(target + distance_mm * towards.to_observer);
  scene.view.up = raytrace::return_frame(geometry).up;
  scene.view.columns = r.columns;
  scene.view.rows = r.rows;
  scene.view.width_mm = shown_width(r, part);
  scene.view.pupil = Angle::from_deg(r.pupil_arcmin / 60.0);
  scene.lamp.position_mm = r.lamp_mm ? to_vec(*r.lamp_mm) : Vec3(target + distance_mm * towards.to_source);
  const double lamp_m = 1e-3 * (scene.lamp.position_mm - target).norm();
  scene.lamp.illuminance_lx =
      lamp ? lamp->intensity.cd(from_aimed(-Vec3::UnitZ(), r.lamp_aim_deg)) / (lamp_m * lamp_m) : r.illuminance_lx;
  scene.lamp.diameter = Angle::from_deg(r.lamp_arcmin / 60.0);
  // A plane illuminated by a half space of uniform luminance L has the illuminance pi L.
  scene.surroundings = {r.ambient_lx / std::numbers::pi, r.backlight_lx / std::numbers::pi};
  const auto [film_x_mm, film_y_mm] = film_of(r);
  if (part.period_mm) scene.film = raytrace::Film{film_x_mm, film_y_mm, r.cylinder_mm};
  return scene;
}

double angle_deg(const Vec3& a, const Vec3& b) {
  return Angle::from_rad(std::atan2(a.cross(b).norm(), a.dot(b))).deg();
}

bool is_unpolarised(const raytrace::Stokes& s) {
  return s.q == 0.0 && s.u == 0.0 && s.v == 0.0;
}

}  // namespace

CameraStudy::CameraStudy(design::Design design, CameraRequest request, raytrace::DiscAverage discs)
    : design_(std::move(design)), request_(std::move(request)) {
  requests::check(request_);
  lamp_ = lamp_of(request_);
  if (!is_unpolarised(design_.light.polarisation))
    throw InputError({design_.source, 0, "light.polarisation"},
                     "camera images support only unpolarised light in this version: leave this key out");
  if (design_.surface.entrance.scatters())
    throw InputError(design_.where_entrance_scatters(),
                     "camera images do not support entrance faces that scatter light: use retrace rre, photometry or "
                     "image --detector");
  check_film(request_, design_.is_infinite());
  model_ = design::make_model(design_, materials::MaterialLibrary::shipped());
  scene_ = scene_of(request_, lamp_, model_.part);
  scene_.discs = discs;
  check_place(model_.part, scene_, scene_.view.eye_mm, {request_.eye_mm ? "eye_mm" : "observation_deg"}, "camera");
  check_place(model_.part, scene_, scene_.lamp.position_mm, {request_.lamp_mm ? "lamp_mm" : "v_deg"}, "lamp");
  const Vec3 view = (scene_.view.target_mm - scene_.view.eye_mm).normalized();
  if (view.cross(scene_.view.up).norm() < 1e-6) scene_.view.up = view.unitOrthogonal();
}

namespace {

/// Returns the number of passes after which the noise is as low as requested. A pass adds one sample to every pixel.
/// The noise is inversely proportional to the square root of the number of passes.
double passes_needed(const raytrace::CameraImage& image, const CameraRequest& request) {
  return image.passes * std::pow(image.relative_noise() / request.noise, 2.0);
}

/// Adds the passes of a picture in ascending order of their numbers, even if they are finished in another order.
class PassLedger : public TaskLedger {
 public:
  PassLedger(const CameraRequest& request, raytrace::CameraImage& image, Progress* progress,
             const std::function<void(const raytrace::CameraImage&)>& after_pass)
      : request_(request),
        image_(image),
        progress_(progress),
        after_pass_(after_pass),
        goal_(request.passes.value_or(CameraStudy::kMaxPasses)),
        max_ahead_(std::max(kFewestAhead, kBytesAhead / (image.luminance.size() * 2 * sizeof(double)))) {}

  std::optional<std::uint64_t> take() override {
    if (is_finished_) return std::nullopt;
    if (!given_back_.empty()) return given_back_.extract(given_back_.begin()).value();
    if (next_ >= goal_ || next_ >= image_.passes + max_ahead_) return std::nullopt;
    return next_++;
  }
  void give_back(std::uint64_t pass) override { given_back_.insert(pass); }
  void finish(std::uint64_t pass, const std::string& bytes) override {
    ahead_[pass] = bytes;
    for (auto next = ahead_.find(image_.passes); !is_finished_ && next != ahead_.end();
         next = ahead_.find(image_.passes)) {
      add(numbers_of(next->second));
      ahead_.erase(next);
    }
  }
  bool is_finished() override { return is_finished_; }

  void add(const std::vector<double>& pass) {
    image_.add(pass);
    if (after_pass_) after_pass_(image_);
    double share = static_cast<double>(image_.passes) / goal_;
    is_finished_ = image_.passes == goal_;
    if (!request_.passes) {
      const double noise = image_.passes > 1 ? image_.relative_noise() : 1.0;
      is_finished_ =
          is_finished_ || (image_.passes >= CameraStudy::kMinPasses && noise <= request_.noise) ||
          (image_.passes >= CameraStudy::kPassesToJudge && passes_needed(image_, request_) > CameraStudy::kMaxPasses);
      share = image_.passes > 1 ? std::min(0.99, std::pow(request_.noise / std::max(noise, 1e-300), 2.0)) : 0.0;
    }
    furthest_ = std::max(furthest_, share);
    if (progress_ != nullptr && !is_finished_) progress_->at(furthest_);
  }

 private:
  static constexpr std::size_t kFewestAhead = 8;
  static constexpr std::size_t kBytesAhead = std::size_t{1} << 30U;

  const CameraRequest& request_;
  raytrace::CameraImage& image_;
  Progress* progress_;
  const std::function<void(const raytrace::CameraImage&)>& after_pass_;
  std::uint32_t goal_;
  std::size_t max_ahead_;  ///< maximum number of passes that are traced before an earlier one is finished
  std::uint64_t next_ = 0;
  std::set<std::uint64_t> given_back_;
  std::map<std::uint64_t, std::string> ahead_;
  double furthest_ = 0.0;
  bool is_finished_ = false;
};

ComputeTask passes_by(const std::shared_ptr<const raytrace::CameraTracer>& tracer) {
  return [tracer](std::uint64_t number, const Cancellation* cancel) -> std::optional<std::string> {
    const auto pass = tracer->pass(static_cast<std::uint32_t>(number), cancel);
    return pass ? std::optional(bytes_of(*pass)) : std::nullopt;
  };
}

}  // namespace

std::shared_ptr<const raytrace::CameraTracer> CameraStudy::tracer() const {
  std::vector<raytrace::WeightedOptics> light;
  for (const design::SpectralOptics& at : model_.spectral) light.push_back({at.optics, at.weight});
  const bool by_cells = !raytrace::obstacle_for(raytrace::Engine::cell, design::engine_facts(design_, &model_.optics));
  return std::make_shared<const raytrace::CameraTracer>(
      model_.part, light, scene_, raytrace::kCameraPolicy, request_.seed,
      by_cells ? raytrace::CameraEngine::fastest : raytrace::CameraEngine::embree);
}

ComputeTask CameraStudy::passes() const {
  return passes_by(tracer());
}

CameraResult CameraStudy::run(Progress* progress, const Cancellation* cancel,
                              const std::function<void(const raytrace::CameraImage&)>& after_pass,
                              const DistributeTasks& distribute) const {
  const auto start = std::chrono::steady_clock::now();
  const std::shared_ptr<const raytrace::CameraTracer> tracing = tracer();
  CameraResult result;
  result.design = design_;
  result.request = request_;
  result.lamp = lamp_;
  result.scene = scene_;
  result.warnings = model_.warnings;
  const Vec3 to_eye = scene_.view.eye_mm - scene_.view.target_mm;
  const Vec3 to_lamp = scene_.lamp.position_mm - scene_.view.target_mm;
  result.observation_deg = angle_deg(to_eye, to_lamp);
  result.entrance_deg = angle_deg(to_lamp, Vec3::UnitZ());
  result.viewing_deg = angle_deg(to_eye, Vec3::UnitZ());
  result.engine = tracing->is_by_cells() ? "cell" : "embree";
  result.image = tracing->empty_image();
  PassLedger ledger(request_, result.image, progress, after_pass);
  if (distribute) distribute(passes_by(tracing), ledger);
  while (!distribute && !ledger.is_finished()) {
    const auto pass = tracing->pass(result.image.passes, cancel);
    if (!pass) break;
    ledger.add(*pass);
  }
  result.complete = ledger.is_finished();
  if (result.complete && !request_.passes && result.image.relative_noise() > request_.noise)
    result.warnings.push_back(
        {"noise_above_target",
         fmt::format("{}: the noise of {} is above the target of {} after {} passes. The target requires about {:.2g} "
                     "passes, but at most {} are made unless you set the number of passes",
                     design_.source_name(), fixed(result.image.relative_noise(), 4), shortest(request_.noise),
                     result.image.passes, passes_needed(result.image, request_), kMaxPasses)});
  if (result.complete && result.image.part_mean() == 0.0)
    result.warnings.push_back(
        {"no_light_found",
         fmt::format("{}: no light from the part reaches the camera in {} passes: the part is dark, or bright paths "
                     "are so rare that more passes are needed (set the number of passes)",
                     design_.source_name(), result.image.passes)});
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace retrace::studies
