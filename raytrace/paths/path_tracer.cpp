#include "raytrace/paths/path_tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/infinity.h"
#include "geometry/part/chosen_elements.h"
#include "raytrace/faces/formed_facet.h"

namespace retrace::raytrace {
namespace {

using geometry::FacetRole;

// Maximum number of tiles (regions of an infinite surface, see PathSetup::tile_half_mm) that a straight ray may
// cross. A ray that crosses more tiles counts as trapped.
constexpr int kMaxWraps = 1000;
// Maximum number of reflections in mirrors_to_entrance(). Paths in prisms and cube corners have at most three.
constexpr int kMaxMirrors = 8;

// Throws the error for a ray that splits into too many paths. Without a cut-off, and if every branch is traced, a ray
// splits without end.
[[noreturn]] void fail_on_segments(std::uint64_t max_segments) {
  throw BudgetError(
      fmt::format("the paths of one ray have more than {} segments: use a larger {}, or a larger {} of retrace rays",
                  max_segments, reference({"cutoff"}), reference({"split"})));
}

}  // namespace

PathSetup::PathSetup(const geometry::Part& part, const BackSurface& back, const Vec2& centre, const Optics& how,
                     const Illumination& illumination, const std::vector<double>& cones_deg, const PathPolicy& paths,
                     const EntranceFace* curved)
    : LightSetup(part, centre, how, illumination, cones_deg),
      surface(back),
      entrance_face(curved),
      policy(paths),
      centre_mm(centre),
      clearance_mm(part.top_mm + std::min(0.01 * part.element_depth_mm, 0.5 * (part.thickness_mm - part.top_mm))) {
  if (part.period_mm) {
    period_mm = *part.period_mm;
    // On each side, the tile is one period smaller than the stored surface, because the outermost cells do not fill
    // their periods.
    tile_half_mm = (part.periods_beyond - 0.5) * period_mm;
  }
  if (!sides.empty()) {
    inner_half_mm = 0.5 * geometry::bounding_box(part.outline).size();
    double scale = 1.0;
    for (const Side& side : sides)
      scale = std::min(scale, side.offset_mm / side.normal.head<2>().cwiseAbs().dot(inner_half_mm));
    inner_half_mm *= std::max(0.0, scale * (1.0 - 1e-9));
  }
  if (how.entrance.scatters()) contaminated_entrance.emplace(how);
  if (!how.shells.empty()) middle_height_mm = curved != nullptr ? curved->middle_height_mm() : thickness_mm;
  if (deflect(how.shells))
    lit_region.emplace(how.shells, to_source, geometry::moved(part.outline, -centre),
                       (curved != nullptr ? curved->highest_mm() : thickness_mm) - middle_height_mm);
  for (const geometry::Polygon& piece : part.entrance_pieces)
    entrance_pieces.push_back(geometry::moved(piece, -centre));
  // The top is at the same height as the entrance face.
  if (!entrance_pieces.empty()) clearance_mm = top_mm + 0.01 * part.element_depth_mm;
}

bool PathSetup::is_over_piece(const Vec2& position_mm, double min_distance_mm) const {
  return std::ranges::any_of(entrance_pieces, [&](const geometry::Polygon& piece) {
    return geometry::contains(piece, position_mm, -min_distance_mm);
  });
}

void PathWalker::trace(const Vec2& entry_mm, RandomKey key, std::uint32_t replicate, std::uint32_t sample) {
  begin(key, replicate, sample);
  enter(entry_mm);
  follow_pending();
}

void PathWalker::resume(const Vec3& position, const Ray& ray, RandomKey key, std::uint32_t replicate,
                        std::uint32_t sample, std::uint32_t& choices) {
  begin(key, replicate, sample, choices);
  State& state = pending_.emplace_back();
  static_cast<Ray&>(state) = ray;
  state.position = position;
  follow_pending();
  choices = choices_;
}

std::optional<Eigen::Matrix3d> PathWalker::mirrors_to_entrance(const Vec3& position, const Vec3& direction) const {
  State state;
  state.position = position;
  state.direction = direction;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (int mirrors = 0; mirrors <= kMaxMirrors; ++mirrors) {
    const Step step = setup_.infinite() ? step_inside_periodic(state) : step_inside(state);
    if (step.end == End::entrance) return turn;
    if (step.end != End::facet && step.end != End::side) return std::nullopt;
    const bool is_side = step.end == End::side;
    const Vec3 normal = is_side ? setup_.sides[step.side].normal : setup_.surface.facet(step.hit.facet).normal;
    state.source = is_side ? FacetRef{} : step.hit.facet;
    state.direction = mirrored(state.direction, normal);
    turn -= 2.0 * normal * (normal.transpose() * turn);
  }
  return std::nullopt;
}

void PathWalker::begin(RandomKey key, std::uint32_t replicate, std::uint32_t sample, std::uint32_t choices) {
  key_ = key;
  replicate_ = replicate;
  sample_ = sample;
  choices_ = choices;
  to_source_ = setup_.to_source;
  splits_at_first_interface_ = true;
}

void PathWalker::follow_pending() {
  std::uint64_t segments = 0;
  while (!pending_.empty()) {
    State state = pending_.back();
    pending_.pop_back();
    while (advance(state))
      if (++segments > setup_.policy.max_segments) fail_on_segments(setup_.policy.max_segments);
  }
}

void PathWalker::enter(const Vec2& entry_mm) {
  if (setup_.lit_region) return enter_through_shells(entry_mm);
  tally_.add(setup_.arrival_losses, Account::transmitted);
  if (setup_.entrance_face != nullptr) return enter_entrance_face(entry_mm);
  State state;
  state.position = {entry_mm.x(), entry_mm.y(), setup_.thickness_mm};
  if (!setup_.stops.reaches(state.position, setup_.to_source)) {
    tally_.other[Account::stopped] += setup_.incident.power();
    return;
  }
  if (setup_.contaminated_entrance) {
    static_cast<Ray&>(state) = {-setup_.to_source, setup_.incident, false, false};
    return enter_contaminated(state);
  }
  const LightSetup::Entry& entry = setup_.entry;
  tally_.other[Account::absorbed] += entry.absorbed;
  tally_.add(entry.reflected_losses, Account::returned_elsewhere);
  if (setup_.stops.passes_mount(state.position, entry.reflected_direction)) {
    tally_.entrance_reflected[entry.reflected_cone] += entry.reflected;
    if (setup_.score != nullptr) setup_.score->add(entry.reflected_direction, entry.reflected.i, tally_.score);
  } else {
    tally_.other[Account::stopped] += entry.reflected.i;
  }
  state.direction = entry.direction;
  state.light = entry.light;
  pending_.push_back(state);
}

/// Traces a path to the next interface and processes the interface. Returns false if the path has ended.
bool PathWalker::advance(State& state) {
  const double power = state.light.power();
  if (power < setup_.policy.cutoff || state.events++ >= setup_.policy.max_events)
    return finish(state, Account::truncated);
  ++tally_.segments;
  if (state.above) return advance_above(state);
  const Step step = state.inside ? (setup_.infinite() ? step_inside_periodic(state) : step_inside(state))
                                 : (setup_.infinite() ? step_outside_periodic(state) : step_outside(state));
  if (state.inside && setup_.optics.absorption_per_mm > 0.0 && step.end != End::miss) {
    const double kept = std::exp(-setup_.optics.absorption_per_mm * step.length_mm);
    tally_.other[Account::absorbed] += power * (1.0 - kept);
    state.light.scale(kept);
  }
  switch (step.end) {
    case End::facet: return meet_facet(state, step.hit);
    case End::entrance:
      return setup_.entrance_face == nullptr ? meet_entrance(state)
                                             : meet_entrance_face(state, step.hit, step.entrance_normal);
    case End::side: return meet_side(state, setup_.sides[step.side].normal);
    case End::escape: return escape(state);
    case End::trapped: return finish(state, Account::truncated);
    case End::miss: break;
  }
  ++tally_.misses;
  return finish(state, Account::lost);
}

std::optional<SurfaceHit> PathWalker::search(const State& state, double t_max) const {
  return setup_.surface.first_hit({state.position, state.direction, state.source, state.inside, t_max});
}

/// Returns the first facet on a path that must meet the back surface, because it would otherwise leave the bounds of
/// the part. If rounding has left a gap between two facets, facets are slightly enlarged.
std::optional<SurfaceHit> PathWalker::search_certainly(const State& state) const {
  return setup_.surface.first_hit_with_tolerance(
      {state.position, state.direction, state.source, state.inside, kInfinity});
}

/// Finds the nearest face on a path inside a finite part: the entrance face, the back surface or a side. The back
/// surface is tested first, then a curved entrance face, and the sides last. Most paths then meet a nearer face before
/// the later tests, so that these tests can be skipped.
PathWalker::Step PathWalker::step_inside(State& state) const {
  Step step;
  double limit = kInfinity;
  if (state.direction.z() > 0.0 && setup_.entrance_face == nullptr) {
    limit = (setup_.thickness_mm - state.position.z()) / state.direction.z();
    step.end = End::entrance;
  }
  // Above the height `clearance_mm`, only descending rays can meet the back surface. The search starts at this height.
  double skipped = 0.0;
  SurfaceRay ray{state.position, state.direction, state.source, true, limit};
  if (state.position.z() > setup_.clearance_mm) {
    skipped = state.direction.z() < 0.0 ? (state.position.z() - setup_.clearance_mm) / -state.direction.z() : kInfinity;
    if (skipped < limit) {
      ray.origin += skipped * state.direction;
      ray.source = {};
    }
  }
  const auto take_facet = [&](const std::optional<SurfaceHit>& hit) {
    step.end = hit ? End::facet : End::miss;
    if (!hit) return;
    step.hit = *hit;
    limit = skipped + hit->t;
  };
  if (skipped < limit) {
    ray.t_max = limit - skipped;
    if (const auto hit = setup_.surface.first_hit(ray)) take_facet(hit);
  }
  if (setup_.entrance_face != nullptr) limit = reach_entrance_face(state, limit, step);
  if (!setup_.is_far_from_sides(state.position + limit * state.direction)) limit = reach_side(state, limit, step);
  if (step.end != End::facet && skipped < limit) {
    const double end_z = ray.origin.z() + (limit - skipped) * state.direction.z();
    ray.t_max = kInfinity;
    if (step.end == End::miss || end_z < setup_.below_surface_mm())
      take_facet(setup_.surface.first_hit_with_tolerance(ray));
  }
  if (skipped < limit) {
    state.position = ray.origin;
    state.source = ray.source;
  } else {
    skipped = 0.0;
  }
  if (step.end != End::miss) state.position += (limit - skipped) * state.direction;
  step.length_mm = limit;
  return step;
}

/// Finds the nearest side of a finite part within the distance `limit`. Returns the distance to this side, or `limit`
/// if there is none.
double PathWalker::reach_side(const State& state, double limit, Step& step) const {
  for (std::size_t k = 0; k < setup_.sides.size(); ++k) {
    const double towards = setup_.sides[k].normal.dot(state.direction);
    if (towards <= 0.0) continue;
    const double gap_mm = setup_.sides[k].offset_mm - setup_.sides[k].normal.dot(state.position);
    if (gap_mm >= limit * towards) continue;
    limit = std::max(gap_mm / towards, 0.0);
    step.end = End::side;
    step.side = k;
  }
  return limit;
}

/// Finds the next face inside an infinite part. Positions are moved into the central period, so that only the surface
/// near this period is needed.
PathWalker::Step PathWalker::step_inside_periodic(State& state) const {
  Step step;
  const double dz = state.direction.z();
  const auto move = [&](double t) {
    state.position += t * state.direction;
    step.length_mm += t;
  };
  for (int wraps = 0; wraps < kMaxWraps; ++wraps) {
    if (state.position.z() >= setup_.clearance_mm * (1.0 - 1e-9)) {
      if (dz > 0.0) {
        move((setup_.thickness_mm - state.position.z()) / dz);
        wrap(state);
        step.end = End::entrance;
        return step;
      }
      if (dz == 0.0) break;  // a horizontal ray never leaves the plate
      if (state.position.z() > setup_.clearance_mm) {
        move((state.position.z() - setup_.clearance_mm) / -dz);
        wrap(state);
      }
    }
    const double up = dz > 0.0 ? (setup_.clearance_mm - state.position.z()) / dz : kInfinity;
    const double limit = std::min(up, distance_to_tile_border(state));
    auto hit = search(state, limit);
    const bool falls_through = state.position.z() + limit * dz < setup_.below_surface_mm();
    if (!hit && falls_through) hit = search_certainly(state);
    if (hit) {
      move(hit->t);
      step.end = End::facet;
      step.hit = *hit;
      return step;
    }
    if (falls_through) return step;
    move(limit);
    if (up > limit) wrap(state);
  }
  step.end = End::trapped;
  return step;
}

/// Finds the next facet in the air below a finite part. Without a facet, the ray escapes.
PathWalker::Step PathWalker::step_outside(State& state) const {
  Step step;
  auto hit = search(state, kInfinity);
  if (!hit && state.direction.z() > 0.0 &&
      is_over_part(state.position + (setup_.top_mm - state.position.z()) / state.direction.z() * state.direction)) {
    // The ray would enter the plate from below. It must therefore meet the surface.
    hit = search_certainly(state);
    if (!hit) return step;
  }
  step.end = hit ? End::facet : End::escape;
  if (!hit) return step;
  step.hit = *hit;
  state.position += hit->t * state.direction;
  return step;
}

PathWalker::Step PathWalker::step_outside_periodic(State& state) const {
  Step step;
  const Vec3 start = state.position;
  const Vec2 start_shift = state.shift_mm;
  const double dz = state.direction.z();
  for (int wraps = 0; wraps < kMaxWraps; ++wraps) {
    const double down =
        dz < 0.0 ? std::max(0.0, (state.position.z() + setup_.depth_mm + setup_.clearance_mm) / -dz) : kInfinity;
    const double up = dz > 0.0 ? std::max(0.0, (setup_.clearance_mm - state.position.z()) / dz) : kInfinity;
    const double border = distance_to_tile_border(state);
    const double limit = std::min({down, up, border});
    auto hit = search(state, limit);
    if (!hit && limit == up) hit = search_certainly(state);
    if (hit) {
      state.position += hit->t * state.direction;
      step.end = End::facet;
      step.hit = *hit;
      return step;
    }
    if (limit == up) return step;
    if (limit == down) {
      step.end = End::escape;
      state.position = start;  // the ray leaves from its starting point
      state.shift_mm = start_shift;
      return step;
    }
    state.position += limit * state.direction;
    wrap(state);
  }
  step.end = End::trapped;
  return step;
}

double PathWalker::distance_to_tile_border(const State& state) const {
  double least = kInfinity;
  for (const Eigen::Index axis : {0, 1}) {
    const double d = state.direction[axis];
    if (d != 0.0)
      least = std::min(least, ((d > 0.0 ? 1.0 : -1.0) * setup_.tile_half_mm[axis] - state.position[axis]) / d);
  }
  return std::max(least, 0.0);
}

/// Moves a position by whole periods into the central period. `source` is reset, because the facet that the path has
/// left is in a different period.
void PathWalker::wrap(State& state) const {
  for (const Eigen::Index axis : {0, 1}) {
    const double by = setup_.period_mm[axis] * std::floor(state.position[axis] / setup_.period_mm[axis] + 0.5);
    state.position[axis] -= by;
    state.shift_mm[axis] += by;
  }
  state.source = {};
}

bool PathWalker::is_over_part(const Vec3& position) const {
  if (!setup_.entrance_pieces.empty())
    return setup_.is_over_piece(position.head<2>(), setup_.clearance_mm - setup_.top_mm);
  return std::all_of(setup_.sides.begin(), setup_.sides.end(), [&](const PathSetup::Side& side) {
    return side.normal.dot(position) < side.offset_mm - setup_.clearance_mm;
  });
}

bool PathWalker::meet_entrance(State& state) {
  state.position.z() = setup_.thickness_mm;
  if (is_on_chamfer(state.position)) return finish(state, Account::stopped);
  if (setup_.contaminated_entrance) return meet_contaminated_entrance(state);
  const Vec3 down = -Vec3::UnitZ();
  const double cos_incidence = state.direction.z();
  const materials::FresnelCoefficients f = fresnel_at_entrance(setup_.optics, true, cos_incidence);
  const Vec3 out = refracted(state.direction, down, setup_.optics.index, cos_incidence, f.cos_refracted);
  state.light.rotate_basis_to_interface(state.direction, down);
  if (setup_.optics.lossless_entrance) {
    if (f.total_reflection)
      returned(state).back().i += state.light.power();
    else
      leave(state, state.light, out);
    return false;
  }
  Light reflected = state.light.reflected(f);
  Light transmitted = state.light.transmitted(f);
  tally_.other[Account::absorbed] += absorbed_at_entrance(setup_.optics, state.light, reflected, transmitted);
  const Branch branch = choose(reflected, transmitted);
  if (branch != Branch::reflected) leave(state, transmitted, out);
  state.light = reflected;
  state.direction = mirrored(state.direction, down);
  state.source = {};
  return branch != Branch::transmitted;
}

/// Traces light from the entrance face past the mount and through all shells. Records the light that neither mount nor
/// shells block.
/// \param record member function that records the light
void PathWalker::record_outside(Record record, const State& state, const Light& light, const Vec3& direction) {
  if (!setup_.stops.passes_mount(state.position, direction)) {
    tally_.other[Account::stopped] += light.power();
    return;
  }
  if (!setup_.optics.shells.empty()) {
    const std::optional<State> outside = beyond_shells(state, light, direction);
    if (outside) (this->*record)(*outside, outside->light, outside->direction);
  } else {
    (this->*record)(state, light, direction);
  }
}

/// Records light that leaves through the entrance face.
/// \param state position of the light on the face
/// \param direction direction of the light in air
void PathWalker::leave(const State& state, const Light& light, const Vec3& direction) {
  record_outside(&PathWalker::record_return, state, light, direction);
}

/// Records light that leaves through the entrance face and through all shells.
void PathWalker::record_return(const State& state, const Light& light, const Vec3& direction) {
  const std::size_t cone = setup_.cone_of(direction, to_source_);
  returned(state)[cone] += in_source_axes(light, direction);
  const Account outside = state.scattered ? Account::scattered_out : Account::returned_elsewhere;
  report_exit(cone < setup_.cone_chord2.size() ? Account::retroreflected : outside, state, direction, light);
  if (setup_.score != nullptr) setup_.score->add(direction, light.power(), tally_.score);
}

/// Records light that the entrance face reflects before the light enters the part.
void PathWalker::send_back(const State& state, const Light& light, const Vec3& direction) {
  record_outside(&PathWalker::record_front_reflection, state, light, direction);
}

/// Records light that the entrance face has reflected and that has left through all shells.
void PathWalker::record_front_reflection(const State& state, const Light& light, const Vec3& direction) {
  const std::size_t cone = setup_.cone_of(direction, to_source_);
  (state.scattered ? tally_.scattered : tally_.entrance_reflected)[cone] += in_source_axes(light, direction);
  const Account outside = state.scattered ? Account::scattered_out : Account::front_specular;
  report_exit(cone < setup_.cone_chord2.size() ? Account::retroreflected : outside, state, direction, light, true);
  if (setup_.score != nullptr) setup_.score->add(direction, light.power(), tally_.score);
}

/// Reports light that leaves the part at the position of `state` to the observer.
void PathWalker::report_exit(Account account, const State& state, const Vec3& direction, const Light& light,
                             bool is_front_reflection) const {
  if (observer_ != nullptr)
    observer_->on_exit({account, state.position, direction, light, state.shift_mm, is_front_reflection});
}

/// Returns the optics of the element to which a facet belongs. They differ from those of other elements if the back of
/// the element is wet (WetBack).
const Optics& PathWalker::optics_of(const FacetRef& facet) const {
  const WetBack* const wet = setup_.optics.wet.get();
  return wet != nullptr && wet->elements->has(facet.placement, facet.facet) ? wet->optics : setup_.optics;
}

const Optics& PathWalker::optics_of_wall(const Vec3& position) const {
  const WetBack* const wet = setup_.optics.wet.get();
  return wet != nullptr && wet->elements->has_wall_at(position.head<2>() + setup_.centre_mm) ? wet->optics
                                                                                             : setup_.optics;
}

/// Splits light that meets a side of the plate or a border wall, and chooses the branches that are followed.
/// \param ratio n on the side of the light over n on the other side
PathWalker::SplitLight PathWalker::split_at_side(State& state, const Vec3& normal, double ratio, double cos_incidence) {
  const materials::FresnelCoefficients f = materials::fresnel(ratio, cos_incidence);
  state.light.rotate_basis_to_interface(state.direction, normal);
  Light reflected = state.light.reflected(f);
  Light transmitted = state.light.transmitted(f);
  const Branch branch = choose(reflected, transmitted);
  return {f, reflected, transmitted, branch};
}

bool PathWalker::meet_side(State& state, const Vec3& normal) {
  const bool is_border_wall = state.position.z() < 0.0;
  const Optics& optics = is_border_wall ? optics_of_wall(state.position) : setup_.optics;
  if (is_border_wall && optics.absorbing_walls) return finish(state, Account::absorbed);
  const double ratio = is_border_wall ? optics.ratio_at_back(true) : optics.index;
  const double cos_incidence = normal.dot(state.direction);
  const auto [f, reflected, transmitted, branch] = split_at_side(state, normal, ratio, cos_incidence);
  // The outline of the part is convex. Light that leaves through a side therefore never comes back.
  if (branch != Branch::reflected) {
    tally_.other[Account::side_exit] += transmitted.power();
    if (observer_ != nullptr)
      report_exit(Account::side_exit, state, refracted(state.direction, -normal, ratio, cos_incidence, f.cos_refracted),
                  transmitted);
  }
  state.light = reflected;
  state.direction = mirrored(state.direction, normal);
  state.source = {};
  state.entrance_source = {};
  return branch != Branch::transmitted;
}

bool PathWalker::meet_facet(State& state, const SurfaceHit& hit) {
  const ExactSurface::Facet& facet = setup_.surface.facet(hit.facet);
  const Optics& optics = optics_of(hit.facet);
  const bool is_wall = facet.role == FacetRole::inner_wall || facet.role == FacetRole::border_wall;
  if (is_wall && optics.absorbing_walls) return finish(state, Account::absorbed);
  const bool is_retro = facet.role == FacetRole::retro_facet;
  state.source = hit.facet;
  state.entrance_source = {};
  const bool is_formed = is_retro && facet.centroid_mm && !optics.facet_form.is_plane();
  const Vec3 normal = is_formed ? normal_at(state, hit.facet) : facet.normal;
  if (is_retro && !optics.is_smooth()) return meet_textured(state, normal, facet.normal, optics);
  const Vec3 against = state.inside ? Vec3(-normal) : normal;
  const double cos_incidence = -against.dot(state.direction);
  const materials::FresnelCoefficients f = fresnel_at_back(optics, facet.role, state.inside, cos_incidence);

  state.light.rotate_basis_to_interface(state.direction, against);
  Light reflected = state.light.reflected(f);
  Light transmitted = state.light.transmitted(f);
  tally_.other[Account::absorbed] += absorbed_at_back(optics, facet.role, state.light, reflected, transmitted);
  const Branch branch = choose(reflected, transmitted);
  return continue_with(state, branch, reflected, against, [&](State& through) {
    through.light = transmitted;
    through.direction = refracted(through.direction, against, ratio_at_face(optics, facet.role, through.inside),
                                  cos_incidence, f.cos_refracted);
    if (through.inside) through.last_exit_role = facet.role;
    through.inside = !through.inside;
  });
}

/// Returns the normal of a facet with a form at the position of a path.
Vec3 PathWalker::normal_at(const State& state, const FacetRef& where) const {
  const ExactSurface::Facet& facet = setup_.surface.facet(where);
  const geometry::Placement& placement = setup_.surface.placement(where);
  const Vec3 place(placement.offset_mm.x(), placement.offset_mm.y(), placement.height_mm);
  const FacetFrame frame(facet.normal, facet.offset_mm, *facet.centroid_mm);
  return formed_normal(setup_.optics, facet.normal, frame, state.position - place, state.direction, state.inside);
}

/// Processes a path at a retro facet with texture.
/// \param normal normal of the facet including its form
/// \param plane_normal normal of the facet without its form
bool PathWalker::meet_textured(State& state, const Vec3& normal, const Vec3& plane_normal, const Optics& optics) {
  surface_models::RandomStream random(key_, replicate_, sample_, choices_++);
  TexturedReturn back = meet_textured_facet(optics, normal, state, setup_.policy.split_power, random);
  if (!optics.facet_form.is_plane()) back.mirror_to_side(plane_normal);
  tally_.other[Account::truncated] += back.truncated;
  tally_.other[Account::absorbed] += back.absorbed;
  const State before = state;
  for (std::size_t k = 0; k < back.count; ++k) {
    state = before;
    static_cast<Ray&>(state) = back.rays[k];
    if (before.inside && !state.inside) state.last_exit_role = FacetRole::retro_facet;
    if (k + 1 < back.count) pending_.push_back(state);
  }
  return back.count > 0;
}

Branch PathWalker::choose(Light& reflected, Light& transmitted) {
  return choose_branch(reflected, transmitted, setup_.policy.split_power,
                       [this] { return unit_interval(philox(key_, replicate_, sample_, choices_++)[0]); });
}

bool PathWalker::finish(const State& state, Account account) {
  tally_.other[account] += state.light.power();
  return false;
}

bool PathWalker::escape(const State& state) {
  const Account account = account_of_exit(state.last_exit_role);
  report_exit(account, state, state.direction, state.light);
  return finish(state, account);
}

}  // namespace retrace::raytrace
