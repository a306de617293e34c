#include "studies/ranging/ranging.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include "core/angle.h"
#include "core/error.h"
#include "core/number_format.h"
#include "core/task_progress.h"
#include "design/io/design_reader.h"
#include "design/io/part_reader.h"
#include "geometry/direction.h"
#include "raytrace/light/aperture_kernel.h"
#include "requests/descriptions.h"
#include "studies/ranging/lit_cubes.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3, raytrace::Stokes;

// Margin of the map around the most deflected beam, in angular widths of the finest details.
constexpr double kMapMargin = 4.0;
// Minimum half width of the map, divided by the outer radius of the annulus.
constexpr double kAnnulusMargin = 1.25;
// Number of rings around the direction to the source on which statistics of the cross section are computed.
constexpr std::size_t kRings = 60;
// Number of points on each ring.
constexpr std::size_t kPointsPerRing = 72;
// A warning is issued if more than this fraction of the incident power is in beams whose diffraction is not computed.
constexpr double kMaxUndiffractedPower = 1e-3;
// Maximum number of directions in which the far field of one point is evaluated. This takes some minutes.
constexpr double kMaxDirections = 1e8;
// Maximum number of directions of an annulus, whose values are all stored.
constexpr double kMaxAnnulusDirections = 1e7;
// Number of directions, including those of the discs of source and receiver, that are evaluated between two reports of
// progress.
constexpr std::size_t kDirectionsPerReport = 65536;
// Light with a smaller degree of polarisation counts as unpolarised.
constexpr double kMinPolarisation = 1e-9;

Stokes sent_stokes(const RangingRequest& request, const design::Design& design) {
  const double twice = 2.0 * request.polarisation_deg * kRadPerDeg;
  if (request.polarisation == "unpolarised") return raytrace::kUnpolarised;
  if (request.polarisation == "linear") return {1.0, std::cos(twice), std::sin(twice), 0.0};
  if (request.polarisation == "right") return {1.0, 0.0, 0.0, 1.0};
  if (request.polarisation == "left") return {1.0, 0.0, 0.0, -1.0};
  return design.light.polarisation;
}

std::optional<Annulus> annulus_of(const RangingRequest& request) {
  if (request.orbit_km) return aberration_of_orbit(*request.orbit_km, request.elevation_deg);
  if (!request.aberration_arcsec) return std::nullopt;
  return Annulus{request.aberration_arcsec->front() * kRadPerArcsec, request.aberration_arcsec->back() * kRadPerArcsec};
}

Vec2 observation_of(const RangingRequest& request, const std::optional<Annulus>& annulus) {
  if (request.observation_arcsec)
    return kRadPerArcsec * Vec2(request.observation_arcsec->front(), request.observation_arcsec->back());
  return annulus ? Vec2(0.5 * (annulus->inner_rad + annulus->outer_rad), 0.0) : Vec2(Vec2::Zero());
}

/// Splits the returned light into its component with the transmitted polarisation and its component with the orthogonal
/// polarisation.
ByPolarisation<double> by_polarisation(const Stokes& returned, const Stokes& sent) {
  ByPolarisation<double> result{returned.i};
  const double degree = std::hypot(sent.q, sent.u, sent.v);
  if (degree < kMinPolarisation) return result;
  const double along = (sent.q * returned.q + sent.u * returned.u + sent.v * returned.v) / degree;
  result.parallel = 0.5 * (returned.i + along);
  result.crossed = 0.5 * (returned.i - along);
  return result;
}

bool has_polarisation(const Stokes& sent) {
  return by_polarisation({}, sent).parallel.has_value();
}

/// Returns the directions of a mean over the discs of source and receiver, with their weights.
std::vector<raytrace::ApertureKernel::Node> nodes_of(const RangingRequest& request, double detail_rad) {
  const raytrace::PhotometricApertures apertures{Angle::from_rad(request.source_arcsec * kRadPerArcsec),
                                                 Angle::from_rad(request.receiver_arcsec * kRadPerArcsec)};
  if (apertures.source.rad() <= 0.0 && apertures.receiver.rad() <= 0.0) return {{Vec2::Zero(), 1.0}};
  return raytrace::ApertureKernel(apertures).nodes(detail_rad);
}

/// Returns the approximate number of directions in which one point is evaluated, including its map.
double directions_of(const RangingSettings& settings, double detail_rad) {
  const auto points = static_cast<double>(settings.request.map_points);
  double directions = points * points + static_cast<double>(kRings * kPointsPerRing);
  const double components = has_polarisation(settings.sent) ? 3.0 : 1.0;
  if (settings.annulus) directions += components * evaluations_over(*settings.annulus, detail_rad);
  return directions * static_cast<double>(nodes_of(settings.request, detail_rad).size());
}

/// Progress of one point, measured by the number of evaluated directions.
class PointProgress {
 public:
  /// \param whole receiver of the finished fraction of the point, or null
  /// \param directions expected number of directions
  PointProgress(Progress* whole, double directions) : whole_(whole), directions_(directions) {}
  void add(std::size_t directions) {
    done_ += static_cast<double>(directions);
    if (whole_ != nullptr) whole_->at(std::min(1.0, done_ / directions_));
  }

 private:
  Progress* whole_;
  double directions_;
  double done_ = 0.0;
};

/// Cross section of all illuminated cubes as a function of the direction of the returned light. It is averaged over the
/// angular extent of the source and the receiver.
class ObservedLight {
 public:
  ObservedLight(const LitCubes& lit, const RangingSettings& settings, PointProgress& progress,
                const Cancellation* cancel)
      : lit_(lit),
        sent_(settings.sent),
        progress_(progress),
        cancel_(cancel),
        nodes_(nodes_of(settings.request, lit.detail_rad())) {}

  /// Returns the light in several directions. If the run is cancelled, the values are meaningless.
  std::vector<ByPolarisation<double>> at(std::span<const Vec2> angles_rad) const {
    std::vector<ByPolarisation<double>> result(angles_rad.size());
    const std::size_t per_report = std::max<std::size_t>(1, kDirectionsPerReport / nodes_.size());
    for (std::size_t first = 0; first < angles_rad.size() && !is_cancelled(cancel_); first += per_report) {
      const std::size_t count = std::min(per_report, angles_rad.size() - first);
      std::vector<Vec2> all;
      for (const Vec2& angles : angles_rad.subspan(first, count))
        for (const raytrace::ApertureKernel::Node& node : nodes_) all.push_back(angles + node.offset_rad);
      const std::vector<Stokes> stokes = lit_.stokes(all, sent_, cancel_);
      for (std::size_t k = 0; k < count; ++k) {
        Stokes mean;
        for (std::size_t node = 0; node < nodes_.size(); ++node)
          mean += nodes_[node].weight * stokes[k * nodes_.size() + node];
        result[first + k] = by_polarisation(mean, sent_);
      }
      progress_.add(all.size());
    }
    return result;
  }

  /// Returns the statistics of one polarisation component over an annulus. Returns nothing if the component is not
  /// defined, because the transmitted light is unpolarised.
  template <class Component>
  std::optional<AnnulusStatistics> over(const Annulus& annulus, const Component& component) const {
    if (!component(by_polarisation({}, sent_))) return std::nullopt;
    return statistics_over(annulus, lit_.detail_rad(), [&](const std::vector<Vec2>& angles_rad) {
      std::vector<double> values;
      for (const ByPolarisation<double>& value : at(angles_rad)) values.push_back(component(value).value_or(0.0));
      return values;
    });
  }

 private:
  const LitCubes& lit_;
  Stokes sent_;
  PointProgress& progress_;
  const Cancellation* cancel_;
  std::vector<raytrace::ApertureKernel::Node> nodes_;
};

ByPolarisation<AnnulusStatistics> over_annulus(const ObservedLight& light, const Annulus& annulus) {
  ByPolarisation<AnnulusStatistics> result;
  result.total = *light.over(annulus, [](const auto& value) { return std::optional(value.total); });
  result.parallel = light.over(annulus, [](const auto& value) { return value.parallel; });
  result.crossed = light.over(annulus, [](const auto& value) { return value.crossed; });
  return result;
}

RangingMap map_of(const ObservedLight& light, const LitCubes& lit, const RangingSettings& settings) {
  RangingMap map;
  const double spots = lit.deflection_rad() + kMapMargin * lit.detail_rad();
  const double outer = settings.annulus ? kAnnulusMargin * settings.annulus->outer_rad : 0.0;
  map.half_width_rad =
      settings.request.window_arcsec ? *settings.request.window_arcsec * kRadPerArcsec : std::max(outer, spots);
  map.points = settings.request.map_points;
  std::vector<Vec2> angles;
  for (std::size_t row = 0; row < map.points; ++row)
    for (std::size_t column = 0; column < map.points; ++column)
      angles.emplace_back(map.angle_rad(column), map.angle_rad(row));
  map.values = light.at(angles);
  angles.clear();
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    map.ring_rad.push_back(map.half_width_rad * static_cast<double>(ring) / static_cast<double>(kRings - 1));
    for (std::size_t k = 0; k < kPointsPerRing; ++k) {
      const double angle = kTwoPi * static_cast<double>(k) / static_cast<double>(kPointsPerRing);
      angles.push_back(map.ring_rad.back() * Vec2(std::cos(angle), std::sin(angle)));
    }
  }
  const std::vector<ByPolarisation<double>> values = light.at(angles);
  for (std::size_t ring = 0; ring < kRings; ++ring) {
    AnnulusStatistics of_ring{0.0, values[ring * kPointsPerRing].total, values[ring * kPointsPerRing].total};
    for (std::size_t k = 0; k < kPointsPerRing; ++k) {
      const double value = values[ring * kPointsPerRing + k].total;
      of_ring.mean += value / static_cast<double>(kPointsPerRing);
      of_ring.min = std::min(of_ring.min, value);
      of_ring.max = std::max(of_ring.max, value);
    }
    map.ring_m2.push_back(of_ring);
  }
  return map;
}

/// Returns a copy of a design with other errors of the dihedral angles.
design::Design with_errors(const design::Design& design, const std::array<double, 3>& errors_arcsec) {
  // An empty value removes a key. Both keys are removed, because the design may contain either of them.
  const std::vector<std::string> overrides = {
      fmt::format("{}=", design::kDihedralErrorArcmin),
      fmt::format("{}=[{}, {}, {}]", design::kDihedralErrorArcsec, shortest(errors_arcsec[0]),
                  shortest(errors_arcsec[1]), shortest(errors_arcsec[2]))};
  return design::with(design, overrides);
}

std::vector<double> sorted_wavelengths(const RangingRequest& request, const design::Design& design) {
  if (request.wavelength_nm.empty() && design.light.spectrum() != nullptr)
    throw InputError(Field{"wavelength_nm"}, "must be given, because the light of the design has a spectrum");
  std::vector<double> wavelengths = request.wavelength_nm;
  std::sort(wavelengths.begin(), wavelengths.end());
  wavelengths.erase(std::unique(wavelengths.begin(), wavelengths.end()), wavelengths.end());
  return wavelengths;
}

/// Returns the cubes of a study. Without an array, the result contains a single cube in the part frame.
CubeSet cube_set(const design::Design& design, const RangingSettings& settings) {
  const std::vector<double> wavelengths = sorted_wavelengths(settings.request, design);
  CubeSet set;
  set.cubes = settings.is_array() ? settings.cubes : std::vector<ArrayCube>{{}};
  set.variants.emplace_back(design, wavelengths, settings.request.entrance_reflections);
  std::map<std::array<double, 3>, std::size_t> known;
  for (const ArrayCube& cube : set.cubes) {
    if (!cube.dihedral_error_arcsec) {
      set.variant_of_cube.push_back(0);
      continue;
    }
    const auto [it, is_new] = known.try_emplace(*cube.dihedral_error_arcsec, set.variants.size());
    if (is_new)
      set.variants.emplace_back(with_errors(design, *cube.dihedral_error_arcsec), wavelengths,
                                settings.request.entrance_reflections);
    set.variant_of_cube.push_back(it->second);
  }
  return set;
}

/// Checks that the far field of each point is evaluated in an acceptable number of directions.
/// \throw InputError that names the field with the most directions
void check_directions(const RangingSettings& settings, const CubeCorner& corner) {
  const double diameter_mm = std::sqrt(4.0 / std::numbers::pi * corner.entrance_mm2());
  const double detail_rad = 1e-6 * corner.indices().front().wavelength_nm / diameter_mm;
  const double of_annulus = settings.annulus ? evaluations_over(*settings.annulus, detail_rad) : 0.0;
  if (of_annulus > kMaxAnnulusDirections)
    throw InputError(Field{settings.request.orbit_km ? "orbit_km" : "aberration_arcsec"},
                     fmt::format("the annulus contains {:.2g} directions at the resolution of the far field, at most "
                                 "{:.2g} are allowed: give a smaller annulus",
                                 of_annulus, kMaxAnnulusDirections));
  const double directions = directions_of(settings, detail_rad);
  if (directions > kMaxDirections)
    throw InputError(Field{"map_points"},
                     fmt::format("the far field of each point would be evaluated in {:.2g} directions, at most {:.2g} "
                                 "are allowed: give fewer points of the map, or smaller discs of source and receiver",
                                 directions, kMaxDirections));
}

}  // namespace

double RangingMap::angle_rad(std::size_t number) const {
  return half_width_rad * (2.0 * static_cast<double>(number) / static_cast<double>(points - 1) - 1.0);
}

ShotSummary summary_of(const std::vector<Shot>& shots) {
  ShotSummary summary;
  if (shots.empty()) return summary;
  const auto count = static_cast<double>(shots.size());
  summary.min_m2 = summary.max_m2 = shots.front().cross_section_m2;
  for (const Shot& shot : shots) {
    summary.mean_m2 += shot.cross_section_m2 / count;
    summary.centroid_mean_mm += shot.centroid_mm / count;
    summary.min_m2 = std::min(summary.min_m2, shot.cross_section_m2);
    summary.max_m2 = std::max(summary.max_m2, shot.cross_section_m2);
  }
  double squares = 0.0;
  double centroid_squares = 0.0;
  for (const Shot& shot : shots) {
    squares += std::pow(shot.cross_section_m2 - summary.mean_m2, 2.0);
    centroid_squares += std::pow(shot.centroid_mm - summary.centroid_mean_mm, 2.0);
  }
  const double freedom = std::max(1.0, count - 1.0);
  summary.deviation_m2 = std::sqrt(squares / freedom);
  summary.centroid_deviation_mm = std::sqrt(centroid_squares / freedom);
  return summary;
}

struct RangingStudy::Prepared {
  design::Design design;
  RangingSettings settings;
  CubeSet set;

  /// Computes one point. For the first point, also stores the map in `result`.
  RangingPoint point_of(std::size_t wavelength, double incidence_deg, double azimuth_deg, RangingResult& result,
                        Progress* progress, const Cancellation* cancel) const {
    const CubeCorner& corner = set.variants.front();
    RangingPoint point;
    point.index = corner.indices()[wavelength];
    point.incidence_deg = incidence_deg;
    point.azimuth_deg = azimuth_deg;
    const Vec3 to_source = geometry::direction_at(Angle::from_deg(incidence_deg), Angle::from_deg(azimuth_deg));
    const LitCubes lit(set, to_source, wavelength, cancel);
    const double beam_m2 = 1e-6 * corner.entrance_mm2();
    const double wave_m = 1e-9 * point.index.wavelength_nm;
    point.lit_cubes = lit.count();
    point.traced_cubes = lit.traced();
    for (const double cosine : lit.cosines())
      point.mirror_m2 += 4.0 * std::numbers::pi * std::pow(beam_m2 * cosine / wave_m, 2.0);
    if (!settings.is_array()) {
      const double sine = std::sin(incidence_deg * kRadPerDeg);
      point.range_correction_mm =
          studies::range_correction_mm(corner.depth_mm(), point.index.index, point.index.group_index, sine);
      point.usual_range_correction_mm =
          studies::usual_range_correction_mm(corner.depth_mm(), point.index.group_index, sine);
    }
    if (lit.count() == 0) {
      if (settings.is_array())
        result.warnings.push_back(
            {"no_lit_cube",
             fmt::format("no cube faces the source at the incidence {} and the azimuth {} degrees: check "
                         "the axes of the cubes, which point out of their faces",
                         shortest(incidence_deg), shortest(azimuth_deg))});
      point.centre = by_polarisation({}, settings.sent);
      if (settings.annulus) point.annulus = dark_annulus();
      return point;
    }
    PointProgress of_point(progress, directions_of(settings, lit.detail_rad()));
    const ObservedLight light(lit, settings, of_point, cancel);
    point.centre = light.at(std::array{Vec2(Vec2::Zero())}).front();
    if (settings.annulus) point.annulus = over_annulus(light, *settings.annulus);
    point.diffracted_power = lit.diffracted_power();
    if (result.map.values.empty()) result.map = map_of(light, lit, settings);
    if (lit.undiffracted_power() > kMaxUndiffractedPower)
      result.warnings.push_back(
          {"undiffracted_light",
           fmt::format("{:.2g} % of the light at {} nm, incidence {} and azimuth {} degrees is missing in the far "
                       "field, because it consists of too many weak beams",
                       100.0 * lit.undiffracted_power(), shortest(point.index.wavelength_nm), shortest(incidence_deg),
                       shortest(azimuth_deg))});
    if (settings.is_array()) add_echoes(lit, point, cancel);
    return point;
  }

  ByPolarisation<AnnulusStatistics> dark_annulus() const {
    ByPolarisation<AnnulusStatistics> dark;
    if (!has_polarisation(settings.sent)) return dark;
    dark.parallel = dark.crossed = AnnulusStatistics{};
    return dark;
  }

  void add_echoes(const LitCubes& lit, RangingPoint& point, const Cancellation* cancel) const {
    point.echoes = lit.echoes(settings.observation_rad, settings.sent);
    point.ranges = distribution_of(point.echoes);
    const std::optional<double>& pulse_ps = settings.request.pulse_ps;
    if (pulse_ps) point.response = response_of(point.echoes, *pulse_ps);
    if (settings.request.shots > 0)
      point.shots = simulated_shots(point.echoes,
                                    {settings.request.shots, settings.sent, pulse_ps, settings.request.seed}, cancel);
  }
};

RangingStudy::RangingStudy(design::Design design, const RangingRequest& request, std::vector<ArrayCube> cubes) {
  requests::check(request);
  const auto prepared = std::make_shared<Prepared>();
  prepared->settings.request = request;
  prepared->settings.sent = sent_stokes(request, design);
  prepared->settings.annulus = annulus_of(request);
  prepared->settings.observation_rad = observation_of(request, prepared->settings.annulus);
  prepared->settings.cubes = std::move(cubes);
  prepared->set = cube_set(design, prepared->settings);
  check_directions(prepared->settings, prepared->set.variants.front());
  prepared->design = std::move(design);
  prepared_ = prepared;
}

RangingResult RangingStudy::run(Progress* progress, const Cancellation* cancel) const {
  const auto start = std::chrono::steady_clock::now();
  const RangingRequest& request = prepared_->settings.request;
  const CubeCorner& corner = prepared_->set.variants.front();
  RangingResult result;
  result.design = prepared_->design;
  result.settings = prepared_->settings;
  result.depth_mm = corner.depth_mm();
  result.entrance_mm2 = corner.entrance_mm2();
  result.warnings = corner.warnings();
  const std::size_t total = corner.indices().size() * request.incidence_deg.size() * request.azimuth_deg.size();
  for (std::size_t wavelength = 0; wavelength < corner.indices().size(); ++wavelength)
    for (const double incidence_deg : request.incidence_deg)
      for (const double azimuth_deg : request.azimuth_deg) {
        if (is_cancelled(cancel)) break;
        PartProgress of_point(progress, static_cast<double>(result.points.size()) / static_cast<double>(total),
                              static_cast<double>(result.points.size() + 1) / static_cast<double>(total));
        RangingPoint point = prepared_->point_of(wavelength, incidence_deg, azimuth_deg, result, &of_point, cancel);
        if (is_cancelled(cancel)) break;
        result.points.push_back(std::move(point));
        of_point.at(1.0);
      }
  if (result.points.empty()) result.map = {};  // the map is incomplete, because its point was interrupted
  result.complete = result.points.size() == total;
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace retrace::studies
