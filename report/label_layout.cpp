#include "report/label_layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace retrace::report {
namespace {

constexpr double kLabelGap = 4.0;      ///< distance between a mark and a label next to it
constexpr double kDistanceStep = 6.0;  ///< difference between the distances of candidates from a mark
constexpr int kDirections = 24;        ///< number of directions of candidates around a mark
constexpr double kClearance = 1.0;     ///< minimum distance between labels

LabelBox enlarged(const LabelBox& box, double by) {
  return {{box.corner.x - by, box.corner.y - by}, {box.size.width + 2.0 * by, box.size.height + 2.0 * by}};
}

bool contains(const LabelBox& outer, const LabelBox& inner) {
  return inner.corner.x >= outer.corner.x && inner.corner.y >= outer.corner.y && inner.right() <= outer.right() &&
         inner.bottom() <= outer.bottom();
}

LabelBox box_of(const MarkedPoint& point) {
  return {{point.at.x - point.radius, point.at.y - point.radius}, {2.0 * point.radius, 2.0 * point.radius}};
}

Point nearest_point(const LabelBox& box, Point to) {
  return {std::clamp(to.x, box.corner.x, box.right()), std::clamp(to.y, box.corner.y, box.bottom())};
}

/// Returns the label in the given direction from its mark. The edge of the label is at the given distance.
/// \param angle counter-clockwise from the right, in radians
LabelBox candidate(const MarkedPoint& point, double distance, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const Point anchor{point.at.x + distance * c, point.at.y - distance * s};
  // The label begins at the anchor if it is on the right, and ends there if it is on the left.
  return {{anchor.x - 0.5 * (1.0 - c) * point.label.width, anchor.y - 0.5 * (1.0 + s) * point.label.height},
          point.label};
}

class LabelPlacer {
 public:
  LabelPlacer(const std::vector<MarkedPoint>& points, const std::vector<LabelBox>& obstacles, const LabelBox& bounds)
      : bounds_(bounds), occupied_(obstacles) {
    for (const MarkedPoint& point : points) {
      occupied_.push_back(box_of(point));
      farthest_ = std::max(farthest_, std::hypot(bounds.size.width, bounds.size.height) + point.label.width);
    }
  }

  PlacedLabel place(const MarkedPoint& point) {
    const double nearest = point.radius + kLabelGap;
    for (const bool inside : {true, false})
      for (double distance = nearest; !inside || distance < farthest_; distance += kDistanceStep)
        for (int k = 0; k < kDirections; ++k) {
          // Directions alternate between both sides, beginning on the right.
          const int step = (k + 1) / 2 * (k % 2 == 0 ? -1 : 1);
          const LabelBox box = candidate(point, distance, 2.0 * std::numbers::pi * step / kDirections);
          if ((inside && !contains(bounds_, box)) || !is_free(box)) continue;
          occupied_.push_back(box);
          return {box, distance > nearest, nearest_point(box, point.at)};
        }
    return {};
  }

 private:
  bool is_free(const LabelBox& box) const {
    const LabelBox wanted = enlarged(box, kClearance);
    return std::none_of(occupied_.begin(), occupied_.end(),
                        [&](const LabelBox& other) { return other.overlaps(wanted); });
  }

  LabelBox bounds_;
  std::vector<LabelBox> occupied_;
  double farthest_ = 0.0;
};

}  // namespace

bool LabelBox::overlaps(const LabelBox& other) const {
  return corner.x < other.right() && other.corner.x < right() && corner.y < other.bottom() && other.corner.y < bottom();
}

std::vector<PlacedLabel> place_labels(const std::vector<MarkedPoint>& points, const std::vector<LabelBox>& obstacles,
                                      const LabelBox& bounds) {
  LabelPlacer placer(points, obstacles, bounds);
  std::vector<PlacedLabel> labels;
  for (const MarkedPoint& point : points) labels.push_back(placer.place(point));
  return labels;
}

}  // namespace retrace::report
