#include "studies/rre/far_field.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace retrace::studies {
namespace {

using geometry::Vec3;

bool is_stronger(const FarFieldSpot& a, const FarFieldSpot& b) {
  if (a.stokes.i != b.stokes.i) return a.stokes.i > b.stokes.i;
  if (a.deviation.rad() != b.deviation.rad()) return a.deviation.rad() < b.deviation.rad();
  return a.orientation.rad() < b.orientation.rad();
}

}  // namespace

FarFieldBuilder::FarFieldBuilder(const raytrace::Illumination& illumination)
    : spot_index_(FarField::kOneDirection_rad) {
  const Vec3 to_source = raytrace::direction_to_source(illumination);
  spots_.push_back({to_source, {}, std::numeric_limits<std::uint32_t>::max()});
  spot_index_.insert(to_source, 0);
}

void FarFieldBuilder::add(const raytrace::ReturnedBeam& beam) {
  std::size_t index = spots_.size();
  spot_index_.visit(beam.direction, [&](std::size_t known) { index = std::min(index, known); });
  if (index == spots_.size()) {
    spots_.push_back({beam.direction, {}, beam.depth});
    spot_index_.insert(beam.direction, index);
  }
  spots_[index].stokes += beam.instance_count() * beam.stokes;
  spots_[index].min_depth = std::min(spots_[index].min_depth, beam.depth);
}

FarFieldSpot FarFieldBuilder::seen_from_source(const Spot& spot) const {
  FarFieldSpot seen{{}, {}, spot.stokes, spot.min_depth};
  const Vec3& to_source = spots_.front().direction;
  if (&spot == &spots_.front()) return seen;
  seen.deviation = Angle::from_rad(std::atan2(spot.direction.cross(to_source).norm(), spot.direction.dot(to_source)));
  const Vec3 first = raytrace::source_axis(to_source);
  const Vec3 second = to_source.cross(first);
  const double turn = std::atan2(spot.direction.dot(second), spot.direction.dot(first));
  // Angles within rounding errors of -180 degrees are shifted by 360 degrees, so that their sign is always positive.
  seen.orientation = Angle::from_rad(turn < 1e-9 - std::numbers::pi ? turn + 2.0 * std::numbers::pi : turn);
  return seen;
}

FarField FarFieldBuilder::finish() const {
  FarField field;
  for (const Spot& spot : spots_) {
    field.total_power += spot.stokes.i;
    if (spot.stokes.i < FarField::kMinPower)
      field.other_power += spot.stokes.i;
    else
      field.spots.push_back(seen_from_source(spot));
  }
  std::sort(field.spots.begin(), field.spots.end(), is_stronger);
  return field;
}

}  // namespace retrace::studies
