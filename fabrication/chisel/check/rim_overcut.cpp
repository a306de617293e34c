#include "fabrication/chisel/check/rim_overcut.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

/// Maximum overcut, in mm, at which neighbouring rims are considered to coincide. It allows for rounding errors.
constexpr double kMeetMm = 1e-9;

/// Returns points along the rims of an element.
std::vector<Vec3> rim_of(const PrismGroove& groove) {
  std::vector<Vec3> rim;
  for (const DesignFacet& facet : groove.facets)
    for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0})
      rim.push_back(groove.root_mm + groove.facet_length_mm * facet.up_slope +
                    (1.0 - 1e-6) * share * groove.half_width_mm * groove.root_direction);
  return rim;
}
std::vector<Vec3> rim_of(const CubeCavity& cavity) {
  std::vector<Vec3> rim;
  // The circumscribed circle of a hexagonal element has a radius of sqrt(2/3) times the edge length of the cube. For a
  // triangular element, the edge length is limited by the length of the cavity's edges.
  const double edge_mm = std::min(cavity.facet_length_mm, cavity.radius_mm * std::sqrt(1.5));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 low = edge_mm * cavity.edges[k];
    const Vec3 next = edge_mm * cavity.edges[(k + 1) % 3];
    const Vec3 between = cavity.is_hexagonal ? Vec3(low + next) : Vec3(0.5 * (low + next));
    for (const Vec3& p : {low, Vec3(0.5 * (low + between)), between, Vec3(0.5 * (between + next))})
      rim.push_back(cavity.root_mm + p);
  }
  return rim;
}

/// Returns the depth of a point below the surface of the volume that the cut of an element removes. It is negative
/// outside of this volume.
double depth_in(const Cavity& groove, const Vec3& p) {
  const auto* const prism = std::get_if<PrismGroove>(&groove);
  if (prism != nullptr && std::abs(prism->along_mm(p)) > prism->half_width_mm) return -1.0;
  double depth_mm = std::numeric_limits<double>::infinity();
  for (const DesignFacet& facet : common(groove).facets) depth_mm = std::min(depth_mm, facet.height_mm(p));
  return depth_mm;
}

}  // namespace

double rim_overcut_mm(const std::vector<Cavity>& grooves) {
  double cell_mm = 0.0;
  for (const Cavity& groove : grooves) cell_mm = std::max(cell_mm, half_size_mm(groove));
  cell_mm *= 4.0;
  const auto index = [&](const Vec3& p) {
    return std::pair{static_cast<std::int64_t>(std::floor(p.x() / cell_mm)),
                     static_cast<std::int64_t>(std::floor(p.y() / cell_mm))};
  };
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::size_t>> cells;
  for (std::size_t i = 0; i < grooves.size(); ++i) cells[index(common(grooves[i]).root_mm)].push_back(i);
  double most_mm = 0.0;
  for (std::size_t i = 0; i < grooves.size(); ++i) {
    const auto [x, y] = index(common(grooves[i]).root_mm);
    const std::vector<Vec3> rim = std::visit([](const auto& groove) { return rim_of(groove); }, grooves[i]);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const auto found = cells.find({x + dx, y + dy});
        if (found == cells.end()) continue;
        for (const std::size_t j : found->second)
          for (const Vec3& p : rim)
            if (j != i && common(grooves[j]).zone == common(grooves[i]).zone)
              most_mm = std::max(most_mm, depth_in(grooves[j], p));
      }
  }
  return most_mm > kMeetMm ? most_mm : 0.0;
}

}  // namespace retrace::fabrication
