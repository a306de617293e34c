#pragma once

// Follows one light path through any part: which face comes next, refraction, reflection, branching and booking.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/random.h"
#include "geometry/part/part.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/faces/entrance_face.h"
#include "raytrace/light/exit_observer.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/light/path_policy.h"
#include "raytrace/paths/soiled_entrance.h"
#include "raytrace/paths/textured_facet.h"

namespace retrace::raytrace {

/// What every path of a run shares.
struct PathSetup : LightSetup {
  PathSetup(const geometry::Part& part, const BackSurface& surface, const Vec2& centre_mm, const Optics& optics,
            const Illumination& illumination, const std::vector<double>& cones_deg, const PathPolicy& policy,
            const EntranceFace* entrance_face = nullptr);

  const BackSurface& surface;
  const EntranceFace* entrance_face = nullptr;  ///< in place of the plane z = thickness_mm; null: that plane
  std::optional<SoiledEntrance> soiled;         ///< where the plane entrance face scatters
  PathPolicy policy;
  Vec2 centre_mm = Vec2::Zero();     ///< where positions are told from, in the part frame
  double clearance_mm = 0.0;         ///< height above z = 0 from which the back surface is looked for
  Vec2 period_mm = Vec2::Zero();     ///< infinite part
  Vec2 tile_half_mm = Vec2::Zero();  ///< infinite part: half size of the piece of surface that stands for it
};

/// Follows light through a part: refraction and reflection at every interface with polarisation, both branches where
/// both matter, one chosen at random with the whole power where not. One walker serves one thread.
class PathWalker {
 public:
  /// \param observer told of all that leaves the part; null: none
  PathWalker(const PathSetup& setup, Tally& tally, ExitObserver* observer = nullptr)
      : setup_(setup), tally_(tally), observer_(observer) {}

  /// Traces all light that enters at a point of the entrance face, as power 1. Random choices depend on `key`,
  /// `replicate` and `sample` alone.
  void trace(const Vec2& entry_mm, RandomKey key, std::uint32_t replicate, std::uint32_t sample);

  /// Traces light that is on its way already.
  /// \param choices made so far with these numbers; counts on
  void resume(const Vec3& position, const Ray& ray, RandomKey key, std::uint32_t replicate, std::uint32_t sample,
              std::uint32_t& choices);

  /// Returns the product of the reflection matrices along the path from a point inside the part to the entrance face.
  /// All faces are assumed to reflect. The product maps the direction at the point to the direction at the entrance
  /// face. Returns nothing if the path has more than kMostMirrors reflections.
  /// \pre all faces are plane
  std::optional<Eigen::Matrix3d> mirrors_to_entrance(const Vec3& position, const Vec3& direction) const;

  /// Traces light of power 1 that comes from anywhere: from above, from a side, from behind, or from inside the part
  /// where it begins there. Its own way back takes the place of that to the source. What the face that it meets first
  /// sends back is a branch like others, and counts as `front_specular` at the entrance face, as `side_exit` at sides,
  /// as `transmitted` behind.
  /// \return false if it does not meet the part: it is then booked nowhere
  bool launch(const Vec3& position, const Ray& ray, RandomKey key, std::uint32_t replicate, std::uint32_t sample);

 private:
  struct State : Ray {
    Vec3 position = Vec3::Zero();
    FacetRef source;                                                      ///< facet that the path has just left
    FacetRef entrance_source;                                             ///< the same, of an entrance surface
    bool above = false;                                                   ///< in the air on the entrance surface's side
    bool entered = false;                                                 ///< it has passed an entrance surface
    geometry::FacetRole left_through = geometry::FacetRole::retro_facet;  ///< last face it left the part through
    std::uint32_t events = 0;
    Vec2 shift_mm = Vec2::Zero();  ///< infinite part: from `position`, in the central period, to where it really is
  };
  enum class End { facet, entrance, side, escape, miss, trapped };
  struct Step {
    End end = End::miss;
    SurfaceHit hit;
    Vec3 entrance_normal = Vec3::UnitZ();  ///< where `hit` is on an entrance surface
    std::size_t side = 0;
    double length_mm = 0.0;
  };
  /// Where light is that comes to the part.
  enum class Medium { above, body, below };
  void begin(RandomKey key, std::uint32_t replicate, std::uint32_t sample, std::uint32_t choices = 0);
  void enter(const Vec2& entry_mm);
  void follow_pending();
  bool advance(State& state);

  Step step_inside(State& state) const;
  Step step_inside_periodic(State& state) const;
  Step step_outside(State& state) const;
  Step step_outside_periodic(State& state) const;
  std::optional<SurfaceHit> search(const State& state, double t_max) const;
  std::optional<SurfaceHit> search_certainly(const State& state) const;
  double distance_to_tile_border(const State& state) const;
  void wrap(State& state) const;
  bool is_over_part(const Vec3& position) const;

  void enter_entrance_face(const Vec2& entry_mm);
  double reach_entrance_face(const State& state, double limit, Step& step) const;
  bool advance_above(State& state);
  bool meet_entrance_face(State& state, const SurfaceHit& hit, const Vec3& normal);
  bool leave_entrance_face(const State& state);
  bool meet_entrance(State& state);
  void send_back(const State& state, const Light& light, const Vec3& direction);
  void enter_soiled(const State& state);
  bool meet_soiled_entrance(const State& state);
  const SoiledReturn& soiled(const Ray& ray);
  std::vector<Stokes>& returned(const State& state) { return state.scattered ? tally_.scattered : tally_.returned; }
  void leave(const State& state, const Light& light, const Vec3& direction);
  void tell(Account account, const State& state, const Vec3& direction, const Light& light) const;
  bool meet_side(State& state, const Vec3& normal);
  bool meet_facet(State& state, const SurfaceHit& hit);
  Vec3 normal_at(const State& state, const FacetRef& where) const;
  bool meet_textured(State& state, const Vec3& normal, const Vec3& plane_normal, const Optics& optics);
  const Optics& optics_of(const FacetRef& facet) const;
  const Optics& optics_of_wall(const Vec3& position) const;
  Branch choose(Light& reflected, Light& transmitted);
  template <class Pass>
  bool go_on(State& state, Branch branch, const Light& reflected, const Vec3& against, const Pass& pass);
  bool finish(const State& state, Account account);
  bool escape(const State& state);

  double start_tolerance(const Vec3& position) const;
  Medium medium_at(Vec3 position, double tolerance_mm) const;
  bool arrive_at_body(State& state);
  bool arrive_at_sheet(State& state);
  bool arrive_from_above(State& state, double reach_mm, double tolerance_mm);
  bool arrive_at_entrance(State& state);
  bool arrive_at_side(State& state, const Vec3& normal);
  bool arrive_from_below(State& state);
  bool begin_inside(State& state, double tolerance_mm);

  const PathSetup& setup_;
  Tally& tally_;
  ExitObserver* observer_;
  std::vector<State> pending_;
  SoiledReturn from_soiled_;
  Vec3 to_source_ = Vec3::UnitZ();  ///< of the light that is traced
  bool splits_at_front_ = true;     ///< both branches of the first interface are followed, whatever their power
  RandomKey key_;
  std::uint32_t replicate_ = 0;
  std::uint32_t sample_ = 0;
  std::uint32_t choices_ = 0;
};

/// Follows the branches at a face. \param pass makes of the path the one that goes through
template <class Pass>
bool PathWalker::go_on(State& state, Branch branch, const Light& reflected, const Vec3& against, const Pass& pass) {
  if (branch == Branch::transmitted) {
    pass(state);
    return true;
  }
  if (branch == Branch::both) pass(pending_.emplace_back(state));
  state.light = reflected;
  state.direction = mirrored(state.direction, against);
  return true;
}

}  // namespace retrace::raytrace
