#include "raytrace/exact/beam_record.h"

#include <algorithm>
#include <utility>

#include "raytrace/exact/lit_face.h"

namespace retrace::raytrace {

BeamRecord::BeamRecord(const BeamScene& scene, BeamObserver observer)
    : scene_(scene), observer_(std::move(observer)), tally_(scene.setup.cone_chord2.size()) {}

void BeamRecord::scatter(const Beam& beam, const Plane& plane, double power) {
  if (sites_ == nullptr) {
    add_to_ledger(beam, Account::truncated, power);
    return;
  }
  // In an infinite part, a beam represents all its periodic copies, and all copies scatter light identically. A single
  // scattering site is therefore sufficient. It receives the total power of the copies.
  const double count = beam.instance_count();
  sites_->push_back({beam.corners, beam.direction, beam.light, beam.path_length, plane.normal,
                     count * beam.area_fraction, count * power, beam.inside,
                     scene_.setup.infinite() ? nullptr : beam.instance_offsets});
}

void BeamRecord::enter() {
  if (!scene_.setup.stops.is_empty()) return enter_past_stops();
  const LightSetup::Entry& entry = scene_.setup.entry;
  tally_.entrance_reflected[entry.reflected_cone] += entry.reflected;
  tally_.other[Account::absorbed] += entry.absorbed;
  tally_.add(scene_.setup.arrival_losses, Account::transmitted);
  tally_.add(entry.reflected_losses, Account::returned_elsewhere);
  if (observer_ && entry.reflected.i > 0.0) observe_entrance_reflection();
}

/// Records the incident light that the stops block and the light that the entrance face and its layers reflect or
/// absorb.
void BeamRecord::enter_past_stops() {
  const LightSetup::Entry& entry = scene_.setup.entry;
  const LitFace lit(scene_);
  tally_.other[Account::stopped] += (1.0 - lit.reached_fraction) * scene_.setup.incident.power() +
                                    (lit.reached_fraction - lit.reflected_fraction) * entry.reflected.i;
  tally_.other[Account::absorbed] += lit.reached_fraction * entry.absorbed;
  tally_.entrance_reflected[entry.reflected_cone] += lit.reflected_fraction * entry.reflected;
  if (!observer_ || !(entry.reflected.i > 0.0) || lit.reflected.empty()) return;
  ReturnedBeam front = reflection_of_face();
  for (const Vec3& p : lit.reflected) front.exit_polygon_mm.push_back(p.head<2>() + scene_.centre_mm);
  front.stokes = lit.reflected_fraction * front.stokes;
  front.efficiency *= lit.reflected_fraction;
  observer_(front);
}

bool BeamRecord::keep_within(Beam& beam, const geometry::Polygon& area, double power) {
  const double before = transmission_of(beam);
  const double area_mm2 = horizontal_area(beam.corners);
  Corners corners = cut_to_outline(beam.corners, area);
  const double kept_mm2 = horizontal_area(corners);
  if (kept_mm2 <= scene_.min_area) {
    add_to_ledger(beam, Account::stopped, before * power);
    return false;
  }
  beam.area_fraction *= kept_mm2 / area_mm2;
  beam.transmission = mean_transmission(corners, beam.path_length, scene_.setup.optics.absorption_per_mm);
  beam.corners = std::move(corners);
  add_to_ledger(beam, Account::stopped, (before - transmission_of(beam)) * power);
  return true;
}

void BeamRecord::leave_through_entrance(const Beam& beam, CoherentLight light, const Vec3& direction) {
  if (!scene_.setup.stops.has_mount()) return record_leaving(beam, light, direction);
  Beam passing = beam;
  if (keep_within(passing, scene_.setup.stops.face_through_mount(direction), light.power()))
    record_leaving(passing, light, direction);
}

/// Records light that has left through the entrance face and is not blocked by the mount.
void BeamRecord::record_leaving(const Beam& beam, CoherentLight light, const Vec3& direction) {
  tally_.add(scene_.setup.pass_shells_outward(light, direction), Account::returned_elsewhere,
             beam.instance_count() * transmission_of(beam));
  const std::size_t cone = scene_.setup.cone_of(direction);
  const Stokes stokes = transmission_of(beam) * in_source_axes(light, direction);
  tally_.returned[cone] += beam.instance_count() * stokes;
  if (!observer_) return;
  ReturnedBeam returned = returned_beam(beam, light, direction);
  returned.stokes = stokes;
  returned.efficiency = stokes.i / beam.area_fraction;
  returned.cone = cone;
  observer_(returned);
}

/// Returns the description of a returned beam for the observer, without its power and cone.
ReturnedBeam BeamRecord::returned_beam(const Beam& beam, CoherentLight light, const Vec3& direction) const {
  const double index = scene_.setup.optics.index;
  const double thickness_mm = scene_.setup.thickness_mm;
  ReturnedBeam returned;
  returned.direction = direction;
  returned.depth = beam.depth;
  for (const Vec3& p : beam.corners) {
    returned.entry_polygon_mm.push_back(beam.entry.of(p));
    returned.exit_polygon_mm.push_back(p.head<2>() + scene_.centre_mm);
  }
  returned.entry_from_exit.linear() = beam.entry.slope.leftCols<2>();
  returned.entry_from_exit.translation() = beam.entry.of({0.0, 0.0, thickness_mm}) - scene_.centre_mm;
  returned.index = index;
  // An odd number of reflections reverses the orientation of the polygon.
  for (geometry::Polygon* polygon : {&returned.entry_polygon_mm, &returned.exit_polygon_mm})
    if (geometry::area(*polygon) < 0.0) std::reverse(polygon->begin(), polygon->end());
  light.rotate_basis_to_axis(direction, source_axis(direction));
  returned.jones = light.jones;
  returned.transmission = transmission_of(beam);
  // The phase is continuous across the face. It is referred to the plane of the face.
  returned.phase_mm = beam.phase_mm + index * beam.direction.z() * thickness_mm;
  returned.replicate = replicate_;
  returned.centre_mm = scene_.centre_mm;
  returned.trail = beam.trail;
  returned.instance_offsets = beam.instance_offsets;
  returned.hits = beam.hits;
  return returned;
}

/// Returns the beam that the entrance face reflects, without its polygon.
ReturnedBeam BeamRecord::reflection_of_face() const {
  const LightSetup::Entry& entry = scene_.setup.entry;
  ReturnedBeam front;
  front.direction = entry.reflected_direction;
  front.stokes = entry.reflected;
  front.efficiency = front.stokes.i;
  front.cone = entry.reflected_cone;
  front.jones = entry.reflected_jones;
  front.transmission = 1.0;
  front.centre_mm = scene_.centre_mm;
  return front;
}

void BeamRecord::observe_entrance_reflection() const {
  const ReturnedBeam front = reflection_of_face();
  if (scene_.setup.infinite()) return observer_(front);
  for (const geometry::Polygon& piece : geometry::entrance_polygons(scene_.part)) {
    // The power that a polygon of the face reflects is proportional to its area.
    const double fraction =
        scene_.part.entrance_pieces.empty() ? 1.0 : geometry::area(piece) / scene_.part.entrance_area_mm2;
    ReturnedBeam portion = front;
    portion.exit_polygon_mm = piece;
    portion.stokes = fraction * front.stokes;
    portion.efficiency *= fraction;
    observer_(portion);
  }
}

BeamResult BeamRecord::result() const {
  BeamResult result;
  for (std::size_t cone = 0; cone < scene_.setup.cone_chord2.size(); ++cone) {
    result.ledgers.push_back(tally_.ledger(cone));
    result.stokes.push_back(tally_.retroreflected(cone));
    result.std_error.push_back(0.0);
  }
  return result;
}

}  // namespace retrace::raytrace
