#pragma once

// The discrete directions in which light leaves a part, gathered from the beams of the exact engine.

#include <cstdint>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/point_lookup.h"

namespace retrace::studies {

/// All light that leaves the entrance face in one direction.
struct FarFieldSpot {
  Angle deviation;                ///< from the direction back to the source
  Angle orientation;              ///< of the deviation: from the first axis of raytrace::source_axis() to the second
  raytrace::Stokes stokes;        ///< along the axes of the spot's own direction
  std::uint32_t least_depth = 0;  ///< interfaces inside, of the shortest path; 0: reflected by the face itself
};

/// The directions in which light leaves the entrance face, for one direction of incidence.
struct FarField {
  static constexpr double kLeastPower = 1e-9;
  static constexpr double kOneDirection_rad = 1e-9;

  std::vector<FarFieldSpot> spots;  ///< of kLeastPower or more, by falling power
  double other_power = 0.0;         ///< of all other spots
  double total_power = 0.0;
};

/// Makes a far field of the returned beams of one direction.
class FarFieldBuilder {
 public:
  explicit FarFieldBuilder(const raytrace::Illumination& illumination);

  void add(const raytrace::ReturnedBeam& beam);
  FarField finish() const;

 private:
  struct Spot {
    geometry::Vec3 direction;
    raytrace::Stokes stokes;
    std::uint32_t least_depth = 0;
  };

  FarFieldSpot seen_from_source(const Spot& spot) const;

  std::vector<Spot> spots_;  ///< the first is the direction to the source, lit or not
  raytrace::PointLookup<std::size_t> places_;
};

}  // namespace retrace::studies
