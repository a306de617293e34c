#include "raytrace/observers/camera.h"

#include <tbb/enumerable_thread_specific.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/error.h"
#include "core/random.h"
#include "core/threads.h"
#include "raytrace/cells/cell_walker.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/faces/entrance_face.h"
#include "raytrace/light/ledger.h"
#include "raytrace/observers/camera_rays.h"
#include "raytrace/observers/pixel_guide.h"
#include "raytrace/observers/pixel_points.h"
#include "raytrace/observers/sensor_accumulator.h"
#include "raytrace/paths/path_tracer.h"
#include "raytrace/sampling/entrance_sampler.h"
#include "raytrace/sampling/flush_denormals.h"
#include "raytrace/sampling/sobol.h"

namespace retrace::raytrace {
namespace {

using std::numbers::pi;

// Numbers of the Philox random streams for, in this order: the scrambles of the points of a pixel, the choices along a
// path that is traced separately, the wavelengths and points of the pupil, the choices along paths that the cell engine
// traces together, and the points that a PixelGuide selects.
constexpr std::uint32_t kCameraScrambleStream = 11;
constexpr std::uint32_t kCameraChoiceStream = 12;
constexpr std::uint32_t kLensStream = 13;
constexpr std::uint32_t kCameraCellStream = 14;
constexpr std::uint32_t kGuideStream = 15;
// Approximate number of paths per wavelength that the cell engine traces together.
constexpr std::size_t kPathsTogether = 4096;
// Number of the PixelGuide's training pass. The two training passes for PixelPoints have the preceding numbers. The
// passes of a picture are numbered from 0, so these numbers do not occur there.
constexpr std::uint32_t kTrainingPass = 0xffffffff;
constexpr std::uint32_t kTrainingPassesOfPoints = 2;
// The picture is divided into rectangular tiles, and a PixelGuide has one map per tile. These are the minimum side
// length of a tile in pixels and the maximum number of tiles along a side of the picture.
constexpr std::size_t kTilePixels = 100;
constexpr std::size_t kMaxTiles = 8;

Vec2 in_unit_disc(double u, double v) {
  const double r = std::sqrt(u);
  return {r * std::cos(2.0 * pi * v), r * std::sin(2.0 * pi * v)};
}

}  // namespace

struct CameraTracer::Impl {
  struct Block;

  Impl(const geometry::Part& p, const std::vector<WeightedOptics>& light, const CameraScene& s,
       const PathPolicy& policy, std::uint32_t number, CameraEngine engine, const geometry::Entrance* curved)
      : part(p),
        scene(s),
        seed(number),
        centre_mm(EntranceSampler(p).centre_mm()),
        surface(p, centre_mm),
        lens(s.view),
        luminaire(s.lamp, s.view, s.discs),
        entrance_mm(EntranceSampler(p).bounding_box()),
        tiles_along(std::clamp<std::size_t>(std::min(s.view.columns, s.view.rows) / kTilePixels, 1, kMaxTiles)),
        points(s.view.columns * s.view.rows, kPointsPerPass) {
    has_shells = std::ranges::any_of(light, [](const WeightedOptics& at) { return !at.optics.shells.empty(); });
    if (curved != nullptr)
      entrance_face = make_entrance_face(*curved, p, centre_mm);
    else if (engine == CameraEngine::fastest && !has_shells)
      cells = CellArray::make(p);
    double sum = 0.0;
    for (const WeightedOptics& at : light) {
      // The direction of incidence has no effect, because each path starts in its own direction.
      setups.emplace_back(p, surface, centre_mm, at.optics, Illumination{}, std::vector<double>{90.0}, policy,
                          entrance_face.get());
      sum += at.weight;
      cumulative.push_back(sum);
    }
    const PathSetup& any = setups.front();
    const double below = any.depth_mm + any.clearance_mm;
    const double top = std::max(entrance_face ? entrance_face->highest_mm() : any.thickness_mm, any.stops.top_mm());
    middle = {0.0, 0.0, 0.5 * (top - below)};
    double reach2 = 0.0;
    for (const Vec2& corner : p.outline) reach2 = std::max(reach2, (corner - centre_mm).squaredNorm());
    radius_mm = std::sqrt(reach2 + std::pow(0.5 * (top + below), 2.0));
  }

  Contact contact_of(const WorldRay& ray) const;
  std::optional<Contact> contact_with_plate(const WorldRay& ray) const;
  std::size_t rows_of_block() const {
    return std::max<std::size_t>(1, kPathsTogether * setups.size() / (kPointsPerPass * scene.view.columns));
  }
  void add_path(const WorldRay& ray, std::size_t wavelength, std::uint32_t pixel, std::uint32_t point,
                Block& block) const;
  void add_paths(std::uint32_t pixel, std::uint32_t pass, Block& block) const;
  std::vector<PixelGuide::Point> points_of(std::uint32_t pixel, std::uint32_t pass) const;
  std::optional<PixelProjection> projection_of(std::uint32_t pixel) const;
  std::uint32_t tile_of(std::size_t pixel) const {
    const std::size_t row = pixel / scene.view.columns * tiles_along / scene.view.rows;
    const std::size_t column = pixel % scene.view.columns * tiles_along / scene.view.columns;
    return static_cast<std::uint32_t>(row * tiles_along + column);
  }
  /// Returns true if all paths start outside of the part. PathWalker::launch() then finds the first surface of each
  /// path.
  bool launches_all() const { return entrance_face != nullptr || has_shells; }
  bool is_guided(std::size_t pixel) const { return guide && has_guide[pixel]; }
  struct GuideTraining;
  std::optional<CameraPass> trace(std::uint32_t pass, const Cancellation* cancel, GuideTraining* training = nullptr,
                                  std::vector<PixelMoments>* moments = nullptr) const;
  bool choose_points(const Cancellation* cancel);
  std::optional<CameraPass> trace_and_learn(std::uint32_t pass, const Cancellation* cancel);
  void follow_together(std::uint32_t pass, std::uint32_t block_number, Block& block, const Cancellation* cancel) const;

  const geometry::Part& part;
  CameraScene scene;
  std::uint32_t seed;
  Vec2 centre_mm;
  BackSurface surface;
  std::unique_ptr<const EntranceFace> entrance_face;  ///< null if the entrance face is plane
  bool has_shells = false;                            ///< true if shells are in front of the part
  Lens lens;
  Luminaire luminaire;
  geometry::Rectangle entrance_mm;
  std::optional<CellArray> cells;  ///< set if paths are traced together by the cell engine
  std::vector<PathSetup> setups;   ///< indexed by wavelength
  std::vector<double> cumulative;
  Vec3 middle;  ///< centre of a sphere around the finite part
  double radius_mm = 0.0;
  std::size_t tiles_along;          ///< number of tiles of the guide along a side of the picture
  std::optional<PixelGuide> guide;  ///< set after the training pass, which is not part of the picture
  bool has_learnt_all = false;      ///< true if the guide has been trained with the training pass and with pass 0
  std::vector<bool> has_guide;      ///< indexed by pixel: true if the guide selects points of this pixel
  std::vector<float> levels;        ///< indexed by pixel: typical luminance, see GuideTraining::level_of()
  PixelPoints points;               ///< number of points of each pixel in a pass
  bool has_chosen_points = false;   ///< true if training passes have determined `points`
};

/// Training samples for a PixelGuide, collected during one pass.
struct CameraTracer::Impl::GuideTraining {
  /// Maximum number of paths that are used as samples.
  static constexpr std::size_t kMaxSamples = std::size_t{1} << 22U;

  explicit GuideTraining(const Impl& h)
      : hidden(h),
        pixels(h.scene.view.columns * h.scene.view.rows),
        guide(h.guide ? *h.guide
                      : PixelGuide(h.cells->period_mm(), h.tiles_along * h.tiles_along,
                                   std::min(kMaxSamples, pixels * kPointsPerPass))),
        levels(h.levels) {
    if (levels.empty()) levels.resize(pixels);
  }

  /// Appends the paths of consecutive pixels to the samples.
  /// \param paths kPointsPerPass paths per pixel
  /// \param pixel index of the first pixel
  void append(const std::vector<CameraSample>& paths, std::size_t pixel, PixelGuide::Samples& into) {
    for (std::size_t k = 0; k < paths.size(); k += kPointsPerPass, ++pixel) {
      const std::span<const CameraSample, kPointsPerPass> paths_of_pixel(paths.data() + k, kPointsPerPass);
      if (!hidden.guide) levels[pixel] = level_of(paths_of_pixel);
      if (pixel % stride != 0) continue;
      for (const CameraSample& path : paths_of_pixel)
        if (path.contact.kind == Contact::Kind::face)
          into.push_back(guide.sample(path.contact.local.head<2>(), hidden.tile_of(pixel),
                                      static_cast<float>(path.luminance) - levels[pixel]));
    }
  }

  const Impl& hidden;
  std::size_t pixels;
  std::size_t stride = (pixels * kPointsPerPass + kMaxSamples - 1) / kMaxSamples;  ///< every stride-th pixel is sampled
  PixelGuide guide;
  std::vector<float> levels;                 ///< see Impl::levels
  std::vector<PixelGuide::Samples> samples;  ///< indexed by block

 private:
  /// Returns the typical luminance of a pixel. It is the second smallest value of its paths, because the few areas that
  /// differ from the rest of the pixel are usually brighter.
  static float level_of(std::span<const CameraSample, kPointsPerPass> paths) {
    std::array<double, kPointsPerPass> seen;
    std::ranges::transform(paths, seen.begin(), &CameraSample::luminance);
    std::ranges::sort(seen);
    return static_cast<float>(seen[1]);
  }
};

/// Returns the point at which a ray enters the plate of a finite part, through the entrance face or a side. Returns
/// nothing if the ray meets neither of them from outside. The sides of a part with notches or holes are ignored.
std::optional<Contact> CameraTracer::Impl::contact_with_plate(const WorldRay& ray) const {
  const PathSetup& setup = setups.front();
  const auto is_within = [&](const Vec3& p, std::size_t except) {
    for (std::size_t k = 0; k < setup.sides.size(); ++k)
      if (k != except && setup.sides[k].normal.dot(p) > setup.sides[k].offset_mm) return false;
    return true;
  };
  // A ray may pass through a notch or a hole of the entrance face.
  const auto is_over_face = [&](const Vec3& p) {
    return setup.entrance_pieces.empty() || setup.is_over_piece(p.head<2>(), 0.0);
  };
  if (ray.direction.z() < 0.0) {
    const double t = (setup.thickness_mm - ray.origin.z()) / ray.direction.z();
    const Vec3 at = ray.origin + t * ray.direction;
    if (t > 0.0 && is_within(at, setup.sides.size()) && is_over_face(at)) {
      Contact contact{Contact::Kind::face, at, at, Eigen::Matrix3d::Identity(), 0};
      contact.local.z() = setup.thickness_mm;
      return contact;
    }
  }
  for (std::size_t k = 0; k < setup.sides.size(); ++k) {
    const double towards = setup.sides[k].normal.dot(ray.direction);
    if (towards >= 0.0) continue;
    const double t = (setup.sides[k].offset_mm - setup.sides[k].normal.dot(ray.origin)) / towards;
    const Vec3 at = ray.origin + t * ray.direction;
    if (t > 0.0 && at.z() < setup.thickness_mm && at.z() > setup.top_mm && is_within(at, k))
      return Contact{Contact::Kind::side, at, at, Eigen::Matrix3d::Identity(), k};
  }
  return std::nullopt;
}

Contact CameraTracer::Impl::contact_of(const WorldRay& ray) const {
  if (scene.film) return contact_with(*scene.film, part.thickness_mm, ray);
  if (has_shells)  // a shell may extend beyond the part and deflect any ray towards the part
    return {Contact::Kind::outside, ray.origin, ray.origin, Eigen::Matrix3d::Identity(), 0};
  const double nearest = (middle - ray.origin).dot(ray.direction);
  if ((ray.origin + nearest * ray.direction - middle).norm() > radius_mm) return {};
  if (!entrance_face)
    if (const auto plate = contact_with_plate(ray)) return *plate;
  // The start is moved close to the part, because Embree's single precision is inaccurate for points metres away.
  const Vec3 at = ray.origin + std::max(0.0, nearest - 1.01 * radius_mm) * ray.direction;
  return {Contact::Kind::outside, at, at, Eigen::Matrix3d::Identity(), 0};
}

/// Rows of the picture that are traced together in one pass. Each thread reuses its block to avoid memory allocations.
struct CameraTracer::Impl::Block {
  explicit Block(const Impl& h) : accumulator(h.luminaire, h.scene, paths), starts(h.setups.size()) {
    for (const PathSetup& setup : h.setups) {
      walkers.emplace_back(setup, tally, &accumulator);
      if (h.cells) cell_walkers.emplace_back(setup, setup.policy, *h.cells, h.centre_mm, true);
    }
  }
  Block(const Block&) = delete;

  void begin() {
    paths.clear();
    for (std::vector<CellRay>& of_wavelength : starts) of_wavelength.clear();
    tally = Tally(1);
  }

  /// Traces the light of one path with the PathWalker.
  void resume(const CellRay& start, std::size_t wavelength, RandomKey key, std::uint32_t replicate,
              std::uint32_t sample, std::uint32_t& choices) {
    const double before = behind();
    accumulator.begin(start.owner);
    walkers[wavelength].resume(start.position, start.ray, key, replicate, sample, choices);
    accumulator.on_transmission(start.owner, behind() - before);
  }

  /// Traces the light of one path that starts outside of the part. Returns false if the light does not meet the part.
  /// Behind a curved entrance face or shells, all paths start in this way. For a part with notches or holes, only the
  /// paths that miss the entrance face do.
  bool launch(const CellRay& start, std::size_t wavelength, RandomKey key, std::uint32_t replicate,
              std::uint32_t sample) {
    const double before = behind();
    const double shells_before = stopped_at_shells();
    PathWalker& walker = walkers[wavelength];
    accumulator.begin(start.owner);
    const bool meets_part = walker.launch(start.position, start.ray, key, replicate, sample);
    accumulator.on_transmission(start.owner, meets_part ? behind() - before : start.ray.light.power());
    accumulator.on_shell_loss(start.owner, stopped_at_shells() - shells_before);
    if (!meets_part) return false;
    Contact& contact = paths[start.owner].contact;
    if (walker.arrival() == PathWalker::Arrival::entrance) contact.kind = Contact::Kind::face;
    if (walker.arrival() == PathWalker::Arrival::side) contact.kind = Contact::Kind::side;
    return true;
  }

  /// Returns the power of light whose tracing ends at shells: light that a shell reflects, and light that leaves the
  /// part and misses a shell.
  double stopped_at_shells() const {
    return tally.other[Account::shell_reflected] + tally.other[Account::returned_elsewhere];
  }
  /// Returns the power that has left through the sides and the back so far.
  double behind() const { return tally.other[Account::transmitted] + tally.other[Account::side_exit]; }

  /// samples of all paths, grouped by pixel; Impl::points contains the number of paths through each pixel
  std::vector<CameraSample> paths;
  Tally tally{1};
  SensorAccumulator accumulator;
  std::vector<PathWalker> walkers;  ///< indexed by wavelength
  std::vector<CellWalker> cell_walkers;
  std::vector<std::vector<CellRay>> starts;  ///< indexed by wavelength: paths that are traced together
};

/// Adds a path to a block. The path is traced immediately, or queued for the cell engine.
void CameraTracer::Impl::add_path(const WorldRay& ray, std::size_t wavelength, std::uint32_t pixel, std::uint32_t point,
                                  Block& block) const {
  const auto number = static_cast<std::uint32_t>(block.paths.size());
  CameraSample& path = block.paths.emplace_back();
  path.contact = contact_of(ray);
  const Contact contact = path.contact;
  path.is_corrected = contact.kind == Contact::Kind::face || launches_all();
  if (path.is_corrected) path.gain = scene.correction.gain_at(contact.local.head<2>());
  if (contact.kind == Contact::Kind::nothing) path.luminance = scene.surroundings.back_side;
  if (contact.kind == Contact::Kind::nothing || contact.kind == Contact::Kind::dark) return;
  const Optics& optics = setups[wavelength].optics;
  const Vec3 direction = contact.world_from_local.transpose() * ray.direction;
  Ray start{direction, {}, contact.kind != Contact::Kind::outside, false};
  start.light.s_axis = direction.unitOrthogonal();
  if (launches_all()) {
    block.launch({contact.local, start, number}, wavelength, {seed, kCameraChoiceStream}, point, pixel);
    return;
  }
  const FaceStops& stops = setups[wavelength].stops;
  if (contact.kind == Contact::Kind::face && !stops.reaches(contact.local, direction)) return;
  if (path.shows_part()) {
    const bool is_side = contact.kind == Contact::Kind::side;
    const Vec3 normal = is_side ? setups[wavelength].sides[contact.side].normal : Vec3(Vec3::UnitZ());
    const double cosine = -normal.dot(direction);
    const materials::FresnelCoefficients f =
        is_side ? materials::fresnel(1.0 / optics.index, cosine) : fresnel_at_entrance(optics, false, cosine);
    start.light.rotate_basis_to_interface(direction, normal);
    const Light front = start.light.reflected(f);
    start.direction = refracted(direction, normal, 1.0 / optics.index, cosine, f.cos_refracted);
    if (is_side || !optics.lossless_entrance) {
      start.light = start.light.transmitted(f);
      if (is_side)
        block.accumulator.on_transmission(number, front.power());
      else if (stops.passes_mount(contact.local, mirrored(direction, normal)))
        block.accumulator.on_front_reflection(number, contact.world, mirrored(direction, normal), front.power());
    }
  }
  const CellRay on{contact.local, start, number};
  if (cells && contact.kind == Contact::Kind::face) {
    block.starts[wavelength].push_back(on);
    return;
  }
  std::uint32_t choices = 0;
  const RandomKey key{seed, kCameraChoiceStream};
  if (!part.entrance_pieces.empty() && contact.kind == Contact::Kind::outside) {
    if (block.launch(on, wavelength, key, point, pixel)) path.contact.kind = Contact::Kind::side;
    return;
  }
  block.resume(on, wavelength, key, point, pixel, choices);
}

/// Returns the area of the entrance face that a pixel shows. Returns nothing if the pixel also shows something else.
std::optional<PixelProjection> CameraTracer::Impl::projection_of(std::uint32_t pixel) const {
  const auto columns = static_cast<std::uint32_t>(scene.view.columns);
  const Vec2 corner(pixel % columns, pixel / columns);
  std::array<Vec2, 4> at;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const Contact contact = contact_of(lens.ray(corner + Vec2(k % 2, k / 2), Vec2::Zero()));
    if (contact.kind != Contact::Kind::face) return std::nullopt;
    at[k] = contact.local.head<2>();
  }
  return PixelProjection{at[0], at[1] - at[0], at[2] - at[0], tile_of(pixel)};
}

/// Returns the points of a pixel at which the paths of a pass start.
std::vector<PixelGuide::Point> CameraTracer::Impl::points_of(std::uint32_t pixel, std::uint32_t pass) const {
  if (is_guided(pixel)) {
    const auto words = philox({seed, kGuideStream}, pass, pixel);
    const auto chosen = guide->points(*projection_of(pixel), {words[0], words[1], words[2], words[3]});
    std::vector<PixelGuide::Point> at(chosen.begin(), chosen.end());
    // The index of a point determines its wavelength. The points are rotated by a random number of indices, so that
    // every wavelength receives points that the guide has selected.
    const auto turn = static_cast<std::ptrdiff_t>(philox({seed, kGuideStream}, pass, pixel, 1)[0] % kPointsPerPass);
    std::rotate(at.begin(), at.begin() + turn, at.end());
    return at;
  }
  const auto words = philox({seed, kCameraScrambleStream}, pass, pixel);
  const SobolSquare square((std::uint64_t{words[0]} << 32) | words[1], (std::uint64_t{words[2]} << 32) | words[3]);
  std::vector<PixelGuide::Point> at(points[pixel]);
  for (std::uint32_t k = 0; k < at.size(); ++k) {
    const auto [x, y] = square(k);
    at[k].within = {x, y};
    at[k].weight = 1.0 / points[pixel];
  }
  return at;
}

/// Starts the paths of one pixel in a pass.
void CameraTracer::Impl::add_paths(std::uint32_t pixel, std::uint32_t pass, Block& block) const {
  const auto columns = static_cast<std::uint32_t>(scene.view.columns);
  const Vec2 corner(pixel % columns, pixel / columns);
  const auto at = points_of(pixel, pass);
  const auto count = static_cast<std::uint32_t>(at.size());
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t point = pass * count + k;
    const auto random = philox({seed, kLensStream}, point, pixel);
    // The points of a pass are distributed over the wavelengths by stratified sampling.
    const double chosen = (static_cast<double>(k) + unit_interval(random[0])) / count;
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end() - 1, chosen * cumulative.back());
    const auto wavelength = static_cast<std::size_t>(found - cumulative.begin());
    const Vec2 pupil = scene.discs == DiscAverage::sampled
                           ? in_unit_disc(unit_interval(random[1]), unit_interval(random[2]))
                           : Vec2(Vec2::Zero());
    const std::size_t number = block.paths.size();
    add_path(lens.ray(corner + at[k].within, pupil), wavelength, pixel, point, block);
    block.paths[number].weight = at[k].weight;
  }
}

/// Traces the queued paths of a block with the cell engine. Paths that this engine cannot complete are continued with
/// the PathWalker.
void CameraTracer::Impl::follow_together(std::uint32_t pass, std::uint32_t block_number, Block& block,
                                         const Cancellation* cancel) const {
  const RandomKey key{seed, kCameraCellStream};
  for (std::size_t w = 0; w < setups.size(); ++w) {
    if (is_cancelled(cancel)) return;
    if (block.starts[w].empty()) continue;
    CellWalker& walker = block.cell_walkers[w];
    const auto sample = static_cast<std::uint32_t>(block_number * setups.size() + w);
    walker.follow(block.starts[w], entrance_mm, key, pass, sample, block.tally, block.accumulator);
    std::uint32_t choices = walker.choices();
    for (const CellRay& ray : walker.handed_over()) block.resume(ray, w, key, pass, sample, choices);
  }
}

/// Traces one pass over the picture.
/// \param training receives training samples for the guide; may be null
/// \param moments receives sums over the luminances of all paths, indexed by pixel; may be null
std::optional<CameraPass> CameraTracer::Impl::trace(std::uint32_t number, const Cancellation* cancel,
                                                    GuideTraining* training, std::vector<PixelMoments>* moments) const {
  const std::size_t columns = scene.view.columns;
  const std::size_t pixels = columns * scene.view.rows;
  CameraPass result(3 * pixels + 1, 0.0);
  for (std::size_t k = 0; k < pixels; ++k) result[2 * pixels + k] = points[k];
  std::vector<double> on_part(pixels, 0.0);
  const std::size_t rows = rows_of_block();
  std::vector<double> lost((scene.view.rows + rows - 1) / rows, 0.0);
  if (training != nullptr) training->samples.resize(lost.size());
  tbb::enumerable_thread_specific<std::unique_ptr<Block>> blocks;
  for_each_in_parallel(lost.size(), [&](std::size_t block_number) {
    const FlushDenormals flush;
    std::unique_ptr<Block>& own = blocks.local();
    if (!own) own = std::make_unique<Block>(*this);
    Block& block = *own;
    block.begin();
    const std::size_t first = block_number * rows * columns;
    const std::size_t last = std::min(pixels, first + rows * columns);
    for (std::size_t pixel = first; pixel < last; ++pixel) {
      if (is_cancelled(cancel)) return;
      add_paths(static_cast<std::uint32_t>(pixel), number, block);
    }
    if (cells) follow_together(number, static_cast<std::uint32_t>(block_number), block, cancel);
    std::size_t next = 0;
    for (std::size_t pixel = first; pixel < last; ++pixel) {
      // The weights of a pixel's points add up to 1 only on average. The weights are therefore applied to the
      // difference from the typical luminance of the pixel, so that deviations of their sum from 1 cause little noise.
      const double level = is_guided(pixel) ? static_cast<double>(levels[pixel]) : 0.0;
      const std::uint32_t count = points[pixel];
      for (std::uint32_t k = 0; k < count; ++k) {
        const CameraSample& path = block.paths[next++];
        const double luminance = level / count + path.weight * (path.luminance - level);
        result[pixel] += luminance;
        if (moments != nullptr) (*moments)[pixel].add(path.luminance);
        if (!path.shows_part()) continue;
        on_part[pixel] += luminance;
        result[pixels + pixel] += 1.0 / count;
      }
    }
    if (training != nullptr) training->append(block.paths, first, training->samples[block_number]);
    lost[block_number] = block.tally.other[Account::lost];
  });
  if (is_cancelled(cancel)) return std::nullopt;
  double lost_power = 0.0;
  for (const double power : lost) lost_power += power;
  if (lost_power > kLostLimit * static_cast<double>(points.total()))
    throw BudgetError(
        "rays missed every face from inside the part: this is a defect of retrace, please report the "
        "design");
  for (const double value : on_part) result.back() += value;
  return result;
}

/// Traces a pass and trains the guide with it. If the pass is cancelled, the guide remains unchanged.
std::optional<CameraPass> CameraTracer::Impl::trace_and_learn(std::uint32_t number, const Cancellation* cancel) {
  GuideTraining training(*this);
  std::optional<CameraPass> result = trace(number, cancel, &training);
  if (!result) return std::nullopt;
  training.guide.train(training.samples);
  std::vector<std::uint8_t> reduces_noise(training.pixels, 0);
  for_each_in_parallel(scene.view.rows, [&](std::size_t row) {
    if (is_cancelled(cancel)) return;
    for (std::size_t column = 0; column < scene.view.columns; ++column) {
      const std::size_t pixel = row * scene.view.columns + column;
      const std::optional<PixelProjection> projection = projection_of(static_cast<std::uint32_t>(pixel));
      reduces_noise[pixel] = projection && training.guide.reduces_noise(*projection) ? 1 : 0;
    }
  });
  if (is_cancelled(cancel)) return std::nullopt;
  has_learnt_all = guide.has_value();
  guide = std::move(training.guide);
  has_guide.assign(reduces_noise.begin(), reduces_noise.end());
  levels = std::move(training.levels);
  return result;
}

/// Traces training passes and determines the number of points of each pixel from the noise of these passes. Returns
/// false if tracing was cancelled.
bool CameraTracer::Impl::choose_points(const Cancellation* cancel) {
  std::vector<PixelMoments> moments(scene.view.columns * scene.view.rows);
  for (std::uint32_t k = 1; k <= kTrainingPassesOfPoints; ++k)
    if (!trace(kTrainingPass - k, cancel, nullptr, &moments)) return false;
  points = PixelPoints(moments, kTrainingPassesOfPoints * kPointsPerPass, scene.view.columns, kPointsPerPass);
  has_chosen_points = true;
  return true;
}

CameraTracer::CameraTracer(const geometry::Part& part, const std::vector<WeightedOptics>& light,
                           const CameraScene& scene, const PathPolicy& policy, std::uint32_t seed, CameraEngine engine,
                           const geometry::Entrance* entrance_face)
    : impl_(std::make_unique<Impl>(part, light, scene, policy, seed, engine, entrance_face)) {}
CameraTracer::~CameraTracer() = default;

bool CameraTracer::is_by_cells() const {
  return impl_->cells.has_value();
}

CameraImage CameraTracer::empty_image() const {
  CameraImage image;
  image.columns = impl_->scene.view.columns;
  image.rows = impl_->scene.view.rows;
  image.luminance.assign(image.columns * image.rows, 0.0);
  image.squares = image.luminance;
  image.coverage = image.luminance;
  image.paths = image.luminance;
  return image;
}

std::optional<CameraPass> CameraTracer::pass(std::uint32_t number, const Cancellation* cancel) const {
  Impl& h = *impl_;
  if (!h.cells) {
    if (!h.has_chosen_points && !h.choose_points(cancel)) return std::nullopt;
    return h.trace(number, cancel);
  }
  if (number == 0 && h.has_learnt_all) {
    h.guide.reset();
    h.levels.clear();
    h.has_learnt_all = false;
  }
  if (!h.guide && !h.trace_and_learn(kTrainingPass, cancel)) return std::nullopt;
  if (number == 0) return h.trace_and_learn(0, cancel);
  if (!h.has_learnt_all && !h.trace_and_learn(0, cancel)) return std::nullopt;
  return h.trace(number, cancel);
}

bool CameraTracer::add_pass(CameraImage& image, const Cancellation* cancel) const {
  const std::optional<CameraPass> one = pass(image.passes, cancel);
  if (one) image.add(*one);
  return one.has_value();
}

}  // namespace retrace::raytrace
