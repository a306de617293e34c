#pragma once

// Active regions of the entrance face (regions that return light), collected from the beams of the exact engine.

#include <array>
#include <optional>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/overlay.h"

namespace retrace::studies {

/// Convex region of the entrance face that returns light.
struct ActiveRegion {
  geometry::Polygon outline_mm;  ///< in the part frame
  double efficiency = 0.0;       ///< returned power divided by the power that is incident on the region
};

/// Regions of the entrance face that return light into the widest acceptance cone, for one direction. Reflection by the
/// face itself, and paths with an efficiency below kMinEfficiency, are not included.
struct Footprint {
  static constexpr double kMinEfficiency = 1e-3;

  std::vector<ActiveRegion> regions;  ///< disjoint, ordered from bottom to top and from left to right
  double entrance_area_mm2 = 0.0;     ///< area of the entrance face, or of one period of it for infinite parts
  double active_area_mm2 = 0.0;

  double active_fraction() const { return active_area_mm2 / entrance_area_mm2; }
  /// Returns the contribution of the regions to RRE.
  double rre_contribution() const;
};

/// Builds the footprint from the returned beams of one direction.
class FootprintBuilder {
 public:
  /// \param cones number of acceptance cones into which beams are sorted
  FootprintBuilder(const geometry::Part& part, std::size_t cones);

  void add(const raytrace::ReturnedBeam& beam);
  Footprint finish() const;

 private:
  void insert(const raytrace::FlatPolygon& entered, double efficiency);

  double entrance_area_mm2_;
  double size_mm_;
  std::optional<geometry::Vec2> period_mm_;
  std::size_t cones_;
  raytrace::Overlay overlay_;
};

/// Entrance face and the elements behind it, as seen along the normal of the part.
struct EntranceFace {
  using Line = std::array<geometry::Vec2, 2>;

  geometry::Polygon outline_mm;  ///< for infinite parts: outline of the central period
  bool is_periodic = false;
  // Edges of the elements. For infinite parts: edges of which at least a part is in the central period.
  std::vector<Line> rims_mm;
  std::vector<Line> roots_mm;  ///< edges between facets of one element
};

EntranceFace entrance_face_of(const geometry::Part& part);

}  // namespace retrace::studies
