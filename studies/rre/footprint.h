#pragma once

// The active regions of the entrance face, gathered from the beams of the exact engine.

#include <array>
#include <optional>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/overlay.h"

namespace retrace::studies {

/// A convex region of the entrance face that sends light back.
struct ActiveRegion {
  geometry::Polygon outline_mm;  ///< in the part frame
  double efficiency = 0.0;       ///< returned power over the power that fell on the region
};

/// Which regions of the entrance face send light back into the widest acceptance cone, for one direction. The
/// reflection of the face itself is not counted, nor are paths that bring back less than kLeastEfficiency.
struct Footprint {
  static constexpr double kLeastEfficiency = 1e-3;

  std::vector<ActiveRegion> regions;  ///< disjoint, from bottom to top and left to right
  double entrance_area_mm2 = 0.0;     ///< infinite parts: of one period
  double active_area_mm2 = 0.0;

  double active_share() const { return active_area_mm2 / entrance_area_mm2; }
  /// What the regions contribute to RRE.
  double rre_shown() const;
};

/// Makes a footprint of the returned beams of one direction.
class FootprintBuilder {
 public:
  /// \param cones how many acceptance cones the beams are sorted by
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

/// The entrance face and the elements behind it, seen along the part's normal.
struct EntranceFace {
  using Line = std::array<geometry::Vec2, 2>;

  geometry::Polygon outline_mm;  ///< infinite parts: the central period
  bool is_periodic = false;
  // Edges of the elements; those of an infinite part that reach into the central period.
  std::vector<Line> rims_mm;
  std::vector<Line> roots_mm;  ///< between facets of one element
};

EntranceFace entrance_face_of(const geometry::Part& part);

}  // namespace retrace::studies
