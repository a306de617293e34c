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
  /// \param observer told of all that leaves through the entrance face from within; null: none
  PathWalker(const PathSetup& setup, Tally& tally, ExitObserver* observer = nullptr)
      : setup_(setup), tally_(tally), observer_(observer) {}

  /// Traces all light that enters at a point of the entrance face, as power 1. Random choices depend on `key`,
  /// `replicate` and `sample` alone.
  void trace(const Vec2& entry_mm, RandomKey key, std::uint32_t replicate, std::uint32_t sample);

  /// Traces light that is on its way already.
  /// \param choices made so far with these numbers; counts on
  void resume(const Vec3& position, const Ray& ray, RandomKey key, std::uint32_t replicate, std::uint32_t sample,
              std::uint32_t& choices);

 private:
  struct State : Ray {
    Vec3 position = Vec3::Zero();
    FacetRef source;                                                      ///< facet that the path has just left
    FacetRef entrance_source;                                             ///< the same, of an entrance surface
    bool above = false;                                                   ///< in the air on the entrance surface's side
    bool entered = false;                                                 ///< it has passed an entrance surface
    geometry::FacetRole left_through = geometry::FacetRole::retro_facet;  ///< last face it left the part through
    std::uint32_t events = 0;
  };
  enum class End { facet, entrance, side, escape, miss, trapped };
  struct Step {
    End end = End::miss;
    SurfaceHit hit;
    Vec3 entrance_normal = Vec3::UnitZ();  ///< where `hit` is on an entrance surface
    std::size_t side = 0;
    double length_mm = 0.0;
  };
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
  void enter_soiled(const Vec2& entry_mm);
  bool meet_soiled_entrance(const State& state);
  const SoiledReturn& soiled(const Ray& ray);
  std::vector<Stokes>& returned(const State& state) { return state.scattered ? tally_.scattered : tally_.returned; }
  void leave(const State& state, const Light& light, const Vec3& direction);
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

  const PathSetup& setup_;
  Tally& tally_;
  ExitObserver* observer_;
  std::vector<State> pending_;
  SoiledReturn from_soiled_;
  RandomKey key_;
  std::uint32_t replicate_ = 0;
  std::uint32_t sample_ = 0;
  std::uint32_t choices_ = 0;
};

}  // namespace retrace::raytrace
