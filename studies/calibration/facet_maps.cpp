#include "studies/calibration/facet_maps.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/length_units.h"
#include "core/number_format.h"
#include "fabrication/chisel/check/cavity.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using geometry::Vec2, geometry::Vec3;

/// Numbers of points that registration uses for the coarse search and for the refinement.
constexpr std::size_t kCoarsePoints = 300;
constexpr std::size_t kFinePoints = 4000;
/// Number of positions that the coarse search tries across an element along each axis, and rotations that it tries at
/// each position.
constexpr int kPlaces = 12;
constexpr double kTurnsDeg[] = {-2.0, -1.0, 0.0, 1.0, 2.0};
/// Number of the best poses of the coarse search that are refined.
constexpr std::size_t kFollowed = 4;
/// Maximum number of refinement steps. The limit applies to the steps with all points, and again to the following
/// steps, which use only points away from edges.
constexpr int kMaxRefinementSteps = 20;
constexpr double kRoughMove = 1e-6;  ///< length of the last step with all points, in mm or rad
/// Length of the last step with points away from edges, in mm or rad. Smaller changes have no effect, because
/// the calibration estimates the pose again.
constexpr double kLastMove = 1e-9;
/// Maximum median deviation of a registered map from the design, as a fraction of an element's depth.
constexpr double kMaxMedianDeviation = 0.02;
/// Minimum number of points that determine the plane of a facet or of the blank's face.
constexpr std::size_t kMinPoints = 30;
/// Distance from edges within which points are ignored, as a fraction of the facet's length and as a number of pixels.
/// The larger of the two distances applies.
constexpr double kMargin = 0.05;
constexpr double kMarginPixels = 2.0;
/// Deviation from the plane above which points are excluded from a fit, in multiples of the median deviation.
constexpr double kFarOff = 6.0;

/// Region of the design's surface: a facet of an element, or the blank's face.
struct Region {
  std::size_t element = 0;
  std::size_t facet = 0;
  bool is_face = false;

  auto operator<=>(const Region&) const = default;
};

/// Surface of the design as a height over x and y.
class DesignSurface {
 public:
  explicit DesignSurface(const std::vector<Cavity>& grooves) : grooves_(grooves), map_(grooves) {}

  Region region(double x_mm, double y_mm) const {
    const auto element = map_.at(x_mm, y_mm);
    if (!element) return {0, 0, true};
    Region region{*element, 0, false};
    for (std::size_t f = 1; f < common(grooves_[*element]).facets.size(); ++f)
      if (z_of(*element, f, x_mm, y_mm) > z_of(*element, region.facet, x_mm, y_mm)) region.facet = f;
    return region;
  }
  /// Returns the height of the design's surface, which is at most 0, the height of the blank's face.
  double z(double x_mm, double y_mm) const {
    const Region r = region(x_mm, y_mm);
    return r.is_face ? 0.0 : std::min(0.0, z_of(r.element, r.facet, x_mm, y_mm));
  }
  /// Returns the region of a point, or nothing if another region is within the margin.
  std::optional<Region> clear_region(const Vec3& p, double margin_mm) const {
    const Region middle = region(p.x(), p.y());
    for (const Vec2& off : {Vec2(margin_mm, margin_mm), Vec2(-margin_mm, margin_mm), Vec2(margin_mm, -margin_mm),
                            Vec2(-margin_mm, -margin_mm)})
      if (!lies_in(middle, p.x() + off.x(), p.y() + off.y())) return std::nullopt;
    return middle;
  }
  Vec3 normal(const Region& r) const {
    return r.is_face ? Vec3::UnitZ() : common(grooves_[r.element]).facets[r.facet].normal;
  }
  double height_mm(const Region& r, const Vec3& p) const {
    return r.is_face ? p.z() : common(grooves_[r.element]).facets[r.facet].height_mm(p);
  }
  const std::vector<Cavity>& grooves() const { return grooves_; }

 private:
  /// Returns true if a point is in the region. For prisms with a vertical axis, the region is the rectangle that
  /// follows from the dimensions of the element.
  bool lies_in(const Region& r, double x_mm, double y_mm) const {
    if (r.is_face) return !map_.at(x_mm, y_mm);
    const auto* const prism = std::get_if<PrismGroove>(&grooves_[r.element]);
    if (prism == nullptr || prism->axis != Vec3::UnitZ()) return region(x_mm, y_mm) == r;
    const Vec2 from_root(x_mm - prism->root_mm.x(), y_mm - prism->root_mm.y());
    const Vec2 along = prism->root_direction.head<2>();
    const Vec2 outward = prism->facets[r.facet].up_slope.head<2>().normalized();
    const double across = from_root.dot(outward);
    return across >= 0.0 && across <= prism->half_base_mm && std::abs(from_root.dot(along)) <= prism->half_width_mm;
  }
  double z_of(std::size_t element, std::size_t facet, double x_mm, double y_mm) const {
    const DesignFacet& f = common(grooves_[element]).facets[facet];
    return (f.offset_mm - f.normal.x() * x_mm - f.normal.y() * y_mm) / f.normal.z();
  }

  const std::vector<Cavity>& grooves_;
  CavityMap map_;
};

/// Returns the measured points. x and y are relative to the centre of the map, and z is relative to the mean height.
std::vector<Vec3> points_of(const surface_models::HeightMap& map) {
  std::vector<Vec3> points;
  double mean = 0.0;
  const auto from_middle = [](std::size_t at, std::size_t count) {
    return static_cast<double>(at) - 0.5 * static_cast<double>(count - 1);
  };
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column) {
      const double nm = map.at(column, row);
      if (!std::isfinite(nm)) continue;
      points.emplace_back(1e-3 * map.x_pixel_um * from_middle(column, map.columns),
                          1e-3 * map.y_pixel_um * from_middle(row, map.rows), 1e-6 * nm);
      mean += 1e-6 * nm;
    }
  if (!points.empty()) mean /= static_cast<double>(points.size());
  for (Vec3& p : points) p.z() -= mean;
  return points;
}

/// Returns at most `most` of the points. The choice is random, because points at regular steps might all be in one row
/// of the map. The choice is the same in every run.
std::vector<Vec3> thinned(const std::vector<Vec3>& points, std::size_t most) {
  if (points.size() <= most) return points;
  std::vector<Vec3> some;
  std::mt19937_64 bits(1);
  for (std::size_t k = 0; k < most; ++k) some.push_back(points[bits() % points.size()]);
  return some;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Registers a map to the design.
class Registration {
 public:
  Registration(const FacetMap& map, const DesignSurface& surface)
      : surface_(surface),
        points_(points_of(map.heights)),
        coarse_(thinned(points_, kCoarsePoints)),
        fine_(thinned(points_, kFinePoints)) {
    const Cavity& groove = surface.grooves().front();
    margin_mm_ = std::max(kMargin * common(groove).facet_length_mm,
                          kMarginPixels * 1e-3 * std::max(map.heights.x_pixel_um, map.heights.y_pixel_um));
    reach_mm_ = half_size_mm(groove);
    if (points_.size() < 3 * kMinPoints)
      throw InputError({map.file, 0, ""},
                       fmt::format("the height map must have at least {} points with a height, got {}", 3 * kMinPoints,
                                   points_.size()));
  }

  /// Returns the best pose of the map on the part.
  /// \throw InputError if no pose fits
  RigidMotion best(const FacetMap& map) const {
    std::vector<std::pair<double, RigidMotion>> tried = coarse(map);
    RigidMotion best;
    double least = std::numeric_limits<double>::infinity();
    for (auto& [off, pose] : tried) {
      refine(pose, false);
      const double now = off_mm(pose);
      if (now < least) std::tie(least, best) = std::pair(now, pose);
    }
    refine(best, true);
    least = off_mm(best);
    const double most = kMaxMedianDeviation * common(surface_.grooves().front()).depth_mm;
    if (!(least < most))
      throw InputError(
          {map.file, 0, ""},
          fmt::format("the height map does not match the design at any position within half an element of x = {}, y = "
                      "{} mm: at the best position, the median deviation is {} nm, but at most {} nm are allowed. "
                      "Check the position, and that the rows of the map are parallel to X of the workpiece",
                      shortest(map.centre_mm.x()), shortest(map.centre_mm.y()), fixed(1e6 * least, 0),
                      fixed(1e6 * most, 0)));
    return best;
  }

  const std::vector<Vec3>& points() const { return points_; }
  double margin_mm() const { return margin_mm_; }

 private:
  /// Returns the best poses of a grid of rotations and positions, each with its median deviation from the design.
  std::vector<std::pair<double, RigidMotion>> coarse(const FacetMap& map) const {
    std::vector<std::pair<double, RigidMotion>> all;
    for (const double turn_deg : kTurnsDeg)
      for (int i = 0; i < kPlaces; ++i)
        for (int j = 0; j < kPlaces; ++j) {
          const double step = 2.0 * reach_mm_ / kPlaces;
          RigidMotion pose{rotation_about(Vec3::UnitZ(), Angle::from_deg(map.rotation_deg + turn_deg)),
                           Vec3(map.centre_mm.x() + (i + 0.5) * step - reach_mm_,
                                map.centre_mm.y() + (j + 0.5) * step - reach_mm_, 0.0)};
          std::vector<double> off;
          for (const Vec3& p : coarse_) {
            const Vec3 at = pose.point(p);
            off.push_back(at.z() - surface_.z(at.x(), at.y()));
          }
          const double middle = median_of(off);
          pose.translation_mm.z() = -middle;
          for (double& o : off) o = std::abs(o - middle);
          all.emplace_back(median_of(off), pose);
        }
    const auto order = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::partial_sort(all.begin(), all.begin() + kFollowed, all.end(), order);
    all.resize(kFollowed);
    return all;
  }

  /// Returns the median distance of points on facets from the design. Points on the blank's face are ignored, because
  /// they fit the flat face in any position of the map.
  double off_mm(const RigidMotion& pose) const {
    std::vector<double> off;
    for (const Vec3& p : fine_) {
      const Vec3 at = pose.point(p);
      const Region region = surface_.region(at.x(), at.y());
      if (!region.is_face) off.push_back(std::abs(surface_.height_mm(region, at)));
    }
    return off.empty() ? std::numeric_limits<double>::infinity() : median_of(off);
  }

  /// Improves a pose by Gauss-Newton steps, which minimize the distances of the points from the planes below them.
  /// \param is_clear true: only points away from edges are used
  void refine(RigidMotion& pose, bool is_clear) const {
    for (int step = 0; step < kMaxRefinementSteps; ++step) {
      std::vector<std::pair<Vec3, Region>> placed;
      std::vector<double> off;
      std::vector<double> off_facets;
      for (const Vec3& p : fine_) {
        const Vec3 at = pose.point(p);
        const auto region = is_clear ? surface_.clear_region(at, margin_mm_) : surface_.region(at.x(), at.y());
        if (!region) continue;
        placed.emplace_back(at, *region);
        off.push_back(std::abs(surface_.height_mm(*region, at)));
        if (!region->is_face) off_facets.push_back(off.back());
      }
      if (off_facets.size() < kMinPoints) return;
      const double most = kFarOff * median_of(off_facets) + 1e-9;
      Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Identity() * 1e-12;
      Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
      for (std::size_t k = 0; k < placed.size(); ++k) {
        if (off[k] > most) continue;
        const auto& [at, region] = placed[k];
        Eigen::Matrix<double, 6, 1> row;
        row << surface_.normal(region), at.cross(surface_.normal(region));
        a += row * row.transpose();
        b -= row * surface_.height_mm(region, at);
      }
      const Eigen::Matrix<double, 6, 1> move = a.ldlt().solve(b);
      const Vec3 turn = move.tail<3>();
      const RigidMotion small{turn.norm() > 0.0 ? rotation_about(turn.normalized(), Angle::from_rad(turn.norm()))
                                                : Eigen::Matrix3d(Eigen::Matrix3d::Identity()),
                              move.head<3>()};
      pose = {small.rotation * pose.rotation, small.point(pose.translation_mm)};
      if (move.norm() < (is_clear ? kLastMove : kRoughMove)) return;
    }
  }

  const DesignSurface& surface_;
  std::vector<Vec3> points_;
  std::vector<Vec3> coarse_;  ///< few points, for the coarse search
  std::vector<Vec3> fine_;    ///< more points, for the refinement
  double margin_mm_ = 0.0;
  double reach_mm_ = 0.0;
};

/// Plane that is fitted to the heights of a region: its height at the centroid of the points, and its slopes.
struct RegionFit {
  Vec2 middle_mm;
  Vec3 value;
  Vec3 uncertainty;
};

/// Returns the height of a point above the plane of a fit.
double left_of(const RegionFit& fit, const Vec3& p) {
  return p.z() - fit.value.dot(Vec3(1.0, p.x() - fit.middle_mm.x(), p.y() - fit.middle_mm.y()));
}

/// Fits a plane together with waves, because the waves would otherwise tilt the plane.
/// \param points two coordinates and the height of each point; points that are too far from the plane are excluded
/// \param waves angular wave vectors of the waves, in rad/mm
std::optional<RegionFit> fitted(const std::vector<Vec3>& points, const std::vector<Vec2>& waves = {}) {
  constexpr int kRounds = 8;
  RegionFit fit{Vec2::Zero(), Vec3::Zero(), Vec3::Zero()};
  const auto unknowns = static_cast<Eigen::Index>(3 + 2 * waves.size());
  const auto row_of = [&](const Vec3& p) {
    Eigen::VectorXd row(unknowns);
    row.head<3>() << 1.0, p.x() - fit.middle_mm.x(), p.y() - fit.middle_mm.y();
    for (std::size_t k = 0; k < waves.size(); ++k) {
      const double phase = waves[k].dot(p.head<2>());
      row.segment<2>(static_cast<Eigen::Index>(3 + 2 * k)) << std::cos(phase), std::sin(phase);
    }
    return row;
  };
  std::vector<const Vec3*> taken;
  for (const Vec3& p : points) taken.push_back(&p);
  for (int round = 0; round < kRounds; ++round) {
    if (taken.size() < kMinPoints) return std::nullopt;
    const auto count = static_cast<double>(taken.size());
    fit.middle_mm.setZero();
    for (const Vec3* p : taken) fit.middle_mm += p->head<2>() / count;
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(unknowns);
    for (const Vec3* p : taken) {
      const Eigen::VectorXd row = row_of(*p);
      a += row * row.transpose();
      b += row * p->z();
    }
    const Eigen::MatrixXd inverse = a.inverse();
    const Eigen::VectorXd solution = inverse * b;
    std::vector<double> off;
    for (const Vec3& p : points) off.push_back(std::abs(p.z() - row_of(p).dot(solution)));
    const double most = std::max(kFarOff * median_of(off), 1e-12);
    std::vector<const Vec3*> near;
    double squares = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (off[k] > most) continue;
      near.push_back(&points[k]);
      squares += off[k] * off[k];
    }
    fit.value = solution.head<3>();
    fit.uncertainty =
        (squares / (static_cast<double>(near.size()) - static_cast<double>(unknowns)) * inverse.diagonal().head<3>())
            .cwiseSqrt();
    if (near == taken) break;
    taken = std::move(near);
  }
  if (!(fit.uncertainty.minCoeff() > 0.0) || !fit.uncertainty.allFinite()) return std::nullopt;
  return fit;
}

/// Fits the plane of a facet. Points in marks are excluded, and waves are fitted together with the plane.
/// \param points for each point: distance up the facet, distance along the facet, and height
/// \param rest receives the marks and waves
std::optional<RegionFit> fitted_facet(const std::vector<Vec3>& points, const CutCoordinates& view, const Vec2& pitch_mm,
                                      FacetResiduals& rest) {
  constexpr int kRounds = 3;
  std::optional<RegionFit> fit = fitted(points);
  std::vector<Vec3> unmarked = points;
  std::vector<Vec3> left;
  for (int round = 0; fit && round < kRounds; ++round) {
    left.clear();
    for (const Vec3& p : points) left.emplace_back(view.position_mm(p).x(), view.position_mm(p).y(), left_of(*fit, p));
    const std::size_t before = rest.marks.size();
    rest = marks_of(rest.at, left, pitch_mm);
    if (rest.marks.size() == before) break;
    unmarked.clear();
    for (const Vec3& p : points)
      if (!rest.is_marked(view.position_mm(p))) unmarked.push_back(p);
    fit = fitted(unmarked);
  }
  if (!fit) return fit;
  add_waves(rest, left);
  std::vector<Vec2> waves;
  for (const surface_models::SpectralPeak& wave : rest.waves) {
    const Eigen::Index axis = wave.axis == surface_models::Axis::x ? 0 : 1;
    waves.push_back(2.0 * std::numbers::pi * wave.frequency_per_mm *
                    Vec2(view.up_step_mm[axis], view.along_step_mm[axis]));
  }
  return waves.empty() ? fit : fitted(unmarked, waves);
}

/// Returns the distance between neighbouring points of a height map along a direction of the part.
double pitch_mm(const FacetMap& map, const RigidMotion& part_from_map, const Vec3& along) {
  const Vec3 seen = part_from_map.rotation.transpose() * along;
  return 1e-3 * std::min(map.heights.x_pixel_um / std::max(std::abs(seen.x()), 1e-6),
                         map.heights.y_pixel_um / std::max(std::abs(seen.y()), 1e-6));
}

/// Adds the distance and both tilts of a facet to the measurements of a map.
void add_figures(RegisteredMap& result, const Region& region, const RegionFit& fit) {
  const auto add = [&](FacetQuantity what, double value, double uncertainty) {
    Measurement m;
    m.at = {region.element, region.facet};
    m.what = what;
    m.value = value;
    m.uncertainty = uncertainty;
    if (what == FacetQuantity::distance) m.position_mm = fit.middle_mm;
    result.figures.push_back(m);
  };
  add(FacetQuantity::distance, kNmPerMm * fit.value[0], kNmPerMm * fit.uncertainty[0]);
  add(FacetQuantity::tilt_up, kArcsecPerRad * fit.value[1], kArcsecPerRad * fit.uncertainty[1]);
  add(FacetQuantity::tilt_along, kArcsecPerRad * fit.value[2], kArcsecPerRad * fit.uncertainty[2]);
}

}  // namespace

RegisteredMap registered(const FacetMap& map, const FabricationResult& plan) {
  const std::vector<Cavity> grooves = designed_cavities(plan.job);
  const DesignSurface surface(grooves);
  const Registration registration(map, surface);
  RegisteredMap result;
  result.part_from_map = registration.best(map);
  std::map<Region, std::vector<Vec3>> by_region;
  std::set<std::size_t> elements;
  double sum = 0.0;
  std::size_t count = 0;
  for (const Vec3& p : registration.points()) {
    const Vec3 at = result.part_from_map.point(p);
    const auto region = surface.clear_region(at, registration.margin_mm());
    if (!region) continue;
    const double height = surface.height_mm(*region, at);
    sum += height * height;
    ++count;
    if (region->is_face) {
      by_region[*region].emplace_back(at.x(), at.y(), height);
      continue;
    }
    elements.insert(region->element);
    const DesignFacet& facet = common(grooves[region->element]).facets[region->facet];
    const Vec3 from_root = at - common(grooves[region->element]).root_mm;
    by_region[*region].emplace_back(facet.up_slope.dot(from_root), facet.along.dot(from_root), height);
  }
  if (count > 0) result.rms_nm = kNmPerMm * std::sqrt(sum / static_cast<double>(count));
  const std::map<FacetId, CutCoordinates> views = cut_coordinates(plan, {elements.begin(), elements.end()});
  for (const auto& [region, points] : by_region) {
    if (region.is_face) {
      if (const std::optional<RegionFit> fit = fitted(points))
        result.face = FaceFigures{
            fit->middle_mm,
            {kNmPerMm * fit->value[0], kArcsecPerRad * fit->value[1], kArcsecPerRad * fit->value[2]},
            {kNmPerMm * fit->uncertainty[0], kArcsecPerRad * fit->uncertainty[1], kArcsecPerRad * fit->uncertainty[2]}};
      continue;
    }
    const auto view = views.find({region.element, region.facet});
    if (view == views.end()) continue;
    const DesignFacet& facet = common(grooves[region.element]).facets[region.facet];
    const auto pitch = [&](Eigen::Index axis) {
      // direction along the edge (axis 0) or along the motion of the edge (axis 1)
      return pitch_mm(map, result.part_from_map,
                      view->second.up_step_mm[axis] * facet.up_slope + view->second.along_step_mm[axis] * facet.along);
    };
    FacetResiduals rest;
    rest.at = {region.element, region.facet};
    const std::optional<RegionFit> fit = fitted_facet(points, view->second, {pitch(0), pitch(1)}, rest);
    if (!fit) continue;
    add_figures(result, region, *fit);
    result.residuals.push_back(std::move(rest));
  }
  if (result.figures.empty())
    throw InputError({map.file, 0, ""}, "the map contains no facet, because all points are too close to edges");
  return result;
}

}  // namespace retrace::studies
