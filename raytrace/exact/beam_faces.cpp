#include "raytrace/exact/beam_faces.h"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <limits>
#include <utility>

#include "raytrace/exact/excerpt_light.h"
#include "raytrace/faces/textured_facet.h"

namespace retrace::raytrace {
namespace {

using geometry::FacetRole, surface_models::Lobe;

// Maximum number of steps of a nearly horizontal beam between two interfaces.
constexpr std::uint32_t kMaxLevelSteps = 1000;
// If more than this number of faces may be met, leave_hull() first discards the faces that the fragment cannot reach.
constexpr std::size_t kManyExits = 8;

/// Returns the power of a fragment at the plane where the beam starts.
double power_at_start(const BeamStep& step, const Fragment& fragment) {
  const Beam& from = step.beam;
  const Plane start{from.start.normal, from.start.normal.dot(from.corners[0])};
  const Corners corners = lifted(fragment.polygon, step.frame, Distance(step.frame, start));
  return fragment.area_fraction *
         mean_transmission(corners, from.path_length, step.scene.setup.optics.absorption_per_mm) * from.light.power();
}

/// Returns the fragment as a beam that has arrived at a plane. The power that the material absorbs up to the plane is
/// added to the ledger.
Beam arrived(const BeamStep& step, const Fragment& fragment, const Plane& plane) {
  const double absorption_per_mm = step.scene.setup.optics.absorption_per_mm;
  Beam beam = step.beam;
  beam.area_fraction = fragment.area_fraction;
  beam.depth = step.beam.depth + 1;
  beam.steps_since_interface = 0;
  beam.corners = lifted(fragment.polygon, step.frame, Distance(step.frame, plane));
  beam.transmission = mean_transmission(beam.corners, beam.path_length, absorption_per_mm);
  if (beam.inside && absorption_per_mm > 0.0)
    step.record.add_to_ledger(beam, Account::absorbed, power_at_start(step, fragment) - power_of(beam));
  return beam;
}

/// Queues a beam that starts at an interface.
/// \param ahead unit normal of the plane on the side into which the beam travels
void send(const BeamStep& step, Beam&& beam, const Plane& plane, const Vec3& ahead, const Vec3& direction,
          const CoherentLight& light, bool inside) {
  // The field is continuous on the plane. The wave vectors before and after the interface therefore differ only along
  // the normal.
  beam.phase_mm +=
      (step.scene.index_at(beam.inside) * beam.direction - step.scene.index_at(inside) * direction).dot(plane.normal) *
      plane.offset_mm;
  beam.path_length = beam.path_length.continued(plane, direction, inside ? 1.0 : 0.0);
  beam.entry = beam.entry.continued(plane, direction);
  for (TexturedHit& hit : beam.hits) hit = hit.continued(plane, direction);
  beam.start = {ahead, ahead.dot(plane.normal) * plane.offset_mm};
  beam.direction = direction;
  beam.light = light;
  beam.inside = inside;
  step.queue.push(std::move(beam));
}

/// Adds a facet with a texture or a form to Beam::hits if the phase shifts of the facet are needed later.
/// \param beam beam that arrives at the facet
void keep_phases(const BeamScene& scene, Beam& beam, const Candidate& facet, const materials::FresnelCoefficients& f,
                 double cos_incidence, Lobe lobe) {
  const Optics& optics = scene.setup.optics;
  const bool has_texture = scene.policy.keeps_phases && !optics.is_smooth();
  const bool has_form = facet.centroid_mm && !optics.facet_form.is_plane();
  if (facet.role != FacetRole::retro_facet || !(has_texture || has_form)) return;
  TexturedHit hit;
  hit.plane = facet.plane;
  if (has_texture) hit.phase = phase_texture(optics, beam.inside, cos_incidence, lobe);
  if (has_form) {
    hit.frame = FacetFrame(hit.plane.normal, hit.plane.offset_mm, *facet.centroid_mm);
    // The path difference per height is the normal component of the wave vector before the facet minus the normal
    // component after the facet, in units of the wave number in vacuum.
    const double before = scene.index_at(beam.inside) * cos_incidence;
    const double behind = lobe == Lobe::reflection ? -before : scene.index_at(!beam.inside) * f.cos_refracted;
    hit.path_per_height = (beam.inside ? 1.0 : -1.0) * (before - behind);
  }
  beam.hits.push_back(hit);
}

/// Returns the reflected or transmitted field of a beam at a facet, without the light that the texture of a retro facet
/// scatters. With BeamPolicy::keeps_phases, the scattered light is included.
CoherentLight unscattered(const BeamScene& scene, const Beam& beam, const materials::FresnelCoefficients& f,
                          FacetRole role, double cos_incidence, Lobe lobe) {
  const Optics& optics = scene.setup.optics;
  const auto passed = [&](const materials::FresnelCoefficients& by) {
    return lobe == Lobe::reflection ? beam.light.reflected(by) : beam.light.transmitted(by);
  };
  if (role != FacetRole::retro_facet || optics.is_smooth() || scene.policy.keeps_phases) return passed(f);
  CoherentLight light = passed(mean_field(optics, beam.inside, cos_incidence, f));
  light.scale(mean_field_fraction(optics, beam.inside, cos_incidence, lobe));
  return light;
}

/// Processes a fragment that meets an outer face from inside: the entrance face, a side or a border wall.
void meet_hull(const BeamStep& step, const Fragment& fragment, const Plane& plane, FacetRole role) {
  const Optics& optics = step.scene.setup.optics;
  const Vec3& direction = step.beam.direction;
  Beam beam = arrived(step, fragment, plane);
  if (role == FacetRole::border_wall && optics.absorbing_walls) {
    step.record.add_to_ledger(beam, Account::absorbed, power_of(beam));
    return;
  }
  const bool is_entrance = role == FacetRole::entrance;
  if (!is_entrance && step.scene.policy.excerpt != nullptr) {
    step.record.add_to_ledger(beam, Account::truncated, power_of(beam));
    return;
  }
  const FaceStops& stops = step.scene.setup.stops;
  if (is_entrance && stops.has_chamfer() && !step.record.keep_within(beam, stops.clear_face(), beam.light.power()))
    return;
  const Vec3 against = -plane.normal;
  const double cos_incidence = plane.normal.dot(direction);
  const double ratio = role == FacetRole::border_wall ? optics.ratio_at_back(true) : optics.index;
  const materials::FresnelCoefficients f =
      is_entrance ? fresnel_at_entrance(optics, true, cos_incidence) : materials::fresnel(ratio, cos_incidence);
  const Vec3 out = refracted(direction, against, ratio, cos_incidence, f.cos_refracted);
  beam.light.rotate_basis_to_interface(direction, against);
  if (is_entrance && optics.lossless_entrance) {
    if (f.total_reflection)
      step.record.leave_outside_cones(beam);
    else
      step.record.leave_through_entrance(beam, beam.light, out);
    return;
  }
  const CoherentLight through = beam.light.transmitted(f);
  const CoherentLight reflected = beam.light.reflected(f);
  if (is_entrance)
    step.record.add_to_ledger(beam, Account::absorbed,
                              transmission_of(beam) * absorbed_at_entrance(optics, beam.light, reflected, through));
  if (!f.total_reflection) {
    if (is_entrance)
      step.record.leave_through_entrance(beam, through, out);
    else
      step.record.add_to_ledger(beam, account_of_exit(role), transmission_of(beam) * through.power());
  }
  send(step, std::move(beam), plane, against, mirrored(direction, against), reflected, true);
}

/// Plane of the entrance face or of a side that a beam may meet.
struct Exit {
  Plane plane;
  Distance distance;
  FacetRole role;
};
using Exits = boost::container::small_vector<Exit, 8>;

/// Removes planes that a fragment cannot reach, because the whole fragment meets another plane before. Cylinders are
/// approximated by many planes, of which most are removed.
void discard_unreached(const FlatPolygon& polygon, double merge_mm, Exits& exits) {
  if (exits.size() <= kManyExits) return;
  const auto range_of = [&](const Exit& exit) {
    std::pair range(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
    for (const Vec2& p : polygon) {
      range.first = std::min(range.first, exit.distance.at(p));
      range.second = std::max(range.second, exit.distance.at(p));
    }
    return range;
  };
  double latest = std::numeric_limits<double>::infinity();
  for (const Exit& exit : exits) latest = std::min(latest, range_of(exit).second);
  const auto is_beyond = [&](const Exit& exit) { return range_of(exit).first > latest + merge_mm; };
  exits.erase(std::remove_if(exits.begin(), exits.end(), is_beyond), exits.end());
}

/// Splits a fragment between the entrance face and the sides. Each face receives the portion of the fragment that
/// reaches this face before the other faces.
void leave_hull(const BeamStep& step, const Fragment& fragment) {
  const LightSetup& setup = step.scene.setup;
  const double merge_mm = step.scene.merge_mm;
  Exits exits;
  const auto offer = [&](const Plane& plane, FacetRole role) {
    if (plane.normal.dot(step.beam.direction) > kMinIncidenceCosine)
      exits.push_back({plane, Distance(step.frame, plane), role});
  };
  offer({Vec3::UnitZ(), setup.thickness_mm}, FacetRole::entrance);
  for (const auto& side : setup.sides) offer({side.normal, side.offset_mm}, FacetRole::side);
  discard_unreached(fragment.polygon, merge_mm, exits);

  const double whole = area(fragment.polygon);
  double used = 0.0;
  const auto meet = [&](const Exit& exit, FacetRole role, const FlatPolygon& own) {
    if (own.empty() || area(own) <= step.scene.min_area) return;
    const double part = fragment.area_fraction * area(own) / whole;
    used += part;
    meet_hull(step, {own, part}, exit.plane, role);
  };
  for (std::size_t k = 0; k < exits.size(); ++k) {
    FlatPolygon own = fragment.polygon;
    for (std::size_t j = 0; j < exits.size() && !own.empty(); ++j) {
      if (j == k) continue;
      const Vec2 slope = exits[k].distance.slope - exits[j].distance.slope;
      own = clipped(own, {slope.x(), slope.y(), exits[j].distance.constant - exits[k].distance.constant}, merge_mm);
    }
    if (exits[k].role == FacetRole::side && setup.optics.border_walls_differ()) {
      // The portion of a side plane below z = 0 is a border wall. On this plane, z = up . p + start, where p contains
      // the coordinates across the beam.
      const Frame& frame = step.frame;
      const Distance& distance = exits[k].distance;
      const Vec2 up = Vec2(frame.u.z(), frame.v.z()) + frame.w.z() * distance.slope;
      const double start = frame.w.z() * distance.constant;
      if (up.norm() > kMinIncidenceCosine) {
        meet(exits[k], FacetRole::border_wall, clipped(own, {up.x(), up.y(), -start}, merge_mm));
        meet(exits[k], FacetRole::side, clipped(own, {-up.x(), -up.y(), start}, merge_mm));
        continue;
      }
    }
    meet(exits[k], exits[k].role, own);
  }
  step.record.add_rounding_loss(step.beam, fragment.area_fraction - used);
}

/// Queues a fragment that has reached the limited horizon of its step without meeting a face. After kMaxLevelSteps such
/// steps, its power is added to `truncated` instead.
void stop_at_horizon(const BeamStep& step, const Fragment& fragment) {
  const Plane there = plane_at(step.horizon, step.beam);
  Beam beam = arrived(step, fragment, there);
  beam.start = there;
  beam.depth = step.beam.depth;
  beam.steps_since_interface = step.beam.steps_since_interface + 1;
  if (beam.steps_since_interface < kMaxLevelSteps)
    step.queue.push(std::move(beam));
  else
    step.record.add_to_ledger(beam, Account::truncated, power_of(beam));
}

/// Returns true if a facet is part of a cell of the back surface. An excerpt also contains sides of the larger part as
/// facets, which are not part of a cell.
bool counts_as_cell(const BeamScene& scene, const Candidate& facet) {
  return scene.policy.excerpt == nullptr || scene.policy.excerpt->kind_of(facet.cell) != geometry::ExcerptCell::side;
}

/// Returns true if light whose first cell is `cell` is traced further. In an excerpt, only the light of one element is.
bool is_traced(const BeamStep& step, const CellInstance& cell) {
  const ExcerptLight* const excerpt = step.scene.policy.excerpt;
  if (excerpt == nullptr) return true;
  const Beam& from = step.beam;
  geometry::Polygon entered;
  for (const Vec3& corner : from.corners) entered.push_back(from.entry.of(corner));
  return excerpt->is_own(geometry::centroid(entered), cell);
}

}  // namespace

void meet_facet(const BeamStep& step, const Fragment& fragment, const Candidate& facet) {
  const Optics& optics = step.scene.setup.optics;
  const Beam& from = step.beam;
  const Plane& plane = facet.plane;
  const bool is_cell = counts_as_cell(step.scene, facet);
  if (is_cell && !from.trail.first && !is_traced(step, facet.cell)) return;
  Beam beam = arrived(step, fragment, plane);
  const bool is_wall = facet.role == FacetRole::inner_wall || facet.role == FacetRole::border_wall;
  if (is_wall && optics.absorbing_walls) {
    step.record.add_to_ledger(beam, Account::absorbed, power_of(beam));
    return;
  }
  const Vec3 against = from.inside ? Vec3(-plane.normal) : plane.normal;
  const double ratio = ratio_at_face(optics, facet.role, from.inside);
  const double cos_incidence = -against.dot(from.direction);
  const materials::FresnelCoefficients f = fresnel_at_back(optics, facet.role, from.inside, cos_incidence);
  if (is_cell) beam.trail.meet(facet.cell);
  beam.light.rotate_basis_to_interface(from.direction, against);
  const CoherentLight reflected = beam.light.reflected(f);
  const CoherentLight transmitted = beam.light.transmitted(f);
  step.record.add_to_ledger(
      beam, Account::absorbed,
      transmission_of(beam) * absorbed_at_back(optics, facet.role, beam.light, reflected, transmitted));
  const CoherentLight back = unscattered(step.scene, beam, f, facet.role, cos_incidence, Lobe::reflection);
  double scattered = reflected.power() - back.power();
  if (!f.total_reflection) {
    Beam through = beam;
    if (from.inside) through.last_exit_role = facet.role;
    keep_phases(step.scene, through, facet, f, cos_incidence, Lobe::transmission);
    const CoherentLight on = unscattered(step.scene, beam, f, facet.role, cos_incidence, Lobe::transmission);
    scattered += transmitted.power() - on.power();
    send(step, std::move(through), plane, -against,
         refracted(from.direction, against, ratio, cos_incidence, f.cos_refracted), on, !from.inside);
  }
  if (scattered > 0.0) step.record.scatter(beam, plane, transmission_of(beam) * scattered);
  keep_phases(step.scene, beam, facet, f, cos_incidence, Lobe::reflection);
  send(step, std::move(beam), plane, against, mirrored(from.direction, against), back, from.inside);
}

void pass_facets(const BeamStep& step, const Fragment& fragment) {
  const Beam& from = step.beam;
  if (step.horizon.limited) return stop_at_horizon(step, fragment);
  if (from.inside) return leave_hull(step, fragment);
  const bool rises_through_plate = step.scene.setup.infinite() && from.direction.z() > 0.0;
  step.record.add_to_ledger(from, rises_through_plate ? Account::truncated : account_of_exit(from.last_exit_role),
                            power_at_start(step, fragment));
}

}  // namespace retrace::raytrace
