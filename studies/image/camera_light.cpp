#include "studies/image/camera_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "core/task_progress.h"
#include "raytrace/engines/wavelengths.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/observers/coefficients.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;

// Number of intervals of the finest grid along each side of the visible face.
constexpr int kMaxIntervals = 8;
// Maximum difference between the gain at the centre of the face and the mean of its corners, relative to the gain, for
// which the grid has no further points.
constexpr double kUniformity = 0.005;
// Maximum error of the interpolation in a coarser grid, relative to the largest luminance, for which a grid is fine
// enough. With half of the step, the error is about a quarter.
constexpr double kInterpolationError = 0.02;
// Minimum cosine of the angles of light and view. At smaller cosines, the gain is 1.
constexpr double kMinCosine = 0.02;
// Standard error, relative to the mean, at which the mean luminance of geometrical optics is known well enough.
constexpr double kMeanError = 0.003;
constexpr std::uint32_t kMinMeanPasses = 8, kMaxMeanPasses = 256;
constexpr std::size_t kMeanPixels = 48;
// Wavelength of the blur, near the maximum of the eye's response. The gain corrects the blur at all wavelengths.
constexpr double kBlurWavelengthNm = 555.0;
// Maximum power whose diffraction may be missing, as a fraction of the incident power.
constexpr double kMaxUndiffractedFraction = 1e-4;

/// Directions and discs at a point of the face, in the frame in which light is traced.
struct View {
  Vec3 to_lamp;
  Vec3 to_eye;
  raytrace::PhotometricApertures apertures;
  bool is_lit() const { return to_lamp.z() > kMinCosine && to_eye.z() > kMinCosine; }
};

View view_at(const geometry::Part& part, const raytrace::CameraScene& scene, const Vec2& local_mm) {
  const raytrace::FacePoint at = raytrace::face_point(part, scene, local_mm);
  const Vec3 lamp = scene.lamp.position_mm - at.world_mm;
  const Vec3 eye = scene.view.eye_mm - at.world_mm;
  const double lamp_mm = (scene.lamp.position_mm - scene.view.target_mm).norm();
  const double eye_mm = (scene.view.eye_mm - scene.view.target_mm).norm();
  const auto seen = [](Angle diameter, double usual_mm, double distance_mm) {
    return Angle::from_rad(diameter.rad() * usual_mm / distance_mm);
  };
  return {at.world_from_local.transpose() * lamp.normalized(),
          at.world_from_local.transpose() * eye.normalized(),
          {seen(scene.lamp.diameter, lamp_mm, lamp.norm()), seen(scene.view.pupil, eye_mm, eye.norm())}};
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

CameraLight::CameraLight(const design::Design& design, const PhotometrySettings& photometry, std::size_t parts,
                         PhotometricResponse response)
    : photometer_(design, photometry, parts, response), flux_(sum_of(photometer_.weights())) {
  photometer_.ignore_front_reflection();
}

std::vector<raytrace::WeightedOptics> CameraLight::optics() const {
  std::vector<raytrace::WeightedOptics> all;
  for (std::size_t k = 0; k < photometer_.optics().size(); ++k)
    all.push_back({photometer_.optics()[k].optics, photometer_.weights()[k] / flux_});
  return all;
}

std::optional<raytrace::ReturnedLight> CameraLight::geometric() const {
  if (std::abs(flux_ - 1.0) < 1e-9) return std::nullopt;
  raytrace::ReturnedLight light;
  light.gain = {flux_};
  return light;
}

/// Gains at the points of a grid over the visible face.
class CameraLight::Grid {
 public:
  Grid(const CameraLight& light, const geometry::Part& part, const raytrace::CameraScene& scene,
       const Cancellation* cancel)
      : light_(light),
        part_(part),
        scene_(scene),
        cancel_(cancel),
        diffracted_(light.photometer_),
        geometric_(light.photometer_),
        beams_(diffracted_.make_tracer()) {
    geometric_.ignore_diffraction();
    returned_.face_mm = raytrace::visible_face(part, scene);
    const double cells_mm = diffracted_.cell_width_mm() > 0.0 ? diffracted_.cell_width_mm() : part.size_mm;
    returned_.blur =
        raytrace::DiffractionBlur::for_cells(cells_mm, kBlurWavelengthNm, diffracted_.kernel().reach_rad());
    if (geometric_.is_exact()) return;
    // Without beams of geometrical optics, the gain is computed at the centre only.
    traced_mean_ = traced_mean(view_at(part_, scene_, returned_.face_mm.centre()));
  }

  Returned computed(Progress* progress) {
    Returned result;
    const int centre = kMaxIntervals / 2;
    if (traced_mean_) {
      PartProgress part(progress, 0.0, 1.0);
      result.cancelled = !compute({{centre, centre}}, &part);
      if (result.cancelled) return result;
      returned_.gain = {nodes_.at({centre, centre}).gain};
    } else {
      PartProgress first(progress, 0.0, 0.3);
      result.cancelled = !compute(points_of(1, {{centre, centre}}), &first);
      if (result.cancelled) return result;
      int intervals = 1;
      double begin = 0.3;
      double error = error_of(1, {{centre, centre}});
      for (double enough = kUniformity; error > enough && intervals < kMaxIntervals; enough = kInterpolationError) {
        intervals *= 2;
        PartProgress next(progress, begin, begin + 0.5 * (1.0 - begin));
        begin += 0.5 * (1.0 - begin);
        const std::vector<Index> points = points_of(intervals, {});
        result.cancelled = !compute(points, &next);
        if (result.cancelled) return result;
        error = error_of(intervals / 2, points);
      }
      returned_.columns = returned_.rows = static_cast<std::size_t>(intervals) + 1;
      returned_.gain.clear();
      for (const Index& index : points_of(intervals, {})) returned_.gain.push_back(nodes_.at(index).gain);
    }
    result.light = returned_;
    result.r_a = nodes_.at({centre, centre}).r_a;
    for (const auto& [index, node] : nodes_) result.is_incomplete = result.is_incomplete || node.is_incomplete;
    return result;
  }

 private:
  /// Numbers of a grid point along x and y, in steps of the finest grid.
  using Index = std::array<int, 2>;
  struct Node {
    double gain = 1.0;
    double luminance = 0.0;  ///< luminance per illuminance
    double r_a = 0.0;
    bool is_incomplete = false;
  };
  /// Intensities per steradian at a grid point: with diffraction, and of the blurred light of geometrical optics.
  struct Intensities {
    double diffracted = 0.0;
    double blurred = 0.0;
    bool is_incomplete = false;
  };

  /// Returns the points of a grid row by row, and further points.
  static std::vector<Index> points_of(int intervals, const std::vector<Index>& more) {
    std::vector<Index> points;
    const int step = kMaxIntervals / intervals;
    for (int y = 0; y <= kMaxIntervals; y += step)
      for (int x = 0; x <= kMaxIntervals; x += step) points.push_back({x, y});
    points.insert(points.end(), more.begin(), more.end());
    return points;
  }

  Vec2 local_mm(const Index& index) const {
    const Vec2 fraction = Vec2(index[0], index[1]) / kMaxIntervals;
    return returned_.face_mm.lower + returned_.face_mm.size().cwiseProduct(fraction);
  }

  bool measure_diffracted(const View& view, Intensities& result) const {
    const auto fields = diffracted_.far_fields(view.to_lamp, beams_, cancel_);
    if (!fields) return false;
    const raytrace::ApertureKernel kernel(view.apertures);
    for (const Photometer::WeightedField& field : *fields) {
      result.diffracted += field.weight * field.field.intensity(view.to_eye, kernel).per_sr;
      result.is_incomplete =
          result.is_incomplete || field.weight * field.field.beyond_budget_power() > kMaxUndiffractedFraction;
    }
    return true;
  }

  bool measure_blurred(const View& view, Intensities& result) const {
    // The picture is traced backwards from the eye.
    const auto fields = geometric_.far_fields(view.to_eye, beams_, cancel_);
    if (!fields) return false;
    const raytrace::ApertureKernel kernel(view.apertures);
    for (const Photometer::WeightedField& field : *fields)
      for (const raytrace::FarFieldRay& ray : field.field.rays()) {
        const double separation_rad = 2.0 * std::asin(std::min(1.0, 0.5 * (ray.direction - view.to_lamp).norm()));
        result.blurred += field.weight / light_.flux_ * ray.power * returned_.blur.per_sr(kernel, separation_rad);
      }
    return true;
  }

  /// Computes the nodes that are not known yet. Returns false if the computation was cancelled.
  bool compute(const std::vector<Index>& points, Progress* progress) {
    std::vector<Index> missing;
    for (const Index& index : points)
      if (!nodes_.contains(index) && view_at(part_, scene_, local_mm(index)).is_lit()) missing.push_back(index);
    std::vector<Intensities> measured(missing.size());
    std::vector<Intensities> blurred(missing.size());
    const std::size_t tasks = traced_mean_ ? 1 : 2;
    TaskProgress all(progress, std::max<std::size_t>(1, tasks * missing.size()));
    const bool done = raytrace::trace_wavelengths(
        missing.size(), tasks, true, all, [&](std::size_t node, std::size_t task, Progress&) {
          const View view = view_at(part_, scene_, local_mm(missing[node]));
          return task == 0 ? measure_diffracted(view, measured[node]) : measure_blurred(view, blurred[node]);
        });
    if (!done || is_cancelled(cancel_)) return false;
    for (std::size_t k = 0; k < missing.size(); ++k) {
      const View view = view_at(part_, scene_, local_mm(missing[k]));
      const double factor = view.to_lamp.z() / view.to_eye.z();
      const double mean = traced_mean_ ? *traced_mean_ : blurred[k].blurred;
      Node& node = nodes_[missing[k]];
      node.luminance = factor * measured[k].diffracted;
      node.r_a = view.to_lamp.z() * measured[k].diffracted;
      node.gain = mean > 0.0 ? node.luminance / mean : 1.0;
      node.is_incomplete = measured[k].is_incomplete;
    }
    for (const Index& index : points) nodes_.try_emplace(index);
    return true;
  }

  /// Returns the largest error of the luminance that interpolation in a grid causes at some points, relative to the
  /// largest luminance.
  double error_of(int intervals, const std::vector<Index>& points) {
    raytrace::ReturnedLight coarse = returned_;
    coarse.columns = coarse.rows = static_cast<std::size_t>(intervals) + 1;
    coarse.gain.clear();
    for (const Index& index : points_of(intervals, {})) coarse.gain.push_back(nodes_.at(index).gain);
    double error = 0.0;
    double largest = 0.0;
    for (const auto& [index, node] : nodes_) largest = std::max(largest, node.luminance);
    for (const Index& index : points) {
      const Node& node = nodes_.at(index);
      if (!(node.luminance > 0.0) || !(node.gain > 0.0)) continue;
      error = std::max(error, std::abs(coarse.gain_at(local_mm(index)) / node.gain - 1.0) * node.luminance / largest);
    }
    return error;
  }

  /// Returns the mean luminance per illuminance of the blurred light of geometrical optics, from a picture of the whole
  /// part in which all directions are those of one point.
  double traced_mean(const View& view) const {
    constexpr double kDistances = 1e5;  // distance of lamp and eye, in sizes of the part
    raytrace::CameraScene scene = scene_;
    Vec2 size;
    if (part_.period_mm) {
      size = 8.0 * *part_.period_mm;
      scene.film = raytrace::Film{size.x(), size.y(), {}};
    } else {
      size = geometry::bounding_box(part_.outline).size();
    }
    const double distance_mm = kDistances * size.norm();
    scene.view.target_mm = {0.0, 0.0, part_.thickness_mm};
    scene.view.eye_mm = scene.view.target_mm + distance_mm * view.to_eye;
    scene.view.up = view.to_eye.cross(Vec3::UnitX()).normalized();
    scene.view.columns = scene.view.rows = kMeanPixels;
    scene.view.width_mm = 1.05 * size.maxCoeff();
    scene.view.pupil = view.apertures.receiver;
    scene.lamp = {scene.view.target_mm + distance_mm * view.to_lamp, 1.0, view.apertures.source};
    scene.surroundings = {};
    scene.returned = raytrace::ReturnedLight{};
    scene.returned->blur = returned_.blur;
    scene.returned->has_front_reflection = false;
    const raytrace::CameraTracer tracer(part_, light_.optics(), scene, raytrace::kCameraPolicy, 1,
                                        raytrace::CameraEngine::embree);
    raytrace::CameraImage image = tracer.empty_image();
    while (image.passes < kMaxMeanPasses && tracer.add_pass(image, cancel_))
      if (image.passes >= kMinMeanPasses && image.part_error() <= kMeanError * image.part_mean()) break;
    return image.part_means.empty() ? 0.0 : image.part_mean();
  }

  const CameraLight& light_;
  const geometry::Part& part_;
  const raytrace::CameraScene& scene_;
  const Cancellation* cancel_;
  Photometer diffracted_;
  Photometer geometric_;
  raytrace::BeamTracer beams_;
  raytrace::ReturnedLight returned_;
  std::optional<double> traced_mean_;
  std::map<Index, Node> nodes_;
};

CameraLight::Returned CameraLight::returned(const geometry::Part& part, const raytrace::CameraScene& scene,
                                            Progress* progress, const Cancellation* cancel) const {
  Returned result;
  const bool is_wide = photometer_.cell_width_mm() >= photometer_.min_undiffracted_mm();
  if (!has_diffraction() || is_wide || !(scene.lamp.illuminance_lx > 0.0)) {
    result.light = geometric();
    return result;
  }
  return Grid(*this, part, scene, cancel).computed(progress);
}

}  // namespace retrace::studies
