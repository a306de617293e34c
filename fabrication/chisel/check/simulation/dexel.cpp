#include "fabrication/chisel/check/simulation/dexel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Half-space outward . p <= bound_mm, in the workpiece frame.
struct Plane {
  Vec3 outward;
  double bound_mm = 0.0;
};

/// Returns the planes of the body that a wedge sweeps. They are of two kinds. The sides of the wedge are moved outward
/// if the travel points outward. Further planes are spanned by the travel and one of the wedge's edges.
std::vector<Plane> planes_of(const SweptVolume& sweep, const RigidMotion& back, const ToolWedge& wedge) {
  const Vec3 travel = sweep.to_mm - sweep.from_mm;
  const std::array<Vec3, 2> tips = {sweep.from_mm - wedge.half_width_mm * wedge.edge,
                                    sweep.from_mm + wedge.half_width_mm * wedge.edge};
  const std::vector<Vec3>& rays = wedge.rays;
  std::vector<Plane> planes;
  const auto add = [&](const Vec3& outward) {
    for (const Vec3& ray : rays)
      if (outward.dot(ray) > 1e-12) return;  // the wedge extends through this plane, so it is not a boundary
    double bound = -1e300;
    for (const Vec3& tip : tips) bound = std::max({bound, outward.dot(tip), outward.dot(tip + travel)});
    const Vec3 turned = back.direction(outward);
    planes.push_back({turned, bound + turned.dot(back.translation_mm)});
  };
  for (const ToolWedge::Side& side : wedge.sides) add(side.outward);
  std::vector<Vec3> edges = rays;
  edges.push_back(wedge.edge);
  for (const Vec3& edge : edges) {
    const Vec3 across = edge.cross(travel);
    if (across.norm() < 1e-12) continue;
    add(across.normalized());
    add(-across.normalized());
  }
  return planes;
}

/// Total length and lowest end of a union of intervals.
struct Removed {
  double length = 0.0;
  double lowest = 0.0;
};

Removed united(std::vector<std::pair<double, double>>& parts, double high) {
  std::sort(parts.begin(), parts.end());
  Removed removed{0.0, parts.empty() ? high : parts.front().first};
  double reached = -1e300;
  for (const auto& [from, to] : parts) {
    removed.length += std::max(0.0, to - std::max(from, reached));
    reached = std::max(reached, to);
  }
  return removed;
}

}  // namespace

double DexelField::volume_mm3() const {
  double sum = 0.0;
  for (const double length : removed_mm) sum += length;
  return sum * cell_area_mm2;
}

DexelField cut_dexels(std::span<const SweptVolume> sweeps, std::span<const RigidMotion> poses, const ToolWedge& wedge,
                      const DexelBox& box, int axis, std::size_t lines) {
  std::vector<std::vector<Plane>> bodies;
  for (const SweptVolume& sweep : sweeps) bodies.push_back(planes_of(sweep, poses[sweep.pose].inverse(), wedge));
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const Vec3 size = box.high_mm - box.low_mm;
  const double pitch = std::max(size[u], size[v]) / static_cast<double>(lines);
  DexelField field;
  field.axis = axis;
  field.columns = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(size[u] / pitch)));
  field.rows = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(size[v] / pitch)));
  const double du = size[u] / static_cast<double>(field.columns);
  const double dv = size[v] / static_cast<double>(field.rows);
  field.cell_area_mm2 = du * dv;
  std::vector<std::pair<double, double>> parts;
  for (std::size_t row = 0; row < field.rows; ++row)
    for (std::size_t column = 0; column < field.columns; ++column) {
      Vec3 p = box.low_mm;
      p[u] += (static_cast<double>(column) + 0.5) * du;
      p[v] += (static_cast<double>(row) + 0.5) * dv;
      p[axis] = 0.0;
      parts.clear();
      for (const std::vector<Plane>& planes : bodies) {
        double low = box.low_mm[axis];
        double high = box.high_mm[axis];
        for (const Plane& plane : planes) {
          const double slope = plane.outward[axis];
          const double room = plane.bound_mm - plane.outward.dot(p);
          if (slope > 0.0)
            high = std::min(high, room / slope);
          else if (slope < 0.0)
            low = std::max(low, room / slope);
          else if (room < 0.0)
            high = low;
          if (high <= low) break;
        }
        if (high > low) parts.emplace_back(low, high);
      }
      const Removed removed = united(parts, box.high_mm[axis]);
      field.removed_mm.push_back(removed.length);
      field.lowest_mm.push_back(removed.lowest);
    }
  return field;
}

}  // namespace retrace::fabrication
