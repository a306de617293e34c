#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/random.h"
#include "geometry/part.h"
#include "materials/fresnel.h"
#include "raytrace/back_surface.h"
#include "raytrace/field.h"
#include "raytrace/ledger.h"
#include "raytrace/optics.h"

namespace retrace::raytrace {

/// How paths are followed.
struct PathPolicy {
  double cutoff = 1e-10;      ///< power below which a path ends in `truncated`
  double split_power = 1e-3;  ///< both branches of an interface are followed while each carries at least this
  std::uint32_t max_events = 1'000'000;  ///< hits on one path before it ends in `truncated`
};

/// Sums of power over paths. What leaves through the entrance face is kept by acceptance cone, so that one run serves
/// several cones.
struct Tally {
  explicit Tally(std::size_t cone_count = 0) : returned(cone_count + 1, 0.0), front(cone_count + 1, 0.0) {}

  std::vector<double> returned;  ///< through the entrance, by the narrowest cone that holds it; last: outside all
  std::vector<double> front;     ///< first-surface reflection, likewise
  Ledger other;                  ///< the remaining accounts
  std::uint64_t segments = 0;    ///< straight pieces traced
  std::uint64_t misses = 0;      ///< rays that missed every face although the part or its surface surrounds them

  void add(const Tally& more);
  /// The ledger for one cone, in units of the tally. \param cone index into the cones of the set-up
  Ledger ledger(std::size_t cone) const;
};

/// One part, lit from one direction: what every path of a run shares. Positions are relative to the centre of the
/// entrance face in x and y.
struct PathSetup {
  /// A side of the part: a vertical plane.
  struct Side {
    Vec3 normal = Vec3::UnitX();  ///< out of the part
    double offset_mm = 0.0;
  };

  /// \param cones_deg half angles of the acceptance cones, ascending, each > 0
  PathSetup(const geometry::Part& part, const BackSurface& surface, const Vec2& centre_mm, const Optics& optics,
            const Illumination& illumination, const std::vector<double>& cones_deg, const PathPolicy& policy);

  const BackSurface& surface;
  Optics optics;
  PathPolicy policy;
  double thickness_mm = 0.0;
  double depth_mm = 0.0;
  double clearance_mm = 0.0;         ///< height above z = 0 from which the back surface is looked for
  std::vector<Side> sides;           ///< empty for an infinite part
  Vec2 period_mm = Vec2::Zero();     ///< infinite part
  Vec2 tile_half_mm = Vec2::Zero();  ///< infinite part: half size of the piece of surface that stands for it
  Vec3 to_source = Vec3::UnitZ();
  std::vector<double> cone_chord2;  ///< squared distance of unit vectors at each cone's edge from the one to the source

  bool infinite() const { return sides.empty(); }
};

/// Follows light through a part: refraction and reflection at every interface with polarisation, both branches where
/// both matter, one chosen at random with the whole power where not. One walker serves one thread.
class PathWalker {
 public:
  PathWalker(const PathSetup& setup, Tally& tally) : setup_(setup), tally_(tally) {}

  /// Traces all light that enters at a point of the entrance face, as power 1. Random choices depend on `key`,
  /// `replicate` and `sample` alone.
  void trace(const Vec2& entry_mm, RandomKey key, std::uint32_t replicate, std::uint32_t sample);

 private:
  struct State {
    Vec3 position = Vec3::Zero();
    Vec3 direction = Vec3::UnitZ();
    Field field;
    FacetRef source;  ///< facet that the path has just left
    bool near_edge = false;
    bool inside = true;
    geometry::FacetRole left_through = geometry::FacetRole::retro_facet;  ///< last face it left the part through
    std::uint32_t events = 0;
  };
  enum class End { facet, entrance, side, escape, miss, trapped };
  struct Step {
    End end = End::miss;
    SurfaceHit hit;
    std::size_t side = 0;
    double length_mm = 0.0;
  };
  enum class Branch { reflected, transmitted, both };

  void enter(const Vec2& entry_mm);
  bool advance(State& state);

  Step step_inside(State& state) const;
  Step step_inside_periodic(State& state) const;
  Step step_outside(State& state) const;
  Step step_outside_periodic(State& state) const;
  std::optional<SurfaceHit> search(const State& state, double t_max) const;
  std::optional<SurfaceHit> search_exactly(const State& state, double t_max) const;
  std::optional<SurfaceHit> search_certainly(const State& state) const;
  double distance_to_tile_border(const State& state) const;
  void wrap(State& state) const;
  bool is_over_part(const Vec3& position) const;

  bool meet_entrance(State& state);
  bool meet_side(State& state, const Vec3& normal);
  bool meet_facet(State& state, const SurfaceHit& hit);
  Branch choose(Field& reflected, Field& transmitted);
  void book_by_cone(std::vector<double>& by_cone, const Vec3& direction, double power) const;
  bool finish(const State& state, Account account);
  bool escape(const State& state);

  const PathSetup& setup_;
  Tally& tally_;
  std::vector<State> pending_;
  RandomKey key_;
  std::uint32_t replicate_ = 0;
  std::uint32_t sample_ = 0;
  std::uint32_t choices_ = 0;
};

}  // namespace retrace::raytrace
