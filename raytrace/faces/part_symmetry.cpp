#include "raytrace/faces/part_symmetry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "core/memory_budget.h"
#include "geometry/centroid.h"
#include "geometry/point_lookup.h"

namespace retrace::raytrace {
namespace {

using geometry::Part, geometry::PatchCell, geometry::PatchFacet, geometry::Placement, geometry::SurfacePatch;
using geometry::Vec2, geometry::Vec3;

// Tolerances. Two positions are equal if their distance is less than kSamePlace times the element size. Two normals are
// equal if the norm of their difference is at most kSameNormal.
constexpr double kSamePlace = 1e-8;
constexpr double kSameNormal = 1e-9;
// Memory in bytes per facet of FacetsByCentroid.
constexpr double kBytesPerFacet = 350.0;

/// Returns true if a FacetsByCentroid of all facets of the part fits into the memory budget.
bool fits_memory(const Part& part) {
  double facets = 0.0;
  for (const Placement& placement : part.placements)
    facets += static_cast<double>(part.patches[placement.patch].facets.size());
  return kBytesPerFacet * facets <= static_cast<double>(element_memory_bytes());
}

/// A facet at its position in the part.
struct PlacedFacet {
  std::vector<Vec3> corners;
  Vec3 middle = Vec3::Zero();  ///< centroid of the corners
  Vec3 normal = Vec3::UnitZ();
  geometry::FacetRole role = geometry::FacetRole::retro_facet;
};

PlacedFacet placed_facet(const SurfacePatch& patch, const PatchFacet& facet, const Vec3& shift) {
  PlacedFacet result{{}, Vec3::Zero(), facet.normal, facet.role};
  for (std::uint32_t c = 0; c < facet.corner_count; ++c)
    result.corners.push_back(patch.vertices[patch.corners[facet.first_corner + c]] + shift);
  result.middle = geometry::centroid(std::span<const Vec3>(result.corners));
  return result;
}

/// Orthogonal map of the plane z = 0 about a fixed point. Heights do not change.
struct PlaneMap {
  Eigen::Matrix2d linear = Eigen::Matrix2d::Identity();
  Vec2 fixed_mm = Vec2::Zero();

  Vec3 direction(const Vec3& v) const {
    const Vec2 mapped = linear * v.head<2>();
    return {mapped.x(), mapped.y(), v.z()};
  }
  Vec2 position(const Vec2& p) const { return fixed_mm + linear * (p - fixed_mm); }
  Vec3 position(const Vec3& p) const {
    const Vec2 mapped = position(Vec2(p.head<2>()));
    return {mapped.x(), mapped.y(), p.z()};
  }
};

PlacedFacet image_of(PlacedFacet facet, const PlaneMap& map) {
  for (Vec3& corner : facet.corners) corner = map.position(corner);
  facet.middle = map.position(facet.middle);
  facet.normal = map.direction(facet.normal);
  return facet;
}

PlacedFacet shifted(PlacedFacet facet, const Vec2& shift_mm) {
  const Vec3 shift(shift_mm.x(), shift_mm.y(), 0.0);
  for (Vec3& corner : facet.corners) corner += shift;
  facet.middle += shift;
  return facet;
}

/// All facets of a part. A facet can be looked up by its centroid.
class FacetsByCentroid {
 public:
  explicit FacetsByCentroid(const Part& part) : near_mm_(kSamePlace * part.size_mm), by_middle_(near_mm_) {
    for (const Placement& placement : part.placements) {
      const SurfacePatch& patch = part.patches[placement.patch];
      const Vec3 shift(placement.offset_mm.x(), placement.offset_mm.y(), placement.height_mm);
      for (const PatchFacet& facet : patch.facets) {
        facets_.push_back(placed_facet(patch, facet, shift));
        by_middle_.insert(facets_.back().middle, facets_.size() - 1);
      }
    }
  }

  const std::vector<PlacedFacet>& all() const { return facets_; }

  bool has(const PlacedFacet& facet) const {
    bool found = false;
    by_middle_.visit(facet.middle, [&](std::size_t k) { found = found || is_same(facets_[k], facet); });
    return found;
  }

 private:
  bool is_same(const PlacedFacet& a, const PlacedFacet& b) const {
    const auto is_corner_of_a = [&](const Vec3& p) {
      return std::any_of(a.corners.begin(), a.corners.end(),
                         [&](const Vec3& q) { return (p - q).squaredNorm() <= near_mm_ * near_mm_; });
    };
    return a.role == b.role && a.corners.size() == b.corners.size() && (a.normal - b.normal).norm() <= kSameNormal &&
           std::all_of(b.corners.begin(), b.corners.end(), is_corner_of_a);
  }

  double near_mm_;
  std::vector<PlacedFacet> facets_;
  geometry::PointLookup<std::size_t> by_middle_;
};

/// Returns the facets of the central period of an infinite part. The patch of such a part contains several periods,
/// stored row by row.
std::vector<PlacedFacet> central_facets(const Part& part) {
  const SurfacePatch& patch = part.patches.front();
  const auto side = static_cast<std::size_t>(2 * part.periods_beyond + 1);
  const std::size_t each = patch.cells.size() / (side * side);
  const std::size_t first = (side * side / 2) * each;
  const Vec2& offset = part.placements.front().offset_mm;
  std::vector<PlacedFacet> facets;
  for (std::size_t k = first; k < first + each; ++k) {
    const PatchCell& cell = patch.cells[k];
    for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f)
      facets.push_back(placed_facet(patch, patch.facets[f], {offset.x(), offset.y(), 0.0}));
  }
  return facets;
}

/// Returns the shift by whole periods that moves a point as close as possible to another point.
Vec2 shift_towards(const Vec2& from, const Vec2& to, const Vec2& period_mm) {
  return ((to - from).array() / period_mm.array()).round().matrix().cwiseProduct(period_mm);
}

/// Facets of an infinite part, to test its symmetries.
class InfiniteFacets {
 public:
  explicit InfiniteFacets(const Part& part)
      : all_(part), central_(central_facets(part)), period_mm_(*part.period_mm), near_mm_(kSamePlace * part.size_mm) {
    for (const PlacedFacet& facet : central_) middle_ += facet.middle.head<2>() / static_cast<double>(central_.size());
  }

  /// Returns true if a linear map, followed by some shift, does not change the part. The tested shifts map the first
  /// facet of the central period to another facet of this period.
  bool has_symmetry(const Eigen::Matrix2d& linear) const {
    const PlacedFacet first = image_of(central_.front(), {linear, Vec2::Zero()});
    return std::any_of(central_.begin(), central_.end(), [&](const PlacedFacet& other) {
      const Vec2 shift_mm = (other.middle - first.middle).head<2>();
      return std::abs(other.middle.z() - first.middle.z()) <= near_mm_ && maps_to_itself(linear, shift_mm);
    });
  }

 private:
  bool maps_to_itself(const Eigen::Matrix2d& linear, const Vec2& shift_mm) const {
    return std::all_of(central_.begin(), central_.end(), [&](const PlacedFacet& facet) {
      const PlacedFacet image = shifted(image_of(facet, {linear, Vec2::Zero()}), shift_mm);
      return all_.has(shifted(image, shift_towards(image.middle.head<2>(), middle_, period_mm_)));
    });
  }

  FacetsByCentroid all_;
  std::vector<PlacedFacet> central_;
  Vec2 middle_ = Vec2::Zero();
  Vec2 period_mm_;
  double near_mm_;
};

/// Facets of a finite part, to test its symmetries.
class FiniteFacets {
 public:
  explicit FiniteFacets(const Part& part)
      : all_(part),
        outline_(part.outline),
        near_mm_(kSamePlace * part.size_mm),
        centre_mm_(geometry::centroid(std::span<const Vec2>(part.outline))) {}

  /// Returns true if a linear map about the centre of the outline does not change the part.
  bool has_symmetry(const Eigen::Matrix2d& linear) const {
    const PlaneMap map{linear, centre_mm_};
    return keeps_outline(map) && std::all_of(all_.all().begin(), all_.all().end(),
                                             [&](const PlacedFacet& facet) { return all_.has(image_of(facet, map)); });
  }

 private:
  /// Returns true if the image of each corner of the outline is one of its corners.
  bool keeps_outline(const PlaneMap& map) const {
    return std::all_of(outline_.begin(), outline_.end(), [&](const Vec2& p) {
      return std::any_of(outline_.begin(), outline_.end(),
                         [&](const Vec2& q) { return (map.position(p) - q).norm() <= near_mm_; });
    });
  }

  FacetsByCentroid all_;
  geometry::Polygon outline_;
  double near_mm_;
  Vec2 centre_mm_;
};

Eigen::Matrix2d reflection(Eigen::Index axis) {
  Eigen::Matrix2d map = Eigen::Matrix2d::Identity();
  map(axis, axis) = -1.0;
  return map;
}

/// Calls `use` with the facets of a part and returns its result.
template <class Use>
auto with_facets(const Part& part, const Use& use) {
  return part.period_mm ? use(InfiniteFacets(part)) : use(FiniteFacets(part));
}

/// Adds the products of `map` and the maps so far.
void multiply(std::vector<Eigen::Matrix2d>& maps, const Eigen::Matrix2d& map) {
  const std::size_t count = maps.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Matrix2d product = map * maps[k];
    const bool is_known = std::any_of(maps.begin(), maps.end(), [&](const Eigen::Matrix2d& known) {
      return (known - product).norm() <= kSameNormal;
    });
    if (!is_known) maps.push_back(product);
  }
}

}  // namespace

bool is_mirror_symmetric(const Part& part, Eigen::Index axis) {
  return fits_memory(part) &&
         with_facets(part, [&](const auto& facets) { return facets.has_symmetry(reflection(axis)); });
}

std::vector<Eigen::Matrix2d> symmetries_of(const Part& part) {
  std::vector<Eigen::Matrix2d> maps = {Eigen::Matrix2d::Identity()};
  if (!fits_memory(part)) return maps;
  with_facets(part, [&](const auto& facets) {
    for (const int order : {6, 4, 3, 2}) {
      const Eigen::Matrix2d turn = Eigen::Rotation2Dd(2.0 * std::numbers::pi / order).toRotationMatrix();
      if (!facets.has_symmetry(turn)) continue;
      for (int k = 1; k < order; ++k) maps.emplace_back(Eigen::Rotation2Dd(2.0 * std::numbers::pi * k / order));
      break;
    }
    for (const Eigen::Index axis : {0, 1})
      if (facets.has_symmetry(reflection(axis))) multiply(maps, reflection(axis));
  });
  return maps;
}

}  // namespace retrace::raytrace
