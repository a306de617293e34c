// Paths through shells, the separate lenses in front of a part. These member functions of PathWalker are not used for
// parts without shells.
#include <algorithm>

#include "raytrace/paths/path_tracer.h"

namespace retrace::raytrace {

/// Traces a path through all shells, and adds the losses in the shells to the accounts. Returns true if the path passes
/// all shells.
bool PathWalker::pass_shells(ShellPassage passage, State& state) {
  const Vec3 middle(0.0, 0.0, setup_.middle_height_mm);
  ShellRay ray{state.position - middle, state.direction, state.light};
  ShellLosses losses;
  const bool is_through = raytrace::pass_shells(setup_.optics.shells, passage, ray, losses);
  tally_.add(losses, passage == ShellPassage::to_part ? Account::transmitted : Account::returned_elsewhere);
  state.position = ray.position_mm + middle;
  state.direction = ray.direction;
  state.light = ray.light;
  return is_through;
}

/// Starts a path of the incident beam in front of shells that change its direction.
/// \param start_mm point of the LitRegion, in which the incident beam starts
void PathWalker::enter_through_shells(const Vec2& start_mm) {
  State state;
  state.position = {start_mm.x(), start_mm.y(), setup_.middle_height_mm + setup_.lit_region->height_mm()};
  state.direction = -setup_.to_source;
  state.light = setup_.incident;
  state.inside = false;
  if (!pass_shells(ShellPassage::to_part, state)) return;
  const double face_mm = setup_.entrance_face != nullptr ? setup_.entrance_face->highest_mm() : setup_.thickness_mm;
  const double to_face = (face_mm - state.position.z()) / state.direction.z();
  const Vec3 on_face = state.position + to_face * state.direction;
  const bool is_beside = std::any_of(setup_.sides.begin(), setup_.sides.end(), [&](const PathSetup::Side& side) {
    return side.normal.dot(on_face) > side.offset_mm;
  });
  if (is_beside || !(state.direction.z() < 0.0)) {
    finish(state, Account::transmitted);
    return;
  }
  if (setup_.entrance_face == nullptr) {
    state.position = {on_face.x(), on_face.y(), face_mm};
    arrive_at_entrance(state);
    return;
  }
  // If a shell extends below the highest point of the entrance surface, the path starts at the shell.
  if (to_face > 0.0) state.position = on_face;
  state.above = true;
  pending_.push_back(state);
}

/// Traces a ray from outside through the shells if it starts in front of them.
PathWalker::ShellEntry PathWalker::enter_shells(State& state) {
  const Shells& shells = setup_.optics.shells;
  const Vec3 from = state.position - Vec3(0.0, 0.0, setup_.middle_height_mm);
  if (shells.empty() || !is_in_front(shells.front().outer, from)) return ShellEntry::outside;
  if (!meets(shells.front().outer, from, state.direction)) return ShellEntry::outside;
  return pass_shells(ShellPassage::to_part, state) ? ShellEntry::passed : ShellEntry::stopped;
}

/// Returns the state of light that has left through the entrance face, after it has passed all shells. Returns nothing
/// if it does not pass.
std::optional<PathWalker::State> PathWalker::beyond_shells(const State& state, const Light& light,
                                                           const Vec3& direction) {
  State outside = state;
  outside.light = light;
  outside.direction = direction;
  if (!pass_shells(ShellPassage::from_part, outside)) return std::nullopt;
  return outside;
}

}  // namespace retrace::raytrace
