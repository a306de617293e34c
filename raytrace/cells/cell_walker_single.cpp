// Member functions of CellWalker that process rays one by one. They are used for facets with a form (a smooth deviation
// from the plane), a texture or layers, and for entrance faces that scatter. These computations take so long that SIMD
// would save little time.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "raytrace/cells/cell_walker.h"

namespace retrace::raytrace {

using geometry::FacetRole;

/// Returns the facet of a column whose normal is nearest to `normal`.
std::size_t CellWalker::facet_of(const Stream& stream, const Vec3& normal) const {
  const std::vector<lanes::Plane>& facets = shapes_[stream.column].facets;
  const auto turned = [&](const lanes::Plane& facet) { return (facet.normal - normal).squaredNorm(); };
  return static_cast<std::size_t>(std::ranges::min_element(facets, {}, turned) - facets.begin());
}

/// Replaces the normals that are stored for rays at facets with a form. The normal of the facet's plane is replaced by
/// the normal of the form at the position of the ray.
void CellWalker::turn_normals(const Stream& stream) {
  const bool inside = stream.place == Place::inside;
  const Shape& shape = shapes_[stream.column];
  const lanes::Rays rays = moved_.rays();
  for (std::size_t k = 0; k < moved_.size(); ++k) {
    if (met_[k] != kFacet) continue;
    const Vec3 normal(met_[capacity_ + k], met_[2 * capacity_ + k], met_[3 * capacity_ + k]);
    const std::optional<FacetFrame>& frame = shape.frames[facet_of(stream, normal)];
    if (!frame) continue;
    const Vec3 formed = formed_normal(setup_.optics, normal, *frame, vector_of(rays, lanes::kX, k),
                                      vector_of(rays, lanes::kDx, k), inside);
    for (std::size_t n = 0; n < 3; ++n) met_[(n + 1) * capacity_ + k] = formed[static_cast<Eigen::Index>(n)];
  }
}

/// Processes rays at textured facets one by one.
void CellWalker::meet_texture(const Stream& stream) {
  const bool was_inside = stream.place == Place::inside;
  const lanes::Rays rays = moved_.rays();
  const auto send = [&](std::size_t k, const Ray& ray) {
    const Place place = ray.inside ? Place::inside : Place::below_after_leaving;
    const std::uint32_t to = stream_of(stream.column, place, ray.scattered);
    const lanes::Rays end = end_of(to, 1);
    for (std::size_t n = 0; n < rays.numbers; ++n) end[n][0] = rays[n][k];
    set(end, 0, ray);
    grow(to, 1);
  };
  for (std::size_t k = 0; k < moved_.size(); ++k) {
    if (met_[k] != kFacet) continue;
    ++tally_->segments;
    const Vec3 normal(met_[capacity_ + k], met_[2 * capacity_ + k], met_[3 * capacity_ + k]);
    surface_models::RandomStream random(key_, replicate_, sample_, choices_++);
    TexturedReturn back = meet_textured_facet(setup_.optics, normal, ray_of(rays, k, was_inside, stream.scattered),
                                              policy_.split_power, random);
    if (!setup_.optics.facet_form.is_plane())
      back.keep_sides(shapes_[stream.column].facets[facet_of(stream, normal)].normal);
    tally_->other[Account::truncated] += back.truncated;
    tally_->other[Account::absorbed] += back.absorbed;
    for (std::size_t n = 0; n < back.count; ++n) send(k, back.rays[n]);
  }
}

/// Processes rays at facets with layers one by one, because the amplitudes of layers are complex numbers.
void CellWalker::meet_layers(const Stream& stream, std::uint32_t reflected_to, std::uint32_t transmitted_to) {
  const Optics& optics = setup_.optics;
  const bool inside = stream.place == Place::inside;
  const lanes::Rays rays = moved_.rays();
  const lanes::Rays reflected_rays = end_of(reflected_to, moved_.size());
  const lanes::Rays transmitted_rays = end_of(transmitted_to, moved_.size());
  lanes::Branches more;
  const auto append = [&](const lanes::Rays& to, std::size_t& at, std::size_t k, const Ray& ray) {
    for (std::size_t n = 0; n < rays.numbers; ++n) to[n][at] = rays[n][k];
    set(to, at++, ray);
  };
  for (std::size_t k = 0; k < moved_.size(); ++k) {
    if (met_[k] != kFacet) continue;
    ++more.count;
    const Vec3 normal(met_[capacity_ + k], met_[2 * capacity_ + k], met_[3 * capacity_ + k]);
    const Vec3 against = inside ? Vec3(-normal) : normal;
    Ray ray = ray_of(rays, k, inside, stream.scattered);
    const double cos_incidence = -against.dot(ray.direction);
    const materials::FresnelCoefficients f = fresnel_at_back(optics, FacetRole::retro_facet, inside, cos_incidence);
    ray.light.turn_to(ray.direction, against);
    Light reflected = ray.light.reflected(f);
    Light transmitted = ray.light.transmitted(f);
    tally_->other[Account::absorbed] += absorbed_by(optics.facet_layers, ray.light, reflected, transmitted);
    const Branch branch = choose_branch(reflected, transmitted, policy_.split_power, [&] { return random(); });
    if (branch != Branch::transmitted) {
      const Ray back{mirrored(ray.direction, against), reflected, inside, stream.scattered};
      append(reflected_rays, more.reflected, k, back);
    }
    if (branch == Branch::reflected) continue;
    const Vec3 on = refracted(ray.direction, against, optics.ratio_at_back(inside), cos_incidence, f.cos_refracted);
    append(transmitted_rays, more.transmitted, k, {on, transmitted, !inside, stream.scattered});
  }
  tally_->segments += more.count;
  grow(reflected_to, more.reflected);
  grow(transmitted_to, more.transmitted);
}

/// Processes rays at an entrance face with layers one by one.
void CellWalker::meet_layers_of_entrance(bool scattered) {
  const Optics& optics = setup_.optics;
  const double height_mm = setup_.thickness_mm - setup_.top_mm;
  const Vec3 down = -Vec3::UnitZ();
  const lanes::Rays rays = moved_.rays();
  const lanes::Rays chosen = chosen_.rays();
  std::vector<Stokes>& returned = scattered ? tally_->scattered : tally_->returned;
  std::size_t reflected_count = 0;
  for (std::size_t k = 0; k < moved_.size(); ++k) {
    if (met_[k] != kTopOrNothing) continue;
    ++tally_->segments;
    Ray ray = ray_of(rays, k, true, scattered);
    const double way_mm = height_mm / ray.direction.z();
    const double before = ray.light.power();
    ray.light.scale(std::exp(-optics.absorption_per_mm * way_mm));
    tally_->other[Account::absorbed] += before - ray.light.power();
    const double cos_incidence = ray.direction.z();
    const materials::FresnelCoefficients f = fresnel_at_entrance(optics, true, cos_incidence);
    ray.light.turn_to(ray.direction, down);
    Light reflected = ray.light.reflected(f);
    Light transmitted = ray.light.transmitted(f);
    tally_->other[Account::absorbed] += absorbed_at_entrance(optics, ray.light, reflected, transmitted);
    const Branch branch = choose_branch(reflected, transmitted, policy_.split_power, [&] { return random(); });
    if (branch != Branch::reflected) {
      const Vec3 out = refracted(ray.direction, down, optics.index, cos_incidence, f.cos_refracted);
      returned[setup_.cone_of(out)] += seen_from_above(transmitted, out);
      if (setup_.score != nullptr) setup_.score->add(out, transmitted.power(), tally_->score);
      if (observer_ != nullptr)
        observer_->leaves(owner_of(rays, k), place_of(rays, k) + way_mm * ray.direction, out, transmitted.power());
    }
    if (branch == Branch::transmitted) continue;
    for (std::size_t n = 0; n < rays.numbers; ++n) chosen[n][reflected_count] = rays[n][k];
    chosen[lanes::kX][reflected_count] += way_mm * ray.direction.x();
    chosen[lanes::kY][reflected_count] += way_mm * ray.direction.y();
    chosen[lanes::kZ][reflected_count] = setup_.thickness_mm;
    set(chosen, reflected_count++, {mirrored(ray.direction, down), reflected, true, scattered});
  }
  chosen_.resize(reflected_count);
  if (!chosen_.empty()) fall(scattered);
}

/// Returns the rays, inside and outside the part, into which a scattering entrance face splits the incident ray.
const SoiledReturn& CellWalker::soiled(const Ray& ray) {
  surface_models::RandomStream random(key_, replicate_, sample_, choices_++);
  from_soiled_.clear();
  soiled_->meet(ray, policy_.split_power, random, from_soiled_);
  tally_->other[Account::absorbed] += from_soiled_.absorbed;
  tally_->other[Account::truncated] += from_soiled_.truncated;
  return from_soiled_;
}

/// Queues a ray that starts just below the entrance face. Values that `place` and `ray` do not contain, such as the
/// owner, are copied from ray `k` of `from`.
void CellWalker::put_in(const lanes::Rays& from, std::size_t k, const Vec3& place, const Ray& ray) {
  RayStore& to = entering_[ray.scattered ? 1 : 0];
  to.reserve(to.size() + 1);
  const lanes::Rays end = to.rays(to.size());
  for (std::size_t n = 0; n < from.numbers; ++n) end[n][0] = from[n][k];
  for (std::size_t n = 0; n < 3; ++n) end[lanes::kX + n][0] = place[static_cast<Eigen::Index>(n)];
  set(end, 0, ray);
  to.resize(to.size() + 1);
}

/// Moves the rays that wait below the entrance face down to the surface, as many at a time as the memory allows.
void CellWalker::fall_in() {
  const std::size_t most = capacity_ - lanes::kPadding;
  chosen_.reserve(most);
  for (const bool scattered : {false, true}) {
    RayStore& from = entering_[scattered ? 1 : 0];
    for (std::size_t first = 0; first < from.size(); first += most) {
      const std::size_t count = std::min(most, from.size() - first);
      chosen_.resize(count);
      const lanes::Rays rays = from.rays(first);
      const lanes::Rays chosen = chosen_.rays();
      for (std::size_t n = 0; n < rays.numbers; ++n) std::copy_n(rays[n], count, chosen[n]);
      fall(scattered);
    }
    from.clear();
  }
}

/// Starts the rays of `chosen_` at a scattering entrance face, one by one.
void CellWalker::enter_soiled(std::size_t count) {
  const lanes::Rays rays = chosen_.rays();
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 place(rays[lanes::kX][k], rays[lanes::kY][k], setup_.thickness_mm);
    for (const Ray& ray : soiled({-setup_.to_source, setup_.incident, false, false}).rays) {
      if (ray.inside)
        put_in(rays, k, place, ray);
      else
        book_front(setup_, ray, *tally_);
    }
  }
  fall_in();
}

/// Processes rays that reach a scattering entrance face from inside.
void CellWalker::meet_soiled_entrance(bool scattered) {
  const double height_mm = setup_.thickness_mm - setup_.top_mm;
  const lanes::Rays rays = moved_.rays();
  for (std::size_t k = 0; k < moved_.size(); ++k) {
    if (met_[k] != kTopOrNothing) continue;
    ++tally_->segments;
    Ray met = ray_of(rays, k, true, scattered);
    const double way_mm = height_mm / met.direction.z();
    const double before = met.light.power();
    met.light.scale(std::exp(-setup_.optics.absorption_per_mm * way_mm));
    tally_->other[Account::absorbed] += before - met.light.power();
    const Vec3 place(rays[lanes::kX][k] + way_mm * met.direction.x(), rays[lanes::kY][k] + way_mm * met.direction.y(),
                     setup_.thickness_mm);
    for (const Ray& ray : soiled(met).rays) {
      if (ray.inside) {
        put_in(rays, k, place, ray);
        continue;
      }
      (ray.scattered ? tally_->scattered : tally_->returned)[setup_.cone_of(ray.direction)] +=
          seen_from_above(ray.light, ray.direction);
      if (setup_.score != nullptr) setup_.score->add(ray.direction, ray.light.power(), tally_->score);
    }
  }
  fall_in();
}

}  // namespace retrace::raytrace
