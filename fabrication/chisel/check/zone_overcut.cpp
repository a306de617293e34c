#include "fabrication/chisel/check/zone_overcut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

namespace retrace::fabrication {
namespace {

using geometry::Vec2;

/// Number of divisions of each side of a sampled triangle. The triangle is one half of a corner of a triangular cavity,
/// outside of the hexagon of the element.
constexpr int kDivisions = 32;
constexpr double kDeg = std::numbers::pi / 180.0;

Vec2 towards(double azimuth_deg) {
  return {std::cos(azimuth_deg * kDeg), std::sin(azimuth_deg * kDeg)};
}

class Overcutter {
 public:
  Overcutter(const VerificationModel& workpiece, const std::vector<bool>& is_cut)
      : grooves_(workpiece.cavities), elements_(workpiece.elements) {
    for (const Cavity& cavity : grooves_) width_mm_ = std::max(width_mm_, 2.0 * half_size_mm(cavity));
    for (std::size_t i = 0; i < grooves_.size(); ++i)
      if (is_cut[i]) squares_[square_of(apex_of(i))].push_back(i);
  }

  ZoneOvercut run() {
    for (const auto& [square, elements] : squares_)
      for (const std::size_t i : elements)
        for (int k = 0; k < 3; ++k)
          for (const double side : {-1.0, 1.0}) add_half_corner(i, k, side);
    result_.elements = static_cast<std::int64_t>(reached_.size());
    return result_;
  }

 private:
  using Square = std::pair<std::int64_t, std::int64_t>;

  const CubeCavity& cavity(std::size_t i) const { return std::get<CubeCavity>(grooves_[i]); }
  Vec2 apex_of(std::size_t i) const { return cavity(i).root_mm.head<2>(); }
  Square square_of(const Vec2& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x() / width_mm_)),
            static_cast<std::int64_t>(std::floor(p.y() / width_mm_))};
  }
  /// Calls `take` for all elements whose cavity may contain a point. A cavity extends from its apex by at most the
  /// width of an element.
  template <class Take>
  void for_each_near(const Vec2& p, const Take& take) const {
    const auto [column, row] = square_of(p);
    for (std::int64_t i = column - 1; i <= column + 1; ++i)
      for (std::int64_t j = row - 1; j <= row + 1; ++j)
        if (const auto square = squares_.find({i, j}); square != squares_.end())
          for (const std::size_t element : square->second) take(element);
  }

  /// Returns the depth of a cavity below a point of the blank's face; 0 outside of the cavity.
  double depth_mm(std::size_t i, const Vec2& p) const { return std::max(0.0, -cavity(i).height_mm(p)); }

  /// Returns true if a point is inside the hexagon of an element. Angle errors do not change the hexagon.
  bool is_in_hexagon(std::size_t i, const Vec2& p) const {
    const Vec2 v = elements_[i].workpiece_from_element.topLeftCorner<2, 2>().transpose() * (p - apex_of(i));
    const double inner_mm = 0.5 * std::numbers::sqrt3 * cavity(i).radius_mm;
    return std::ranges::all_of(std::array{0.0, 60.0, 120.0},
                               [&](double azimuth) { return std::abs(v.dot(towards(azimuth))) <= inner_mm; });
  }

  bool has_neighbour(std::size_t i, const Vec2& apex) const {
    constexpr double kSameShare = 1e-3;
    bool is_there = false;
    for_each_near(apex, [&](std::size_t k) {
      is_there |=
          elements_[k].zone == elements_[i].zone && (apex_of(k) - apex).norm() < kSameShare * cavity(i).radius_mm;
    });
    return is_there;
  }

  /// Adds one half of the corner in which cavity i extends beyond its hexagon at dihedral edge k. Seen along Z, the
  /// half is an equilateral triangle inside the hexagon of one neighbour.
  /// \param side -1 or 1, to select one of the two halves
  void add_half_corner(std::size_t i, int k, double side) {
    const double radius_mm = cavity(i).radius_mm;
    const double edge_deg = 120.0 * k - 90.0;
    const auto place = [&](double azimuth_deg, double mm) -> Vec2 {
      return apex_of(i) + elements_[i].workpiece_from_element.topLeftCorner<2, 2>() * (mm * towards(azimuth_deg));
    };
    if (has_neighbour(i, place(edge_deg + 30.0 * side, std::numbers::sqrt3 * radius_mm))) return;
    const Vec2 a = place(edge_deg, radius_mm);
    const Vec2 u = (place(edge_deg, 2.0 * radius_mm) - a) / kDivisions;
    const Vec2 v = (place(edge_deg + 60.0 * side, radius_mm) - a) / kDivisions;
    const double area_mm2 = 0.25 * std::numbers::sqrt3 * u.squaredNorm();
    for (int m = 0; m < kDivisions; ++m)
      for (int n = 0; m + n < kDivisions; ++n) {
        take(i, a + (m + 1.0 / 3.0) * u + (n + 1.0 / 3.0) * v, area_mm2);
        if (m + n + 1 < kDivisions) take(i, a + (m + 2.0 / 3.0) * u + (n + 2.0 / 3.0) * v, area_mm2);
      }
    // The maximum depth is on a side of the triangle. The corners of the grid, which include points on the sides, are
    // therefore also evaluated. Their area is set to 0, so that they do not change the total area and volume.
    for (int m = 0; m <= kDivisions; ++m)
      for (int n = 0; m + n <= kDivisions; ++n) take(i, a + m * u + n * v, 0.0);
  }

  /// Adds the material that cavity i removes at a point outside of its hexagon. If several cavities contain this point,
  /// only the deepest one removes material there.
  /// \param area_mm2 area that the point represents
  void take(std::size_t i, const Vec2& p, double area_mm2) {
    const double own_mm = depth_mm(i, p);
    if (own_mm <= 0.0) return;
    std::optional<std::size_t> holder;
    bool is_deepest = true;
    for_each_near(p, [&](std::size_t k) {
      if (k == i) return;
      if (is_in_hexagon(k, p)) {
        holder = k;
        return;
      }
      const double other_mm = depth_mm(k, p);
      is_deepest &= other_mm < own_mm || (other_mm == own_mm && k > i);
    });
    const double held_mm = holder ? depth_mm(*holder, p) : 0.0;
    if (!is_deepest || held_mm >= own_mm) return;
    result_.volume_mm3 += area_mm2 * (own_mm - held_mm);
    // On the common border of two elements of one zone, angle errors cause a small height difference. It is not
    // counted.
    const bool is_on_border = area_mm2 == 0.0;
    if (!holder || (is_on_border && elements_[*holder].zone == elements_[i].zone)) return;
    result_.area_mm2 += area_mm2;
    result_.deepest_mm = std::max(result_.deepest_mm, own_mm - held_mm);
    if (!is_on_border) reached_.insert(*holder);
  }

  const std::vector<Cavity>& grooves_;
  const std::vector<CutElement>& elements_;
  double width_mm_ = 0.0;
  std::map<Square, std::vector<std::size_t>> squares_;
  std::set<std::size_t> reached_;
  ZoneOvercut result_;
};

}  // namespace

ZoneOvercut zone_overcut(const VerificationModel& workpiece, const std::vector<bool>& is_cut) {
  return Overcutter(workpiece, is_cut).run();
}

}  // namespace retrace::fabrication
