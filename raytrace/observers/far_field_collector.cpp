// Coherent grouping of the returned light: the member functions of FarFieldCollector, which sort beams by cell, wave
// and optical path length.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "raytrace/exact/flat_polygon.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/observers/error_free_exit.h"
#include "raytrace/observers/far_field.h"
#include "raytrace/observers/formed_aperture.h"
#include "raytrace/observers/lattice_field.h"
#include "raytrace/observers/small_angle.h"

namespace retrace::raytrace {
namespace {

using geometry::Vec2, std::numbers::pi;

// Directions that differ by less than this angle are treated as equal.
constexpr double kOneDirection_rad = 1e-9;
// Beams with less power than this value are not diffracted.
constexpr double kFaint = 1e-10;
// Up to this number of polygons, all beams are diffracted. The total power of an undiffracted beam has a single
// direction. If the discs of source and receiver are smaller than a diffraction spot, such a beam appears much too
// bright.
constexpr std::size_t kFewPolygons = 256;
// Steps to which quantities are rounded to compare the fields of cells: lengths in element sizes, direction cosines,
// amplitudes, and paths in mm.
constexpr double kLengthStep = 1e-7, kCosineStep = 1e-8, kAmplitudeStep = 1e-7, kPathStep_mm = 1e-7;
// Rounding step for the points where light met facets, in element sizes, and for the derivatives of these points.
constexpr double kHitStep = 1e-6;
// Polygons are joined if their union differs from a convex polygon by less than this fraction of size_mm^2.
constexpr double kJoinOutlinesFraction = 1e-10;

std::int64_t step_of(double value, double step) {
  return std::llround(value / step);
}

/// Rounded data with which the fields of two cells are compared.
using Signature = std::vector<std::int64_t>;

/// Appends to `key` the points where light met facets with a form. The coordinates are those of the facets' frames.
void add_form_keys(const std::vector<FieldHit>& hits, double size_mm, Signature& key) {
  for (const FieldHit& hit : hits) {
    if (hit.path_per_height == 0.0) continue;
    key.push_back(step_of(hit.path_per_height, kHitStep));
    for (const double length : hit.form_constant_mm) key.push_back(step_of(length, kHitStep * size_mm));
    for (const double slope : hit.form_slope.reshaped()) key.push_back(step_of(slope, kHitStep));
  }
}

/// Appends the corners of a convex polygon to `key`.
void add_corner_keys(const geometry::Polygon& polygon, double size_mm, Signature& key) {
  std::vector<std::array<std::int64_t, 2>> corners;
  for (const Vec2& p : polygon)
    corners.push_back({step_of(p.x(), kLengthStep * size_mm), step_of(p.y(), kLengthStep * size_mm)});
  std::sort(corners.begin(), corners.end());
  for (const auto& corner : corners) key.insert(key.end(), corner.begin(), corner.end());
}

Signature signature_of(const CoherentGroup& group, double size_mm) {
  Signature all = {group.replicate ? 1 + std::int64_t{*group.replicate} : 0};
  for (const FieldPolygon& p : group.polygons) {
    const Vec2 centroid = geometry::centroid(p.transform.polygon());
    for (const double length : {centroid.x(), centroid.y(), std::sqrt(p.transform.area_mm2())})
      all.push_back(step_of(length, kLengthStep * size_mm));
    all.push_back(step_of(p.cosines.x(), kCosineStep));
    all.push_back(step_of(p.cosines.y(), kCosineStep));
    const double scale = 1.0 / std::sqrt(std::max(p.power, std::numeric_limits<double>::min()));
    for (const std::complex<double>& a : p.amplitude.reshaped()) {
      const std::complex<double> unit = a * scale * size_mm;
      all.push_back(step_of(unit.real(), 1e3 * kAmplitudeStep));
      all.push_back(step_of(unit.imag(), 1e3 * kAmplitudeStep));
    }
    add_form_keys(p.hits, size_mm, all);
    // For resampled beams, the corners are compared in addition. The centroid of such a beam is the origin of its
    // coordinates, so that comparing centroids does not distinguish beams.
    if (group.replicate) add_corner_keys(p.transform.polygon(), size_mm, all);
  }
  return all;
}

/// Returns the number of copies of `group` that have the same total power as `other`. Both groups have the same shape.
/// Their powers may differ if the entrance face has reflected the light, or if beams were resampled. The number is
/// therefore not always an integer.
double copies_in(const CoherentGroup& group, const CoherentGroup& other) {
  return other.power() * group.copies / group.power();
}

}  // namespace

FarFieldCollector::FarFieldCollector(const geometry::Part& part, const Illumination& illumination,
                                     const FarFieldPolicy& policy)
    : policy_(policy),
      is_infinite_(part.period_mm.has_value()),
      cells_interfere_(policy.interference && part.period_mm),
      period_mm_(part.period_mm.value_or(Vec2::Zero())),
      size_mm_(part.size_mm),
      thickness_mm_(part.thickness_mm),
      to_source_(direction_to_source(illumination)),
      directions_(kOneDirection_rad) {
  field_.replicates_ = policy.replicates;
  field_.wavelength_mm_ = 1e-6 * policy.wavelength_nm;
  field_.coherency_ = coherency_of_source(illumination.stokes);
  field_.cancel_ = policy.cancel;
}

void FarFieldCollector::add_ray(const FarFieldRay& ray) {
  std::size_t index = field_.rays_.size();
  directions_.visit(ray.direction, [&](std::size_t known) {
    if (field_.rays_[known].replicate == ray.replicate) index = std::min(index, known);
  });
  if (index == field_.rays_.size()) {
    field_.rays_.push_back({ray.direction, 0.0, ray.replicate});
    directions_.insert(ray.direction, index);
  }
  field_.rays_[index].power += ray.power;
}

/// Adds the specular fraction of a ray. The scattered fraction is added to `unplaced_power_`, the power whose direction
/// is not computed.
void FarFieldCollector::add_scattering_ray(const FarFieldRay& ray, double phase_variance) {
  const double specular = std::exp(-phase_variance) * ray.power;
  field_.unplaced_power_ += ray.power - specular;
  add_ray({ray.direction, specular, ray.replicate});
}

void FarFieldCollector::add(const ReturnedBeam& beam) {
  const double power = beam.stokes.i / replicates_of(beam);
  field_.total_power_ += beam.instance_count() * power;
  const bool is_diffracted = policy_.diffraction && beam.exit_polygon_mm.size() >= 3 && power > kFaint &&
                             small_angle_between(beam.direction, to_source_) <= policy_.window_rad;
  if (!is_diffracted) {
    double phase_variance = 0.0;
    for (const TexturedHit& hit : beam.hits) phase_variance += hit.phase.variance();
    return add_scattering_ray({beam.direction, beam.instance_count() * power, beam.replicate}, phase_variance);
  }
  put(moved_to_first_copy(beam), beam);
}

/// Adds a beam to all cells from which it comes.
void FarFieldCollector::put(CollectedBeam piece, const ReturnedBeam& beam) {
  const auto number = static_cast<std::uint32_t>(beams_.size());
  CoherenceKey place = coherence_key_of(beam, piece);
  if (is_infinite_) piece.copies = beam.instance_count();
  if (cells_interfere_) {
    const Vec2 first = beam.trail.first ? beam.trail.first->offset_mm : Vec2::Zero();
    piece.positions_mm = {first};
    if (beam.instance_offsets) {
      piece.positions_mm.clear();
      for (const Vec2& by : *beam.instance_offsets) piece.positions_mm.push_back(first + by);
    }
  }
  beams_.push_back(std::move(piece));
  if (!beam.instance_offsets || is_infinite_) {
    cells_[place].push_back(number);
    return;
  }
  for (const Vec2& by : *beam.instance_offsets) {
    const Vec2 at = beam.trail.first->offset_mm + by;
    place.x = step_of(at.x(), kLengthStep * size_mm_);
    place.y = step_of(at.y(), kLengthStep * size_mm_);
    cells_[place].push_back(number);
  }
}

/// Returns the key of the coherent sum to which the field of a beam is added.
///
/// All beams that met only one cell have the key of this cell. Beams that met several cells have equal keys if they are
/// fragments of one wave. The tracer creates such fragments when it divides the entrance face.
/// A resampled beam has a unique key. A beam that met no cell, such as the reflection at the entrance face, also has a
/// unique key.
FarFieldCollector::CoherenceKey FarFieldCollector::coherence_key_of(const ReturnedBeam& beam,
                                                                    const CollectedBeam& piece) {
  if (beam.replicate || !beam.trail.first) return {0, 0, 0, ++unique_keys_};
  CoherenceKey place{beam.trail.first->id, 0, 0, 0};
  if (!is_infinite_) {
    place.x = step_of(beam.trail.first->offset_mm.x(), kLengthStep * size_mm_);
    place.y = step_of(beam.trail.first->offset_mm.y(), kLengthStep * size_mm_);
  }
  if (beam.trail.is_mixed) {
    const auto [known, is_new] = mixed_.try_emplace({beam.trail.sequence_hash, wave_of(piece)}, unique_keys_ + 1);
    if (is_new) ++unique_keys_;
    place.beam = known->second;
  }
  return place;
}

/// Returns the number by which the power of a beam is divided to obtain a mean over the replicates.
double FarFieldCollector::replicates_of(const ReturnedBeam& beam) const {
  return beam.replicate ? static_cast<double>(policy_.replicates) : 1.0;
}

/// Returns a beam as if it had left the reference cell, which is the copy of its cell at the origin. The outline of the
/// beam is that of a part without errors of angle (ErrorFreeExit).
/// Copies of a cell have the same field except for a phase. The incident and the returned wave cause this phase,
/// because the copies are at different positions. The function removes it.
FarFieldCollector::CollectedBeam FarFieldCollector::moved_to_first_copy(const ReturnedBeam& beam) const {
  const Vec2 by = beam.trail.first ? beam.trail.first->offset_mm : Vec2::Zero();
  const ErrorFreeExit exit = error_free_exit(beam, to_source_, by).value_or(ErrorFreeExit{});
  const Eigen::Affine2d home_from_exit = Eigen::Translation2d(-by) * exit.from_exit;
  CollectedBeam piece;
  for (const Vec2& p : beam.exit_polygon_mm) piece.outline_mm.push_back(home_from_exit * (p - beam.centre_mm));
  piece.direction = beam.direction;
  piece.jones = beam.jones;
  piece.transmission = beam.transmission / replicates_of(beam);
  piece.phase_mm = beam.phase_mm + exit.phase_change_mm + (beam.direction + to_source_).head<2>().dot(by);
  piece.power = beam.stokes.i / replicates_of(beam);
  piece.replicate = beam.replicate;
  const Vec3 moved(by.x(), by.y(), 0.0);
  const Eigen::Affine2d exit_from_home = home_from_exit.inverse();
  const Vec2 exit_of_home = exit_from_home.translation();
  piece.entry_from_exit = Eigen::Translation2d(-by) * beam.entry_from_exit * exit_from_home;
  for (const TexturedHit& hit : beam.hits) {
    FieldHit at_home;
    at_home.normal = hit.plane.normal;
    at_home.offset_mm = hit.plane.offset_mm - hit.plane.normal.dot(moved);
    at_home.constant_mm = hit.of({exit_of_home.x(), exit_of_home.y(), thickness_mm_}) - moved;
    at_home.slope = hit.slope.leftCols<2>() * exit_from_home.linear();
    at_home.phase = hit.phase;
    at_home.path_per_height = hit.path_per_height;
    at_home.form = hit.form != nullptr ? hit.form : policy_.form;
    Eigen::Matrix<double, 2, 3> axes;
    axes << hit.frame.horizontal.transpose(), hit.frame.down.transpose();
    at_home.form_constant_mm = axes * (at_home.constant_mm + moved - hit.frame.origin_mm);
    at_home.form_slope = axes * at_home.slope;
    piece.hits.push_back(at_home);
  }
  return piece;
}

Vec2 FarFieldCollector::centroid_of(const BeamsOfCell& numbers) const {
  Vec2 middle = Vec2::Zero();
  double area = 0.0;
  for (const std::uint32_t number : numbers) {
    const double own = geometry::area(beams_[number].outline_mm);
    middle += own * geometry::centroid(beams_[number].outline_mm);
    area += own;
  }
  return area > 0.0 ? Vec2(middle / area) : middle;
}

/// Divides the light of a cell into groups whose optical paths differ by more than the coherence length.
std::vector<CoherentGroup> FarFieldCollector::groups_of(const BeamsOfCell& numbers, const Vec2& middle_mm) const {
  const auto path = [&](const CollectedBeam& p) { return p.phase_mm + p.direction.head<2>().dot(middle_mm); };
  std::vector<CollectedBeam> sorted;
  for (const std::uint32_t number : numbers) sorted.push_back(beams_[number]);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const CollectedBeam& a, const CollectedBeam& b) { return path(a) < path(b); });
  std::vector<CoherentGroup> groups;
  std::vector<CollectedBeam> open;
  for (const CollectedBeam& piece : sorted) {
    if (!open.empty() && path(piece) - path(open.back()) > policy_.coherence_length_mm) {
      groups.push_back(group_of(std::move(open), middle_mm));
      open.clear();
    }
    open.push_back(piece);
  }
  groups.push_back(group_of(std::move(open), middle_mm));
  return groups;
}

FarFieldCollector::WaveKey FarFieldCollector::wave_of(const CollectedBeam& p) const {
  WaveKey key(11);
  key[0] = step_of(p.direction.x(), kCosineStep);
  key[1] = step_of(p.direction.y(), kCosineStep);
  key[2] = step_of(p.phase_mm, kPathStep_mm);
  for (std::size_t k = 0; k < 4; ++k) {
    const std::complex<double> a = p.jones.reshaped()(static_cast<Eigen::Index>(k));
    key[3 + 2 * k] = step_of(a.real(), kAmplitudeStep);
    key[4 + 2 * k] = step_of(a.imag(), kAmplitudeStep);
  }
  // Beams with equal directions and fields may have met the facets at different points or in a different order. They
  // are then different waves.
  for (const FieldHit& hit : p.hits) {
    for (const double cosine : hit.normal) key.push_back(step_of(cosine, kCosineStep));
    for (const double length : hit.constant_mm) key.push_back(step_of(length, kHitStep * size_mm_));
    for (const double slope : hit.slope.reshaped()) key.push_back(step_of(slope, kHitStep));
  }
  add_form_keys(p.hits, size_mm_, key);
  return key;
}

/// Joins the fragments of a wave. The tracer divides a large entrance face into fragments that are independent of
/// cells.
void FarFieldCollector::join(std::vector<CollectedBeam>& pieces) const {
  std::stable_sort(pieces.begin(), pieces.end(),
                   [&](const CollectedBeam& a, const CollectedBeam& b) { return wave_of(a) < wave_of(b); });
  std::vector<CollectedBeam> joined;
  for (std::size_t first = 0; first < pieces.size();) {
    std::size_t last = first;
    FlatPolygons outlines;
    double area_before = 0.0;
    double transmission = 0.0;
    double power = 0.0;
    for (; last < pieces.size() && wave_of(pieces[last]) == wave_of(pieces[first]); ++last) {
      outlines.emplace_back(pieces[last].outline_mm.begin(), pieces[last].outline_mm.end());
      area_before += geometry::area(pieces[last].outline_mm);
      transmission += pieces[last].transmission;
      power += pieces[last].power;
    }
    if (last - first > 1) join_convex(outlines, kJoinOutlinesFraction * size_mm_ * size_mm_);
    for (const FlatPolygon& outline : outlines) {
      CollectedBeam piece = pieces[first];
      piece.outline_mm.assign(outline.begin(), outline.end());
      const double share = raytrace::area(outline) / area_before;
      piece.transmission = share * transmission;
      piece.power = share * power;
      joined.push_back(std::move(piece));
    }
    first = last;
  }
  pieces = std::move(joined);
}

CoherentGroup FarFieldCollector::group_of(std::vector<CollectedBeam> pieces, const Vec2& middle_mm) const {
  join(pieces);
  const double wave_number = 2.0 * pi / field_.wavelength_mm_;
  const auto path = [&](const CollectedBeam& p) { return p.phase_mm + p.direction.head<2>().dot(middle_mm); };
  const auto key = [](const CollectedBeam& p) {
    const Vec2 c = geometry::centroid(p.outline_mm);
    return std::tuple(step_of(c.x(), 1e-6), step_of(c.y(), 1e-6), step_of(p.direction.x(), kCosineStep));
  };
  std::stable_sort(pieces.begin(), pieces.end(),
                   [&](const CollectedBeam& a, const CollectedBeam& b) { return key(a) < key(b); });
  CoherentGroup group;
  if (!pieces.empty()) {
    group.replicate = pieces.front().replicate;
    group.copies = pieces.front().copies;
    for (const Vec2& position : pieces.front().positions_mm) group.positions_mm.push_back(position + middle_mm);
  }
  const double first_path = pieces.empty() ? 0.0 : path(pieces.front());
  group.path_mm = first_path + to_source_.head<2>().dot(middle_mm);
  for (const CollectedBeam& piece : pieces) {
    geometry::Polygon outline;
    for (const Vec2& p : piece.outline_mm) outline.push_back(p - middle_mm);
    PolygonTransform transform(outline);
    if (!(transform.area_mm2() > 0.0)) continue;
    const double phase = wave_number * (path(piece) - first_path);
    const std::complex<double> factor = std::polar(std::sqrt(piece.transmission / transform.area_mm2()), phase);
    for (const Vec2& p : outline) group.extent_mm = std::max(group.extent_mm, 2.0 * p.norm());
    FieldPolygon polygon{std::move(transform), piece.direction.head<2>(), factor * piece.jones, piece.power,
                         piece.hits};
    for (FieldHit& hit : polygon.hits) {
      hit.constant_mm += hit.slope * middle_mm;
      hit.form_constant_mm += hit.form_slope * middle_mm;
      polygon.phase_variance += hit.phase.variance();
    }
    polygon.mean_factor = std::exp(-0.5 * polygon.phase_variance);
    polygon.path_mm = path(piece) - first_path;
    polygon.entry_mm = piece.entry_from_exit * middle_mm - middle_mm;
    polygon.entry_slope = piece.entry_from_exit.linear();
    group.polygons.push_back(std::move(polygon));
  }
  return group;
}

/// Returns the groups of all cells. Cells with the same field are combined into one group with a number of copies.
std::vector<CoherentGroup> FarFieldCollector::distinct_groups() const {
  std::vector<CoherentGroup> groups;
  std::map<Signature, std::size_t> known;
  // For each distinct cell: its groups, and the number of copies of each group that has the power of one cell.
  std::map<BeamsOfCell, std::vector<std::pair<std::size_t, double>>> known_cells;
  // All copies of a cell use the centroid of the first copy as the origin, so that equal fields have equal keys.
  std::optional<std::uint64_t> cell;
  Vec2 middle = Vec2::Zero();
  for (const auto& [place, pieces] : cells_) {
    if (is_cancelled(policy_.cancel)) break;
    const bool is_alone = place.beam != 0;
    if (!is_alone && place.cell != cell) middle = centroid_of(pieces);
    if (!is_alone) cell = place.cell;
    const auto [same, is_first] = known_cells.try_emplace(pieces);
    if (!is_first) {
      for (const auto& [group, copies] : same->second) groups[group].copies += copies;
      continue;
    }
    for (CoherentGroup& group : groups_of(pieces, is_alone ? centroid_of(pieces) : middle)) {
      if (group.polygons.empty()) continue;
      if (cells_interfere_) {
        // The positions and optical paths of cells matter, so that equal fields of different cells are not combined.
        groups.push_back(std::move(group));
        continue;
      }
      const auto [it, is_new] = known.try_emplace(signature_of(group, size_mm_), groups.size());
      if (is_new) {
        same->second.emplace_back(it->second, 1.0);
        groups.push_back(std::move(group));
      } else {
        const double copies = copies_in(groups[it->second], group);
        same->second.emplace_back(it->second, copies);
        groups[it->second].copies += copies;
      }
    }
  }
  return groups;
}

void FarFieldCollector::keep_strongest(std::vector<CoherentGroup> groups) {
  double left = 0.0;
  for (const CoherentGroup& group : groups) left += group.power();
  const double least = policy_.undiffracted_fraction * left;
  std::stable_sort(groups.begin(), groups.end(),
                   [](const CoherentGroup& a, const CoherentGroup& b) { return a.power() > b.power(); });
  std::size_t polygons = 0;
  FormedPolicy how_finely{.wave_number = 2.0 * pi / field_.wavelength_mm_, .max_polygons = policy_.max_polygons};
  for (const CoherentGroup& group : groups)
    for (const FieldPolygon& p : group.polygons)
      how_finely.strongest = std::max(how_finely.strongest, group.copies * p.power);
  field_.scattered_ = ScatteredField(field_.wavelength_mm_, field_.coherency_, std::sin(policy_.window_rad), groups,
                                     policy_.replicates);
  for (CoherentGroup& group : groups) {
    if (is_cancelled(policy_.cancel)) return;
    const bool is_strong = left > least || polygons < kFewPolygons;
    const bool is_narrow = field_.wavelength_mm_ >= policy_.finest_detail_rad * group.extent_mm;
    const bool is_to_be_diffracted = is_strong && is_narrow;
    left -= group.power();
    const bool is_formed = is_strong && (policy_.form != nullptr || group.has_form());
    CoherentGroup bent = is_formed ? formed(group, how_finely) : CoherentGroup{};
    const std::size_t more = is_formed ? bent.polygons.size() : group.polygons.size();
    const bool is_within_budget = polygons + more <= policy_.max_polygons;
    if (is_strong && is_within_budget) field_.scattered_.add(group, is_narrow);
    if (is_formed) {
      field_.max_deflection_ = std::max(field_.max_deflection_, max_deflection(group, bent));
      if (is_to_be_diffracted && is_within_budget) field_.plane_groups_.push_back(group);
      group = std::move(bent);
    }
    if (is_to_be_diffracted && is_within_budget) {
      polygons += group.polygons.size();
      field_.groups_.push_back(std::move(group));
      continue;
    }
    if (is_to_be_diffracted) field_.beyond_budget_power_ += group.power();
    add_undiffracted(group, is_strong && is_within_budget);
  }
}

void FarFieldCollector::add_undiffracted(const CoherentGroup& group, bool has_lobes) {
  for (const FieldPolygon& p : group.polygons) {
    const double height = std::sqrt(std::max(0.0, 1.0 - p.cosines.squaredNorm()));
    const double specular = p.mean_factor * p.mean_factor * p.power;
    add_ray({{p.cosines.x(), p.cosines.y(), height}, group.copies * specular, group.replicate});
    if (!has_lobes) field_.unplaced_power_ += group.copies * (p.power - specular);
  }
}

FarField FarFieldCollector::finish() {
  keep_strongest(distinct_groups());
  cells_.clear();
  beams_.clear();
  const auto fields_of = [&](const std::vector<CoherentGroup>& groups) {
    return ApertureField(groups, field_.wavelength_mm_, field_.coherency_, kLengthStep * size_mm_, policy_.replicates);
  };
  field_.field_ = fields_of(field_.groups_);
  field_.plane_field_ = fields_of(field_.plane_groups_);
  if (cells_interfere_)
    field_.lattice_ = std::make_shared<const LatticeField>(
        LatticeField::Setting{period_mm_.asDiagonal(), to_source_.head<2>(), field_.wavelength_mm_, field_.coherency_,
                              policy_.coherence_length_mm, *policy_.interference},
        field_.groups_);
  return std::move(field_);
}

}  // namespace retrace::raytrace
