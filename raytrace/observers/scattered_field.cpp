#include "raytrace/observers/scattered_field.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "raytrace/exact/flat_polygon.h"

namespace retrace::raytrace {
namespace {

using geometry::Vec2, std::numbers::pi;
using Amplitude = std::complex<double>;

// Radius of the grid of distances, in units of the longest correlation length. At 3.6 lengths, the covariance is only
// exp(-3.6^2). The factor 1.2 allows for oblique light, for which distances on the entrance face are up to about a
// tenth longer than on a facet.
constexpr double kReachInLengths = 3.6 * 1.2;
// Maximum phase, over the radius of the grid, for which the grid is refined. Finer details of lobes are not resolved.
constexpr double kMaxPhase = 200.0;
// Numbers of grid points: minimum per interval of the radius, minimum per half circle, and increase per radian of
// phase.
constexpr double kMinRadialPoints = 8.0, kMinAngularPoints = 24.0, kAlongPerRad = 0.5;
constexpr std::size_t kCoarseAlong = 6, kCoarseRound = 24;
// Two maps between points are treated as equal if their images differ by less than this fraction of the correlation
// length.
constexpr double kOneMap = 0.3;
// Tolerances for equal facet planes: components of the normals, and offsets as a fraction of the correlation length.
constexpr double kOnePlane = 1e-8, kOneOffset = 1e-3;
// Minimum determinant of the map from the entrance face to a facet. At smaller values, light is at grazing incidence.
constexpr double kMinFacetDeterminant = 1e-9;
// Corners are merged if their distance is less than this fraction of the polygon's size.
constexpr double kMergedCorners = 1e-9;
// Ratio of the singular values of Moves::matrix below which the map is treated as a reflection at a line. For an
// exact reflection, the matrix has rank 1 and the ratio is 0.
constexpr double kFolded = 0.1;
// Width of the Gaussian term that is subtracted from fringes where two partner points coincide (see Shared), relative
// to the width of the covariance. With this width, the integral of the term across a line of reflection is equal to the
// integral of the complementary error function.
constexpr double kDipWidth = 2.0 / pi;
// Minimum common area as a fraction of the polygon's area. Smaller areas are neglected.
constexpr double kMinCommonFraction = 1e-6;
// Correlations below this value are neglected.
constexpr double kMinCorrelation = 1e-12;
// Phases that vary by less than this value over a polygon are treated as constant.
constexpr double kSamePhase = 1e-6;
// Distance between the points at which the slopes of a form are compared, as a fraction of the polygon's size.
constexpr double kSlopeStep = 0.3;

Amplitude phasor(double phase) {
  return {std::cos(phase), std::sin(phase)};
}

FlatPolygon flat_outline(const geometry::Polygon& polygon) {
  return {polygon.begin(), polygon.end()};
}

bool contains(const FlatPolygon& polygon, const Vec2& place) {
  for (std::size_t i = 0; i < polygon.size(); ++i)
    if (left_of(polygon[i], polygon[(i + 1) % polygon.size()]).excess(place) > 0.0) return false;
  return true;
}

/// Two hits of the same facet, by the light of the first path (`here`) and of the second path (`there`).
using HitPair = std::pair<const FieldHit*, const FieldHit*>;

/// Returns the covariance of the phases, summed over the facets of `pairs`.
/// \param distance_mm distance of the points on the entrance face, for the second path
double covariance(const std::vector<HitPair>& pairs, const Vec2& distance_mm) {
  double sum = 0.0;
  for (const auto& [a, b] : pairs) {
    const double square = (b->slope * distance_mm).squaredNorm();
    for (std::size_t k = 0; k < a->phase.terms.size(); ++k) {
      const auto& term = b->phase.terms[k];
      const double product = a->phase.terms[k].rms_rad * term.rms_rad;
      if (product != 0.0) sum += product * std::exp(-square / (term.length_mm * term.length_mm));
    }
  }
  return sum;
}

/// Common areas of two polygons, one of which is displaced. The polygons and the map between their points are those of
/// ScatteredField::Shared.
class DisplacedOverlap {
 public:
  DisplacedOverlap(const PolygonTransform& here, const PolygonTransform& there, const Eigen::Matrix2d& partner_map,
                   const Vec2& shift_mm)
      : merge_mm_(kMergedCorners * here.size_mm()), back_(partner_map.inverse()), here_(flat_outline(here.polygon())) {
    for (const Vec2& r : there.polygon()) partners_.push_back(back_ * (r - shift_mm));
    if (partner_map.determinant() < 0.0) std::reverse(partners_.begin(), partners_.end());
    const auto add_edges = [this](const FlatPolygon& of, const FlatPolygon& other, double sign) {
      for (std::size_t k = 0; k < of.size(); ++k) {
        const HalfPlane half = left_of(of[k], of[(k + 1) % of.size()]);
        double least = half.excess(other.front());
        for (const Vec2& p : other) least = std::min(least, half.excess(p));
        separators_.push_back({sign * half.a, sign * half.b, least});
      }
    };
    add_edges(here_, partners_, 1.0);
    add_edges(partners_, here_, -1.0);
  }

  /// Returns true if common_places() is empty. Two convex polygons have no common points if and only if the line
  /// through an edge of one of them separates them.
  bool is_empty(const Vec2& distance_mm) const {
    const Vec2 move = back_ * distance_mm;
    return std::any_of(separators_.begin(), separators_.end(),
                       [&](const HalfPlane& s) { return s.a * move.x() + s.b * move.y() <= s.c; });
  }
  /// Returns the points of `here` whose partners, displaced by `distance_mm`, are in `there`.
  FlatPolygon common_places(const Vec2& distance_mm) const {
    const Vec2 move = back_ * distance_mm;
    FlatPolygon partners = partners_;
    for (Vec2& p : partners) p -= move;
    return intersection(here_, partners, merge_mm_);
  }

 private:
  double merge_mm_;
  Eigen::Matrix2d back_;
  FlatPolygon here_;
  FlatPolygon partners_;  ///< points of `here` whose partners are the corners of `there`
  /// One for each edge of both polygons. The edge separates the polygons if a x + b y <= c for the displacement (x, y)
  /// of the partners.
  std::vector<HalfPlane> separators_;
};

/// Deflection of the light of a polygon by forms, such as the curvature of the entrance surface. The direction cosines
/// of light that leaves at r are those of the polygon plus cosines + per_mm r. This is the linear approximation at the
/// centroid of the polygon.
struct FormDeflection {
  Vec2 cosines = Vec2::Zero();
  Eigen::Matrix2d per_mm = Eigen::Matrix2d::Zero();

  explicit FormDeflection(const FieldPolygon& polygon) {
    const Vec2& centre = polygon.transform.centroid_mm();
    const double step_mm = kSlopeStep * polygon.transform.size_mm();
    const auto at = [&](const Vec2& r) {
      Vec2 sum = Vec2::Zero();
      for (const FieldHit& hit : polygon.hits)
        if (hit.path_per_height != 0.0)
          sum += hit.path_per_height * hit.form_slope.transpose() *
                 hit.form->slope(hit.form_constant_mm + hit.form_slope * r);
      return sum;
    };
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const Vec2 step = step_mm * Vec2::Unit(axis);
      per_mm.col(axis) = (at(centre + step) - at(centre - step)) / (2.0 * step_mm);
    }
    cosines = at(centre) - per_mm * centre;
  }
};

}  // namespace

/// Displacements between points r of `here` and their partners partner_map r + shift (see Shared). `partner_map` is any
/// linear map, such as a rotation by 180 degrees or a reflection. The displacement is r - (partner_map r + shift) =
/// matrix r - shift.
struct ScatteredField::Moves {
  Eigen::Matrix2d matrix;  ///< identity minus `partner_map`
  Vec2 shift_mm;
  double stretch = 0.0;            ///< largest singular value of `matrix`
  bool is_folded = false;          ///< true if the map is nearly a reflection at a line
  Vec2 from_line = Vec2::UnitX();  ///< direction perpendicular to the line of reflection
  Vec2 direction = Vec2::UnitX();  ///< direction of the displacement of points next to the line of reflection

  explicit Moves(const Shared& shared);

  /// Returns the point whose displacement is `distance_mm`.
  Vec2 place_that_moves_by(const Vec2& distance_mm) const { return matrix.inverse() * (distance_mm + shift_mm); }

  /// Returns the integral of f(d(r)) over all points r of a polygon. Here, f is the density of a normal distribution
  /// and d(r) is the displacement of r.
  double places_at_line(const FlatPolygon& polygon, const Eigen::Matrix2d& spread_mm2) const {
    constexpr int kStrips = 16;
    constexpr double kReach = 4.0;
    const double narrow = direction.dot(spread_mm2.inverse() * direction);
    const double step_mm = kReach / std::sqrt(narrow) / kStrips;
    const double at_line = -direction.dot(shift_mm);
    double sum = 0.0;
    for (int k = -kStrips; k < kStrips; ++k) {
      // The strip contains the points whose displacement is between k and k + 1 steps.
      FlatPolygon strip = polygon;
      const Vec2 across = stretch * from_line;
      clip(strip, {across.x(), across.y(), (k + 1) * step_mm - at_line}, 0.0);
      if (strip.size() >= 3) clip(strip, {-across.x(), -across.y(), at_line - k * step_mm}, 0.0);
      if (strip.size() < 3) continue;
      const double move_mm = (k + 0.5) * step_mm;
      sum += area(strip) * std::exp(-0.5 * move_mm * move_mm * narrow);
    }
    return sum / (2.0 * pi * std::sqrt(spread_mm2.determinant()));
  }
};

/// Correlation between two polygons, which may be identical. Light at a point r of `here` and light at the point
/// partner_map r + shift of `there` have met the same points of facets. These facets are listed in `pairs`. The two
/// points are called partners.
struct ScatteredField::Shared {
  const FieldPolygon* here = nullptr;
  const FieldPolygon* there = nullptr;
  Eigen::Matrix2d partner_map = Eigen::Matrix2d::Identity();
  Vec2 shift_mm = Vec2::Zero();
  std::vector<HitPair> pairs;
  /// Logarithm of the product of exp(-variance / 2) for `here` and for `there`. The textures reduce the two mean fields
  /// by these factors.
  double log_means = 0.0;

  /// Returns the maximum distance between the images of a corner of `here` under this map and under another map.
  double farthest_from(const Eigen::Matrix2d& other_map, const Vec2& other_shift_mm) const {
    double most = 0.0;
    for (const Vec2& r : here->transform.polygon())
      most = std::max(most, ((partner_map - other_map) * r + shift_mm - other_shift_mm).norm());
    return most;
  }
  /// Returns true if the map is the identity, so that each point is its own partner.
  bool is_in_place(double tolerance_mm) const {
    return farthest_from(Eigen::Matrix2d::Identity(), Vec2::Zero()) < tolerance_mm;
  }
  /// Returns the mean product of both phase factors over all heights, minus the product of their means.
  double correlation(const Vec2& distance_mm) const {
    return std::exp(log_means) * std::expm1(covariance(pairs, distance_mm));
  }
  DisplacedOverlap overlap() const { return {here->transform, there->transform, partner_map, shift_mm}; }

  /// Returns all maps between points of `here` and `there` that result from facets which both paths have met.
  static std::vector<Shared> of(const FieldPolygon& here, const FieldPolygon& there, double shortest_mm) {
    std::vector<Shared> found;
    const double log_means = -0.5 * (here.phase_variance + there.phase_variance);
    for (const FieldHit& a : here.hits)
      for (const FieldHit& b : there.hits) {
        if (a.phase.variance() == 0.0 || b.phase.variance() == 0.0) continue;
        if ((a.normal - b.normal).norm() > kOnePlane || std::abs(a.offset_mm - b.offset_mm) > kOneOffset * shortest_mm)
          continue;
        const Eigen::Matrix2d square = b.slope.transpose() * b.slope;
        if (square.determinant() < kMinFacetDeterminant) continue;
        Shared one{&here, &there, Eigen::Matrix2d::Identity(), Vec2::Zero(), {{&a, &b}}, log_means};
        if (&a != &b) {
          const Eigen::Matrix<double, 2, 3> inverse = square.inverse() * b.slope.transpose();
          one.partner_map = inverse * a.slope;
          one.shift_mm = inverse * (a.constant_mm - b.constant_mm);
          if (std::abs(one.partner_map.determinant()) < kMinFacetDeterminant) continue;
        }
        const auto same = std::find_if(found.begin(), found.end(), [&](const Shared& s) {
          return s.farthest_from(one.partner_map, one.shift_mm) < kOneMap * shortest_mm;
        });
        if (same == found.end())
          found.push_back(std::move(one));
        else
          same->pairs.push_back(one.pairs.front());
      }
    return found;
  }
};

ScatteredField::Moves::Moves(const Shared& shared)
    : matrix(Eigen::Matrix2d::Identity() - shared.partner_map), shift_mm(shared.shift_mm) {
  const Eigen::JacobiSVD<Eigen::Matrix2d> singular(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  stretch = singular.singularValues()[0];
  is_folded = singular.singularValues()[1] < kFolded * stretch;
  from_line = singular.matrixV().col(0);
  direction = singular.matrixU().col(0);
}

ScatteredField::ScatteredField(double wavelength_mm, const Eigen::Matrix2cd& coherency, double reach_cosine,
                               const std::vector<CoherentGroup>& groups, std::uint32_t replicates)
    : wave_number_(2.0 * pi / wavelength_mm), coherency_(coherency), replicate_weights_(0, replicates) {
  double greatest_variance = 0.0;
  double extent_mm = 0.0;
  for (const CoherentGroup& group : groups)
    for (const FieldPolygon& p : group.polygons) {
      greatest_variance = std::max(greatest_variance, p.phase_variance);
      extent_mm = std::max(extent_mm, group.extent_mm);
      for (const FieldHit& hit : p.hits)
        for (const auto& term : hit.phase.terms) {
          if (term.rms_rad == 0.0) continue;
          shortest_mm_ = longest_mm_ > 0.0 ? std::min(shortest_mm_, term.length_mm) : term.length_mm;
          longest_mm_ = std::max(longest_mm_, term.length_mm);
        }
    }
  if (longest_mm_ == 0.0) return;
  const double reach_mm = std::min(kReachInLengths * longest_mm_, extent_mm);
  const double phase_per_mm = std::min(wave_number_ * reach_cosine, kMaxPhase / reach_mm);
  // If phases are large, the covariance of the phase factors is narrower than the covariance of the phases.
  double width_mm = 0.5 * shortest_mm_ / std::sqrt(std::max(1.0, greatest_variance));
  for (double from = 0.0; from < reach_mm;) {
    const double until = std::min(from + width_mm, reach_mm);
    const auto along = static_cast<std::size_t>(kMinRadialPoints + kAlongPerRad * phase_per_mm * (until - from));
    const GaussRule fine = gauss_legendre(along);
    for (std::size_t k = 0; k < along; ++k) {
      const double r = std::lerp(from, until, fine.nodes[k]);
      rings_.push_back(
          {r, (until - from) * fine.weights[k], static_cast<std::size_t>(kMinAngularPoints + phase_per_mm * r)});
    }
    const GaussRule coarse = gauss_legendre(kCoarseAlong);
    for (std::size_t k = 0; k < kCoarseAlong; ++k)
      coarse_rings_.push_back(
          {std::lerp(from, until, coarse.nodes[k]), (until - from) * coarse.weights[k], kCoarseRound});
    from = until;
    width_mm = from;
  }
  for (const Ring& ring : rings_)
    for (std::size_t k = 0; k < ring.angles; ++k) {
      const double angle = pi * (static_cast<double>(k) + 0.5) / static_cast<double>(ring.angles);
      distances_.push_back({ring.radius_mm * Vec2(std::cos(angle), std::sin(angle)), 0.0});
    }
  replicate_weights_.setZero(std::ssize(distances_), replicates);
}

void ScatteredField::add(const CoherentGroup& group, bool with_fringes) {
  if (longest_mm_ == 0.0) return;
  power_ += group.power() - group.specular_power();
  const double tolerance_mm = kOneMap * shortest_mm_;
  for (std::size_t i = 0; i < group.polygons.size(); ++i)
    for (std::size_t j = i; j < group.polygons.size(); ++j)
      for (const Shared& shared : Shared::of(group.polygons[i], group.polygons[j], shortest_mm_)) {
        // Each pair of polygons represents both orders. The contributions of the two orders are complex conjugates.
        const double copies = (i == j ? 1.0 : 2.0) * group.copies;
        if (shared.is_in_place(tolerance_mm))
          add_lobe(shared, group, copies);
        else if (with_fringes && !group.replicate)
          add_fringes(shared, copies);
      }
}

void ScatteredField::add_lobe(const Shared& shared, const CoherentGroup& group, double copies) {
  const bool is_one = shared.here == shared.there;
  const DisplacedOverlap overlap = shared.overlap();
  const FormDeflection deflection(*shared.there);
  const Amplitude field = copies * (shared.here->amplitude * coherency_ * shared.there->amplitude.adjoint()).trace() *
                          std::pow(wave_number_ / (2.0 * pi), 2.0);
  const Vec2 phase_gradient = wave_number_ * (shared.there->cosines - shared.here->cosines);
  const Vec2 cosines = shared.there->cosines + deflection.cosines;
  const double size_mm = shared.here->transform.size_mm();
  // Distances in the opposite direction contribute as well. For a single polygon, their contribution is the complex
  // conjugate. For a pair, it is the conjugate of the pair with exchanged order, and both directions are computed.
  const std::vector<double> signs = is_one ? std::vector{1.0} : std::vector{1.0, -1.0};
  std::size_t at = 0;
  for (const Ring& ring : rings_) {
    const double step = pi / static_cast<double>(ring.angles) * ring.weight_mm * ring.radius_mm;
    for (std::size_t k = 0; k < ring.angles; ++k, ++at) {
      Amplitude sum = 0.0;
      std::optional<double> correlation;  // equal for both directions
      for (const double sign : signs) {
        const Vec2 distance = sign * distances_[at].mm;
        if (overlap.is_empty(distance)) continue;
        if (!correlation) correlation = shared.correlation(distance);
        if (std::abs(*correlation) < kMinCorrelation) break;
        const FlatPolygon common = overlap.common_places(distance);
        if (common.size() < 3) continue;
        const Vec2 kappa = phase_gradient + wave_number_ * (deflection.per_mm.transpose() * distance);
        Amplitude places = area(common);
        if (kappa.norm() * size_mm >= kSamePhase) places = PolygonTransform({common.begin(), common.end()}).at(kappa);
        const Amplitude one = field * *correlation * phasor(-wave_number_ * cosines.dot(distance)) * places;
        sum += sign > 0.0 ? one : std::conj(one);
      }
      if (is_one) sum *= 2.0;
      if (sum == 0.0) continue;
      distances_[at].weight += step * sum;
      if (group.replicate) replicate_weights_(static_cast<Eigen::Index>(at), *group.replicate) += step * sum;
    }
  }
}

void ScatteredField::add_fringes(const Shared& shared, double copies) {
  const DisplacedOverlap overlap = shared.overlap();
  const FlatPolygon common = overlap.common_places(Vec2::Zero());
  const double common_mm2 = common.size() < 3 ? 0.0 : area(common);
  if (!(common_mm2 > kMinCommonFraction * shared.here->transform.area_mm2())) return;
  const Moves moves(shared);
  double whole_mm2 = 0.0;     // integral of the correlation over all distances
  double strength_mm4 = 0.0;  // integral of the correlation times the common area, which decreases with the distance
  double still_mm2 = 0.0;     // as `whole_mm2`, but only over the displacements of points of the common area
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  for (const Ring& ring : coarse_rings_)
    for (std::size_t k = 0; k < ring.angles; ++k) {
      const double angle = 2.0 * pi * (static_cast<double>(k) + 0.5) / static_cast<double>(ring.angles);
      const Vec2 distance = ring.radius_mm * Vec2(std::cos(angle), std::sin(angle));
      const double weight =
          2.0 * pi / static_cast<double>(ring.angles) * ring.weight_mm * ring.radius_mm * shared.correlation(distance);
      if (weight == 0.0) continue;
      const FlatPolygon left = overlap.common_places(distance);
      whole_mm2 += weight;
      strength_mm4 += weight * (left.size() < 3 ? 0.0 : area(left));
      moments += weight * distance * distance.transpose();
      if (!moves.is_folded && contains(common, moves.place_that_moves_by(distance))) still_mm2 += weight;
    }
  if (!(strength_mm4 > 0.0)) return;
  const Eigen::Matrix2d spread_mm2 = moments / whole_mm2;
  // At the apex and along fold lines, points coincide with their partners, and fringes would carry power there. A
  // Gaussian term with the width of the covariance is subtracted, so that the total power of the fringes is 0.
  const double still = moves.is_folded ? moves.places_at_line(common, spread_mm2)
                                       : still_mm2 / whole_mm2 / std::abs(moves.matrix.determinant());
  // `still` is the area of points per unit area of their displacements, for displacements near 0. Its product with the
  // integral of the Gaussian term is an area.
  const Eigen::Matrix2d dip_mm2 = kDipWidth * kDipWidth * spread_mm2;
  const double dip_area_mm2 = still * 2.0 * pi * std::sqrt(dip_mm2.determinant());
  if (!(dip_area_mm2 < 0.5 * common_mm2)) return;
  const Amplitude field = copies * (shared.here->amplitude * coherency_ * shared.there->amplitude.adjoint()).trace() *
                          std::pow(wave_number_ / (2.0 * pi), 2.0);
  const Amplitude coefficient = strength_mm4 / (common_mm2 - dip_area_mm2) * field;
  const PolygonTransform places({common.begin(), common.end()});
  fringes_.push_back({field_lanes::Outline(places),
                      shared.partner_map,
                      shared.shift_mm,
                      shared.here->cosines,
                      shared.there->cosines,
                      {coefficient.real(), coefficient.imag()},
                      spread_mm2,
                      dip_mm2,
                      dip_area_mm2});
}

double ScatteredField::lobes_per_cosines(const Vec2& cosines) const {
  const Vec2 kappa = wave_number_ * cosines;
  double sum = 0.0;
  for (const Distance& d : distances_) {
    const double phase = kappa.dot(d.mm);
    sum += d.weight.real() * std::cos(phase) - d.weight.imag() * std::sin(phase);
  }
  return sum;
}

Eigen::ArrayXd ScatteredField::lobes_by_replicate(const Vec2& cosines, const Eigen::Matrix2d& cosines_per_rad,
                                                  const ApertureKernel& kernel) const {
  const Eigen::Index replicates = replicate_weights_.cols();
  Eigen::ArrayXd sums = Eigen::ArrayXd::Zero(1 + replicates);
  for (std::size_t k = 0; k < distances_.size(); ++k) {
    const Vec2 kappa = wave_number_ * distances_[k].mm;
    const Amplitude wave = phasor(kappa.dot(cosines)) * kernel.transform((cosines_per_rad.transpose() * kappa).norm());
    sums[0] += (distances_[k].weight * wave).real();
    sums.tail(replicates) += (replicate_weights_.row(static_cast<Eigen::Index>(k)).transpose() * wave).real();
  }
  sums[0] -= sums.tail(replicates).sum();
  return sums;
}

double ScatteredField::lobes_within(const Vec2& centre, const Eigen::Matrix2d& axes) const {
  double sum = 0.0;
  for (const Distance& d : distances_) {
    const Vec2 kappa = wave_number_ * d.mm;
    sum += (d.weight * phasor(kappa.dot(centre))).real() * disc_transform((axes.transpose() * kappa).norm());
  }
  return pi * std::abs(axes.determinant()) * sum;
}

std::vector<double> ScatteredField::fringes_per_cosines(std::span<const Vec2> cosines,
                                                        const Cancellation* cancel) const {
  std::vector<double> power(cosines.size(), 0.0);
  for (std::size_t first = 0; first < cosines.size(); first += field_lanes::kBlock) {
    if (is_cancelled(cancel)) break;
    const std::size_t count = std::min(field_lanes::kBlock, cosines.size() - first);
    field_lanes::Block x, y, sum{};
    for (std::size_t k = 0; k < field_lanes::kBlock; ++k) {
      const Vec2& at = cosines[first + std::min(k, count - 1)];
      x[k] = at.x();
      y[k] = at.y();
    }
    for (const field_lanes::Fringes& fringes : fringes_) field_lanes::add_fringes(fringes, wave_number_, x, y, sum);
    std::copy_n(sum.begin(), count, power.begin() + static_cast<std::ptrdiff_t>(first));
  }
  return power;
}

}  // namespace retrace::raytrace
