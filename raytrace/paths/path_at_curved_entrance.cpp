// Paths at a curved entrance face. These member functions of PathWalker are not used for plane entrance faces.
#include <limits>

#include "raytrace/paths/path_tracer.h"

namespace retrace::raytrace {

/// Starts a path on the plane that touches the curved entrance face from above. The beam crosses this plane inside the
/// part's outline. The plane is inclined if the face is inclined.
void PathWalker::enter_entrance_face(const Vec2& entry_mm) {
  State state;
  state.position = {entry_mm.x(), entry_mm.y(), setup_.entrance_face->beam_height_mm(entry_mm)};
  state.direction = -setup_.to_source;
  state.light = setup_.incident;
  state.inside = false;
  state.above = true;
  if (setup_.stops.passes_mount(state.position, setup_.to_source))
    pending_.push_back(state);
  else
    finish(state, Account::stopped);
}

/// Returns the distance to the curved entrance face from inside, or `limit` if the path does not meet it before.
double PathWalker::reach_entrance_face(const State& state, double limit, Step& step) const {
  const auto met =
      setup_.entrance_face->first_hit({state.position, state.direction, state.entrance_source, true, limit});
  if (!met) return limit;
  step.end = End::entrance;
  step.hit = met->hit;
  step.entrance_normal = met->normal;
  return met->hit.t;
}

/// Traces a path in the air above the curved entrance face. It enters the part again or leaves. The outline of the part
/// is convex, so that light that leaves the space above it does not come back.
bool PathWalker::advance_above(State& state) {
  const auto met = setup_.entrance_face->first_hit(
      {state.position, state.direction, state.entrance_source, false, std::numeric_limits<double>::infinity()});
  if (!met) return leave_entrance_face(state);
  if (!setup_.is_far_from_sides(state.position + met->hit.t * state.direction)) {
    Step unused;
    if (reach_side(state, met->hit.t, unused) < met->hit.t) return leave_entrance_face(state);
  }
  state.position += met->hit.t * state.direction;
  return meet_entrance_face(state, met->hit, met->normal);
}

bool PathWalker::meet_entrance_face(State& state, const SurfaceHit& hit, const Vec3& normal) {
  if (is_on_chamfer(state.position)) return finish(state, Account::stopped);
  const bool from_inside = state.inside;
  const bool is_first = state.entrance_source == FacetRef{} && !from_inside;
  const Vec3 against = from_inside ? Vec3(-normal) : normal;
  const double cos_incidence = std::max(0.0, -against.dot(state.direction));
  const double ratio = from_inside ? setup_.optics.index : 1.0 / setup_.optics.index;
  const materials::FresnelCoefficients f = fresnel_at_entrance(setup_.optics, from_inside, cos_incidence);
  state.light.rotate_basis_to_interface(state.direction, against);
  state.source = {};
  state.entrance_source = hit.facet;
  const bool is_lossless = setup_.optics.lossless_entrance;
  if (is_lossless && f.total_reflection) {
    returned(state).back().i += state.light.power();
    return false;
  }
  Light reflected = is_lossless ? Light{Stokes{}, state.light.s_axis} : state.light.reflected(f);
  Light transmitted = is_lossless ? state.light : state.light.transmitted(f);
  if (!is_lossless)
    tally_.other[Account::absorbed] += absorbed_at_entrance(setup_.optics, state.light, reflected, transmitted);
  // Both branches of the first surface are traced, as at a plane entrance face.
  const Branch branch =
      is_first && splits_at_first_interface_ && !is_lossless ? Branch::both : choose(reflected, transmitted);
  return continue_with(state, branch, reflected, against, [&](State& through) {
    through.light = transmitted;
    through.direction = refracted(through.direction, against, ratio, cos_incidence, f.cos_refracted);
    through.inside = !from_inside;
    through.above = from_inside;
    through.entered = true;
  });
}

bool PathWalker::leave_entrance_face(const State& state) {
  if (state.entrance_source == FacetRef{})
    return finish(state, Account::transmitted);  // in this case, the light has never met the part
  if (state.entered) {
    leave(state, state.light, state.direction);
    return false;
  }
  send_back(state, state.light, state.direction);
  return false;
}

}  // namespace retrace::raytrace
