#include "raytrace/exact/overlay.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <deque>
#include <iterator>
#include <optional>
#include <utility>

#include "geometry/point_lookup.h"

namespace retrace::raytrace {
namespace {

namespace bg = boost::geometry;

using geometry::Vec2, geometry::Vec3;
using Corner = bg::model::point<double, 2, bg::cs::cartesian>;
using TreeBox = bg::model::box<Corner>;
using Entry = std::pair<TreeBox, std::size_t>;
using Tree = bg::index::rtree<Entry, bg::index::quadratic<16>>;

constexpr double kPolygonMergeFraction = 1e-11;
constexpr double kMinPolygonFraction = 1e-13;
// Tolerance for equal corners and straight edges when polygons are joined, as a fraction of `size_mm`.
constexpr double kFuseFraction = 1e-10;

TreeBox box_of(const FlatPolygon& polygon) {
  Vec2 lower = polygon[0];
  Vec2 upper = polygon[0];
  for (const Vec2& p : polygon) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  return {{lower.x(), lower.y()}, {upper.x(), upper.y()}};
}

}  // namespace

struct Overlay::Impl {
  explicit Impl(double size_mm)
      : merge_mm(kPolygonMergeFraction * size_mm), min_area(kMinPolygonFraction * size_mm * size_mm) {}

  double merge_mm;
  double min_area;
  std::vector<ValuedPolygon> pieces;  ///< an empty polygon marks an entry that was divided into new entries
  Tree tree;

  void add(FlatPolygon polygon, double value) {
    tree.insert({box_of(polygon), pieces.size()});
    pieces.push_back({std::move(polygon), value});
  }

  /// Returns the polygons that may overlap a polygon, in order of insertion.
  std::vector<Entry> near(const FlatPolygon& polygon) const {
    std::vector<Entry> found;
    tree.query(bg::index::intersects(box_of(polygon)), std::back_inserter(found));
    std::sort(found.begin(), found.end(), [](const Entry& a, const Entry& b) { return a.second < b.second; });
    return found;
  }

  void subtract_all(std::vector<FlatPolygon>& from, const FlatPolygon& what) const {
    std::vector<FlatPolygon> left;
    for (const FlatPolygon& piece : from) subtract(piece, what, min_area, merge_mm, left);
    from = std::move(left);
  }

  /// Divides a stored polygon into the part that `polygon` covers and the rest. `value` is added to the covered part.
  /// Returns false if the two polygons do not overlap.
  bool divide(const Entry& entry, const FlatPolygon& polygon, double value) {
    const ValuedPolygon before = pieces[entry.second];
    FlatPolygon common = intersection(before.polygon, polygon, merge_mm);
    if (common.size() < 3 || area(common) <= min_area) return false;
    std::vector<FlatPolygon> outside;
    subtract(before.polygon, polygon, min_area, merge_mm, outside);
    tree.remove(entry);
    pieces[entry.second].polygon.clear();
    add(std::move(common), before.value + value);
    for (FlatPolygon& piece : outside) add(std::move(piece), before.value);
    return true;
  }
};

Overlay::Overlay(double size_mm) : impl_(std::make_unique<Impl>(size_mm)) {}

Overlay::~Overlay() = default;

void Overlay::insert(const FlatPolygon& polygon, double value) {
  if (polygon.size() < 3 || area(polygon) <= impl_->min_area) return;
  std::vector<FlatPolygon> rest = {polygon};
  for (const Entry& entry : impl_->near(polygon)) {
    const FlatPolygon there = impl_->pieces[entry.second].polygon;
    if (impl_->divide(entry, polygon, value)) impl_->subtract_all(rest, there);
  }
  for (FlatPolygon& piece : rest) impl_->add(std::move(piece), value);
}

std::vector<ValuedPolygon> Overlay::polygons() const {
  std::vector<ValuedPolygon> all;
  for (const ValuedPolygon& piece : impl_->pieces)
    if (!piece.polygon.empty()) all.push_back(piece);
  return all;
}

namespace {

/// Joins adjacent polygons of nearly equal value until no further pair has a convex union.
class Fusion {
 public:
  Fusion(double size_mm, double value_tolerance)
      : near_mm_(kFuseFraction * size_mm), value_tolerance_(value_tolerance), edges_(near_mm_) {}

  void add(const ValuedPolygon& piece) {
    const std::size_t id = pieces_.size();
    pieces_.push_back({without_straight_corners(piece.polygon), piece.value});
    const FlatPolygon& polygon = pieces_.back().polygon;
    for (std::size_t k = 0; k < polygon.size(); ++k) edges_.insert(middle_of_edge(polygon, k), {id, k});
    open_.push_back(id);
  }

  void run() {
    for (; !open_.empty(); open_.pop_front()) {
      const std::size_t id = open_.front();
      for (std::size_t k = 0; k < pieces_[id].polygon.size(); ++k)
        if (fuse_across(id, k)) break;
    }
  }

  std::vector<ValuedPolygon> result() const {
    std::vector<ValuedPolygon> all;
    for (const ValuedPolygon& piece : pieces_)
      if (!piece.polygon.empty()) all.push_back(piece);
    return all;
  }

 private:
  struct Edge {
    std::size_t piece = 0;
    std::size_t first_corner = 0;
  };

  static const Vec2& corner(const FlatPolygon& polygon, std::size_t k) { return polygon[k % polygon.size()]; }
  static Vec3 middle_of_edge(const FlatPolygon& polygon, std::size_t k) {
    const Vec2 middle = 0.5 * (corner(polygon, k) + corner(polygon, k + 1));
    return {middle.x(), middle.y(), 0.0};
  }

  enum class Turn { convex, straight, other };

  /// Classifies the angle at b of the path a, b, c.
  Turn turn(const Vec2& a, const Vec2& b, const Vec2& c) const {
    const Vec2 along = (c - a).normalized();
    const double bulge = along.y() * (b - a).x() - along.x() * (b - a).y();
    if (bulge > near_mm_) return Turn::convex;
    return bulge >= -near_mm_ && (b - a).dot(c - b) > 0.0 ? Turn::straight : Turn::other;
  }

  FlatPolygon without_straight_corners(const FlatPolygon& polygon) const {
    FlatPolygon kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec2& before = kept.empty() ? polygon.back() : kept.back();
      if (turn(before, polygon[k], corner(polygon, k + 1)) != Turn::straight) kept.push_back(polygon[k]);
    }
    return kept;
  }

  std::optional<Edge> partner_of(std::size_t id, std::size_t k) const {
    const ValuedPolygon& own = pieces_[id];
    std::optional<Edge> best;
    edges_.visit(middle_of_edge(own.polygon, k), [&](const Edge& edge) {
      const ValuedPolygon& other = pieces_[edge.piece];
      if (edge.piece == id || other.polygon.empty()) return;
      const bool is_common =
          (corner(own.polygon, k) - corner(other.polygon, edge.first_corner + 1)).norm() <= near_mm_ &&
          (corner(own.polygon, k + 1) - corner(other.polygon, edge.first_corner)).norm() <= near_mm_;
      if (!is_common || std::abs(own.value - other.value) > value_tolerance_) return;
      if (!best || edge.piece < best->piece) best = edge;
    });
    return best;
  }

  /// Common edges of two polygons: the corners `first` to `last` of one polygon are the corners `start` to `end` of the
  /// other polygon in reverse order.
  struct CommonEdges {
    std::size_t first, last, start, end;
  };

  /// Returns the chain of common edges of two polygons that includes edge `ka` of `a` and edge `kb` of `b`. The
  /// returned indices are arguments of corner(). They include the number of corners as an offset, so that they are
  /// never negative.
  CommonEdges common_edges(const FlatPolygon& a, std::size_t ka, const FlatPolygon& b, std::size_t kb) const {
    CommonEdges c{ka + a.size(), ka + a.size() + 1, kb + b.size() + 1, kb + b.size()};
    const auto meet = [&](std::size_t on_a, std::size_t on_b) {
      return (corner(a, on_a) - corner(b, on_b)).norm() <= near_mm_;
    };
    while (c.last + 1 < c.first + a.size() && meet(c.first - 1, c.start + 1)) {
      --c.first;
      ++c.start;
    }
    while (c.last + 1 < c.first + a.size() && meet(c.last + 1, c.end - 1)) {
      ++c.last;
      --c.end;
    }
    return c;
  }

  /// Returns the union of two polygons with a common edge, or nothing if the union is not convex.
  std::optional<FlatPolygon> joined(const FlatPolygon& a, std::size_t ka, const FlatPolygon& b, std::size_t kb) const {
    const CommonEdges c = common_edges(a, ka, b, kb);
    const Turn at_first = turn(corner(a, c.first - 1), corner(a, c.first), corner(b, c.start + 1));
    const Turn at_last = turn(corner(b, c.end - 1), corner(a, c.last), corner(a, c.last + 1));
    if (at_first == Turn::other || at_last == Turn::other) return std::nullopt;
    FlatPolygon both;
    if (at_last == Turn::convex) both.push_back(corner(a, c.last));
    for (std::size_t k = c.last + 1; k < c.first + a.size(); ++k) both.push_back(corner(a, k));
    if (at_first == Turn::convex) both.push_back(corner(a, c.first));
    for (std::size_t k = c.start + 1; k < c.end + b.size(); ++k) both.push_back(corner(b, k));
    return both;
  }

  bool fuse_across(std::size_t id, std::size_t k) {
    const std::optional<Edge> partner = partner_of(id, k);
    if (!partner) return false;
    const ValuedPolygon own = pieces_[id];
    const ValuedPolygon other = pieces_[partner->piece];
    const auto both = joined(own.polygon, k, other.polygon, partner->first_corner);
    if (!both) return false;
    const double own_area = area(own.polygon);
    const double other_area = area(other.polygon);
    pieces_[id].polygon.clear();
    pieces_[partner->piece].polygon.clear();
    add({*both, (own.value * own_area + other.value * other_area) / (own_area + other_area)});
    return true;
  }

  double near_mm_;
  double value_tolerance_;
  std::vector<ValuedPolygon> pieces_;  ///< an empty polygon marks an entry that was joined to another entry
  geometry::PointLookup<Edge> edges_;
  std::deque<std::size_t> open_;
};

}  // namespace

std::vector<ValuedPolygon> fused(const std::vector<ValuedPolygon>& pieces, double size_mm, double value_tolerance) {
  Fusion fusion(size_mm, value_tolerance);
  for (const ValuedPolygon& piece : pieces) fusion.add(piece);
  fusion.run();
  return fusion.result();
}

}  // namespace retrace::raytrace
