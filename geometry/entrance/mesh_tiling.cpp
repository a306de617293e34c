#include "geometry/entrance/mesh_tiling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>

namespace retrace::geometry {
namespace {

using Corners = std::array<std::uint32_t, 3>;

// Largest z component of the unit normal at which a triangle counts as vertical.
constexpr double kStandsUpright = 1e-6;

/// Directed side of a triangle, with the triangle on its left.
struct SheetSide {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
};

bool has_side(const Corners& t, std::uint32_t from, std::uint32_t to) {
  for (std::size_t k = 0; k < 3; ++k)
    if (t[k] == from && t[(k + 1) % 3] == to) return true;
  return false;
}

double turn_of(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

class GapFinder {
 public:
  GapFinder(const std::vector<Vec3>& vertices, const std::vector<Corners>& sheet, const std::vector<Corners>& mesh,
            const Polygon& outline, double tolerance_mm)
      : vertices_(vertices), sheet_(sheet), mesh_(mesh), outline_(outline), tolerance_mm_(tolerance_mm) {}

  std::optional<TilingGap> find() const {
    const std::vector<SheetSide> open = open_sides();
    if (open.empty()) return std::nullopt;
    const Vec2 middle = *middle_inside(open.front());
    return TilingGap{fault_of(open.front(), middle, open), middle};
  }

 private:
  Vec2 plan(std::uint32_t vertex) const { return vertices_[vertex].head<2>(); }

  /// Returns the centre of the portion of a side that is inside the outline, or nothing if no portion is inside.
  std::optional<Vec2> middle_inside(const SheetSide& side) const {
    const Vec2 a = plan(side.from);
    const Vec2 along = plan(side.to) - a;
    double begin = 0.0;
    double end = 1.0;
    for (std::size_t k = 0; k < outline_.size() && begin < end; ++k) {
      const Vec2 edge = (outline_[(k + 1) % outline_.size()] - outline_[k]).normalized();
      const Vec2 inward(-edge.y(), edge.x());
      const double depth = inward.dot(a - outline_[k]) - tolerance_mm_;
      const double rise = inward.dot(along);
      if (rise > 0.0) begin = std::max(begin, -depth / rise);
      if (rise < 0.0) end = std::min(end, -depth / rise);
      if (rise == 0.0 && depth <= 0.0) return std::nullopt;
    }
    if (!(begin < end)) return std::nullopt;
    return a + 0.5 * (begin + end) * along;
  }

  /// Returns the sides inside the outline that are traversed more often in one direction than in the other, sorted by
  /// the indices of their corners.
  std::vector<SheetSide> open_sides() const {
    std::vector<std::tuple<std::uint32_t, std::uint32_t, int>> passes;
    for (const Corners& t : sheet_)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k];
        const std::uint32_t b = t[(k + 1) % 3];
        passes.emplace_back(std::min(a, b), std::max(a, b), a < b ? 1 : -1);
      }
    std::sort(passes.begin(), passes.end());
    std::vector<SheetSide> open;
    for (std::size_t k = 0; k < passes.size();) {
      const auto [a, b, first] = passes[k];
      int balance = 0;
      for (; k < passes.size() && std::get<0>(passes[k]) == a && std::get<1>(passes[k]) == b; ++k)
        balance += std::get<2>(passes[k]);
      const SheetSide side = balance > 0 ? SheetSide{a, b} : SheetSide{b, a};
      if (balance != 0 && middle_inside(side)) open.push_back(side);
    }
    return open;
  }

  TilingFault fault_of(const SheetSide& side, const Vec2& middle, const std::vector<SheetSide>& open) const {
    for (const Corners& t : mesh_) {
      const bool goes_on = has_side(t, side.to, side.from);
      if (!goes_on && !has_side(t, side.from, side.to)) continue;
      const Vec3 twice = (vertices_[t[1]] - vertices_[t[0]]).cross(vertices_[t[2]] - vertices_[t[0]]);
      if (twice.z() > kStandsUpright * twice.norm()) continue;
      if (twice.norm() == 0.0) return TilingFault::no_area;
      if (twice.z() > -kStandsUpright * twice.norm()) return TilingFault::vertical_triangle;
      return goes_on ? TilingFault::overhang : TilingFault::reversed_triangle;
    }
    if (has_corner_on_side(side, open)) return TilingFault::corner_on_side;
    return fault_by_cover(side, middle);
  }

  bool is_on(std::uint32_t vertex, const SheetSide& side) const {
    if (vertex == side.from || vertex == side.to) return false;
    const Vec3 along = vertices_[side.to] - vertices_[side.from];
    const Vec3 to = vertices_[vertex] - vertices_[side.from];
    const double share = to.dot(along) / along.squaredNorm();
    return share > 0.0 && share < 1.0 && (to - share * along).norm() <= tolerance_mm_;
  }

  bool has_corner_on_side(const SheetSide& side, const std::vector<SheetSide>& open) const {
    return std::any_of(open.begin(), open.end(), [&](const SheetSide& other) {
      return is_on(other.from, side) || is_on(other.to, side) || is_on(side.from, other) || is_on(side.to, other);
    });
  }

  int cover(const Vec2& p) const {
    return static_cast<int>(std::count_if(sheet_.begin(), sheet_.end(), [&](const Corners& t) {
      const Vec2 a = plan(t[0]);
      const Vec2 b = plan(t[1]);
      const Vec2 c = plan(t[2]);
      return turn_of(a, b, p) > 0.0 && turn_of(b, c, p) > 0.0 && turn_of(c, a, p) > 0.0;
    }));
  }

  /// Determines the kind of fault at a gap by counting the triangles that cover a point on each side of the gap.
  TilingFault fault_by_cover(const SheetSide& side, const Vec2& middle) const {
    constexpr double kBeside = 1e-4;
    const Vec2 along = plan(side.to) - plan(side.from);
    const Vec2 left = kBeside * Vec2(-along.y(), along.x());
    if (cover(middle + left) > 1 || cover(middle - left) > 1) return TilingFault::overlap;
    return cover(middle - left) == 0 ? TilingFault::hole : TilingFault::height_jump;
  }

  const std::vector<Vec3>& vertices_;
  const std::vector<Corners>& sheet_;
  const std::vector<Corners>& mesh_;
  const Polygon& outline_;
  double tolerance_mm_;
};

}  // namespace

std::string_view text_of(TilingFault fault) {
  switch (fault) {
    case TilingFault::hole: return "the mesh has a hole";
    case TilingFault::overlap: return "triangles overlap";
    case TilingFault::height_jump: return "the mesh has a step in height";
    case TilingFault::corner_on_side: return "a vertex is on the edge of another triangle";
    case TilingFault::no_area: return "a triangle has no area";
    case TilingFault::vertical_triangle: return "a triangle is vertical";
    case TilingFault::overhang: return "a triangle overhangs others";
    case TilingFault::reversed_triangle: return "a triangle has the wrong orientation";
  }
  return "";
}

std::optional<TilingGap> find_gap(const std::vector<Vec3>& vertices, const std::vector<Corners>& sheet,
                                  const std::vector<Corners>& mesh, const Polygon& outline, double tolerance_mm) {
  return GapFinder(vertices, sheet, mesh, outline, tolerance_mm).find();
}

}  // namespace retrace::geometry
