#pragma once

// Traces a single light path through any part: finds the next face, splits the light by refraction and reflection, and
// adds the power to the accounts of the ledger.

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/random.h"
#include "geometry/part/part.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/faces/contaminated_entrance.h"
#include "raytrace/faces/entrance_face.h"
#include "raytrace/faces/textured_facet.h"
#include "raytrace/light/exit_observer.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/light/path_policy.h"
#include "raytrace/sampling/lit_region.h"

namespace retrace::raytrace {

/// Data that all paths of a run use.
struct PathSetup : LightSetup {
  PathSetup(const geometry::Part& part, const BackSurface& surface, const Vec2& centre_mm, const Optics& optics,
            const Illumination& illumination, const std::vector<double>& cones_deg, const PathPolicy& policy,
            const EntranceFace* entrance_face = nullptr);

  const BackSurface& surface;
  const EntranceFace* entrance_face = nullptr;  ///< curved entrance face; null for the plane z = thickness_mm
  std::optional<ContaminatedEntrance> contaminated_entrance;  ///< set if the plane entrance face scatters light
  std::optional<LitRegion> lit_region;  ///< region of the incident beam; set if shells deflect light
  double middle_height_mm = 0.0;        ///< height of the entrance surface at the middle of the part, see Shell
  PathPolicy policy;
  Vec2 centre_mm = Vec2::Zero();  ///< origin of positions, in the part frame
  double clearance_mm = 0.0;      ///< maximum z at which rays are tested against the back surface
  Vec2 period_mm = Vec2::Zero();  ///< period of an infinite part
  /// Half size of a rectangle around the origin that is inside all sides of a finite part.
  Vec2 inner_half_mm = Vec2::Zero();
  Vec2 tile_half_mm = Vec2::Zero();  ///< infinite part: half size of the tile, the region in which rays are traced
  /// Convex polygons of the entrance face of a part with notches or holes, see Part::entrance_pieces.
  std::vector<geometry::Polygon> entrance_pieces;

  /// Returns a height below the whole back surface. A ray from the inside gets there only if rounding errors let it
  /// pass between two facets.
  double below_surface_mm() const {
    return -depth_mm - (entrance_pieces.empty() ? clearance_mm : clearance_mm - top_mm);
  }
  /// Returns true if a position is inside the rectangle of `inner_half_mm`. A line between two such positions cannot
  /// meet a side.
  bool is_far_from_sides(const Vec3& position_mm) const {
    return std::abs(position_mm.x()) < inner_half_mm.x() && std::abs(position_mm.y()) < inner_half_mm.y();
  }
  /// Returns true if a position is inside one of `entrance_pieces`.
  /// \param min_distance_mm minimum distance from the sides of the polygon; with a negative value, the position may be
  ///     outside by this distance
  bool is_over_piece(const Vec2& position_mm, double min_distance_mm) const;
};

/// Traces polarized light through a part. At every interface, a path splits into a refracted and a reflected branch. If
/// both branches are strong, both are traced. Otherwise, one branch is chosen at random and receives the total power.
/// One walker serves one thread.
class PathWalker {
 public:
  /// \param observer receives all light that leaves the part; null for none
  PathWalker(const PathSetup& setup, Tally& tally, ExitObserver* observer = nullptr)
      : setup_(setup), tally_(tally), observer_(observer) {}

  /// Traces the light that enters at a point of the entrance face, with power 1. Random choices depend only on `key`,
  /// `replicate` and `sample`.
  void trace(const Vec2& entry_mm, RandomKey key, std::uint32_t replicate, std::uint32_t sample);

  /// Continues the trace of light that has already entered.
  /// \param choices number of random choices made so far with the same `key`, `replicate` and `sample`; is increased
  void resume(const Vec3& position, const Ray& ray, RandomKey key, std::uint32_t replicate, std::uint32_t sample,
              std::uint32_t& choices);

  /// Predicts the path from a point inside the part to the entrance face if every face on the path only reflects.
  /// Returns the product of the reflection matrices, which maps the direction at the point to the direction at the
  /// entrance face. Returns nothing if the path has more than kMaxMirrors reflections.
  /// \pre all faces are plane
  std::optional<Eigen::Matrix3d> mirrors_to_entrance(const Vec3& position, const Vec3& direction) const;

  /// Traces light of power 1 that comes from any direction: from above, from a side, from below, or from a point inside
  /// the part. Light that starts in front of the outermost shell crosses the shells first. All other light starts
  /// behind the shells. The acceptance cones are centred on the direction opposite to `ray`, instead of the direction
  /// to the source. Light that the first face reflects from outside is a branch of the path. Its power is added to
  /// `front_specular` at the entrance face, to `side_exit` at sides, and to `transmitted` at the back.
  /// \return false if the light does not meet the part; it is then not added to any account
  bool launch(const Vec3& position, const Ray& ray, RandomKey key, std::uint32_t replicate, std::uint32_t sample);

  /// Surface at which the light of launch() first meets the part. If the light starts inside the part, it is `inside`.
  /// If the light meets only shells, it is `none`.
  enum class Arrival { none, entrance, side, back, inside };
  /// Returns the place where the light of the last call of launch() has met the part.
  /// \pre this call has returned true
  Arrival arrival() const { return arrival_; }

 private:
  struct State : Ray {
    Vec3 position = Vec3::Zero();
    FacetRef source;           ///< facet that the path has just left
    FacetRef entrance_source;  ///< facet of a curved entrance face that the path has just left
    bool above = false;        ///< true if the path is in the air above a curved entrance face
    bool entered = false;      ///< true if the path has passed a curved entrance face
    geometry::FacetRole last_exit_role = geometry::FacetRole::retro_facet;  ///< last face through which light left
    std::uint32_t events = 0;
    Vec2 shift_mm = Vec2::Zero();  ///< infinite part: real position minus `position` (in the central period)
  };
  enum class End { facet, entrance, side, escape, miss, trapped };
  struct Step {
    End end = End::miss;
    SurfaceHit hit;
    Vec3 entrance_normal = Vec3::UnitZ();  ///< normal at `hit` if it is on a curved entrance face
    std::size_t side = 0;
    double length_mm = 0.0;
  };
  /// Medium in which light starts.
  enum class Medium { above, body, below };
  void begin(RandomKey key, std::uint32_t replicate, std::uint32_t sample, std::uint32_t choices = 0);
  void enter(const Vec2& entry_mm);
  void follow_pending();
  bool advance(State& state);

  Step step_inside(State& state) const;
  double reach_side(const State& state, double limit, Step& step) const;
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
  void enter_contaminated(const State& state);
  bool meet_contaminated_entrance(const State& state);
  const EntranceScatter& scatter_at_face(const Ray& ray);
  std::vector<Stokes>& returned(const State& state) { return state.scattered ? tally_.scattered : tally_.returned; }
  bool is_on_chamfer(const Vec3& position) const { return !setup_.stops.is_clear(position.head<2>()); }
  /// Member function that records light outside all shells.
  using Record = void (PathWalker::*)(const State& state, const Light& light, const Vec3& direction);
  void record_outside(Record record, const State& state, const Light& light, const Vec3& direction);
  void leave(const State& state, const Light& light, const Vec3& direction);
  void record_return(const State& state, const Light& light, const Vec3& direction);
  void record_front_reflection(const State& state, const Light& light, const Vec3& direction);
  /// Result for a ray from outside: it does not meet the shells, it passes all of them, or it ends at one of them.
  enum class ShellEntry { outside, passed, stopped };
  ShellEntry enter_shells(State& state);
  void enter_through_shells(const Vec2& start_mm);
  bool pass_shells(ShellPassage passage, State& state);
  std::optional<State> beyond_shells(const State& state, const Light& light, const Vec3& direction);
  void report_exit(Account account, const State& state, const Vec3& direction, const Light& light,
                   bool is_front_reflection = false) const;
  bool meet_side(State& state, const Vec3& normal);
  bool meet_facet(State& state, const SurfaceHit& hit);
  Vec3 normal_at(const State& state, const FacetRef& where) const;
  bool meet_textured(State& state, const Vec3& normal, const Vec3& plane_normal, const Optics& optics);
  const Optics& optics_of(const FacetRef& facet) const;
  const Optics& optics_of_wall(const Vec3& position) const;
  Branch choose(Light& reflected, Light& transmitted);
  /// Light at a smooth face between transparent media, and the branches that are followed.
  struct SplitLight {
    materials::FresnelCoefficients f;
    Light reflected;
    Light transmitted;
    Branch branch;
  };
  SplitLight split_at_side(State& state, const Vec3& normal, double ratio, double cos_incidence);
  template <class Pass>
  bool continue_with(State& state, Branch branch, const Light& reflected, const Vec3& facing_normal, const Pass& pass);
  bool finish(const State& state, Account account);
  bool escape(const State& state);

  double start_tolerance(const Vec3& position) const;
  Medium medium_at(Vec3 position, double tolerance_mm) const;
  bool arrive_at_body(State& state);
  bool arrive_at_sheet(State& state);
  bool arrive_from_above(State& state, double reach_mm, double tolerance_mm);
  bool arrive_at_entrance(State& state);
  bool stop_at_mount(State& state);
  bool arrive_at_side(State& state, const Vec3& normal);
  bool arrive_from_below(State& state);
  bool begin_inside(State& state, double tolerance_mm);

  const PathSetup& setup_;
  Tally& tally_;
  ExitObserver* observer_;
  std::vector<State> pending_;
  EntranceScatter scatter_;
  Vec3 to_source_ = Vec3::UnitZ();  ///< direction opposite to the light that is traced
  /// true if the mount blocks the light of launch() on its way to the entrance face
  bool is_shadowed_ = false;
  bool splits_at_first_interface_ = true;  ///< true if both branches of the first interface are traced at any power
  Arrival arrival_ = Arrival::entrance;
  RandomKey key_;
  std::uint32_t replicate_ = 0;
  std::uint32_t sample_ = 0;
  std::uint32_t choices_ = 0;
};

/// Continues a path at a face with the chosen branch or both branches.
/// \param pass function that changes the state of the path to that of the transmitted branch
template <class Pass>
bool PathWalker::continue_with(State& state, Branch branch, const Light& reflected, const Vec3& facing_normal,
                               const Pass& pass) {
  if (branch == Branch::transmitted) {
    pass(state);
    return true;
  }
  if (branch == Branch::both) pass(pending_.emplace_back(state));
  state.light = reflected;
  state.direction = mirrored(state.direction, facing_normal);
  return true;
}

}  // namespace retrace::raytrace
