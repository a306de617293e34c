#pragma once

// Independent simulation of turning programs, which computes the height of the cut surface at single points. The
// simulation divides each block into small steps and evaluates the edge where it passes over the point. It shares no
// code with the verifier. It is valid for tools without rake.

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "fabrication/turning/part.h"
#include "tests/fabrication/mutants.h"

namespace retrace::fabrication::test {

class PlainCut {
 public:
  PlainCut(const turning::TurnedPart& part, const std::vector<PlainMove>& cuts) : part_(part) {
    for (const PlainMove& m : cuts) {
      std::vector<std::array<double, 4>> points;
      for (int k = 0; k <= kSteps; ++k) {
        points.emplace_back();
        for (std::size_t axis = 0; axis < 4; ++axis)
          points.back()[axis] = m.from[axis] + static_cast<double>(k) / kSteps * (m.at[axis] - m.from[axis]);
      }
      add(points);
    }
  }
  /// Simulates a program with one cut.
  /// \param points positions X, Y, Z (mm) and C (degrees) along the cut
  PlainCut(const turning::TurnedPart& part, const std::vector<std::array<double, 4>>& points) : part_(part) {
    add(points);
  }

  /// Returns the height of the cut surface above the design, along Z, in mm. Returns a huge value if the edge does not
  /// pass over the point.
  double deviation(double x, double y) const {
    const double r = part_.tool.nose_radius_mm;
    const double reach = r * std::sin(0.5 * part_.tool.window_deg * kRad);
    double lowest = 1e300;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      if (poses_[i].is_first) continue;
      const Pose& a = poses_[i - 1];
      const Pose& b = poses_[i];
      const double before = x * a.sine + y * a.cosine - a.y;
      const double after = x * b.sine + y * b.cosine - b.y;
      if ((before > 0.0) == (after > 0.0)) continue;
      const double share = before / (before - after);
      const double aside_a = x * a.cosine - y * a.sine - a.x;
      const double aside_b = x * b.cosine - y * b.sine - b.x;
      const double aside = aside_a + share * (aside_b - aside_a);
      if (std::abs(aside) < reach)
        lowest = std::min(lowest, a.z + share * (b.z - a.z) + r - std::sqrt(r * r - aside * aside));
    }
    return lowest - part_.surface.height_mm(x, y);
  }

 private:
  static constexpr int kSteps = 8;
  static constexpr double kRad = std::numbers::pi / 180.0;
  struct Pose {
    double x;
    double y;
    double z;
    double cosine;
    double sine;
    bool is_first;
  };

  void add(const std::vector<std::array<double, 4>>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto& [x, y, z, c] = points[i];
      poses_.push_back({x, y, z, std::cos(c * kRad), std::sin(c * kRad), i == 0});
    }
  }

  const turning::TurnedPart& part_;
  std::vector<Pose> poses_;
};

/// Returns points just inside the border of a part, in mm.
inline std::vector<std::array<double, 2>> border_places(const turning::TurnedPart& part, int count) {
  constexpr double kInside = 1.0 - 1e-6;
  const turning::PathOptions& path = part.path;
  std::vector<std::array<double, 2>> places;
  for (int k = 0; k < count; ++k) {
    const double share = (k + 0.5) / count;
    if (path.strategy == turning::Strategy::spiral) {
      const double angle = 2.0 * std::numbers::pi * share;
      places.push_back({kInside * path.radius_mm * std::cos(angle), kInside * path.radius_mm * std::sin(angle)});
      continue;
    }
    for (const double side : {-0.5 * kInside, 0.5 * kInside}) {
      places.push_back({side * path.height_mm, kInside * path.width_mm * (share - 0.5)});
      places.push_back({kInside * path.height_mm * (share - 0.5), side * path.width_mm});
    }
  }
  return places;
}

/// Returns the deviations of the cut surface from the design at given points, in mm.
inline std::vector<double> deviations(const PlainCut& cut, const std::vector<std::array<double, 2>>& places) {
  std::vector<double> result;
  for (const auto& [x, y] : places) result.push_back(cut.deviation(x, y));
  return result;
}

}  // namespace retrace::fabrication::test
