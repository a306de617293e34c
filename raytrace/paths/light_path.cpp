#include "raytrace/paths/light_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/angle.h"
#include "raytrace/light/light_setup.h"

namespace retrace::raytrace {
namespace {

constexpr std::size_t kMaxSteps = 16;
constexpr double kFaintest = 1e-3;

class Follower {
 public:
  Follower(const geometry::Part& part, const HitFinder& first_hit, const Vec2& centre_mm, const LightSetup& setup,
           const EntranceFace* entrance_face)
      : part_(part),
        first_hit_(first_hit),
        setup_(setup),
        entrance_face_(entrance_face),
        centre_mm_(centre_mm),
        air_mm_(0.4 * (part.thickness_mm + part.size_mm)) {}

  LightPath follow(const Vec2& entry_mm) {
    position_ = {entry_mm.x() - centre_mm_.x(), entry_mm.y() - centre_mm_.y(), setup_.thickness_mm};
    if (entrance_face_ != nullptr) {
      position_.z() = entrance_face_->beam_height_mm(position_.head<2>());
      path_.points_mm.push_back(in_part_frame(position_ + air_mm_ * setup_.to_source));
      if (!setup_.stops.passes_mount(position_, setup_.to_source)) return stop_before_face();
      if (!enter_curved_face()) return pass_beside();
    } else {
      path_.points_mm.push_back(in_part_frame(position_ + air_mm_ * setup_.to_source));
      if (!setup_.stops.reaches(position_, setup_.to_source)) return stop_before_face();
      direction_ = setup_.entry.direction;
      light_ = setup_.entry.light;
      add({PathEvent::enters, geometry::FacetRole::entrance, position_, deg(setup_.to_source.z()), light_.power()});
    }
    while (path_.steps.size() < kMaxSteps && light_.power() > kFaintest && advance()) {
    }
    if (!is_done_) add({PathEvent::ends, geometry::FacetRole::entrance, position_, 0.0, light_.power()});
    path_.power = light_.power();
    return std::move(path_);
  }

 private:
  static double deg(double cosine) { return Angle::from_rad(std::acos(std::clamp(cosine, -1.0, 1.0))).deg(); }
  Vec3 in_part_frame(const Vec3& p) const { return {p.x() + centre_mm_.x(), p.y() + centre_mm_.y(), p.z()}; }

  void add(PathStep step) {
    step.at_mm = in_part_frame(step.at_mm);
    path_.points_mm.push_back(step.at_mm);
    path_.steps.push_back(step);
  }

  bool end(PathEvent event, geometry::FacetRole role, double incidence_deg) {
    add({event, role, position_, incidence_deg, light_.power()});
    path_.points_mm.push_back(in_part_frame(position_ + air_mm_ * direction_));
    is_done_ = true;
    return false;
  }

  /// Refracts the light at the curved entrance face. Returns false if the light does not meet the face.
  bool enter_curved_face() {
    direction_ = -setup_.to_source;
    const auto [side, limit] = nearest_side();
    const auto met = entrance_face_->first_hit({position_, direction_, {}, false, limit});
    if (!met) return false;
    position_ += met->hit.t * direction_;
    entrance_source_ = met->hit.facet;
    const double cosine = -met->normal.dot(direction_);
    const auto f = fresnel_at_entrance(setup_.optics, false, cosine);
    static_cast<Light&>(light_) = setup_.incident;
    light_.rotate_basis_to_interface(direction_, met->normal);
    if (!setup_.optics.lossless_entrance) light_ = light_.transmitted(f);
    direction_ = refracted(direction_, met->normal, 1.0 / setup_.optics.index, cosine, f.cos_refracted);
    add({PathEvent::enters, geometry::FacetRole::entrance, position_, deg(cosine), light_.power()});
    return true;
  }

  /// Ends the path at the chamfer or, if the light does not meet the chamfer, at the plane of the mount's edge.
  void stop(const Vec3& direction) {
    if (setup_.stops.is_clear(position_.head<2>()))
      position_ += (setup_.stops.top_mm() - position_.z()) / direction.z() * direction;
    add({PathEvent::stopped, geometry::FacetRole::entrance, position_, 0.0, 0.0});
    light_.scale(0.0);
    is_done_ = true;
  }

  /// Ends the path of incident light that the mount or the chamfer blocks.
  LightPath stop_before_face() {
    stop(setup_.to_source);
    return std::move(path_);
  }

  /// Ends the path of light that passes beside the part.
  LightPath pass_beside() {
    path_.power = 1.0;
    add({PathEvent::escapes, geometry::FacetRole::entrance, position_, 0.0, 1.0});
    path_.points_mm.push_back(in_part_frame(position_ + air_mm_ * direction_));
    return std::move(path_);
  }

  /// Returns the nearest side of the part in the direction of the light, and the distance to it. Facets and the
  /// entrance face are not considered.
  std::pair<const LightSetup::Side*, double> nearest_side() const {
    double limit = std::numeric_limits<double>::infinity();
    const LightSetup::Side* side = nullptr;
    for (const LightSetup::Side& candidate : setup_.sides) {
      const double towards = candidate.normal.dot(direction_);
      if (towards <= 0.0) continue;
      const double t = std::max(0.0, (candidate.offset_mm - candidate.normal.dot(position_)) / towards);
      if (t >= limit) continue;
      limit = t;
      side = &candidate;
    }
    return {side, limit};
  }

  bool advance() { return inside_ ? advance_inside() : advance_outside(); }

  bool advance_inside() {
    auto [side, limit] = nearest_side();
    Vec3 entrance_normal = Vec3::UnitZ();
    FacetRef entrance_facet;
    if (const auto met = reach_entrance(limit)) {
      side = nullptr;
      limit = met->hit.t;
      entrance_normal = met->normal;
      entrance_facet = met->hit.facet;
    }
    const auto hit = first_hit_({position_, direction_, source_, true, limit});
    if (hit) return meet_facet(*hit);
    if (!std::isfinite(limit)) return false;
    absorb(limit);
    position_ += limit * direction_;
    source_ = {};
    entrance_source_ = entrance_facet;
    if (side != nullptr) return meet(side->normal, geometry::FacetRole::side, setup_.optics.index);
    return meet(entrance_normal, geometry::FacetRole::entrance, setup_.optics.index);
  }

  /// Returns the point at which the light meets the entrance face from inside. Returns nothing if there is no such
  /// point within the distance `limit`.
  std::optional<EntranceHit> reach_entrance(double limit) const {
    if (entrance_face_ != nullptr)
      return entrance_face_->first_hit({position_, direction_, entrance_source_, true, limit});
    if (!(direction_.z() > 0.0)) return std::nullopt;
    const double t = (setup_.thickness_mm - position_.z()) / direction_.z();
    if (t > limit) return std::nullopt;
    EntranceHit met;
    met.hit.t = t;
    return met;
  }

  bool advance_outside() {
    const auto hit = first_hit_({position_, direction_, source_, false, std::numeric_limits<double>::infinity()});
    if (!hit) {
      path_.points_mm.push_back(in_part_frame(position_ + air_mm_ * direction_));
      path_.steps.push_back(
          {PathEvent::escapes, geometry::FacetRole::flat_back, in_part_frame(position_), 0.0, light_.power()});
      is_done_ = true;
      return false;
    }
    return meet_facet(*hit);
  }

  void absorb(double length_mm) { light_.scale(std::exp(-setup_.optics.absorption_per_mm * length_mm)); }

  bool meet_facet(const SurfaceHit& hit) {
    const geometry::SurfacePatch& patch = part_.patches[part_.placements[hit.facet.placement].patch];
    const geometry::PatchFacet& facet = patch.facets[hit.facet.facet];
    if (inside_) absorb(hit.t);
    position_ += hit.t * direction_;
    source_ = hit.facet;
    entrance_source_ = {};
    const Vec3 out = inside_ ? facet.normal : Vec3(-facet.normal);
    const auto f = fresnel_at_back(setup_.optics, facet.role, inside_, out.dot(direction_));
    const bool goes_on = split(out, facet.role, f, ratio_at_face(setup_.optics, facet.role, inside_));
    path_.steps.back().facet = hit.facet;
    return goes_on;
  }

  bool meet(const Vec3& out, geometry::FacetRole role, double ratio) {
    const double cosine = out.dot(direction_);
    const bool is_entrance = role == geometry::FacetRole::entrance;
    if (is_entrance && !setup_.stops.is_clear(position_.head<2>())) {
      stop(direction_);
      return false;
    }
    return split(out, role,
                 is_entrance ? fresnel_at_entrance(setup_.optics, true, cosine) : materials::fresnel(ratio, cosine),
                 ratio);
  }

  /// Splits the light at a face and continues with the stronger branch.
  /// \param out normal of the face that points to the side away from the incoming light
  bool split(const Vec3& out, geometry::FacetRole role, const materials::FresnelCoefficients& f, double ratio) {
    const double cosine = out.dot(direction_);
    light_.rotate_basis_to_interface(direction_, out);
    const CoherentLight reflected = light_.reflected(f);
    const CoherentLight transmitted = light_.transmitted(f);
    if (f.total_reflection || reflected.power() >= transmitted.power()) {
      light_ = reflected;
      direction_ = mirrored(direction_, out);
      const bool is_total = f.total_reflection && !setup_.optics.facet_layers.absorbs() && !setup_.optics.mirror_facets;
      add({is_total ? PathEvent::total_reflection : PathEvent::reflection, role, position_, deg(cosine),
           light_.power()});
      return true;
    }
    light_ = transmitted;
    direction_ = refracted(direction_, -out, ratio, cosine, f.cos_refracted);
    if (role == geometry::FacetRole::side) return end(PathEvent::leaves_side, role, deg(cosine));
    if (role == geometry::FacetRole::entrance && !setup_.stops.passes_mount(position_, direction_)) {
      stop(direction_);
      return false;
    }
    if (role == geometry::FacetRole::entrance) {
      path_.deviation_deg = deg(direction_.dot(setup_.to_source));
      path_.is_returned = setup_.cone_of(direction_) == 0;
      return end(PathEvent::leaves, role, deg(cosine));
    }
    add({inside_ ? PathEvent::exits : PathEvent::enters_again, role, position_, deg(cosine), light_.power()});
    inside_ = !inside_;
    return true;
  }

  const geometry::Part& part_;
  const HitFinder& first_hit_;
  const LightSetup& setup_;
  const EntranceFace* entrance_face_;
  Vec2 centre_mm_;
  double air_mm_;
  LightPath path_;
  Vec3 position_ = Vec3::Zero();
  Vec3 direction_ = -Vec3::UnitZ();
  CoherentLight light_;
  FacetRef source_;
  FacetRef entrance_source_;  ///< facet of a curved entrance face that the light has just left
  bool inside_ = true;
  bool is_done_ = false;
};

}  // namespace

LightPath strongest_path(const geometry::Part& part, const HitFinder& first_hit, const Vec2& centre_mm,
                         const Optics& optics, const Illumination& illumination, double cone_deg, const Vec2& entry_mm,
                         const EntranceFace* entrance_face) {
  const LightSetup setup(part, centre_mm, optics, illumination, {cone_deg});
  return Follower(part, first_hit, centre_mm, setup, entrance_face).follow(entry_mm);
}

}  // namespace retrace::raytrace
