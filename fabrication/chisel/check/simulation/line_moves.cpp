#include "fabrication/chisel/check/simulation/line_moves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Margin of the comparisons that decide whether a move is omitted, in mm. It is much larger than rounding errors.
/// Moves that affect the result are therefore never omitted.
constexpr double kMarginMm = 1e-9;
/// Minimum cosine of the angle between a line and the normal of a side, for a side that bounds s. Other sides are
/// considered parallel to the lines.
constexpr double kParallelCosine = 1e-5;
/// Maximum number of moves for which a family is not divided further.
constexpr std::size_t kFewMoves = 6;

/// Linear function of the slant.
struct Linear {
  double at_zero_mm = 0.0;
  double slope = 0.0;

  double at(double slant_mm) const { return at_zero_mm + slope * slant_mm; }
};

/// Cross-section of a swept body in the plane of the lines, as lower and upper bounds of s.
struct BodySection {
  const SweptVolume* move = nullptr;
  std::vector<Linear> lower;
  std::vector<Linear> upper;
  /// Distances of the line from the sides that are parallel to it. A negative distance is outside of the body.
  std::vector<Linear> distances;
  std::vector<double> drifts_mm;  ///< for each of these sides: maximum change of the distance along the line
};

/// Part of the family, from its first to its last line.
struct LineRange {
  double first_mm = 0.0;
  double last_mm = 0.0;
  double exit_mm = 0.0;  ///< maximum parameter s at which one of the lines leaves the blank

  bool is_above(const Linear& a, const Linear& b) const {
    return a.at(first_mm) > b.at(first_mm) + kMarginMm && a.at(last_mm) > b.at(last_mm) + kMarginMm;
  }
};

/// Depths of a cut at the first and the last line of a range. Swept bodies are convex, so that the cut is deeper than
/// the linear interpolation of these depths.
struct CutDepth {
  double first_mm = 0.0;
  double last_mm = 0.0;
};

class LineDivider {
 public:
  LineDivider(const LineFamily& lines, std::span<const SweptBody* const> bodies, std::span<const RigidMotion> poses,
              const MeasureLine& measure)
      : lines_(lines), measure_(measure) {
    sections_.reserve(bodies.size());
    for (const SweptBody* const body : bodies) add(*body, poses[body->move->pose]);
  }

  void run() {
    std::vector<const BodySection*> all;
    for (const BodySection& section : sections_) all.push_back(&section);
    if (!lines_.slants_mm.empty()) divide(0, lines_.slants_mm.size(), all);
  }

 private:
  void add(const SweptBody& body, const RigidMotion& pose) {
    BodySection& section = sections_.emplace_back();
    section.move = body.move;
    const Vec3 origin = pose.point(lines_.origin_mm);
    const Vec3 up = pose.direction(lines_.up);
    const Vec3 direction = pose.direction(lines_.direction);
    for (const ToolWedge::Side& side : body.sides) {
      // The side bounds s by s * along <= distance.
      const double along = side.outward.dot(direction);
      const Linear distance{side.bound_mm - side.outward.dot(origin), -side.outward.dot(up)};
      if (std::abs(along) < kParallelCosine) {
        section.distances.push_back(distance);
        section.drifts_mm.push_back(std::abs(along) * lines_.reach_mm + kMarginMm);
      } else {
        (along > 0.0 ? section.upper : section.lower).push_back({distance.at_zero_mm / along, distance.slope / along});
      }
    }
  }

  void divide(std::size_t begin, std::size_t end, const std::vector<const BodySection*>& candidates) {
    const std::vector<const BodySection*> kept = determining(begin, end, candidates);
    if (end - begin > 1 && kept.size() > kFewMoves) {
      const std::size_t middle = begin + (end - begin) / 2;
      divide(begin, middle, kept);
      divide(middle, end, kept);
      return;
    }
    std::vector<const SweptVolume*> moves;
    for (const BodySection* const section : kept) moves.push_back(section->move);
    for (std::size_t line = begin; line < end; ++line) measure_(line, moves);
  }

  /// Returns the moves that may determine the surface along the lines of a range.
  std::vector<const BodySection*> determining(std::size_t begin, std::size_t end,
                                              const std::vector<const BodySection*>& candidates) const {
    const auto exits = lines_.exits_mm.begin();
    const LineRange range{
        lines_.slants_mm[begin], lines_.slants_mm[end - 1],
        *std::max_element(exits + static_cast<std::ptrdiff_t>(begin), exits + static_cast<std::ptrdiff_t>(end))};
    const BodySection* deepest = nullptr;
    CutDepth depth;
    for (const BodySection* const section : candidates) {
      const std::optional<CutDepth> open = open_cut(*section, range);
      if (!open || (deepest != nullptr && open->first_mm + open->last_mm >= depth.first_mm + depth.last_mm)) continue;
      deepest = section;
      depth = *open;
    }
    std::vector<const BodySection*> kept;
    for (const BodySection* const section : candidates) {
      const bool is_omitted = section != deepest && (is_beside_lines(*section, range) ||
                                                     (deepest != nullptr && is_higher(*section, range, depth)));
      if (!is_omitted) kept.push_back(section);
    }
    return kept;
  }

  /// Returns the depths of a cut if the cut removes all material up to the blank's face on all lines of a range.
  std::optional<CutDepth> open_cut(const BodySection& section, const LineRange& range) const {
    const auto low_at = [&](double slant_mm) -> std::optional<double> {
      double low = -std::numeric_limits<double>::infinity();
      for (const Linear& bound : section.lower) low = std::max(low, bound.at(slant_mm));
      if (low < -lines_.reach_mm || low > range.exit_mm) return std::nullopt;
      for (const Linear& bound : section.upper)
        if (bound.at(slant_mm) < range.exit_mm + kMarginMm) return std::nullopt;
      for (std::size_t k = 0; k < section.distances.size(); ++k)
        if (section.distances[k].at(slant_mm) < section.drifts_mm[k]) return std::nullopt;
      return low;
    };
    const std::optional<double> first = low_at(range.first_mm);
    if (!first) return std::nullopt;
    const std::optional<double> last = low_at(range.last_mm);
    if (!last) return std::nullopt;
    return CutDepth{*first, *last};
  }

  /// Returns true if a move crosses no line of a range.
  static bool is_beside_lines(const BodySection& section, const LineRange& range) {
    for (std::size_t k = 0; k < section.distances.size(); ++k)
      if (std::max(section.distances[k].at(range.first_mm), section.distances[k].at(range.last_mm)) <
          -section.drifts_mm[k])
        return true;
    return std::ranges::any_of(section.lower, [&](const Linear& low) {
      return std::ranges::any_of(section.upper, [&](const Linear& high) { return range.is_above(low, high); });
    });
  }

  /// Returns true if a move cuts less deep than a given cut on all lines of a range.
  static bool is_higher(const BodySection& section, const LineRange& range, const CutDepth& depth) {
    return std::ranges::any_of(section.lower, [&](const Linear& low) {
      return low.at(range.first_mm) > depth.first_mm + kMarginMm && low.at(range.last_mm) > depth.last_mm + kMarginMm;
    });
  }

  const LineFamily& lines_;
  const MeasureLine& measure_;
  std::vector<BodySection> sections_;
};

}  // namespace

void for_each_line(const LineFamily& lines, std::span<const SweptBody* const> bodies,
                   std::span<const RigidMotion> poses, const MeasureLine& measure) {
  LineDivider(lines, bodies, poses, measure).run();
}

}  // namespace retrace::fabrication
