#include "geometry/elements/ruled_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "geometry/direction.h"
#include "geometry/elements/plane_polygon.h"
#include "geometry/plane_math.h"

namespace retrace::geometry {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
/// Relative tolerance of positions. Lines within this fraction of the smallest spacing pass through the same point.
constexpr double kCoincident = 1e-9;
/// Relative tolerance for a common multiple of the periods of groove sets.
constexpr double kCommensurate = 1e-10;
/// Largest number of periods of one groove set in a common period.
constexpr int kMaxMultiple = 2000;
/// Largest number of grooves of one set in a period of this set.
constexpr std::size_t kMaxGroovesOfPeriod = 2000;

/// Plane of a face, or of a portion of a groove bottom, as a function of the distance from the groove along the left
/// normal: height_mm + slope * distance.
struct ProfileLine {
  double height_mm = 0.0;
  double slope = 0.0;
  bool is_bottom = false;  ///< true for the flat or a chord of the arc
};

/// VGroove of a set. Its profile is the lower envelope of its lines.
struct VGroove {
  double position_mm = 0.0;
  double left_cot = 0.0;  ///< steepness of the left face
  double right_cot = 0.0;
  std::vector<ProfileLine> bottom;
};

double cot_deg(double deg) {
  return 1.0 / std::tan(deg * kRadPerDeg);
}

/// Returns the width of the groove bottom in plan.
double width_of_bottom(const GrooveSet& set, const std::array<double, 2>& half_deg) {
  if (set.bottom_radius_mm == 0.0) return set.bottom_flat_mm;
  return set.bottom_radius_mm * (std::cos(half_deg[0] * kRadPerDeg) + std::cos(half_deg[1] * kRadPerDeg));
}

std::vector<ProfileLine> bottom_lines(const GrooveSet& set, const std::array<double, 2>& half_deg) {
  const double left = half_deg[0] * kRadPerDeg, right = half_deg[1] * kRadPerDeg;
  if (set.bottom_flat_mm > 0.0)
    return {{set.rise_mm - set.bottom_flat_mm / (std::tan(left) + std::tan(right)), 0.0, true}};
  std::vector<ProfileLine> lines;
  if (set.bottom_radius_mm == 0.0) return lines;
  // Angles of the upward unit normals of the left and the right face, measured from the left normal towards +z.
  const double from = left, to = std::numbers::pi - right;
  const double half_step = 0.5 * (to - from) / set.bottom_chords;
  // The centre is at the distance r below both faces.
  const double r = set.bottom_radius_mm;
  const double determinant = std::cos(left) * std::sin(right) + std::cos(right) * std::sin(left);
  const double x = r * (std::sin(left) - std::sin(right)) / determinant;
  const double z = -r * (std::cos(left) + std::cos(right)) / determinant;
  for (int k = 0; k < set.bottom_chords; ++k) {
    const double angle = from + (2 * k + 1) * half_step;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    const double offset = cosine * x + sine * z + r * std::cos(half_step);
    lines.push_back({set.rise_mm + offset / sine, -cosine / sine, true});
  }
  return lines;
}

/// The grooves of a set in order of their positions.
class Ruling {
 public:
  explicit Ruling(const GrooveSet& set) : set_(set) {
    const Angle azimuth = Angle::from_deg(set.azimuth_deg);
    const Vec2 along = direction_at(azimuth);
    normal_ = plane::left_of(along);
    grooves_ = std::lcm(set.spacing_mm.size(), set.half_angles_deg.size());
    double position = set.offset_mm;
    for (std::size_t m = 0; m < grooves_; ++m) {
      const std::array<double, 2>& half = set.half_angles_deg[m % set.half_angles_deg.size()];
      own_.push_back({position, cot_deg(half[0]), cot_deg(half[1]), bottom_lines(set, half)});
      position += set.spacing_mm[m % set.spacing_mm.size()];
    }
    period_mm_ = position - set.offset_mm;
  }

  const GrooveSet& set() const { return set_; }
  const Vec2& normal() const { return normal_; }
  double period_mm() const { return period_mm_; }
  double grooves_per_mm() const { return static_cast<double>(grooves_) / period_mm_; }
  double widest_mm() const { return *std::max_element(set_.spacing_mm.begin(), set_.spacing_mm.end()); }
  double narrowest_mm() const { return *std::min_element(set_.spacing_mm.begin(), set_.spacing_mm.end()); }
  double flattest_cot() const {
    double least = own_.front().left_cot;
    for (const VGroove& groove : own_) least = std::min({least, groove.left_cot, groove.right_cot});
    return least;
  }

  /// Returns the number of the last groove whose position is at most `position_mm`.
  std::int64_t last_before(double position_mm) const {
    const double periods = std::floor((position_mm - set_.offset_mm) / period_mm_);
    std::int64_t number = static_cast<std::int64_t>(periods) * static_cast<std::int64_t>(grooves_);
    while (position(number + 1) <= position_mm) ++number;
    while (position(number) > position_mm) --number;
    return number;
  }
  const VGroove& groove(std::int64_t number) const {
    const auto count = static_cast<std::int64_t>(grooves_);
    return own_[static_cast<std::size_t>(((number % count) + count) % count)];
  }
  double position(std::int64_t number) const {
    const auto count = static_cast<std::int64_t>(grooves_);
    const std::int64_t of_period = ((number % count) + count) % count;
    return own_[static_cast<std::size_t>(of_period)].position_mm +
           static_cast<double>((number - of_period) / count) * period_mm_;
  }

  /// Returns a height below which the surface is nowhere, judged by this set only.
  double lowest_mm() const {
    double lowest = set_.rise_mm;
    for (std::size_t m = 0; m < grooves_; ++m) {
      const VGroove& here = own_[m];
      const VGroove& next = own_[(m + 1) % grooves_];
      const double spacing = set_.spacing_mm[m % set_.spacing_mm.size()];
      lowest = std::min(lowest, set_.rise_mm - spacing / (1.0 / here.left_cot + 1.0 / next.right_cot));
    }
    return lowest;
  }

 private:
  GrooveSet set_;
  Vec2 normal_;
  std::size_t grooves_ = 1;
  std::vector<VGroove> own_;
  double period_mm_ = 0.0;
};

/// Returns true if a line divides a polygon.
bool crosses(const Polygon& polygon, const Vec2& normal, double position_mm, double tolerance_mm) {
  bool is_below = false, is_above = false;
  for (const Vec2& p : polygon) {
    const double at = normal.dot(p) - position_mm;
    is_below = is_below || at < -tolerance_mm;
    is_above = is_above || at > tolerance_mm;
  }
  return is_below && is_above;
}

/// Portions of a convex polygon on both sides of a line. Vertices within the tolerance of the line are on it.
struct SplitPolygon {
  Polygon below, above;
};
SplitPolygon split(const Polygon& polygon, const Vec2& normal, double position_mm, double tolerance_mm) {
  SplitPolygon parts;
  bool is_below = false, is_above = false;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2& a = polygon[k];
    const Vec2& b = polygon[(k + 1) % polygon.size()];
    const double at_a = normal.dot(a) - position_mm;
    const double at_b = normal.dot(b) - position_mm;
    is_below = is_below || at_a < -tolerance_mm;
    is_above = is_above || at_a > tolerance_mm;
    if (at_a <= tolerance_mm) parts.below.push_back(a);
    if (at_a >= -tolerance_mm) parts.above.push_back(a);
    if ((at_a < -tolerance_mm && at_b > tolerance_mm) || (at_a > tolerance_mm && at_b < -tolerance_mm)) {
      const Vec2 cut = a + (b - a) * (at_a / (at_a - at_b));
      parts.below.push_back(cut);
      parts.above.push_back(cut);
    }
  }
  if (!is_below) parts.below.clear();
  if (!is_above) parts.above.clear();
  return parts;
}

/// Planes of one groove that are above a cell. The whole cell is on one side of the centre line of the groove. The
/// surface of the groove is the lower envelope of these planes.
using CellProfile = std::vector<CellFacet>;

/// Computes the cells of all groove sets.
class CellBuilder {
 public:
  CellBuilder(const std::vector<GrooveSet>& sets, const std::optional<double>& depth_mm) : depth_mm_(depth_mm) {
    for (const GrooveSet& set : sets) rulings_.emplace_back(set);
    floor_mm_ = -INFINITY;
    double smallest = INFINITY;
    for (const Ruling& ruling : rulings_) {
      floor_mm_ = std::max(floor_mm_, ruling.lowest_mm());
      smallest = std::min(smallest, ruling.narrowest_mm());
    }
    if (depth_mm_) floor_mm_ = std::max(floor_mm_, -*depth_mm_);
    tolerance_mm_ = kCoincident * smallest;
  }

  const std::vector<Ruling>& rulings() const { return rulings_; }

  /// Returns the cells whose centroid is in a rectangle. The outline of a cell is a polygon of groove bottoms.
  /// \throw InputError if there are too many
  std::vector<Polygon> outlines_in(const Rectangle& area) const {
    double margin = 0.0;
    for (const Ruling& ruling : rulings_) margin = std::max(margin, ruling.widest_mm());
    const double wide = kMargin * margin;
    Rectangle window{area.lower - Vec2::Constant(wide), area.upper + Vec2::Constant(wide)};
    std::vector<Polygon> cells = {to_polygon(window)};
    for (const Ruling& ruling : rulings_) {
      double low = INFINITY, high = -INFINITY;
      for (const Vec2& corner : to_polygon(window)) {
        low = std::min(low, ruling.normal().dot(corner));
        high = std::max(high, ruling.normal().dot(corner));
      }
      const std::int64_t last = ruling.last_before(high);
      for (std::int64_t number = ruling.last_before(low); number <= last; ++number) {
        std::vector<Polygon> finer;
        for (Polygon& cell : cells) {
          if (!crosses(cell, ruling.normal(), ruling.position(number), tolerance_mm_)) {
            finer.push_back(std::move(cell));
            continue;
          }
          SplitPolygon parts = split(cell, ruling.normal(), ruling.position(number), tolerance_mm_);
          if (!parts.below.empty()) finer.push_back(std::move(parts.below));
          if (!parts.above.empty()) finer.push_back(std::move(parts.above));
        }
        cells = std::move(finer);
        if (cells.size() > kMaxWindowCells)
          throw InputError(
              fmt::format("the grooves have more than {} cells in one period or in the part: choose "
                          "shorter lists of spacings and half-angles, or a smaller part",
                          kMaxRuledCells));
      }
    }
    const auto is_cut = [&](const Polygon& cell) {
      for (const Vec2& p : cell)
        for (const Eigen::Index axis : {0, 1})
          if (p[axis] <= window.lower[axis] + tolerance_mm_ || p[axis] >= window.upper[axis] - tolerance_mm_)
            return true;
      return false;
    };
    cells.erase(std::remove_if(cells.begin(), cells.end(), is_cut), cells.end());
    const auto is_outside = [&](const Polygon& cell) {
      const Vec2 at = centroid(cell);
      return (at.array() < area.lower.array()).any() || (at.array() > area.upper.array()).any();
    };
    cells.erase(std::remove_if(cells.begin(), cells.end(), is_outside), cells.end());
    return cells;
  }

  /// Returns the cell over an outline: the upper envelope of the profiles of all grooves that reach it.
  Cell cell_over(Polygon outline) const {
    std::vector<CellProfile> profiles = profiles_over(outline);
    Cell cell;
    for (std::size_t j = 0; j < profiles.size(); ++j)
      for (std::size_t k = 0; k < profiles[j].size(); ++k)
        for (Polygon& part : highest(outline, profiles, j, k)) {
          CellFacet facet = profiles[j][k];
          facet.outline = without_short_sides(std::move(part), outline);
          if (facet.outline.empty()) continue;
          if (!facet.is_edge && !facet.is_flat) facet.centroid_mm = centroid(facet.outline);
          cell.facets.push_back(std::move(facet));
        }
    const auto turn = [](const CellFacet& facet) {
      const double angle = std::atan2(facet.plane.slope.y(), facet.plane.slope.x());
      return facet.is_flat || facet.is_edge ? 2.0 * std::numbers::pi + angle
                                            : (angle < -1e-9 ? angle + 2.0 * std::numbers::pi : angle);
    };
    std::stable_sort(cell.facets.begin(), cell.facets.end(),
                     [&](const CellFacet& a, const CellFacet& b) { return turn(a) < turn(b); });
    cell.at_mm = lowest_point_of(cell);
    cell.outline = std::move(outline);
    return cell;
  }

 private:
  static constexpr double kMargin = 4.0;
  static constexpr std::size_t kMaxWindowCells = 4 * kMaxRuledCells;

  static Vec2 lowest_point_of(const Cell& cell) {
    Vec2 lowest = Vec2::Zero();
    double height = INFINITY;
    for (const CellFacet& facet : cell.facets)
      for (const Vec2& p : facet.outline)
        if (facet.plane.at(p) < height) {
          height = facet.plane.at(p);
          lowest = p;
        }
    return lowest;
  }

  CellFacet facet_of(const Ruling& ruling, double position_mm, const ProfileLine& line) const {
    CellFacet facet;
    facet.plane.slope = line.slope * ruling.normal();
    facet.plane.height_mm = line.height_mm - line.slope * position_mm;
    facet.is_flat = line.is_bottom && line.slope == 0.0;
    facet.is_edge = line.is_bottom && !facet.is_flat;
    return facet;
  }

  std::vector<CellProfile> profiles_over(const Polygon& outline) const {
    std::vector<CellProfile> profiles;
    for (const Ruling& ruling : rulings_) {
      const double centre = ruling.normal().dot(centroid(outline));
      double low = INFINITY, high = -INFINITY;
      for (const Vec2& p : outline) {
        low = std::min(low, ruling.normal().dot(p));
        high = std::max(high, ruling.normal().dot(p));
      }
      const double reach = (ruling.set().rise_mm - floor_mm_) / ruling.flattest_cot();
      const std::int64_t before = ruling.last_before(centre);
      const auto add = [&](std::int64_t number, bool is_left) {
        const VGroove& groove = ruling.groove(number);
        const double position = ruling.position(number);
        CellProfile profile = {
            facet_of(ruling, position, {ruling.set().rise_mm, is_left ? -groove.left_cot : groove.right_cot, false})};
        for (const ProfileLine& line : groove.bottom) profile.push_back(facet_of(ruling, position, line));
        profiles.push_back(std::move(profile));
      };
      for (std::int64_t number = before; number == before || ruling.position(number) > low - reach; --number)
        add(number, true);
      for (std::int64_t number = before + 1; number == before + 1 || ruling.position(number) < high + reach; ++number)
        add(number, false);
    }
    if (depth_mm_) {
      CellFacet top;
      top.plane.height_mm = -*depth_mm_;
      top.is_flat = true;
      profiles.push_back({top});
    }
    return profiles;
  }

  bool is_nowhere_higher(const Polygon& polygon, const HeightPlane& plane, const HeightPlane& than) const {
    return std::all_of(polygon.begin(), polygon.end(),
                       [&](const Vec2& p) { return plane.at(p) - than.at(p) <= tolerance_mm_; });
  }
  bool is_sliver(const Polygon& polygon) const {
    return polygon.size() < 3 || area(polygon) <= tolerance_mm_ * bounding_box(polygon).size().norm();
  }
  static bool is_same(const HeightPlane& a, const HeightPlane& b, double tolerance_mm) {
    return (a.slope - b.slope).norm() <= kCommensurate && std::abs(a.height_mm - b.height_mm) <= tolerance_mm;
  }

  /// Moves points near the corners of a cell onto these corners, and merges points near each other. Rounding errors
  /// cause such points where three planes meet. Returns an empty polygon if less than three points remain.
  Polygon without_short_sides(Polygon polygon, const Polygon& outline) const {
    Polygon kept;
    for (Vec2& p : polygon) {
      for (const Vec2& corner : outline)
        if ((p - corner).norm() <= tolerance_mm_) p = corner;
      if (kept.empty() || (p - kept.back()).norm() > tolerance_mm_) kept.push_back(p);
    }
    while (kept.size() > 1 && (kept.front() - kept.back()).norm() <= tolerance_mm_) kept.pop_back();
    if (kept.size() < 3) kept.clear();
    return kept;
  }

  /// Returns the portions of an outline where plane k of profile j is the surface, as convex polygons.
  std::vector<Polygon> highest(const Polygon& outline, const std::vector<CellProfile>& profiles, std::size_t j,
                               std::size_t k) const {
    const HeightPlane& plane = profiles[j][k].plane;
    Polygon start = outline;
    for (std::size_t other = 0; other < profiles[j].size() && !start.empty(); ++other)
      if (other != k) start = where_higher(start, profiles[j][other].plane, plane);
    std::vector<Polygon> parts;
    if (!is_sliver(start)) parts.push_back(std::move(start));
    for (std::size_t h = 0; h < profiles.size() && !parts.empty(); ++h) {
      if (h == j) continue;
      std::vector<Polygon> kept;
      for (const Polygon& part : parts) add_above(kept, part, plane, profiles[h], h < j);
      parts = std::move(kept);
    }
    return parts;
  }

  /// Adds the portions of a polygon where a plane is above the profile of another groove.
  /// \param loses_ties true if the plane does not count as higher where both planes are equal
  void add_above(std::vector<Polygon>& kept, const Polygon& polygon, const HeightPlane& plane,
                 const CellProfile& profile, bool loses_ties) const {
    for (const CellFacet& other : profile) {
      if (loses_ties && is_same(other.plane, plane, tolerance_mm_)) continue;
      if (is_nowhere_higher(polygon, other.plane, plane)) return kept.push_back(polygon);
    }
    Polygon rest = polygon;
    for (const CellFacet& other : profile) {
      if (loses_ties && is_same(other.plane, plane, tolerance_mm_)) continue;
      Polygon part = where_higher(rest, plane, other.plane);
      if (!is_sliver(part)) kept.push_back(std::move(part));
      rest = where_higher(rest, other.plane, plane);
      if (is_sliver(rest)) return;
    }
  }

  std::vector<Ruling> rulings_;
  std::optional<double> depth_mm_;
  double floor_mm_ = 0.0;  ///< height below which the surface is nowhere
  double tolerance_mm_ = 0.0;
};

/// Returns the smallest common multiple of the periods of all sets along an axis. Returns nothing if there is none.
std::optional<double> period_along(const std::vector<Ruling>& rulings, Eigen::Index axis) {
  constexpr double kParallel = 1e-12;
  std::vector<double> steps;
  for (const Ruling& ruling : rulings)
    if (std::abs(ruling.normal()[axis]) > kParallel)
      steps.push_back(ruling.period_mm() / std::abs(ruling.normal()[axis]));
  if (steps.empty()) return std::nullopt;
  const double longest = *std::max_element(steps.begin(), steps.end());
  for (int k = 1; k <= kMaxMultiple; ++k) {
    const double period = k * longest;
    const bool is_common = std::all_of(steps.begin(), steps.end(), [&](double step) {
      const double count = period / step;
      return std::abs(count - std::round(count)) <= kCommensurate * count;
    });
    if (is_common) return period;
  }
  return std::nullopt;
}

/// Returns an upper bound of the number of cells per area: the number of crossings of two lines. A pattern
/// of lines has one cell for each crossing, and fewer cells if more than two lines pass through one point.
double cells_per_mm2(const std::vector<Ruling>& rulings) {
  double crossings = 0.0;
  for (std::size_t a = 0; a < rulings.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      crossings += std::abs(plane::cross(rulings[a].normal(), rulings[b].normal())) * rulings[a].grooves_per_mm() *
                   rulings[b].grooves_per_mm();
  return crossings;
}

/// Returns the cells of one period, each of them one time.
std::vector<Polygon> outlines_of_period(const CellBuilder& builder, const Vec2& period_mm) {
  // A cell belongs to the period that contains its centroid. The origin is shifted, so that no centroid of a regular
  // pattern is on the border. Cells that are found on opposite borders nevertheless count one time.
  const Vec2 from = Vec2(-0.4142135623730951, -0.3178372451957823).cwiseProduct(period_mm);
  const double slack = 1e-7 * period_mm.minCoeff();
  std::vector<Polygon> found =
      builder.outlines_in({from - Vec2::Constant(slack), from + period_mm + Vec2::Constant(slack)});
  std::vector<Polygon> once;
  std::vector<Vec2> at_border;
  for (Polygon& cell : found) {
    const Vec2 at = centroid(cell);
    const bool is_near = ((at - from).array() < slack).any() || ((at - from - period_mm).array() > -slack).any();
    const auto is_copy = [&](const Vec2& other) {
      const Vec2 periods = (at - other).cwiseQuotient(period_mm);
      return (periods.array() - periods.array().round()).abs().maxCoeff() < 1e-6;
    };
    if (is_near && std::any_of(at_border.begin(), at_border.end(), is_copy)) continue;
    if (is_near) at_border.push_back(at);
    once.push_back(std::move(cell));
  }
  return once;
}

std::vector<Cell> cells_over(const CellBuilder& builder, std::vector<Polygon> outlines) {
  std::vector<Cell> cells;
  for (Polygon& outline : outlines) cells.push_back(builder.cell_over(std::move(outline)));
  return cells;
}

bool has_faces(const Cell& cell) {
  return std::any_of(cell.facets.begin(), cell.facets.end(),
                     [](const CellFacet& facet) { return !facet.is_flat && !facet.is_edge; });
}

void check_bottoms(const std::vector<GrooveSet>& sets) {
  for (const GrooveSet& set : sets) {
    const double narrowest = *std::min_element(set.spacing_mm.begin(), set.spacing_mm.end());
    for (const std::array<double, 2>& half : set.half_angles_deg)
      if (width_of_bottom(set, half) >= narrowest)
        throw InputError({"", 0, "grooves.bottom_flat_um"},
                         fmt::format("the groove bottoms must be narrower than the spacing, {:.6g} mm, got {:.6g} mm",
                                     narrowest, width_of_bottom(set, half)));
    if (std::lcm(set.spacing_mm.size(), set.half_angles_deg.size()) > kMaxGroovesOfPeriod)
      throw InputError(fmt::format("the lists of spacings and half-angles must repeat after at most {} grooves, got {}",
                                   kMaxGroovesOfPeriod, std::lcm(set.spacing_mm.size(), set.half_angles_deg.size())));
  }
}

/// Checks that at least two groove sets cross each other.
void check_directions(const std::vector<GrooveSet>& sets) {
  constexpr double kMinAngle = 1e-3;
  const Vec2 first = direction_at(Angle::from_deg(sets.front().azimuth_deg));
  const bool cross = std::any_of(sets.begin(), sets.end(), [&](const GrooveSet& set) {
    return std::abs(plane::cross(first, direction_at(Angle::from_deg(set.azimuth_deg)))) > kMinAngle;
  });
  if (!cross) throw InputError("the grooves leave no cells: at least two sets must have different azimuths");
}

}  // namespace

std::vector<GrooveSet> perpendicular_groove_sets(const std::array<double, 3>& base_deg, double spacing_mm) {
  std::array<double, 3> sine{}, cosine{};
  for (std::size_t k = 0; k < 3; ++k) {
    sine[k] = std::sin(base_deg[k] * kRadPerDeg);
    cosine[k] = std::cos(base_deg[k] * kRadPerDeg);
  }
  const double diameter = spacing_mm / (sine[1] * sine[2]);  // of the circumscribed circle of the base triangle
  const std::array<double, 3> azimuth = {270.0, 90.0 - base_deg[2], 90.0 + base_deg[1]};
  std::vector<GrooveSet> sets;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t b = (k + 1) % 3, c = (k + 2) % 3;
    GrooveSet set;
    set.azimuth_deg = azimuth[k];
    set.spacing_mm = {k == 0 ? spacing_mm : diameter * sine[b] * sine[c]};
    const double half_rad = std::atan(std::sqrt(cosine[b] * cosine[c] / cosine[k]));
    set.half_angles_deg = {{half_rad / kRadPerDeg, half_rad / kRadPerDeg}};
    set.offset_mm = -diameter * cosine[b] * cosine[c];  // the apex is above the orthocentre
    sets.push_back(std::move(set));
  }
  return sets;
}

std::array<double, 3> base_angles_of_cant(double cant_deg) {
  const double upright_rad = std::atan(1.0 / std::numbers::sqrt2);
  const double base_deg = std::atan(1.0 / std::sin(upright_rad + cant_deg * kRadPerDeg)) / kRadPerDeg;
  return {180.0 - 2.0 * base_deg, base_deg, base_deg};
}

RuledPattern ruled_pattern(std::vector<GrooveSet> sets, std::optional<double> depth_mm) {
  check_directions(sets);
  check_bottoms(sets);
  RuledPattern pattern;
  pattern.sets = std::move(sets);
  pattern.depth_mm = depth_mm;
  const CellBuilder builder(pattern.sets, depth_mm);
  const auto x_mm = period_along(builder.rulings(), 0);
  const auto y_mm = period_along(builder.rulings(), 1);
  if (x_mm && y_mm && cells_per_mm2(builder.rulings()) * *x_mm * *y_mm <= static_cast<double>(kMaxCellsOfPeriod))
    pattern.period_mm = Vec2(*x_mm, *y_mm);
  if (pattern.period_mm) {
    pattern.cells = cells_over(builder, outlines_of_period(builder, *pattern.period_mm));
  } else {
    double widest = 0.0;
    for (const Ruling& ruling : builder.rulings()) widest = std::max(widest, ruling.widest_mm());
    pattern.cells =
        cells_over(builder, builder.outlines_in({Vec2::Constant(-2.0 * widest), Vec2::Constant(2.0 * widest)}));
  }
  double total_mm2 = 0.0;
  bool any = false;
  for (const Cell& cell : pattern.cells) {
    total_mm2 += area(cell.outline);
    any = any || has_faces(cell);
    for (const CellFacet& facet : cell.facets)
      for (const Vec2& p : facet.outline) pattern.lowest_mm = std::min(pattern.lowest_mm, facet.plane.at(p));
  }
  if (!any) throw InputError("the grooves leave no cells: their flat bottoms or the flat tops cover the part");
  pattern.mean_cell_mm2 = total_mm2 / static_cast<double>(pattern.cells.size());
  return pattern;
}

Lattice ruled_lattice(const RuledPattern& pattern, const ArrayLayout& array) {
  Lattice lattice;
  if (pattern.period_mm) {
    lattice.period_mm = *pattern.period_mm;
    lattice.cells = pattern.cells;
    lattice.elements_per_period = static_cast<int>(lattice.cells.size());
    return lattice;
  }
  if (array.extent == Extent::infinite)
    throw InputError(
        "the grooves have no common period along x and y, or one with too many cells: give a finite array, or choose "
        "other spacings and azimuths");
  const Vec2 size(array.x_length_mm, array.y_length_mm);
  if (size.prod() > static_cast<double>(kMaxRuledCells) * pattern.mean_cell_mm2)
    throw InputError(
        fmt::format("a part whose grooves have no common period along x and y must have at most {} cells, "
                    "got about {:.0f}",
                    kMaxRuledCells, size.prod() / pattern.mean_cell_mm2));
  double widest = 0.0;
  for (const GrooveSet& set : pattern.sets)
    widest = std::max(widest, *std::max_element(set.spacing_mm.begin(), set.spacing_mm.end()));
  const Vec2 half = 0.5 * size + Vec2::Constant(4.0 * widest);
  const CellBuilder builder(pattern.sets, pattern.depth_mm);
  lattice.cells = cells_over(builder, builder.outlines_in({-half, half}));
  lattice.elements_per_period = static_cast<int>(lattice.cells.size());
  lattice.period_mm = 4.0 * half;
  lattice.repeats = false;
  return lattice;
}

Cell largest_cell(const RuledPattern& pattern) {
  Cell cell = *std::max_element(pattern.cells.begin(), pattern.cells.end(), [](const Cell& a, const Cell& b) {
    return area(a.outline) < area(b.outline) * (1.0 - kCoincident);
  });
  const Vec2 by = -cell.at_mm;
  cell.at_mm = Vec2::Zero();
  cell.outline = moved(std::move(cell.outline), by);
  for (CellFacet& facet : cell.facets) {
    facet.outline = moved(std::move(facet.outline), by);
    facet.plane.height_mm -= facet.plane.slope.dot(by);
    if (facet.centroid_mm) *facet.centroid_mm += by;
  }
  return cell;
}

double aperture_of_mean_cell_mm(const RuledPattern& pattern) {
  return 2.0 * std::sqrt(4.0 * pattern.mean_cell_mm2 / (3.0 * std::numbers::sqrt3));
}

}  // namespace retrace::geometry
