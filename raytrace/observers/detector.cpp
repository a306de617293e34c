#include "raytrace/observers/detector.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "core/angle.h"
#include "core/error.h"
#include "core/infinity.h"
#include "core/random.h"
#include "core/task_progress.h"
#include "core/threads.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/faces/entrance_face.h"
#include "raytrace/light/exit_observer.h"
#include "raytrace/light/ledger.h"
#include "raytrace/paths/path_tracer.h"
#include "raytrace/sampling/entrance_sampler.h"
#include "raytrace/sampling/flush_denormals.h"
#include "raytrace/sampling/replicates.h"
#include "raytrace/sampling/sobol.h"

namespace retrace::raytrace {
namespace {

using geometry::Polygon;

constexpr std::uint32_t kRaysPerDetectorTask = 2048;

/// Returns the outline of the entrance face, or of one period if the part is infinite.
Polygon face_of(const geometry::Part& part) {
  return part.period_mm ? geometry::to_polygon({Vec2::Zero(), *part.period_mm}) : part.outline;
}

/// Distributes the power of a beam uniformly over a polygon. In an infinite part, the irradiance is periodic. The part
/// of the polygon outside of the period is therefore moved into it by whole periods.
void spread(const geometry::Part& part, const PixelGrid& grid, const Polygon& polygon, double power,
            std::vector<double>& irradiance) {
  const double area = geometry::area(polygon);
  if (!(area > 0.0)) return;
  const double to_irradiance = power / area * part.entrance_area_mm2 / grid.pixel_area_mm2();
  const auto add = [&](std::size_t pixel, double covered_mm2) { irradiance[pixel] += to_irradiance * covered_mm2; };
  if (!part.period_mm) {
    grid.cover(polygon, add);
    return;
  }
  const geometry::Rectangle box = geometry::bounding_box(polygon);
  const Vec2 first = box.lower.cwiseQuotient(*part.period_mm).array().floor();
  const Vec2 last = box.upper.cwiseQuotient(*part.period_mm).array().floor();
  for (double j = first.y(); j <= last.y(); ++j)
    for (double i = first.x(); i <= last.x(); ++i)
      grid.cover(geometry::moved(polygon, -Vec2(i, j).cwiseProduct(*part.period_mm)), add);
}

void add_direction(const DetectorSetting& setting, const Vec3& direction, double power, DetectorMaps& maps) {
  const Vec2 angles_rad = setting.frame.angles_rad(direction);
  if (const auto bin = setting.angles.bin_of(angles_rad))
    maps.per_sr.value[*bin] += power / setting.angles.solid_angle_sr(*bin);
  else
    maps.outside += power;
  if (const auto ring = AngularRings::ring_at(angles_rad.norm())) maps.rings.power[*ring] += power;
}

DetectorMaps empty_maps(const DetectorSetting& setting) {
  DetectorMaps maps;
  maps.leaving.value.assign(setting.face.size(), 0.0);
  maps.entering.value.assign(setting.face.size(), 0.0);
  maps.per_sr.value.assign(setting.angles.size(), 0.0);
  return maps;
}

/// Power that one path adds to one pixel, ring or bin of directions. There are few entries per path. They are added in
/// the order of the paths, so that the sum does not depend on the number of threads.
struct Deposit {
  std::uint32_t index = 0;
  double power = 0.0;
};
struct Deposits {
  std::vector<Deposit> leaving;
  std::vector<Deposit> entering;
  std::vector<Deposit> rings;   ///< indices of AngularRings::power
  std::vector<Deposit> angles;  ///< indices of bins; the index after the last bin means outside of the grid
  double in_cone = 0.0;
  double truncated = 0.0;
  double lost = 0.0;
};

/// Records the light of paths, one path after another.
class Recorder : public ExitObserver {
 public:
  Recorder(const geometry::Part& part, const Vec2& centre_mm, const PathSetup& light, const DetectorSetting& setting,
           Deposits& deposits)
      : part_(part), centre_mm_(centre_mm), light_(light), setting_(setting), deposits_(deposits) {}

  /// Begins a path at a point of the plane in which the incident beam starts.
  void enters(const Vec2& position_mm) {
    if (light_.entrance_face != nullptr) {
      entry_ = pixel_of_curved_face(position_mm);
      return;  // the walker reports the light that a curved face reflects
    }
    entry_ = pixel_at(position_mm);
    if (light_.optics.entrance.scatters()) return;  // in this case the walker reports the reflected light
    const Vec3 on_face(position_mm.x(), position_mm.y(), light_.thickness_mm);
    if (!light_.stops.reaches(on_face, light_.to_source) ||
        !light_.stops.passes_mount(on_face, light_.entry.reflected_direction))
      return;
    add(position_mm, light_.entry.reflected_direction, light_.entry.reflected.i);
  }
  void on_exit(const ExitEvent& departure) override {
    if (departure.is_through_entrance())
      add(departure.position.head<2>(), departure.direction, departure.light.power());
  }

 private:
  std::optional<std::size_t> pixel_at(Vec2 position_mm) const {
    position_mm += centre_mm_;
    if (part_.period_mm) {
      const Vec2 periods = position_mm.cwiseQuotient(*part_.period_mm).array().floor();
      position_mm -= periods.cwiseProduct(*part_.period_mm);
    }
    return setting_.face.pixel_at(position_mm);
  }

  /// Returns the pixel at which the light meets the curved entrance face, or nothing if the light misses the face.
  std::optional<std::size_t> pixel_of_curved_face(const Vec2& position_mm) const {
    const Vec3 start(position_mm.x(), position_mm.y(), light_.entrance_face->beam_height_mm(position_mm));
    const Vec3 direction = -light_.to_source;
    const auto met = light_.entrance_face->first_hit({start, direction, {}, false, way_over_part(start, direction)});
    if (!met) return std::nullopt;
    return pixel_at((start + met->hit.t * direction).head<2>());
  }

  /// Returns the distance along a ray from its start to the nearest side of the part.
  double way_over_part(const Vec3& start, const Vec3& direction) const {
    double way_mm = kInfinity;
    for (const LightSetup::Side& side : light_.sides) {
      const double towards = side.normal.dot(direction);
      if (towards > 0.0) way_mm = std::min(way_mm, std::max(0.0, (side.offset_mm - side.normal.dot(start)) / towards));
    }
    return way_mm;
  }

  void add(const Vec2& position_mm, const Vec3& direction, double power) {
    const Vec2 angles_rad = setting_.frame.angles_rad(direction);
    const auto bin = setting_.angles.bin_of(angles_rad);
    if (const auto ring = AngularRings::ring_at(angles_rad.norm()))
      deposits_.rings.push_back({static_cast<std::uint32_t>(*ring), power});
    deposits_.angles.push_back({static_cast<std::uint32_t>(bin.value_or(setting_.angles.size())), power});
    if (light_.cone_of(direction) >= light_.cone_chord2.size()) return;
    deposits_.in_cone += power;
    if (const auto pixel = pixel_at(position_mm))
      deposits_.leaving.push_back({static_cast<std::uint32_t>(*pixel), power});
    if (entry_) deposits_.entering.push_back({static_cast<std::uint32_t>(*entry_), power});
  }

  const geometry::Part& part_;
  Vec2 centre_mm_;
  const PathSetup& light_;
  const DetectorSetting& setting_;
  Deposits& deposits_;
  std::optional<std::size_t> entry_;
};

}  // namespace

std::optional<std::size_t> AngularRings::ring_at(double angle_rad) {
  const double ring = Angle::from_rad(angle_rad).deg() / kMaxDeg * static_cast<double>(kCount);
  if (!(ring < static_cast<double>(kCount))) return std::nullopt;
  return static_cast<std::size_t>(ring);
}

std::optional<double> AngularRings::half_angle_deg(double fraction) const {
  double total = 0.0;
  for (const double p : power) total += p;
  if (!(total > 0.0)) return std::nullopt;
  double sum = 0.0;
  for (std::size_t k = 0; k < power.size(); ++k) {
    sum += power[k];
    if (sum >= fraction * total) return kMaxDeg * static_cast<double>(k + 1) / static_cast<double>(kCount);
  }
  return kMaxDeg;
}

std::optional<FarField> detector_far_field(const geometry::Part& part, const Optics& optics,
                                           const Illumination& illumination, double acceptance_deg,
                                           const BeamPolicy& beams, const FarFieldPolicy& policy,
                                           std::vector<FarFieldRay>& specular) {
  FarFieldCollector collector(part, illumination, policy);
  BeamPolicy for_cells = beams;
  for_cells.separate_cells = true;
  const BeamResult traced =
      BeamTracer(part, BeamTracer::Elements::instanced)
          .trace(optics, illumination, {acceptance_deg}, for_cells, policy.cancel, [&](const ReturnedBeam& beam) {
            if (beam.depth > 0)
              collector.add(beam);
            else
              specular.push_back({beam.direction, beam.stokes.i});
          });
  if (!traced.complete) return std::nullopt;
  return collector.finish();
}

DetectorMaps exact_detector_maps(const geometry::Part& part, const Optics& optics, const Illumination& illumination,
                                 const DetectorSetting& setting, const BeamPolicy& policy, const Cancellation* cancel) {
  DetectorMaps maps = empty_maps(setting);
  const Polygon face = face_of(part);
  const auto record = [&](const ReturnedBeam& beam) {
    add_direction(setting, beam.direction, beam.stokes.i, maps);
    if (beam.cone > 0) return;
    maps.rre += beam.stokes.i;
    const bool entered = beam.depth > 0;
    // The front of a finite part reflects from the polygons that make up its face.
    const Polygon& reflecting = part.period_mm ? face : beam.exit_polygon_mm;
    spread(part, setting.face, entered ? beam.exit_polygon_mm : reflecting, beam.stokes.i, maps.leaving.value);
    spread(part, setting.face, entered ? beam.entry_polygon_mm : reflecting, beam.stokes.i, maps.entering.value);
  };
  const BeamResult traced =
      BeamTracer(part).trace(optics, illumination, {setting.acceptance_deg}, policy, cancel, record);
  maps.complete = traced.complete;
  maps.rays = traced.beams;
  if (traced.complete) maps.truncated = traced.ledgers.front()[Account::truncated];
  return maps;
}

struct DetectorSampler::Impl {
  /// A wavelength, ready to be traced.
  struct Light {
    Light(const Impl& all, const DetectorLight& light, const Illumination& illumination, const PathPolicy& policy)
        : setup(all.part, all.surface, all.entrance.centre_mm(), *light.optics, illumination,
                {all.setting.acceptance_deg}, policy, all.entrance_face.get()),
          weight(light.weight),
          seed(light.seed) {}
    PathSetup setup;
    double weight;
    std::uint32_t seed;
  };

  Impl(const geometry::Part& traced_part, const std::vector<DetectorLight>& all, const Illumination& illumination,
       const DetectorSetting& wanted, std::uint64_t rays, const PathPolicy& policy, const geometry::Entrance* curved)
      : part(traced_part), setting(wanted), entrance(part), surface(part, entrance.centre_mm()) {
    if (curved != nullptr) entrance_face = make_entrance_face(*curved, part, entrance.centre_mm());
    for (const DetectorLight& light : all) {
      lights.emplace_back(*this, light, illumination, policy);
      largest_weight = std::max(largest_weight, light.weight);
    }
    const std::uint64_t shares = kReplicates * lights.size();
    per_replicate =
        static_cast<std::uint32_t>(std::clamp<std::uint64_t>((rays + shares - 1) / shares, 1, UINT32_MAX / 2));
    tasks = (per_replicate + kRaysPerDetectorTask - 1) / kRaysPerDetectorTask;
  }

  /// Traces the rays of one wavelength and one replicate, and adds them to the sums of the present replicate. Returns
  /// false if tracing was cancelled.
  bool trace(const Light& light, TaskProgress& all, const Cancellation* cancel) {
    const auto words = philox({light.seed, kScrambleStream}, finished, 0);
    const SobolSquare square((std::uint64_t{words[0]} << 32) | words[1], (std::uint64_t{words[2]} << 32) | words[3]);
    std::vector<Deposits> done(tasks);
    for_each_in_parallel(tasks, [&](std::size_t task) {
      if (is_cancelled(cancel)) return;
      const FlushDenormals flush;
      Deposits& deposits = done[task];
      Tally tally(1);
      Recorder recorder(part, entrance.centre_mm(), light.setup, setting, deposits);
      PathWalker walker(light.setup, tally, &recorder);
      const auto first = static_cast<std::uint32_t>(task) * kRaysPerDetectorTask;
      for (std::uint32_t ray = first; ray < std::min(first + kRaysPerDetectorTask, per_replicate); ++ray) {
        const Vec2 entry = entrance(square(ray));
        recorder.enters(entry);
        walker.trace(entry, {light.seed, kChoiceStream}, finished, ray);
      }
      deposits.truncated = tally.other[Account::truncated];
      deposits.lost = tally.other[Account::lost];
      TaskProgress::Task(all).finish();
    });
    if (is_cancelled(cancel)) return false;
    for (const Deposits& deposits : done) {
      add(deposits, light.weight);
      if (deposits.lost > kLostLimit * per_replicate)
        throw BudgetError(
            "rays missed every face from inside the part: this is a defect of retrace, please report "
            "the design");
    }
    return true;
  }

  void add(const Deposits& deposits, double weight) {
    const auto bins = static_cast<std::uint32_t>(setting.angles.size());
    for (const Deposit& d : deposits.leaving) leaving.replicate()[d.index] += weight * d.power;
    for (const Deposit& d : deposits.entering) entering.replicate()[d.index] += weight * d.power;
    for (const Deposit& d : deposits.angles)
      (d.index < bins ? angles.replicate()[d.index] : sums.outside) += weight * d.power;
    for (const Deposit& d : deposits.rings) sums.rings.power[d.index] += weight * d.power / per_replicate;
    rre.replicate()[0] += weight * deposits.in_cone;
    sums.truncated += weight * deposits.truncated / per_replicate;
  }

  double irradiance_of_ray() const { return part.entrance_area_mm2 / setting.face.pixel_area_mm2(); }

  void close_replicate() {
    const double share = 1.0 / per_replicate;
    leaving.close(share * irradiance_of_ray());
    entering.close(share * irradiance_of_ray());
    angles.close(share);
    rre.close(share);
    // A cancelled replicate is not included in these sums.
    closed.outside = sums.outside;
    closed.truncated = sums.truncated;
    closed.rings = sums.rings;
    ++finished;
  }

  const geometry::Part& part;
  const DetectorSetting& setting;
  EntranceSampler entrance;
  BackSurface surface;
  std::unique_ptr<const EntranceFace> entrance_face;  ///< null if the entrance face is plane
  std::deque<Light> lights;
  double largest_weight = 0.0;
  std::uint32_t per_replicate = 1;  ///< number of rays of one wavelength in a replicate
  std::size_t tasks = 1;            ///< number of tasks into which these rays are divided
  std::uint32_t finished = 0;       ///< number of finished replicates
  PixelPyramid leaving{setting.face.columns(), setting.face.rows(), setting.face_bins};
  PixelPyramid entering{setting.face.columns(), setting.face.rows(), setting.face_bins};
  PixelPyramid angles{setting.angles.columns(), setting.angles.rows(), setting.angle_bins};
  PixelPyramid rre{1, 1, {}};
  /// Sums of the numbers that have no standard error: `sums` over all replicates, `closed` over the finished ones.
  struct Sums {
    double outside = 0.0;
    double truncated = 0.0;
    AngularRings rings;
  };
  Sums sums, closed;
};

DetectorSampler::DetectorSampler(const geometry::Part& part, const std::vector<DetectorLight>& lights,
                                 const Illumination& illumination, const DetectorSetting& setting, std::uint64_t rays,
                                 const PathPolicy& policy, const geometry::Entrance* entrance_face)
    : impl_(std::make_unique<Impl>(part, lights, illumination, setting, rays, policy, entrance_face)) {}

DetectorSampler::~DetectorSampler() = default;

bool DetectorSampler::add_pass(Progress* progress, const Cancellation* cancel) {
  TaskProgress all(progress, kReplicates * impl_->lights.size() * impl_->tasks);
  for (std::uint32_t replicate = 0; replicate < kReplicates; ++replicate) {
    for (const Impl::Light& light : impl_->lights)
      if (!impl_->trace(light, all, cancel)) return false;
    impl_->close_replicate();
  }
  return true;
}

std::uint32_t DetectorSampler::replicates() const {
  return impl_->finished;
}

DetectorMaps DetectorSampler::maps() const {
  const Impl& all = *impl_;
  const double replicates = all.finished;
  const auto wavelengths = static_cast<double>(all.lights.size());
  DetectorMaps maps;
  maps.rays = std::uint64_t{all.per_replicate} * all.finished * all.lights.size();
  // Maximum contribution of a ray to the sum over all rays. Rays of the wavelength with the largest weight reach it.
  const double largest = all.largest_weight * wavelengths;
  maps.leaving = all.leaving.values(maps.rays, largest * all.irradiance_of_ray());
  maps.entering = all.entering.values(maps.rays, largest * all.irradiance_of_ray());
  maps.per_sr = all.angles.values(maps.rays, largest);
  for (std::size_t bin = 0; bin < all.setting.angles.size(); ++bin) {
    maps.per_sr.value[bin] /= all.setting.angles.solid_angle_sr(bin);
    maps.per_sr.std_error[bin] /= all.setting.angles.solid_angle_sr(bin);
  }
  maps.outside = all.closed.outside / all.per_replicate / replicates;
  maps.truncated = all.closed.truncated / replicates;
  maps.rings = all.closed.rings;
  for (double& power : maps.rings.power) power /= replicates;
  const PixelValues total = all.rre.values(maps.rays, largest);
  maps.rre = total.value[0];
  maps.std_error = total.std_error[0];
  return maps;
}

DetectorMaps sampled_detector_maps(const geometry::Part& part, const Optics& optics, const Illumination& illumination,
                                   const DetectorSetting& setting, std::uint64_t rays, std::uint32_t seed,
                                   const PathPolicy& policy, Progress* progress, const Cancellation* cancel) {
  const std::vector<DetectorLight> lights = {{&optics, 1.0, seed}};
  DetectorSampler sampler(part, lights, illumination, setting, rays, policy);
  if (sampler.add_pass(progress, cancel)) return sampler.maps();
  DetectorMaps maps = empty_maps(setting);
  maps.complete = false;
  return maps;
}

}  // namespace retrace::raytrace
