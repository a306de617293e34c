#include "studies/appearance/appearance.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numbers>

#include "core/error.h"
#include "core/number_format.h"
#include "core/number_range.h"
#include "core/random.h"
#include "materials/chromaticity.h"
#include "materials/io/spectrum_reader.h"
#include "raytrace/observers/photometric_geometry.h"
#include "studies/photometry/colour.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;
using View = raytrace::PhotometricDirections;

// Spans of each colour matching function, of two wavelengths each; of the eye, to judge the table by.
constexpr std::size_t kParts = 2;
constexpr std::size_t kPartsOfProbes = 4;
// Grid steps from the middle of the discs' density to its end, along the plane of incidence at the largest entrance
// angle, where it is narrowest: cubics err by the fourth power of the step (docs/theory/appearance.md).
constexpr double kStepsPerReach = 4.0;
constexpr std::size_t kMostColumns = 161;
// Extents of the first cells, at most.
constexpr double kFirstEntranceDeg = 20.0;
constexpr double kFirstAzimuthDeg = 30.0;
// Halvings of a first cell, at most: 3 steps of a cell times this are a lattice on which directions are known again.
constexpr int kMostHalvings = 6;
// Directions of light that are computed at once, and views of each by which a cell is judged.
constexpr std::size_t kBatch = 16;
constexpr std::uint32_t kViews = 48;
constexpr std::uint32_t kProbes = 200;
// A cell is judged by this share of its views.
constexpr double kJudgedShare = 0.95;
constexpr RandomKey kViewKey{.seed = 0x6d61746cU, .stream = 1};
constexpr RandomKey kProbeKey{.seed = 0x6d61746cU, .stream = 2};

void check(double value, const NumberRange& range, const char* option) {
  if (!range.contains(value))
    throw InputError({"", 0, option}, fmt::format("must be {}, got {}", range.text(), shortest(value)));
}

void check(const AppearanceRequest& request) {
  check(request.window_deg, {.low = 0.1, .high = 5.0}, "--window-deg");
  check(request.entrance_deg, {.low = 1.0, .high = 40.0}, "--entrance-deg");
  check(request.error, {.low = 0.001, .high = 0.5}, "--error");
  check(static_cast<double>(request.most_directions), {.low = 64.0, .high = 10000.0}, "--most-directions");
  const NumberRange discs{.low = 1.0, .high = 120.0};
  check(60.0 * request.apertures.source.deg(), discs, "--source-arcmin");
  check(60.0 * request.apertures.receiver.deg(), discs, "--receiver-arcmin");
}

PhotometryRequest photometry_of(const AppearanceRequest& request) {
  PhotometryRequest photometry;
  photometry.apertures = request.apertures;
  // The corners of the square, seen aslant.
  const double widest =
      std::numbers::sqrt2 * request.window_deg / std::cos(Angle::from_deg(request.entrance_deg).rad());
  photometry.window_deg = std::min(widest, 10.0);
  photometry.light = PhotometricLight::illuminant_d65;
  photometry.engine = Engine::exact;
  return photometry;
}

/// Linear red, green and blue of X, Y and Z: the inverse of the matrix whose columns are the primaries of IEC 61966-2-1
/// (ITU-R BT.709), as bright as makes the light's own colour 1, 1, 1.
Eigen::Matrix3d rgb_from_xyz(const materials::Tristimulus& white) {
  Eigen::Matrix3d primaries;
  primaries << 0.64, 0.30, 0.15, 0.33, 0.60, 0.06, 0.03, 0.10, 0.79;
  const Eigen::Vector3d brightness = primaries.inverse() * Eigen::Vector3d(white[0], white[1], white[2]) / white[1];
  return (primaries * brightness.asDiagonal()).inverse();
}

/// None below the horizon.
std::optional<View> view_of(const Vec3& to_source, const Vec2& deviation) {
  const Vec2 across = to_source.head<2>() + deviation;
  if (across.squaredNorm() >= 1.0) return std::nullopt;
  return View{to_source, {across.x(), across.y(), std::sqrt(1.0 - across.squaredNorm())}};
}

/// A place on the lattice of directions that cells share.
using LatticePlace = std::pair<int, int>;  ///< in entrance angle and azimuth

/// A cell of the table to be.
struct PlannedCell {
  int entrance = 0, azimuth = 0;  ///< lattice place of its lower corner
  int size = 0;                   ///< lattice steps along its sides: a multiple of 3
  double error = 0.0;             ///< of what lies between its directions
};

/// Of x, y or z, without the mirror image, which goes where a mirror's does and not back to the source.
Photometer photometer_of(const Design& design, const PhotometryRequest& request, std::size_t response,
                         std::size_t parts) {
  Photometer photometer(design, request_of_response(request, response), parts,
                        static_cast<PhotometricResponse>(response));
  photometer.leave_out_mirror_image();
  return photometer;
}

/// \throw InputError for a design that the exact engine does not take
void check_engine(const Design& design, PhotometryRequest request) {
  request.engine = Engine::automatic;
  const Photometer photometer(design, request, kParts);
  if (!photometer.is_exact())
    throw InputError(design.where_facets(),
                     "a material is computed by the exact engine, which does not take this design: " +
                         photometer.why_undiffracted());
}

constexpr auto kEye = static_cast<std::size_t>(PhotometricResponse::y_bar);

class TableMaker {
 public:
  TableMaker(const Design& design, const AppearanceRequest& request)
      : design_(design),
        request_(request),
        photometry_(photometry_of(request)),
        eye_(photometer_of(design, photometry_, kEye, kParts)) {
    const materials::SpectralCurve lamp = lamp_power(photometry_.light);
    const materials::Tristimulus sent = materials::tristimulus(lamp, materials::shipped_colour_matching());
    // Photometers tell shares of what their response makes of the light.
    rgb_of_shares_ = rgb_from_xyz(sent) * Eigen::Vector3d(sent[0], sent[1], sent[2]).asDiagonal() / sent[1];
    table_.half_width = std::sin(Angle::from_deg(request.window_deg).rad());
    table_.most_entrance = Angle::from_deg(request.entrance_deg);
    table_.mirrors = eye_.mirrors();
    const double narrowest =
        raytrace::ApertureKernel(request.apertures).reach_rad() * std::cos(table_.most_entrance.rad());
    const double steps = 2.0 * table_.half_width * kStepsPerReach / narrowest;
    table_.columns = std::clamp(static_cast<std::size_t>(std::ceil(steps)) + 1, kPerSide, kMostColumns);
  }

  /// False if it was cancelled.
  bool make(Progress* progress, const Cancellation* cancel) {
    cells_ = first_cells();
    if (!compute(cells_, progress, cancel)) return false;
    first_directions_ = table_.directions.size();
    for (std::size_t judged = 0;;) {
      table_.cells.clear();
      for (const PlannedCell& cell : cells_) table_.cells.push_back(cell_of(cell));
      if (!judge(judged, cancel)) return false;
      const auto worst = std::max_element(cells_.begin(), cells_.end(), [](const PlannedCell& a, const PlannedCell& b) {
        return (a.size > 3 ? a.error : 0.0) < (b.size > 3 ? b.error : 0.0);
      });
      if (worst->error <= request_.error || worst->size <= 3) break;
      const std::vector<PlannedCell> parts = halves_of(*worst);
      if (new_places(parts).size() + table_.directions.size() > request_.most_directions) break;
      if (!compute(parts, progress, cancel)) return false;
      cells_.erase(worst);
      judged = cells_.size();
      cells_.insert(cells_.end(), parts.begin(), parts.end());
    }
    return true;
  }

  /// Random geometries and what the photometer reads there; none if it was cancelled.
  std::optional<std::vector<AppearanceProbe>> probes(const Cancellation* cancel) const {
    std::vector<AppearanceProbe> probes;
    std::vector<PhotometerSetting> settings;
    for (std::uint32_t k = 0; k < kProbes; ++k) {
      const auto random = philox(kProbeKey, k, 0);
      const double sine = std::sin(table_.most_entrance.rad()) * std::sqrt(unit_interval(random[0]));
      const Vec3 to_source =
          direction_of(Angle::from_rad(std::asin(sine)), Angle::from_deg(360.0 * unit_interval(random[1])));
      const Vec2 deviation = deviation_of(random[2], random[3]);
      const std::optional<View> view = view_of(to_source, deviation);
      if (!view) continue;
      probes.push_back({view->to_source, view->to_observer, 0.0, most_of(to_source)});
      settings.push_back(setting_of(*view));
    }
    const Photometer judge = photometer_of(design_, photometry_, kEye, kPartsOfProbes);
    const auto readings = judge.measure(settings, nullptr, cancel);
    if (!readings) return std::nullopt;
    for (std::size_t k = 0; k < probes.size(); ++k) probes[k].r_a = (*readings)[k].r_a.front();
    return probes;
  }

  double least_cell_deg() const {
    int least = lattice_size();
    for (const PlannedCell& cell : cells_) least = std::min(least, cell.size);
    return least * entrance_step().deg();
  }
  ReflectionTable take() { return std::move(table_); }

 private:
  /// Lattice steps along a first cell.
  static int lattice_size() { return 3 << kMostHalvings; }
  int entrance_cells() const { return static_cast<int>(std::ceil(request_.entrance_deg / kFirstEntranceDeg)); }
  int azimuth_cells() const {
    const std::array<Angle, 2> range = table_.azimuths();
    return static_cast<int>(std::ceil((range[1].deg() - range[0].deg()) / kFirstAzimuthDeg - 1e-9));
  }
  Angle entrance_step() const {
    return Angle::from_rad(table_.most_entrance.rad() / (entrance_cells() * lattice_size()));
  }
  Angle azimuth_step() const {
    const std::array<Angle, 2> range = table_.azimuths();
    return Angle::from_rad((range[1].rad() - range[0].rad()) / (azimuth_cells() * lattice_size()));
  }
  Angle entrance_at(double place) const { return Angle::from_rad(place * entrance_step().rad()); }
  Angle azimuth_at(double place) const {
    return Angle::from_rad(table_.azimuths()[0].rad() + place * azimuth_step().rad());
  }

  std::vector<PlannedCell> first_cells() const {
    std::vector<PlannedCell> cells;
    for (int e = 0; e < entrance_cells(); ++e)
      for (int a = 0; a < azimuth_cells(); ++a)
        cells.push_back({e * lattice_size(), a * lattice_size(), lattice_size()});
    return cells;
  }

  static std::vector<PlannedCell> halves_of(const PlannedCell& cell) {
    std::vector<PlannedCell> parts;
    const int half = cell.size / 2;
    for (const int e : {0, half})
      for (const int a : {0, half}) parts.push_back({cell.entrance + e, cell.azimuth + a, half});
    return parts;
  }

  /// By azimuth, then by entrance angle. At normal incidence azimuths are one, and those of a full turn meet.
  std::vector<LatticePlace> places_of(const PlannedCell& cell) const {
    std::vector<LatticePlace> places;
    const bool closes = !table_.mirrors[0] && !table_.mirrors[1];
    const int turn = azimuth_cells() * lattice_size();
    for (int a = 0; a < static_cast<int>(kPerSide); ++a)
      for (int e = 0; e < static_cast<int>(kPerSide); ++e) {
        const int entrance = cell.entrance + e * cell.size / 3;
        const int azimuth = cell.azimuth + a * cell.size / 3;
        places.emplace_back(entrance, entrance == 0 ? 0 : closes && azimuth == turn ? 0 : azimuth);
      }
    return places;
  }

  std::vector<LatticePlace> new_places(const std::vector<PlannedCell>& cells) const {
    std::vector<LatticePlace> places;
    for (const PlannedCell& cell : cells)
      for (const LatticePlace& place : places_of(cell))
        if (!known_.contains(place) && std::find(places.begin(), places.end(), place) == places.end())
          places.push_back(place);
    return places;
  }

  /// The directions that cells need and that are not known. False if it was cancelled.
  bool compute(const std::vector<PlannedCell>& cells, Progress* progress, const Cancellation* cancel) {
    const std::vector<LatticePlace> places = new_places(cells);
    for (std::size_t first = 0; first < places.size(); first += kBatch) {
      const std::size_t count = std::min(kBatch, places.size() - first);
      if (!compute({places.data() + first, count}, cancel)) return false;
      if (progress != nullptr) progress->at(share_done(places.size()));
    }
    return true;
  }

  /// The first cells are half of the work, and of the other half nobody knows how much will be done. \param first
  /// directions of the first cells, while these are computed
  double share_done(std::size_t first) const {
    const auto done = static_cast<double>(table_.directions.size());
    if (first_directions_ == 0) return 0.5 * done / static_cast<double>(first);
    const auto before = static_cast<double>(first_directions_);
    return 0.5 +
           0.5 * (done - before) / std::max(static_cast<double>(request_.most_directions) - before, done - before);
  }

  bool compute(std::span<const LatticePlace> places, const Cancellation* cancel) {
    const std::size_t grid = table_.columns * table_.columns;
    std::vector<PhotometerSetting> settings;
    std::vector<std::size_t> of_value;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Vec3 to_source = direction_of(entrance_at(places[k].first), azimuth_at(places[k].second));
      for (std::size_t point = 0; point < grid; ++point)
        if (const auto view = view_of(to_source, table_.deviation(point))) {
          settings.push_back(setting_of(*view));
          of_value.push_back(k * grid + point);
        }
    }
    std::vector<Rgb> values(places.size() * grid, Rgb{});
    for (std::size_t response = 0; response < 3; ++response) {
      const Photometer one = photometer_of(design_, photometry_, response, kParts);
      const auto readings = one.measure(settings, nullptr, cancel);
      if (!readings) return false;
      for (std::size_t k = 0; k < settings.size(); ++k)
        for (Eigen::Index band = 0; band < 3; ++band)
          values[of_value[k]][static_cast<std::size_t>(band)] +=
              rgb_of_shares_(band, static_cast<Eigen::Index>(response)) * (*readings)[k].r_a.front();
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
      known_[places[k]] = table_.directions.size();
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(k * grid);
      table_.directions.push_back({entrance_at(places[k].first), azimuth_at(places[k].second),
                                   std::vector<Rgb>(from, from + static_cast<std::ptrdiff_t>(grid))});
    }
    return true;
  }

  ReflectionTable::Cell cell_of(const PlannedCell& planned) const {
    ReflectionTable::Cell cell;
    cell.entrance = {entrance_at(planned.entrance), entrance_at(planned.entrance + planned.size)};
    cell.azimuth = {azimuth_at(planned.azimuth), azimuth_at(planned.azimuth + planned.size)};
    const std::vector<LatticePlace> places = places_of(planned);
    for (std::size_t k = 0; k < places.size(); ++k) cell.directions[k] = known_.at(places[k]);
    return cell;
  }

  Vec2 deviation_of(std::uint32_t x, std::uint32_t y) const {
    return table_.half_width * Vec2(2.0 * unit_interval(x) - 1.0, 2.0 * unit_interval(y) - 1.0);
  }

  /// The greatest value of a direction that the table holds.
  double most_of(const Vec3& to_source) const {
    const auto among = table_.at(to_source).value();
    double most = 0.0;
    for (std::size_t place = 0; place < table_.columns * table_.columns; ++place) {
      double value = 0.0;
      for (std::size_t k = 0; k < among.directions.size(); ++k)
        value += among.weights[k] * luminous(table_.directions[among.directions[k]].r_a[place]);
      most = std::max(most, value);
    }
    return most;
  }

  /// Compares the cells from the `first` on with the photometer between their directions. False if it was cancelled.
  bool judge(std::size_t first, const Cancellation* cancel) {
    std::vector<PhotometerSetting> settings;
    std::vector<double> told;
    std::vector<double> floor;
    std::vector<std::size_t> of_cell;
    for (std::size_t k = first; k < cells_.size(); ++k) {
      for (const double share : {1.0 / 6.0, 0.5, 5.0 / 6.0}) {
        const Vec3 to_source = direction_of(entrance_at(cells_[k].entrance + share * cells_[k].size),
                                            azimuth_at(cells_[k].azimuth + share * cells_[k].size));
        const double least = AppearanceError::kFloor * most_of(to_source);
        for (std::uint32_t view = 0; view < kViews; ++view) {
          const auto random = philox(kViewKey, view, static_cast<std::uint32_t>(k));
          const std::optional<View> seen = view_of(to_source, deviation_of(random[0], random[1]));
          if (!seen) continue;
          settings.push_back(setting_of(*seen));
          told.push_back(luminous(table_.r_a(seen->to_source, seen->to_observer).value()));
          floor.push_back(least);
          of_cell.push_back(k);
        }
      }
    }
    const auto readings = eye_.measure(settings, nullptr, cancel);
    if (!readings) return false;
    std::map<std::size_t, std::vector<double>> errors;
    for (std::size_t k = 0; k < settings.size(); ++k) {
      const double truth = (*readings)[k].r_a.front();
      errors[of_cell[k]].push_back(std::abs(told[k] - truth) / std::max({truth, floor[k], 1e-300}));
    }
    for (auto& [cell, of_views] : errors) {
      std::sort(of_views.begin(), of_views.end());
      cells_[cell].error = of_views[static_cast<std::size_t>(kJudgedShare * static_cast<double>(of_views.size() - 1))];
    }
    return true;
  }

  const Design& design_;
  const AppearanceRequest& request_;
  PhotometryRequest photometry_;
  Photometer eye_;
  Eigen::Matrix3d rgb_of_shares_;
  ReflectionTable table_;
  std::vector<PlannedCell> cells_;
  std::map<LatticePlace, std::size_t> known_;  ///< index of the direction there
  std::size_t first_directions_ = 0;           ///< of the first cells; 0 until they are computed
};

}  // namespace

AppearanceError appearance_error(const std::vector<AppearanceProbe>& probes, const std::vector<double>& r_a) {
  std::vector<double> errors;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const double scale = std::max({probes[k].r_a, AppearanceError::kFloor * probes[k].r_a_most, 1e-300});
    errors.push_back(std::abs(r_a[k] - probes[k].r_a) / scale);
  }
  std::sort(errors.begin(), errors.end());
  const auto at = [&](double share) {
    return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
  };
  return {errors.size(), at(0.5), at(0.95), errors.back()};
}

AppearanceResult compute_appearance(const Design& design, const AppearanceRequest& request, Progress* progress,
                                    const Cancellation* cancel) {
  check(request);
  check_engine(design, photometry_of(request));
  const auto begin = std::chrono::steady_clock::now();
  AppearanceResult result;
  result.design = design;
  result.request = request;
  TableMaker maker(design, request);
  result.complete = maker.make(progress, cancel);
  std::optional<std::vector<AppearanceProbe>> probes;
  if (result.complete) probes = maker.probes(cancel);
  result.complete = probes.has_value();
  if (!result.complete) return result;
  result.least_cell_deg = maker.least_cell_deg();
  result.table = maker.take();
  result.probes = *std::move(probes);
  std::vector<double> told;
  for (const AppearanceProbe& probe : result.probes)
    told.push_back(luminous(result.table.r_a(probe.to_source, probe.to_observer).value()));
  result.error = appearance_error(result.probes, told);
  if (result.error.of_95_percent > request.error)
    result.warnings.push_back(fmt::format(
        "of 95 % of random geometries the table is within {} % of the photometer, not within {} %: give more "
        "--most-directions, or a smaller --entrance-deg",
        fixed(100.0 * result.error.of_95_percent, 1), fixed(100.0 * request.error, 1)));
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (progress != nullptr) progress->at(1.0);
  return result;
}

}  // namespace retrace::studies
