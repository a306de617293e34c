#include "raytrace/cells/cell_facets.h"

#include <optional>

namespace retrace::raytrace {
namespace {

using geometry::FacetRole;
using lanes::Hit, lanes::label_of;

/// Streams of the rays that are reflected and transmitted at a face.
struct Branches {
  StreamKey reflected;
  StreamKey transmitted;
};

/// Returns the streams for the rays that a facet reflects and transmits. A ray that leaves the part through the convex
/// surface of a column cannot meet this surface again.
Branches branches_at_facet(const StreamKey& stream) {
  const StreamKey above{stream.column, RayLocation::inside, stream.scattered};
  const StreamKey below{stream.column, RayLocation::below_after_leaving, stream.scattered};
  return stream.inside() ? Branches{above, below} : Branches{below, above};
}

/// Replaces the normals that are stored for rays at facets with a form (a smooth deviation from the plane). The normal
/// of the facet's plane is replaced by the normal of the form at the position of the ray.
void replace_by_formed_normals(const CellStep& step) {
  const lanes::Rays rays = step.rays();
  const std::uint32_t column = step.stream().column;
  for (std::size_t k = 0; k < step.size(); ++k) {
    if (!step.batch.hits.is_facet(k)) continue;
    const Vec3 normal = step.batch.hits.normal(k);
    const std::optional<FacetFrame>& frame = step.faces.frame(column, step.faces.facet_of(column, normal));
    if (!frame) continue;
    step.batch.hits.set_normals(k, 1,
                                formed_normal(step.setup.optics, normal, *frame, vector_of(rays, lanes::kX, k),
                                              vector_of(rays, lanes::kDx, k), step.stream().inside()));
  }
}

void meet_mirrors(const CellStep& step) {
  const StreamKey to = branches_at_facet(step.stream()).reflected;
  const std::size_t more = lanes::meet_mirrors(step.rays(), step.size(), step.meeting(label_of(Hit::facet)),
                                               step.streams.end_of(to, step.size()));
  step.run.tally.segments += more;
  step.streams.grow(to, more);
}

// The following two functions process rays one by one. The computations take so long that SIMD would save little time.

void meet_texture(const CellStep& step) {
  const Optics& optics = step.setup.optics;
  const std::uint32_t column = step.stream().column;
  const lanes::Rays rays = step.rays();
  for (std::size_t k = 0; k < step.size(); ++k) {
    if (!step.batch.hits.is_facet(k)) continue;
    ++step.run.tally.segments;
    const Vec3 normal = step.batch.hits.normal(k);
    surface_models::RandomStream random = step.run.random_stream();
    TexturedReturn back = meet_textured_facet(optics, normal, step.batch.ray(rays, k), step.policy.split_power, random);
    if (!optics.facet_form.is_plane())
      back.mirror_to_side(step.faces.normal(column, step.faces.facet_of(column, normal)));
    step.run.tally.other[Account::truncated] += back.truncated;
    step.run.tally.other[Account::absorbed] += back.absorbed;
    for (std::size_t n = 0; n < back.count; ++n) {
      const Ray& ray = back.rays[n];
      const StreamKey to{column, ray.inside ? RayLocation::inside : RayLocation::below_after_leaving, ray.scattered};
      copy_ray(rays, k, step.streams.end_of(to, 1), 0, ray);
      step.streams.grow(to, 1);
    }
  }
}

/// Processes rays at facets with layers. The amplitude coefficients of such facets are complex numbers.
void meet_layers(const CellStep& step) {
  const Optics& optics = step.setup.optics;
  const bool inside = step.stream().inside();
  const bool scattered = step.stream().scattered;
  const Branches to = branches_at_facet(step.stream());
  const lanes::Rays rays = step.rays();
  const lanes::Rays reflected_rays = step.streams.end_of(to.reflected, step.size());
  const lanes::Rays transmitted_rays = step.streams.end_of(to.transmitted, step.size());
  lanes::Branches more;
  for (std::size_t k = 0; k < step.size(); ++k) {
    if (!step.batch.hits.is_facet(k)) continue;
    ++more.count;
    const Vec3 normal = step.batch.hits.normal(k);
    const Vec3 against = inside ? Vec3(-normal) : normal;
    Ray ray = step.batch.ray(rays, k);
    const double cos_incidence = -against.dot(ray.direction);
    const materials::FresnelCoefficients f = fresnel_at_back(optics, FacetRole::retro_facet, inside, cos_incidence);
    ray.light.rotate_basis_to_interface(ray.direction, against);
    Light reflected = ray.light.reflected(f);
    Light transmitted = ray.light.transmitted(f);
    step.run.tally.other[Account::absorbed] += absorbed_by(optics.facet_layers, ray.light, reflected, transmitted);
    const Branch branch =
        choose_branch(reflected, transmitted, step.policy.split_power, [&] { return step.run.random(); });
    if (branch != Branch::transmitted) {
      const Ray back{mirrored(ray.direction, against), reflected, inside, scattered};
      copy_ray(rays, k, reflected_rays, more.reflected++, back);
    }
    if (branch == Branch::reflected) continue;
    const Vec3 on = refracted(ray.direction, against, optics.ratio_at_back(inside), cos_incidence, f.cos_refracted);
    copy_ray(rays, k, transmitted_rays, more.transmitted++, {on, transmitted, !inside, scattered});
  }
  step.run.tally.segments += more.count;
  step.streams.grow(to.reflected, more.reflected);
  step.streams.grow(to.transmitted, more.transmitted);
}

/// Computes the branches of the rays with the given label, which have met interfaces between transparent media. The
/// reflected rays are added to their stream. The transmitted rays are written behind the last ray of their stream. The
/// caller must add them to the stream.
/// \return the number of transmitted rays
std::size_t meet_interfaces(const CellStep& step, lanes::Label label, const Branches& to) {
  const lanes::Rays reflected = step.streams.end_of(to.reflected, step.size());
  const lanes::Rays transmitted = step.streams.end_of(to.transmitted, step.size());
  const lanes::Branches more =
      lanes::meet_faces(step.rays(), step.size(), step.meeting(label),
                        step.setup.optics.ratio_at_back(step.stream().inside()), reflected, transmitted);
  step.run.tally.segments += more.count;
  step.streams.grow(to.reflected, more.reflected);
  return more.transmitted;
}

}  // namespace

void meet_facets(const CellStep& step) {
  const Optics& optics = step.setup.optics;
  const bool is_retro = step.faces.role(step.stream().column) == FacetRole::retro_facet;
  if (is_retro && !optics.facet_form.is_plane()) replace_by_formed_normals(step);
  if (is_retro && optics.mirror_facets) return meet_mirrors(step);
  if (is_retro && !optics.is_smooth()) return meet_texture(step);
  if (is_retro && !optics.facet_layers.empty()) return meet_layers(step);
  const Branches to = branches_at_facet(step.stream());
  step.streams.grow(to.transmitted, meet_interfaces(step, label_of(Hit::facet), to));
}

void meet_wall(const ColumnFaces::Exit& exit, const CellStep& step) {
  if (step.setup.optics.absorbing_walls) return step.add_to_ledger(*exit.wall, Account::absorbed);
  if (!step.batch.hits.contain(*exit.wall, step.size())) return;
  step.batch.hits.set_normals(0, step.size(), exit.wall_normal);
  const StreamKey& from = step.stream();
  const RayLocation here = from.inside() ? RayLocation::inside : RayLocation::below;
  const RayLocation there = from.inside() ? RayLocation::below : RayLocation::inside;
  const Branches to = {{from.column, here, from.scattered}, {exit.column, there, from.scattered}};
  step.streams.grow_from_neighbour(to.transmitted, meet_interfaces(step, *exit.wall, to), exit.shift_mm);
}

}  // namespace retrace::raytrace
