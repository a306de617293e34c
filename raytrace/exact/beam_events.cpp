// Interaction of beams with faces. These member functions of BeamWalk split beams at interfaces, add power to the
// ledger and queue the new beams.
#include <fmt/format.h>

#include "raytrace/exact/beam_walk.h"
#include "raytrace/faces/textured_facet.h"

namespace retrace::raytrace {

using geometry::FacetRole, surface_models::Lobe;

/// Returns the power of a fragment of a beam at the plane where the beam starts.
double BeamWalk::power_at_start(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share) const {
  const Plane start{from.start.normal, from.start.normal.dot(from.corners[0])};
  const Corners corners = lifted(piece, frame, Distance(frame, start));
  return share * mean_transmission(corners, from.path_length, setup_.optics.absorption_per_mm) * from.light.power();
}

/// Returns the fragment of a beam that meets a plane. The power that the material absorbs up to the plane is added to
/// the ledger.
Beam BeamWalk::arrived(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share,
                       const Plane& plane) {
  Beam beam = from;
  beam.share = share;
  beam.depth = from.depth + 1;
  beam.level_steps = 0;
  beam.corners = lifted(piece, frame, Distance(frame, plane));
  beam.transmission = mean_transmission(beam.corners, beam.path_length, setup_.optics.absorption_per_mm);
  if (from.inside && setup_.optics.absorption_per_mm > 0.0)
    book(Account::absorbed, power_at_start(from, frame, piece, share) - power_of(beam));
  return beam;
}

/// Queues a beam that starts at an interface.
/// \param ahead normal of the plane, which points to the side into which the beam travels
void BeamWalk::send(Beam&& beam, const Plane& plane, const Vec3& ahead, const Vec3& direction,
                    const CoherentLight& light, bool inside) {
  // The field is continuous on the plane. The wave vectors before and after therefore differ only along the normal.
  beam.phase_mm +=
      (index_at(beam.inside) * beam.direction - index_at(inside) * direction).dot(plane.normal) * plane.offset_mm;
  beam.path_length = beam.path_length.continued(plane, direction, inside ? 1.0 : 0.0);
  beam.entry = beam.entry.continued(plane, direction);
  for (TexturedHit& hit : beam.hits) hit = hit.continued(plane, direction);
  beam.start = {ahead, ahead.dot(plane.normal) * plane.offset_mm};
  beam.direction = direction;
  beam.light = light;
  beam.inside = inside;
  pend(std::move(beam));
}

void BeamWalk::meet_facet(const Beam& from, const Frame& frame, const Candidate& candidate, const FlatPolygon& piece,
                          double share) {
  Beam beam = arrived(from, frame, piece, share, candidate.plane);
  const bool is_wall = candidate.role == FacetRole::inner_wall || candidate.role == FacetRole::border_wall;
  if (is_wall && setup_.optics.absorbing_walls) {
    book(Account::absorbed, power_of(beam));
    return;
  }
  const Vec3 against = from.inside ? Vec3(-candidate.plane.normal) : candidate.plane.normal;
  const double ratio = setup_.optics.ratio_at_back(from.inside);
  const double cos_incidence = -against.dot(from.direction);
  const materials::FresnelCoefficients f = fresnel_at_back(setup_.optics, candidate.role, from.inside, cos_incidence);
  beam.trail.meet(candidate.cell);
  beam.light.turn_to(from.direction, against);
  const CoherentLight reflected = beam.light.reflected(f);
  const CoherentLight transmitted = beam.light.transmitted(f);
  book(Account::absorbed,
       transmission_of(beam) * absorbed_at_back(setup_.optics, candidate.role, beam.light, reflected, transmitted));
  const CoherentLight left = mean_field(beam, f, candidate.role, cos_incidence, Lobe::reflection);
  double scattered = reflected.power() - left.power();
  if (!f.total_reflection) {
    Beam through = beam;
    if (from.inside) through.left_through = candidate.role;
    keep_phases(through, candidate, f, cos_incidence, Lobe::transmission);
    const CoherentLight left_through = mean_field(beam, f, candidate.role, cos_incidence, Lobe::transmission);
    scattered += transmitted.power() - left_through.power();
    send(std::move(through), candidate.plane, -against,
         refracted(from.direction, against, ratio, cos_incidence, f.cos_refracted), left_through, !from.inside);
  }
  if (scattered > 0.0) book_scattered(beam, candidate.plane, transmission_of(beam) * scattered);
  keep_phases(beam, candidate, f, cos_incidence, Lobe::reflection);
  send(std::move(beam), candidate.plane, against, mirrored(from.direction, against), left, from.inside);
}

/// Adds a scattering site, or adds the scattered power to `truncated` if sites are not collected.
/// \param beam beam that arrives; its light is expressed in the s and p axes of the facet
void BeamWalk::book_scattered(const Beam& beam, const Plane& plane, double power) {
  if (sites_ == nullptr) {
    book(Account::truncated, power);
    return;
  }
  // In an infinite part, a beam represents all its periodic copies, and all copies scatter light identically. A single
  // scattering site is therefore sufficient. It receives the total power of the copies.
  sites_->push_back({beam.corners, beam.direction, beam.light, beam.path_length, plane.normal,
                     place_count_ * beam.share, place_count_ * power, beam.inside,
                     setup_.infinite() ? nullptr : beam.places});
}

/// Records that the beam meets a facet with a texture or a form, if the phases of the facet are needed later.
/// \param beam beam that arrives at the facet
void BeamWalk::keep_phases(Beam& beam, const Candidate& candidate, const materials::FresnelCoefficients& f,
                           double cos_incidence, Lobe lobe) const {
  const bool has_texture = policy_.keeps_phases && !setup_.optics.is_smooth();
  const bool has_form = candidate.middle_mm && !setup_.optics.facet_form.is_plane();
  if (candidate.role != FacetRole::retro_facet || !(has_texture || has_form)) return;
  TexturedHit hit;
  hit.plane = candidate.plane;
  if (has_texture) hit.phase = phase_texture(setup_.optics, beam.inside, cos_incidence, lobe);
  if (has_form) {
    hit.frame = FacetFrame(hit.plane.normal, hit.plane.offset_mm, *candidate.middle_mm);
    // The path difference per height is the normal component of the wave vector before the facet minus that after the
    // facet, in units of the vacuum wave number.
    const double before = index_at(beam.inside) * cos_incidence;
    const double behind = lobe == Lobe::reflection ? -before : index_at(!beam.inside) * f.cos_refracted;
    hit.path_per_height = (beam.inside ? 1.0 : -1.0) * (before - behind);
  }
  beam.hits.push_back(hit);
}

CoherentLight BeamWalk::mean_field(const Beam& beam, const materials::FresnelCoefficients& f, FacetRole role,
                                   double cos_incidence, Lobe lobe) const {
  const auto passed = [&](const materials::FresnelCoefficients& by) {
    return lobe == Lobe::reflection ? beam.light.reflected(by) : beam.light.transmitted(by);
  };
  if (role != FacetRole::retro_facet || setup_.optics.is_smooth() || policy_.keeps_phases) return passed(f);
  CoherentLight light = passed(raytrace::mean_field(setup_.optics, beam.inside, cos_incidence, f));
  light.scale(mean_field_share(setup_.optics, beam.inside, cos_incidence, lobe));
  return light;
}

void BeamWalk::meet_hull(const Beam& from, const Frame& frame, const FlatPolygon& piece, double share,
                         const Plane& plane, FacetRole role) {
  Beam beam = arrived(from, frame, piece, share, plane);
  if (role == FacetRole::border_wall && setup_.optics.absorbing_walls) {
    book(Account::absorbed, power_of(beam));
    return;
  }
  const bool is_entrance = role == FacetRole::entrance;
  const Vec3 against = -plane.normal;
  const double cos_incidence = plane.normal.dot(from.direction);
  const double ratio = role == FacetRole::border_wall ? setup_.optics.ratio_at_back(true) : setup_.optics.index;
  const materials::FresnelCoefficients f =
      is_entrance ? fresnel_at_entrance(setup_.optics, true, cos_incidence) : materials::fresnel(ratio, cos_incidence);
  const Vec3 out = refracted(from.direction, against, ratio, cos_incidence, f.cos_refracted);
  beam.light.turn_to(from.direction, against);
  if (is_entrance && setup_.optics.lossless_entrance) {
    if (f.total_reflection)
      tally_.returned.back().i += place_count_ * power_of(beam);
    else
      leave_through_entrance(beam, beam.light, out);
    return;
  }
  const CoherentLight through = beam.light.transmitted(f);
  const CoherentLight reflected = beam.light.reflected(f);
  if (is_entrance)
    book(Account::absorbed,
         transmission_of(beam) * absorbed_at_entrance(setup_.optics, beam.light, reflected, through));
  if (!f.total_reflection) {
    if (is_entrance)
      leave_through_entrance(beam, through, out);
    else
      book(account_of_exit(role), transmission_of(beam) * through.power());
  }
  send(std::move(beam), plane, against, mirrored(from.direction, against), reflected, true);
}

/// Records light that leaves through the entrance face.
/// \param direction direction of the light in air
void BeamWalk::leave_through_entrance(const Beam& beam, const CoherentLight& light, const Vec3& direction) {
  const std::size_t cone = setup_.cone_of(direction);
  const Stokes stokes = transmission_of(beam) * seen_from_above(light, direction);
  tally_.returned[cone] += place_count_ * stokes;
  if (!observer_) return;
  ReturnedBeam returned = returned_beam(beam, light, direction);
  returned.stokes = stokes;
  returned.efficiency = stokes.i / beam.share;
  returned.cone = cone;
  observer_(returned);
}

/// Returns the description of a returned beam for the observer, without its power and cone.
ReturnedBeam BeamWalk::returned_beam(const Beam& beam, CoherentLight light, const Vec3& direction) const {
  ReturnedBeam returned;
  returned.direction = direction;
  returned.depth = beam.depth;
  for (const Vec3& p : beam.corners) {
    returned.entered_mm.push_back(beam.entry.of(p));
    returned.left_mm.push_back(p.head<2>() + centre_mm_);
  }
  returned.entry_from_exit.linear() = beam.entry.slope.leftCols<2>();
  returned.entry_from_exit.translation() = beam.entry.of({0.0, 0.0, setup_.thickness_mm}) - centre_mm_;
  returned.index = setup_.optics.index;
  // An odd number of reflections reverses the orientation of the polygon.
  for (geometry::Polygon* polygon : {&returned.entered_mm, &returned.left_mm})
    if (geometry::area(*polygon) < 0.0) std::reverse(polygon->begin(), polygon->end());
  light.turn_to_axis(direction, source_axis(direction));
  returned.jones = light.jones;
  returned.transmission = transmission_of(beam);
  // The phase is continuous across the face. It is referred to the plane of the face.
  returned.phase_mm = beam.phase_mm + setup_.optics.index * beam.direction.z() * setup_.thickness_mm;
  returned.replicate = replicate_;
  returned.centre_mm = centre_mm_;
  returned.trail = beam.trail;
  returned.places = beam.places;
  returned.hits = beam.hits;
  return returned;
}

void BeamWalk::observe_front() const {
  ReturnedBeam front;
  front.direction = setup_.entry.front_direction;
  front.stokes = setup_.entry.front;
  front.efficiency = front.stokes.i;
  front.cone = setup_.entry.front_cone;
  front.jones = setup_.entry.front_jones;
  front.transmission = 1.0;
  front.centre_mm = centre_mm_;
  if (!setup_.infinite()) front.left_mm = part_.outline;
  observer_(front);
}

void BeamWalk::fail_on_budget() const {
  throw TraceBudgetError(
      fmt::format("the budget of {} beams ran out with {:.3g} of the power not accounted for; a larger {} follows "
                  "fewer beams",
                  policy_.max_beams, open_power(), reference({"cutoff"})));
}

}  // namespace retrace::raytrace
