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
#include "raytrace/observers/camera_face.h"
#include "raytrace/observers/small_angle.h"

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
// Maximum relative standard error of the gain at the centre of the face. Above it, the cut-off power of beams is
// reduced.
constexpr double kResamplingError = 0.004;
// Factor by which the cut-off power is reduced in each further attempt, and the maximum number of further attempts.
constexpr double kCutoffStep = 0.1;
constexpr int kMaxCutoffSteps = 3;
// Fraction of the progress for the mean luminance of geometrical optics, and fraction of the remaining progress for the
// choice of the cut-off power.
constexpr double kProgressOfMean = 0.6, kProgressOfCutoff = 0.3;
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

CameraLight::Returned CameraLight::without_diffraction() const {
  Returned result;
  if (std::abs(flux_ - 1.0) >= 1e-9) result.correction.gain = {flux_};
  return result;
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
    correction_.face_mm = raytrace::visible_face(part, scene);
    const double cells_mm = diffracted_.cell_width_mm() > 0.0 ? diffracted_.cell_width_mm() : part.size_mm;
    correction_.blur =
        raytrace::DiffractionBlur::for_cells(cells_mm, kBlurWavelengthNm, diffracted_.kernel().reach_rad());
  }

  /// Computes the returned light. Returns nothing if the computation was cancelled.
  std::optional<Returned> compute(Progress* progress) {
    double begin = 0.0;
    const auto next = [&](double end) { return PartProgress(progress, std::exchange(begin, end), end); };
    // Without beams of geometrical optics, the gain is computed at the centre only.
    if (!geometric_.is_exact()) {
      PartProgress part = next(kProgressOfMean);
      traced_mean_ = traced_mean(view_at(part_, scene_, correction_.face_mm.centre()), &part);
      if (is_cancelled(cancel_)) return std::nullopt;
    }
    PartProgress of_cutoff = next(std::lerp(begin, 1.0, kProgressOfCutoff));
    if (!choose_cutoff(&of_cutoff)) return std::nullopt;
    PartProgress of_nodes = next(1.0);
    Returned result;
    if (traced_mean_) {
      if (!compute_nodes({kCentre}, &of_nodes)) return std::nullopt;
      result.correction = correction_;
      result.correction.gain = {nodes_.at(kCentre).gain};
    } else {
      const std::optional<int> intervals = refine(&of_nodes);
      if (!intervals) return std::nullopt;
      result.correction = correction_with(*intervals);
    }
    result.r_a = nodes_.at(kCentre).r_a;
    result.r_a_error = nodes_.at(kCentre).r_a_error;
    result.is_incomplete = std::ranges::any_of(nodes_, [](const auto& item) { return item.second.is_incomplete; });
    return result;
  }

 private:
  /// Numbers of a grid point along x and y, in steps of the finest grid.
  using Index = std::array<int, 2>;
  static constexpr Index kCentre = {kMaxIntervals / 2, kMaxIntervals / 2};
  struct Node {
    double gain = 1.0;
    double luminance = 0.0;  ///< luminance per illuminance
    double r_a = 0.0;
    double r_a_error = 0.0;
    bool is_incomplete = false;
  };
  /// Intensities per steradian at a grid point: with diffraction, and of the blurred light of geometrical optics.
  struct Intensities {
    double diffracted = 0.0;
    double diffracted_error = 0.0;  ///< standard error caused by the resampling of weak beams
    double blurred = 0.0;
    double blurred_error = 0.0;
    bool is_incomplete = false;

    /// Returns the standard error of the gain, relative to the gain.
    double relative_error() const {
      return std::hypot(diffracted > 0.0 ? diffracted_error / diffracted : 0.0,
                        blurred > 0.0 ? blurred_error / blurred : 0.0);
    }
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
    return correction_.face_mm.lower + correction_.face_mm.size().cwiseProduct(fraction);
  }

  /// Computes finer grids until one is fine enough. Returns its number of intervals along each side, or nothing if the
  /// computation was cancelled.
  std::optional<int> refine(Progress* progress) {
    PartProgress first(progress, 0.0, 0.3);
    if (!compute_nodes(points_of(1, {kCentre}), &first)) return std::nullopt;
    int intervals = 1;
    double begin = 0.3;
    double error = error_of(1, {kCentre});
    for (double enough = kUniformity; error > enough && intervals < kMaxIntervals; enough = kInterpolationError) {
      intervals *= 2;
      PartProgress next(progress, begin, begin + 0.5 * (1.0 - begin));
      begin += 0.5 * (1.0 - begin);
      const std::vector<Index> points = points_of(intervals, {});
      if (!compute_nodes(points, &next)) return std::nullopt;
      error = error_of(intervals / 2, points);
    }
    return intervals;
  }

  bool measure_diffracted(const View& view, Intensities& result) const {
    const auto fields = diffracted_.far_fields(view.to_lamp, beams_, cancel_);
    if (!fields) return false;
    const raytrace::ApertureKernel kernel(view.apertures);
    for (const Photometer::WeightedField& field : *fields) {
      const raytrace::FarFieldIntensity seen = field.field.intensity(view.to_eye, kernel);
      result.diffracted += field.weight * seen.per_sr;
      result.diffracted_error = std::hypot(result.diffracted_error, field.weight * seen.error_per_sr);
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
    for (const Photometer::WeightedField& field : *fields) {
      std::vector<double> of_replicate(geometric_.replicates(), 0.0);
      for (const raytrace::FarFieldRay& ray : field.field.rays()) {
        const double separation_rad = raytrace::small_angle_between(ray.direction, view.to_lamp);
        const double per_sr = field.weight / light_.flux_ * ray.power * correction_.blur.per_sr(kernel, separation_rad);
        result.blurred += per_sr;
        if (ray.replicate) of_replicate[*ray.replicate] += per_sr;
      }
      result.blurred_error = std::hypot(result.blurred_error, error_of_sum(of_replicate));
    }
    return true;
  }

  /// Returns the standard error of the sum of all values.
  /// \param of_replicate values of independent replicates, each already divided by the number of replicates
  static double error_of_sum(const std::vector<double>& of_replicate) {
    const auto count = static_cast<double>(of_replicate.size());
    if (of_replicate.size() < 2) return 0.0;
    const double mean = sum_of(of_replicate) / count;
    double squares = 0.0;
    for (const double value : of_replicate) squares += (value - mean) * (value - mean);
    return std::sqrt(squares * count / (count - 1.0));
  }

  /// Reduces the cut-off power of beams until the standard error of the gain at the centre is small, or until there
  /// would be too many beams. Returns false if the computation was cancelled.
  bool choose_cutoff(Progress* progress) {
    const View view = view_at(part_, scene_, local_mm(kCentre));
    if (!view.is_lit()) return true;
    const auto use = [&](double cutoff) {
      diffracted_.set_cutoff_of_element(cutoff);
      geometric_.set_cutoff_of_element(cutoff);
    };
    TaskProgress all(progress, tasks_of_point() * (kMaxCutoffSteps + 1));
    for (int step = 0;; ++step) {
      const double cutoff = diffracted_.cutoff_of_element();
      std::optional<std::vector<Intensities>> seen;
      try {
        seen = measured({view}, all);
      } catch (const BudgetError&) {
        if (step == 0) throw;
        use(cutoff / kCutoffStep);
        return true;
      }
      if (!seen) return false;
      set_node(kCentre, view, seen->front());
      // If the returned light is too weak to be visible, its error need not be reduced.
      const bool is_dark = nodes_.at(kCentre).luminance < kMinRetroreflected;
      if (is_dark || step == kMaxCutoffSteps || seen->front().relative_error() <= kResamplingError) return true;
      use(kCutoffStep * cutoff);
    }
  }

  std::size_t tasks_of_point() const { return traced_mean_ ? 1 : 2; }

  /// Measures the intensities for several views. Returns nothing if the computation was cancelled.
  std::optional<std::vector<Intensities>> measured(const std::vector<View>& views, TaskProgress& all) {
    std::vector<Intensities> found(views.size());
    const bool done = raytrace::trace_wavelengths(
        views.size(), tasks_of_point(), true, all, [&](std::size_t k, std::size_t task, Progress&) {
          return task == 0 ? measure_diffracted(views[k], found[k]) : measure_blurred(views[k], found[k]);
        });
    if (!done || is_cancelled(cancel_)) return std::nullopt;
    return found;
  }

  void set_node(const Index& index, const View& view, const Intensities& seen) {
    const double factor = view.to_lamp.z() / view.to_eye.z();
    const double mean = traced_mean_ ? *traced_mean_ : seen.blurred;
    Node& node = nodes_[index];
    node.luminance = factor * seen.diffracted;
    node.r_a = view.to_lamp.z() * seen.diffracted;
    node.r_a_error = view.to_lamp.z() * seen.diffracted_error;
    node.gain = mean > 0.0 ? node.luminance / mean : 1.0;
    node.is_incomplete = seen.is_incomplete;
  }

  /// Computes the nodes that are not known yet. Returns false if the computation was cancelled.
  bool compute_nodes(const std::vector<Index>& points, Progress* progress) {
    std::vector<Index> missing;
    std::vector<View> views;
    for (const Index& index : points) {
      const View view = view_at(part_, scene_, local_mm(index));
      if (nodes_.contains(index) || !view.is_lit()) continue;
      missing.push_back(index);
      views.push_back(view);
    }
    TaskProgress all(progress, std::max<std::size_t>(1, tasks_of_point() * missing.size()));
    const std::optional<std::vector<Intensities>> found = measured(views, all);
    if (!found) return false;
    for (std::size_t k = 0; k < missing.size(); ++k) set_node(missing[k], views[k], (*found)[k]);
    for (const Index& index : points) nodes_.try_emplace(index);
    return true;
  }

  /// Returns the correction with the gains at the points of a grid.
  /// \param intervals number of intervals of the grid along each side
  /// \pre the nodes of the grid have been computed
  raytrace::ReturnCorrection correction_with(int intervals) const {
    raytrace::ReturnCorrection correction = correction_;
    correction.columns = correction.rows = static_cast<std::size_t>(intervals) + 1;
    correction.gain.clear();
    for (const Index& index : points_of(intervals, {})) correction.gain.push_back(nodes_.at(index).gain);
    return correction;
  }

  /// Returns the largest error of the luminance that interpolation in a grid causes at some points, relative to the
  /// largest luminance.
  double error_of(int intervals, const std::vector<Index>& points) const {
    const raytrace::ReturnCorrection coarse = correction_with(intervals);
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
  double traced_mean(const View& view, Progress* progress) const {
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
    scene.correction.blur = correction_.blur;
    scene.has_front_reflection = false;
    const raytrace::CameraTracer tracer(part_, light_.optics(), scene, raytrace::kCameraPolicy, 1,
                                        raytrace::CameraEngine::embree);
    raytrace::CameraImage image = tracer.empty_image();
    while (image.passes < kMaxMeanPasses && tracer.add_pass(image, cancel_)) {
      if (image.passes < kMinMeanPasses || image.part_means.empty()) continue;
      const double goal = kMeanError * image.part_mean();
      const double error = image.part_error();
      if (error <= goal) break;
      // The error is inversely proportional to the square root of the number of passes.
      const double needed = goal > 0.0 ? image.passes * std::pow(error / goal, 2.0) : kMaxMeanPasses;
      if (progress != nullptr)
        progress->at(image.passes / std::clamp<double>(needed, std::max(kMinMeanPasses, image.passes), kMaxMeanPasses));
    }
    return image.part_means.empty() ? 0.0 : image.part_mean();
  }

  const CameraLight& light_;
  const geometry::Part& part_;
  const raytrace::CameraScene& scene_;
  const Cancellation* cancel_;
  Photometer diffracted_;
  Photometer geometric_;
  raytrace::BeamTracer beams_;
  raytrace::ReturnCorrection correction_;  ///< blur and area of the grid; the gains are set later
  std::optional<double> traced_mean_;
  std::map<Index, Node> nodes_;
};

std::optional<CameraLight::Returned> CameraLight::returned(const geometry::Part& part,
                                                           const raytrace::CameraScene& scene, Progress* progress,
                                                           const Cancellation* cancel) const {
  const bool is_wide = photometer_.cell_width_mm() >= photometer_.min_undiffracted_mm();
  if (!has_diffraction() || is_wide || !(scene.lamp.illuminance_lx > 0.0)) return without_diffraction();
  return Grid(*this, part, scene, cancel).compute(progress);
}

}  // namespace retrace::studies
