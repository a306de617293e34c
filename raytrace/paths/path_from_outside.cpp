// Start of paths with any position and direction. These member functions of PathWalker are not used for the light of
// the incident beam.
#include <algorithm>

#include "core/infinity.h"
#include "raytrace/paths/path_tracer.h"

namespace retrace::raytrace {
namespace {

// Relative tolerance of starting positions: a few rounding errors of single precision, which files of rays contain.
constexpr double kStartTolerance = 0x1p-21;

/// Interval of a line inside the part's convex outline. It is empty if `enter` > `leave`.
struct Span {
  double enter = -kInfinity;
  double leave = kInfinity;
  std::size_t side = 0;  ///< side of the outline at `enter`
};

Span span_over_outline(const LightSetup& setup, const Vec3& position, const Vec3& direction) {
  Span span;
  for (std::size_t k = 0; k < setup.sides.size(); ++k) {
    const double towards = setup.sides[k].normal.dot(direction);
    const double gap = setup.sides[k].offset_mm - setup.sides[k].normal.dot(position);
    if (towards > 0.0) span.leave = std::min(span.leave, gap / towards);
    if (towards == 0.0 && gap < 0.0) span.leave = -kInfinity;
    if (towards >= 0.0 || gap / towards <= span.enter) continue;
    span.enter = gap / towards;
    span.side = k;
  }
  return span;
}

}  // namespace

bool PathWalker::launch(const Vec3& position, const Ray& ray, RandomKey key, std::uint32_t replicate,
                        std::uint32_t sample) {
  begin(key, replicate, sample);
  to_source_ = -ray.direction;
  splits_at_first_interface_ = false;
  arrival_ = Arrival::none;
  State state;
  static_cast<Ray&>(state) = ray;
  state.position = position;
  state.inside = false;
  is_shadowed_ = setup_.stops.is_in_front_of_mount(position) && !setup_.stops.passes_mount(position, ray.direction);
  const ShellEntry entry = enter_shells(state);
  if (entry == ShellEntry::stopped) return true;
  const bool meets = setup_.infinite() ? arrive_at_sheet(state) : arrive_at_body(state);
  if (meets) follow_pending();
  if (meets || entry == ShellEntry::outside) return meets;
  // The light has crossed the shells, which may have reduced its power. The remaining light passes beside the part.
  report_exit(Account::transmitted, state, state.direction, state.light);
  finish(state, Account::transmitted);
  return true;
}

double PathWalker::start_tolerance(const Vec3& position) const {
  return kStartTolerance * (position.cwiseAbs().maxCoeff() + setup_.centre_mm.cwiseAbs().maxCoeff() +
                            setup_.thickness_mm + setup_.depth_mm);
}

/// Returns the medium at a position.
/// \pre the position is inside the outline in projection along z
PathWalker::Medium PathWalker::medium_at(Vec3 position, double tolerance_mm) const {
  if (setup_.entrance_face == nullptr) {
    if (position.z() >= setup_.thickness_mm - tolerance_mm) return Medium::above;
  } else {
    const Vec3 raised = position + tolerance_mm * Vec3::UnitZ();
    const bool is_high = raised.z() >= setup_.entrance_face->highest_mm();
    if (is_high || setup_.entrance_face->first_hit({raised, -Vec3::UnitZ(), {}, false, kInfinity}))
      return Medium::above;
  }
  if (!setup_.entrance_pieces.empty() && !setup_.is_over_piece(position.head<2>(), -tolerance_mm)) return Medium::below;
  if (position.z() > setup_.top_mm) return Medium::body;
  if (position.z() < -setup_.depth_mm) return Medium::below;
  // The nearest face above the position determines the medium. The position is moved slightly inward, so that rounding
  // does not move it outside of the surface.
  if (!setup_.infinite()) position.head<2>() *= 1.0 - 1e-9;
  const auto into_body = setup_.surface.first_hit({position, Vec3::UnitZ(), {}, false, kInfinity});
  if (!into_body) return Medium::body;
  const auto out_of_body = setup_.surface.first_hit({position, Vec3::UnitZ(), {}, true, into_body->t});
  return out_of_body ? Medium::body : Medium::below;
}

/// Starts a path at a finite part. Returns false if the light misses the part; otherwise, its branches are queued.
bool PathWalker::arrive_at_body(State& state) {
  const double tolerance = start_tolerance(state.position);
  const Span span = span_over_outline(setup_, state.position, state.direction);
  const double start = std::max(span.enter, 0.0);
  if (!(span.leave - start > tolerance)) return false;
  state.position += start * state.direction;
  switch (medium_at(state.position, tolerance)) {
    case Medium::above: return arrive_from_above(state, span.leave - start, tolerance);
    case Medium::below: return arrive_from_below(state);
    case Medium::body: break;
  }
  return span.enter >= -tolerance ? arrive_at_side(state, setup_.sides[span.side].normal)
                                  : begin_inside(state, tolerance);
}

/// Starts a path at an infinite part. Returns false if the light does not meet the part.
bool PathWalker::arrive_at_sheet(State& state) {
  const double tolerance = start_tolerance(state.position);
  if (state.position.z() >= setup_.thickness_mm - tolerance) return arrive_from_above(state, kInfinity, tolerance);
  wrap(state);
  return medium_at(state.position, tolerance) == Medium::below ? arrive_from_below(state)
                                                               : begin_inside(state, tolerance);
}

/// Starts a path in the air above the part.
/// \param reach_mm distance along the path to the outline of the part
bool PathWalker::arrive_from_above(State& state, double reach_mm, double tolerance_mm) {
  if (setup_.entrance_face != nullptr) {
    state.above = true;
    const auto met = setup_.entrance_face->first_hit({state.position, state.direction, {}, false, reach_mm});
    if (!met) return false;
    if (is_shadowed_) return stop_at_mount(state);
    arrival_ = Arrival::entrance;
    state.position += met->hit.t * state.direction;
    if (meet_entrance_face(state, met->hit, met->normal)) pending_.push_back(state);
    return true;
  }
  if (!(state.direction.z() < 0.0)) return false;
  const double way = std::max(0.0, (setup_.thickness_mm - state.position.z()) / state.direction.z());
  if (way > reach_mm + tolerance_mm) return false;
  state.position += way * state.direction;
  state.position.z() = setup_.thickness_mm;
  if (setup_.infinite()) wrap(state);
  // Light beside the polygons of the entrance face enters a notch or a hole.
  if (!setup_.entrance_pieces.empty() && !setup_.is_over_piece(state.position.head<2>(), -tolerance_mm))
    return arrive_from_below(state);
  return is_shadowed_ ? stop_at_mount(state) : arrive_at_entrance(state);
}

/// Ends the path of light that the mount blocks on its way to the entrance face. Always returns true.
bool PathWalker::stop_at_mount(State& state) {
  arrival_ = Arrival::entrance;
  finish(state, Account::stopped);
  return true;
}

/// Processes light that meets the plane entrance face from the air.
bool PathWalker::arrive_at_entrance(State& state) {
  ++tally_.segments;
  arrival_ = Arrival::entrance;
  if (is_on_chamfer(state.position)) {
    finish(state, Account::stopped);
    return true;
  }
  if (setup_.contaminated_entrance) {
    enter_contaminated(state);
    return true;
  }
  const Vec3 up = Vec3::UnitZ();
  const double cos_incidence = -state.direction.z();
  const materials::FresnelCoefficients f = fresnel_at_entrance(setup_.optics, false, cos_incidence);
  const Vec3 front = mirrored(state.direction, up);
  state.light.rotate_basis_to_interface(state.direction, up);
  Branch branch = Branch::transmitted;
  if (!setup_.optics.lossless_entrance) {
    Light reflected = state.light.reflected(f);
    Light transmitted = state.light.transmitted(f);
    tally_.other[Account::absorbed] += absorbed_at_entrance(setup_.optics, state.light, reflected, transmitted);
    branch = choose(reflected, transmitted);
    if (branch != Branch::transmitted) send_back(state, reflected, front);
    state.light = transmitted;
  }
  if (branch == Branch::reflected) return true;
  state.direction = refracted(state.direction, up, 1.0 / setup_.optics.index, cos_incidence, f.cos_refracted);
  state.inside = true;
  pending_.push_back(state);
  return true;
}

/// Processes light that meets a side of the plate from outside, or the border wall below z = 0.
bool PathWalker::arrive_at_side(State& state, const Vec3& normal) {
  ++tally_.segments;
  arrival_ = Arrival::side;
  const bool is_border_wall = state.position.z() < 0.0;
  const Optics& optics = is_border_wall ? optics_of_wall(state.position) : setup_.optics;
  if (is_border_wall && optics.absorbing_walls) {
    finish(state, Account::absorbed);
    return true;
  }
  const double ratio = is_border_wall ? optics.ratio_at_back(false) : 1.0 / optics.index;
  const double cos_incidence = -normal.dot(state.direction);
  const auto [f, reflected, transmitted, branch] = split_at_side(state, normal, ratio, cos_incidence);
  if (branch != Branch::transmitted) {
    tally_.other[Account::side_exit] += reflected.power();
    report_exit(Account::side_exit, state, mirrored(state.direction, normal), reflected);
  }
  if (branch == Branch::reflected) return true;
  state.light = transmitted;
  state.direction = refracted(state.direction, normal, ratio, cos_incidence, f.cos_refracted);
  state.inside = true;
  pending_.push_back(state);
  return true;
}

/// Starts a path in the air below the back surface.
bool PathWalker::arrive_from_below(State& state) {
  const double lowest = setup_.below_surface_mm();
  if (state.position.z() < lowest) {
    if (!(state.direction.z() > 0.0)) return false;
    state.position += (lowest - state.position.z()) / state.direction.z() * state.direction;
    if (setup_.infinite()) wrap(state);
  }
  const Step step = setup_.infinite() ? step_outside_periodic(state) : step_outside(state);
  if (step.end == End::escape) return false;
  ++tally_.segments;
  arrival_ = Arrival::back;
  if (step.end == End::facet) {
    state.last_exit_role = setup_.surface.facet(step.hit.facet).role;  // role of the face that reflects the light
    if (meet_facet(state, step.hit)) pending_.push_back(state);
    return true;
  }
  if (step.end == End::miss) ++tally_.misses;
  finish(state, step.end == End::trapped ? Account::truncated : Account::lost);
  return true;
}

/// Starts a path in the body. Light that starts on a facet of the back, up to rounding, is treated as light in the air
/// that meets this facet.
bool PathWalker::begin_inside(State& state, double tolerance_mm) {
  if (const auto left = setup_.surface.first_hit({state.position, state.direction, {}, true, tolerance_mm})) {
    state.position += left->t * state.direction;
    state.source = left->facet;
    return arrive_from_below(state);
  }
  if (const auto met = setup_.surface.first_hit({state.position, -state.direction, {}, true, tolerance_mm})) {
    state.position -= met->t * state.direction;
    arrival_ = Arrival::back;
    state.last_exit_role = setup_.surface.facet(met->facet).role;
    if (meet_facet(state, *met)) pending_.push_back(state);
    return true;
  }
  arrival_ = Arrival::inside;
  state.inside = true;
  pending_.push_back(state);
  return true;
}

}  // namespace retrace::raytrace
