#pragma once

// Discrete directions in which light leaves a part, collected from the beams of the exact engine.

#include <cstdint>
#include <vector>

#include "geometry/point_lookup.h"
#include "raytrace/exact/beam_tracer.h"

namespace retrace::studies {

/// Light that leaves the entrance face in one direction (spot of the far field).
struct FarFieldSpot {
  Angle deviation;  ///< angle to the direction back to the source
  /// Azimuth of the spot around the direction back to the source, from the first axis of raytrace::source_axis()
  /// towards the second.
  Angle orientation;
  raytrace::Stokes stokes;  ///< Stokes parameters with respect to the axes of the spot's direction
  /// Number of interfaces on the shortest path inside the part; 0: reflected at the outside of the entrance face.
  std::uint32_t min_depth = 0;
};

/// Directions in which light leaves the entrance face, for one direction of incidence.
struct FarField {
  static constexpr double kMinPower = 1e-9;
  static constexpr double kOneDirection_rad = 1e-9;

  std::vector<FarFieldSpot> spots;  ///< spots with at least kMinPower, in descending order of power
  double other_power = 0.0;         ///< power of all other spots
  double total_power = 0.0;
};

/// Builds the far field from the returned beams of one direction.
class FarFieldBuilder {
 public:
  explicit FarFieldBuilder(const raytrace::Illumination& illumination);

  void add(const raytrace::ReturnedBeam& beam);
  FarField finish() const;

 private:
  struct Spot {
    geometry::Vec3 direction;
    raytrace::Stokes stokes;
    std::uint32_t min_depth = 0;
  };

  FarFieldSpot seen_from_source(const Spot& spot) const;

  std::vector<Spot> spots_;  ///< the first spot is the direction back to the source, even if it has no light
  geometry::PointLookup<std::size_t> spot_index_;
};

}  // namespace retrace::studies
