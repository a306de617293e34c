#include "studies/appearance/appearance.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "core/error.h"
#include "core/number_format.h"
#include "core/random.h"
#include "core/threads.h"
#include "geometry/direction.h"
#include "materials/chromaticity.h"
#include "materials/io/spectrum_reader.h"
#include "raytrace/light/aperture_kernel.h"
#include "raytrace/observers/coefficients.h"
#include "raytrace/observers/disc_means.h"
#include "raytrace/observers/photometric_geometry.h"
#include "requests/descriptions.h"
#include "studies/photometry/colour.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;
using View = raytrace::PhotometricDirections;

// Number of spectral intervals into which each colour matching function is divided. Each interval is represented by two
// wavelengths.
constexpr std::size_t kParts = 2;
// Number of spectral intervals for the random geometries at which the table is compared with the photometer. These
// geometries are computed for the eye's response only.
constexpr std::size_t kPartsOfProbes = 4;
// Initial resolution of a grid of view directions: number of grid steps across the radius of the aperture kernel. The
// kernel averages over the discs of source and receiver. Its radius is taken along the plane of incidence at the
// maximum entrance angle, where the kernel is narrowest. The error of cubic interpolation grows with the fourth power
// of the step (docs/theory/appearance.md).
constexpr double kStepsPerReach = 4.0;
// Maximum initial number of grid points along a side.
constexpr std::size_t kMostColumns = 161;
// Maximum interpolation error of a grid of view directions, as a fraction of the requested error.
constexpr double kShareOfGrid = 0.5;
// Factor by which the number of grid points along each side grows if the interpolation error is too large.
constexpr double kFinerGrid = 1.5;
// Number of grid points along a side above which a grid is not refined further.
constexpr std::size_t kMostColumnsForError = 121;
// Azimuth of the test light by which back_of() distinguishes prisms from cube corners. At this azimuth, prisms and cube
// corners return light into clearly different directions.
constexpr double kAsideDeg = 30.0;
// Maximum extents, in entrance angle and azimuth, of the initial cells of the table, which are then halved.
constexpr double kFirstEntranceDeg = 20.0;
constexpr double kFirstAzimuthDeg = 30.0;
// Maximum number of times that an initial cell is halved. The side of an initial cell is 3 x 2^8 steps of the lattice
// of light directions. After all halvings, the directions of a cell are therefore still lattice points, so that
// neighbouring cells share the directions on their common sides.
constexpr int kMostHalvings = 8;
// Threshold for halving a cell along a side. The mean third difference of the values is computed along each of the two
// sides. A cell is halved along a side if the third difference along it is at least this fraction of the larger third
// difference, or if the cell cannot be halved along its other side.
constexpr double kLeastBend = 0.3;
// Number of directions of light that are computed in parallel.
constexpr std::size_t kBatch = 16;
// Number of random view directions at which the error of a cell is measured, for each tested direction of light.
constexpr std::uint32_t kViews = 48;
constexpr std::uint32_t kProbes = 200;
// Fraction of the random view directions of a cell at which the error must be below the requested error.
constexpr double kJudgedShare = 0.95;
constexpr RandomKey kViewKey{.seed = 0x6d61746cU, .stream = 1};
constexpr RandomKey kProbeKey{.seed = 0x6d61746cU, .stream = 2};
constexpr RandomKey kGridKey{.seed = 0x6d61746cU, .stream = 3};

raytrace::PhotometricApertures apertures_of(const MaterialRequest& request) {
  return {Angle::from_deg(request.source_arcmin / 60.0), Angle::from_deg(request.receiver_arcmin / 60.0)};
}

/// Returns the settings of the photometer for the table.
/// \param back value of ReflectionTable::back
PhotometrySettings photometry_of(const MaterialRequest& request, const Vec2& back) {
  PhotometrySettings photometry;
  photometry.apertures = apertures_of(request);
  // The window is a disc about the direction to the source that contains the corners of the square range of views. The
  // cosine accounts for oblique incidence.
  photometry.window_deg =
      std::numbers::sqrt2 * request.window_deg / std::cos(Angle::from_deg(request.entrance_deg).rad());
  if (back != Vec2::Ones()) photometry.window_deg += 2.0 * request.entrance_deg;
  photometry.light = PhotometricLight::illuminant_d65;
  photometry.engine = Engine::exact;
  return photometry;
}

/// Returns the matrix that converts X, Y, Z to linear red, green, blue. It is the inverse of the matrix whose columns
/// are the primaries of IEC 61966-2-1 (ITU-R BT.709). The primaries are scaled so that the colour of the light becomes
/// 1, 1, 1.
Eigen::Matrix3d rgb_from_xyz(const materials::Tristimulus& white) {
  Eigen::Matrix3d primaries;
  primaries << 0.64, 0.30, 0.15, 0.33, 0.60, 0.06, 0.03, 0.10, 0.79;
  const Eigen::Vector3d brightness = primaries.inverse() * Eigen::Vector3d(white[0], white[1], white[2]) / white[1];
  return (primaries * brightness.asDiagonal()).inverse();
}

/// Returns the directions to source and observer, or nothing if `across` is too long to be part of a unit vector.
/// \param across x and y components of the unit vector to the observer
std::optional<View> view_of(const Vec3& to_source, const Vec2& across) {
  if (across.squaredNorm() >= 1.0) return std::nullopt;
  return View{to_source, {across.x(), across.y(), std::sqrt(1.0 - across.squaredNorm())}};
}

/// Position on the lattice of light directions, which is common to all cells.
using LatticePlace = std::pair<int, int>;  ///< entrance angle and azimuth, in lattice steps

/// Cell of the reflection table while the table is being made.
struct PlannedCell {
  /// Position of the lower corner on the lattice of light directions: entrance angle, azimuth.
  std::array<int, 2> corner{};
  std::array<int, 2> size{};  ///< lattice steps along its sides: multiples of 3
  double error = 0.0;         ///< relative error of values that are interpolated inside the cell

  bool is_least() const { return size[0] <= 3 && size[1] <= 3; }
};

/// Returns a photometer for the response x, y or z. The photometer ignores light that the entrance face reflects
/// specularly, because this light does not return to the source.
Photometer photometer_of(const Design& design, const PhotometrySettings& request, std::size_t response,
                         std::size_t parts) {
  Photometer photometer(design, request_of_response(request, response), parts,
                        static_cast<PhotometricResponse>(response));
  photometer.leave_out_mirror_image();
  return photometer;
}

/// Checks that the exact engine supports the design.
/// \throw InputError if it does not
void check_engine(const Design& design, PhotometrySettings request) {
  request.engine = Engine::automatic;
  const Photometer photometer(design, request, kParts);
  if (!photometer.is_exact())
    throw InputError(design.where_facets(),
                     "a material is computed by the exact engine, which does not take this design: " +
                         std::string(text_of(photometer.why_undiffracted())));
}

constexpr auto kEye = static_cast<std::size_t>(PhotometricResponse::y_bar);

/// Returns the value of ReflectionTable::back: for each axis, 1 if light reverses its direction component along the
/// axis, and -1 if light keeps this component. Cube corners reverse both components, prisms only one. The case that
/// applies to more than half of the returned light is chosen. If there is no such case, both components count as
/// reversed. Returns nothing if the computation was cancelled.
std::optional<Vec2> back_of(const Design& design, const MaterialRequest& request, const Cancellation* cancel) {
  const Vec3 to_source = geometry::direction_at(Angle::from_deg(request.entrance_deg), Angle::from_deg(kAsideDeg));
  const Photometer eye = photometer_of(design, photometry_of(request, -Vec2::Ones()), kEye, kParts);
  const auto fields = eye.far_fields(to_source, eye.make_tracer(), cancel);
  if (!fields) return std::nullopt;
  const std::array<Vec2, 3> ways = {Vec2(1.0, 1.0), Vec2(1.0, -1.0), Vec2(-1.0, 1.0)};
  std::array<double, 3> powers{};
  const auto add = [&](const Vec2& cosines, double power) {
    const auto distance = [&](const Vec2& way) { return (cosines - way.cwiseProduct(to_source.head<2>())).norm(); };
    const auto nearest = std::min_element(ways.begin(), ways.end(),
                                          [&](const Vec2& a, const Vec2& b) { return distance(a) < distance(b); });
    if (distance(*nearest) < std::sin(Angle::from_deg(request.window_deg).rad()))
      powers[static_cast<std::size_t>(nearest - ways.begin())] += power;
  };
  for (const Photometer::WeighedField& one : *fields) {
    for (const raytrace::FarFieldRay& ray : one.field.rays()) add(ray.direction.head<2>(), one.weight * ray.power);
    for (const raytrace::CoherentGroup& group : one.field.groups())
      for (const raytrace::FieldPolygon& polygon : group.polygons)
        add(polygon.cosines, one.weight * group.copies * polygon.power);
  }
  const auto most = std::max_element(powers.begin(), powers.end());
  const bool has_most_light = 2.0 * *most > powers[0] + powers[1] + powers[2];
  return has_most_light ? ways[static_cast<std::size_t>(most - powers.begin())] : ways[0];
}

/// Returns the relative error of the interpolated value `told`, compared with `truth`. If `truth` is below the fraction
/// AppearanceError::kFloor of the maximum `most`, the error is relative to this fraction of `most`.
double error_of(double told, double truth, double most) {
  return std::abs(told - truth) / std::max({truth, AppearanceError::kFloor * most, 1e-300});
}

double quantile(std::vector<double> errors, double share) {
  std::sort(errors.begin(), errors.end());
  return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
}

double share_within(const std::vector<double>& errors) {
  return quantile(errors, kJudgedShare);
}

/// Photometer for one of the responses x, y and z, and its beam tracer.
struct Instrument {
  explicit Instrument(Photometer of_response) : photometer(std::move(of_response)), tracer(photometer.make_tracer()) {}

  Photometer photometer;
  raytrace::BeamTracer tracer;
};

class TableMaker {
 public:
  /// \param back value of ReflectionTable::back
  TableMaker(const Design& design, const MaterialRequest& request, const Vec2& back)
      : design_(design), request_(request), photometry_(photometry_of(request, back)) {
    for (std::size_t response = 0; response < instruments_.size(); ++response)
      instruments_[response] = std::make_unique<Instrument>(photometer_of(design, photometry_, response, kParts));
    const materials::SpectralCurve lamp = lamp_power(photometry_.light);
    const materials::Tristimulus sent = materials::tristimulus(lamp, materials::shipped_colour_matching());
    // Readings of a photometer are divided by its response to the incident light. The matrix therefore multiplies the
    // readings by this response, `sent`.
    rgb_of_shares_ = rgb_from_xyz(sent) * Eigen::Vector3d(sent[0], sent[1], sent[2]).asDiagonal() / sent[1];
    table_.back = back;
    table_.half_width = std::sin(Angle::from_deg(request.window_deg).rad());
    table_.most_entrance = Angle::from_deg(request.entrance_deg);
    table_.mirrors = eye().mirrors();
    const double narrowest =
        raytrace::ApertureKernel(apertures_of(request)).reach_rad() * std::cos(table_.most_entrance.rad());
    const double steps = 2.0 * table_.half_width * kStepsPerReach / narrowest;
    table_.columns = std::clamp(static_cast<std::size_t>(std::ceil(steps)) + 1, kPerSide, kMostColumns);
  }

  /// Computes the table. Returns false if the computation was cancelled.
  bool make(Progress* progress, const Cancellation* cancel) {
    if (!refine_grid(cancel)) return false;
    cells_ = first_cells();
    if (!compute(cells_, progress, cancel)) return false;
    first_directions_ = table_.directions.size();
    for (std::size_t judged = 0;;) {
      table_.cells.clear();
      for (const PlannedCell& cell : cells_) table_.cells.push_back(cell_of(cell));
      if (!judge(judged, cancel)) return false;
      const auto worst =
          std::max_element(cells_.begin(), cells_.end(),
                           [&](const PlannedCell& a, const PlannedCell& b) { return urgency(a) < urgency(b); });
      if (!(urgency(*worst) > 0.0)) break;
      const std::vector<PlannedCell> parts = halves_of(*worst);
      if (new_places(parts).size() + table_.directions.size() > request_.most_directions) break;
      if (!compute(parts, progress, cancel)) return false;
      cells_.erase(worst);
      judged = cells_.size();
      cells_.insert(cells_.end(), parts.begin(), parts.end());
    }
    return true;
  }

  /// Returns random geometries with their photometer readings. Returns nothing if the computation was cancelled.
  std::optional<std::vector<AppearanceProbe>> probes(const Cancellation* cancel) const {
    std::vector<AppearanceProbe> probes;
    std::vector<PhotometerSetting> settings;
    for (std::uint32_t k = 0; k < kProbes; ++k) {
      const auto random = philox(kProbeKey, k, 0);
      const double sine = std::sin(table_.most_entrance.rad()) * std::sqrt(unit_interval(random[0]));
      const Vec3 to_source =
          geometry::direction_at(Angle::from_rad(std::asin(sine)), Angle::from_deg(360.0 * unit_interval(random[1])));
      const Vec2 deviation = deviation_of(random[2], random[3]);
      const std::optional<View> view = view_of(to_source, table_.middle(to_source) + deviation);
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
    for (const PlannedCell& cell : cells_) least = std::min(least, cell.size[0]);
    return least * entrance_step().deg();
  }
  ReflectionTable take() { return std::move(table_); }

 private:
  /// Returns the priority with which a cell is halved: its error times its projected solid angle of light directions,
  /// up to a constant factor. Returns 0 if the error is small enough.
  double urgency(const PlannedCell& cell) const {
    if (cell.error <= request_.error || cell.is_least()) return 0.0;
    const double from = std::sin(entrance_at(cell.corner[0]).rad());
    const double to = std::sin(entrance_at(cell.corner[0] + cell.size[0]).rad());
    return cell.error * (to * to - from * from) * cell.size[1];
  }
  const Photometer& eye() const { return instruments_[kEye]->photometer; }
  /// Returns the number of lattice steps along each side of a first cell.
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
        cells.push_back({{e * lattice_size(), a * lattice_size()}, {lattice_size(), lattice_size()}});
    return cells;
  }

  /// Returns the smaller cells into which a cell is divided. The cell is halved along each side along which the third
  /// differences of the values are large.
  std::vector<PlannedCell> halves_of(const PlannedCell& cell) const {
    const std::array<double, 2> bends = bends_of(cell);
    const double most = std::max(bends[0], bends[1]);
    std::vector<PlannedCell> parts = {cell};
    for (const std::size_t side : {0U, 1U}) {
      if (cell.size[side] <= 3) continue;
      if (cell.size[1 - side] > 3 && bends[side] < kLeastBend * most) continue;
      const std::size_t count = parts.size();
      for (std::size_t k = 0; k < count; ++k) {
        parts[k].size[side] /= 2;
        parts.push_back(parts[k]);
        parts.back().corner[side] += parts[k].size[side];
      }
    }
    return parts;
  }

  /// Returns the mean third differences of the values along entrance angle and azimuth.
  std::array<double, 2> bends_of(const PlannedCell& planned) const {
    const ReflectionTable::Cell cell = cell_of(planned);
    const auto value = [&](std::size_t azimuth, std::size_t entrance, std::size_t point) {
      return luminous(table_.directions[cell.directions[kPerSide * azimuth + entrance]].r_a[point]);
    };
    std::array<double, 2> bends{};
    for (std::size_t point = 0; point < table_.columns * table_.columns; ++point)
      for (std::size_t line = 0; line < kPerSide; ++line) {
        bends[0] += std::abs(value(line, 3, point) - 3.0 * value(line, 2, point) + 3.0 * value(line, 1, point) -
                             value(line, 0, point));
        bends[1] += std::abs(value(3, line, point) - 3.0 * value(2, line, point) + 3.0 * value(1, line, point) -
                             value(0, line, point));
      }
    return bends;
  }

  /// Returns the lattice positions of a cell's 4 x 4 directions, ordered by azimuth and then by entrance angle. At
  /// normal incidence, all azimuths are the same direction. If the azimuths cover a full circle, the last azimuth is
  /// the same as the first.
  std::vector<LatticePlace> places_of(const PlannedCell& cell) const {
    std::vector<LatticePlace> places;
    const bool closes = !table_.mirrors[0] && !table_.mirrors[1];
    const int turn = azimuth_cells() * lattice_size();
    for (int a = 0; a < static_cast<int>(kPerSide); ++a)
      for (int e = 0; e < static_cast<int>(kPerSide); ++e) {
        const int entrance = cell.corner[0] + e * cell.size[0] / 3;
        const int azimuth = cell.corner[1] + a * cell.size[1] / 3;
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

  /// Computes the directions of light that the cells need and that are not yet known. Returns false if the computation
  /// was cancelled.
  bool compute(const std::vector<PlannedCell>& cells, Progress* progress, const Cancellation* cancel) {
    const std::vector<LatticePlace> places = new_places(cells);
    for (std::size_t first = 0; first < places.size(); first += kBatch) {
      const std::size_t count = std::min(kBatch, places.size() - first);
      if (!compute({places.data() + first, count}, cancel)) return false;
      if (progress != nullptr) progress->at(share_done(places.size()));
    }
    return true;
  }

  /// Returns the finished fraction of the work. The first cells count as one half of the work, because the amount of
  /// refinement after them is not known in advance.
  /// \param first number of directions of the first cells; used only while these directions are computed
  double share_done(std::size_t first) const {
    const auto done = static_cast<double>(table_.directions.size());
    if (first_directions_ == 0) return 0.5 * done / static_cast<double>(first);
    const auto before = static_cast<double>(first_directions_);
    return 0.5 +
           0.5 * (done - before) / std::max(static_cast<double>(request_.most_directions) - before, done - before);
  }

  bool compute(std::span<const LatticePlace> places, const Cancellation* cancel) {
    std::vector<ReflectionTable::Direction> computed(places.size());
    for_each_in_parallel(places.size(), [&](std::size_t k) {
      computed[k] = {entrance_at(places[k].first), azimuth_at(places[k].second), {}};
      const Vec3 to_source = geometry::direction_at(computed[k].entrance, computed[k].azimuth);
      if (std::optional<Fields> fields = fields_of(to_source, cancel))
        computed[k].r_a = grid_of(to_source, *fields, cancel);
    });
    if (is_cancelled(cancel)) return false;
    for (std::size_t k = 0; k < places.size(); ++k) {
      known_[places[k]] = table_.directions.size();
      table_.directions.push_back(std::move(computed[k]));
    }
    return true;
  }

  /// Far fields for the responses x, y and z, and the weights with which they contribute to red, green and blue.
  struct Fields {
    std::array<std::vector<Photometer::WeighedField>, 3> of_response;
    std::vector<raytrace::BandedField> weighed;
  };
  /// Computes the far fields for one direction of light. Returns nothing if the computation was cancelled.
  std::optional<Fields> fields_of(const Vec3& to_source, const Cancellation* cancel) const {
    Fields fields;
    const Angle entrance = Angle::from_rad(std::acos(to_source.z()));
    for (std::size_t response = 0; response < instruments_.size(); ++response) {
      const Instrument& with = *instruments_[response];
      auto found = with.photometer.far_fields(to_source, with.tracer, cancel);
      if (!found) return std::nullopt;
      fields.of_response[response] = *std::move(found);
      for (const Photometer::WeighedField& one : fields.of_response[response]) {
        raytrace::BandedField& weighed = fields.weighed.emplace_back();
        weighed.field = &one.field;
        for (std::size_t band = 0; band < weighed.weights.size(); ++band)
          weighed.weights[band] = rgb_of_shares_(static_cast<Eigen::Index>(band), static_cast<Eigen::Index>(response)) *
                                  raytrace::coefficient_of_retroreflection(one.weight, entrance);
      }
    }
    return fields;
  }
  std::vector<Rgb> grid_of(const Vec3& to_source, const Fields& fields, const Cancellation* cancel) const {
    return raytrace::disc_means(fields.weighed, {table_.middle(to_source), table_.half_width, table_.columns},
                                eye().kernel(), cancel);
  }

  /// Increases the number of grid points until interpolation between view directions is accurate. The test uses one
  /// direction of light, in the middle of the range of entrance angles and azimuths. Returns false if the computation
  /// was cancelled.
  bool refine_grid(const Cancellation* cancel) {
    const std::array<Angle, 2> range = table_.azimuths();
    const Vec3 to_source = geometry::direction_at(Angle::from_rad(0.5 * table_.most_entrance.rad()),
                                                  Angle::from_rad(0.5 * (range[0].rad() + range[1].rad())));
    const std::optional<Fields> fields = fields_of(to_source, cancel);
    if (!fields) return false;
    std::vector<Vec2> deviations;
    std::vector<double> truth;
    for (std::uint32_t k = 0; k < kProbes; ++k) {
      const auto random = philox(kGridKey, k, 0);
      const Vec2 deviation = deviation_of(random[0], random[1]);
      const std::optional<View> view = view_of(to_source, table_.middle(to_source) + deviation);
      if (!view) continue;
      deviations.push_back(deviation);
      Rgb sum{};
      for (const raytrace::BandedField& one : fields->weighed) {
        const double per_sr = one.field->intensity(view->to_observer, eye().kernel()).per_sr;
        for (std::size_t band = 0; band < sum.size(); ++band) sum[band] += one.weights[band] * per_sr;
      }
      truth.push_back(luminous(sum));
    }
    for (;;) {
      const std::vector<Rgb> grid = grid_of(to_source, *fields, cancel);
      if (is_cancelled(cancel)) return false;
      double most = 0.0;
      for (const Rgb& value : grid) most = std::max(most, luminous(value));
      std::vector<double> errors;
      for (std::size_t k = 0; k < truth.size(); ++k)
        errors.push_back(error_of(luminous(table_.between(grid, deviations[k])), truth[k], most));
      const auto finer = static_cast<std::size_t>(std::ceil(kFinerGrid * static_cast<double>(table_.columns)));
      if (share_within(errors) <= kShareOfGrid * request_.error || finer > kMostColumnsForError) return true;
      table_.columns = finer;
    }
  }

  ReflectionTable::Cell cell_of(const PlannedCell& planned) const {
    ReflectionTable::Cell cell;
    cell.entrance = {entrance_at(planned.corner[0]), entrance_at(planned.corner[0] + planned.size[0])};
    cell.azimuth = {azimuth_at(planned.corner[1]), azimuth_at(planned.corner[1] + planned.size[1])};
    const std::vector<LatticePlace> places = places_of(planned);
    for (std::size_t k = 0; k < places.size(); ++k) cell.directions[k] = known_.at(places[k]);
    return cell;
  }

  Vec2 deviation_of(std::uint32_t x, std::uint32_t y) const {
    return table_.half_width * Vec2(2.0 * unit_interval(x) - 1.0, 2.0 * unit_interval(y) - 1.0);
  }

  /// Returns the maximum of R_A over the grid points of the table, for the eye's response and one direction of light.
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

  /// Compares the table with the photometer at random geometries inside the cells from index `first` on, and sets the
  /// errors of these cells. Returns false if the computation was cancelled.
  bool judge(std::size_t first, const Cancellation* cancel) {
    std::vector<PhotometerSetting> settings;
    std::vector<double> told;
    std::vector<double> most;
    std::vector<std::size_t> of_cell;
    for (std::size_t k = first; k < cells_.size(); ++k) {
      for (const double share : {1.0 / 6.0, 0.5, 5.0 / 6.0}) {
        const Vec3 to_source = geometry::direction_at(entrance_at(cells_[k].corner[0] + share * cells_[k].size[0]),
                                                      azimuth_at(cells_[k].corner[1] + share * cells_[k].size[1]));
        const double greatest = most_of(to_source);
        for (std::uint32_t view = 0; view < kViews; ++view) {
          const auto random = philox(kViewKey, view, static_cast<std::uint32_t>(k));
          const std::optional<View> seen =
              view_of(to_source, table_.middle(to_source) + deviation_of(random[0], random[1]));
          if (!seen) continue;
          settings.push_back(setting_of(*seen));
          told.push_back(luminous(table_.r_a(seen->to_source, seen->to_observer).value()));
          most.push_back(greatest);
          of_cell.push_back(k);
        }
      }
    }
    const auto readings = eye().measure(settings, nullptr, cancel);
    if (!readings) return false;
    std::map<std::size_t, std::vector<double>> errors;
    for (std::size_t k = 0; k < settings.size(); ++k)
      errors[of_cell[k]].push_back(error_of(told[k], (*readings)[k].r_a.front(), most[k]));
    for (auto& [cell, of_views] : errors) cells_[cell].error = share_within(of_views);
    return true;
  }

  const Design& design_;
  const MaterialRequest& request_;
  PhotometrySettings photometry_;
  std::array<std::unique_ptr<Instrument>, 3> instruments_;  ///< one for each of the responses x, y and z
  Eigen::Matrix3d rgb_of_shares_;
  ReflectionTable table_;
  std::vector<PlannedCell> cells_;
  std::map<LatticePlace, std::size_t> known_;  ///< index of each lattice position in the table's list of directions
  std::size_t first_directions_ = 0;           ///< number of directions of the first cells; 0 until they are computed
};

}  // namespace

AppearanceError appearance_error(const std::vector<AppearanceProbe>& probes, const std::vector<double>& r_a) {
  std::vector<double> errors;
  for (std::size_t k = 0; k < probes.size(); ++k) errors.push_back(error_of(r_a[k], probes[k].r_a, probes[k].r_a_most));
  return {errors.size(), quantile(errors, 0.5), quantile(errors, 0.95), quantile(errors, 1.0)};
}

AppearanceResult compute_appearance(const Design& design, const MaterialRequest& request, Progress* progress,
                                    const Cancellation* cancel) {
  requests::check(request);
  check_engine(design, photometry_of(request, Vec2::Ones()));
  const auto begin = std::chrono::steady_clock::now();
  AppearanceResult result;
  result.design = design;
  result.request = request;
  const std::optional<Vec2> back = back_of(design, request, cancel);
  result.complete = back.has_value();
  if (!result.complete) return result;
  TableMaker maker(design, request, *back);
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
    result.warnings.push_back(
        {"table_error_above_target",
         fmt::format("for 95 % of random geometries, the table is within {} % of the photometer, but {} % were "
                     "requested: allow "
                     "more directions of light, or give a smaller largest entrance angle",
                     fixed(100.0 * result.error.of_95_percent, 1), fixed(100.0 * request.error, 1))});
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (progress != nullptr) progress->at(1.0);
  return result;
}

}  // namespace retrace::studies
