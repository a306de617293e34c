#pragma once

// The cell engine: moves streams of rays from column to column of an endless array and books where their power ends.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/random.h"
#include "raytrace/cells/cell_array.h"
#include "raytrace/cells/cell_lanes.h"
#include "raytrace/cells/ray_store.h"
#include "raytrace/faces/formed_facet.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/light/path_policy.h"
#include "raytrace/paths/soiled_entrance.h"

namespace retrace::raytrace {

/// A vector of a ray. \param first of its three numbers
inline Vec3 vector_of(const lanes::Rays& rays, std::size_t first, std::size_t k) {
  return {rays[first][k], rays[first + 1][k], rays[first + 2][k]};
}

/// Where on the part a ray is. \pre rays.have_periods()
inline Vec3 place_of(const lanes::Rays& rays, std::size_t k) {
  return vector_of(rays, lanes::kX, k) + Vec3(rays[lanes::kOx][k], rays[lanes::kOy][k], 0.0);
}

inline std::uint32_t owner_of(const lanes::Rays& rays, std::size_t k) {
  return rays.numbers == lanes::kRayNumbers ? static_cast<std::uint32_t>(rays[lanes::kOwner][k]) : 0;
}

/// Follows light through an endless array, column by column, many rays at once: all that are over one column, or under
/// its surface, wait in one stream and are moved in SIMD lanes, the fullest stream first. Rays that leave the inner
/// piece of a finite part are handed over to PathWalker, which traces its borders. One walker serves one thread.
class CellWalker {
 public:
  /// A ray that the walker does not follow any more.
  struct HandedOver {
    Vec3 position = Vec3::Zero();  ///< relative to the centre of the entrance face
    Ray ray;
    std::uint32_t owner = 0;
  };
  /// A ray that starts just below the entrance face: one that is handed over the other way. Owners are numbers by
  /// which rays are told apart.
  using Start = HandedOver;
  /// Told what becomes of rays by their owners.
  class Observer {
   public:
    virtual ~Observer() = default;
    /// As ExitObserver::leaves().
    virtual void leaves(std::uint32_t owner, const Vec3& position, const Vec3& direction, double power) = 0;
    /// Light that leaves through the back.
    virtual void is_transmitted(std::uint32_t owner, double power) = 0;
  };

  /// \param centre_mm of the entrance face; finite parts \param has_owners for follow(), in place of trace()
  CellWalker(const LightSetup& setup, const PathPolicy& policy, const CellArray& array, const Vec2& centre_mm,
             bool has_owners = false);
  CellWalker(const CellWalker&) = delete;
  CellWalker(CellWalker&&) = default;

  /// Traces light that enters at points `first`..`first + count - 1` of SobolSquare(key_x, key_y), spread over the
  /// rectangle `entrance_mm` (relative to the centre; infinite parts: one period), each as power 1. Random choices
  /// depend on `key`, `replicate` and `first` alone.
  void trace(const geometry::Rectangle& entrance_mm, std::uint64_t key_x, std::uint64_t key_y, std::uint32_t first,
             std::size_t count, RandomKey key, std::uint32_t replicate, Tally& tally);

  /// Follows rays that are in the part. \param entrance_mm of the whole part, as in trace() \pre a plane entrance face
  /// that does not scatter; the walker has owners
  void follow(const std::vector<Start>& starts, const geometry::Rectangle& entrance_mm, RandomKey key,
              std::uint32_t replicate, std::uint32_t first, Tally& tally, Observer& observer);

  /// What the last trace() or follow() has not followed to its end; none in infinite parts.
  const std::vector<HandedOver>& handed_over() const { return handed_over_; }
  /// Random choices made so far under the first point's number.
  std::uint32_t choices() const { return choices_; }

 private:
  /// Numbers of what lanes::advance_inside() and lanes::advance_outside() find.
  static constexpr double kFacet = 0.0;
  static constexpr double kTopOrNothing = 1.0;

  /// Where rays are. Over its own column a surface is convex: light that leaves it there does not come back before
  /// another column.
  enum class Place : std::uint8_t { inside, below, below_after_leaving };
  static constexpr std::size_t kPlaces = 3;
  static constexpr std::size_t kStreamsOfColumn = 2 * kPlaces;  ///< of light that has been scattered, and that has not

  /// One way on across a border.
  struct Crossing {
    std::uint32_t column = 0;
    Vec2 shift_mm = Vec2::Zero();
    Vec3 wall_normal = Vec3::Zero();  ///< out of the part
  };
  /// A border that needs a closer look: its stretches are numbered from `to` on.
  struct Refinement {
    double number = 0.0;
    double to = 0.0;
    lanes::Border border;
    std::size_t first_crossing = 0;
  };
  struct Stream {
    std::uint32_t column = 0;
    Place place = Place::inside;
    bool scattered = false;
    RayStore rays;
    std::vector<std::optional<Crossing>> borders;  ///< those with one level neighbour
    std::vector<Refinement> refinements;
    std::vector<Crossing> crossings;  ///< of the refinements
  };
  struct Shape {
    std::vector<lanes::Plane> facets;
    std::vector<lanes::Plane> borders;
    std::vector<lanes::LinearForm> heights;
    std::vector<std::optional<FacetFrame>> frames;  ///< of facets that have a form
    geometry::FacetRole role = geometry::FacetRole::retro_facet;
  };

  static std::uint32_t stream_of(std::uint32_t column, Place place, bool scattered) {
    return static_cast<std::uint32_t>(kStreamsOfColumn * column + (scattered ? kPlaces : 0) +
                                      static_cast<std::size_t>(place));
  }
  void prepare(Stream& stream) const;
  void begin(const geometry::Rectangle& entrance_mm, std::uint32_t first, std::size_t count, RandomKey key,
             std::uint32_t replicate, Tally& tally);
  void advance(std::uint32_t number);
  void move(const Stream& stream);
  void meet_surface(const Stream& stream);
  std::size_t facet_of(const Stream& stream, const Vec3& normal) const;
  void turn_normals(const Stream& stream);
  void meet_texture(const Stream& stream);
  void meet_layers(const Stream& stream, std::uint32_t reflected_to, std::uint32_t transmitted_to);
  void meet_wall(const Stream& stream, const Crossing& crossing, double number);
  void meet_faces(double number, bool inside, std::uint32_t reflected_to, std::uint32_t transmitted_to,
                  const Crossing* crossing);
  void meet_entrance(bool scattered);
  void meet_layers_of_entrance(bool scattered);
  void enter(std::size_t count);
  void enter_soiled(std::size_t count);
  void meet_soiled_entrance(bool scattered);
  const SoiledReturn& soiled(const Ray& ray);
  void put_in(const lanes::Rays& from, std::size_t k, const Vec3& place, const Ray& ray);
  void fall_in();
  void cross(const Stream& stream, const Crossing& crossing, double number);
  void fall(bool scattered);
  void book(double number, Account account);
  void tell_of_transmitted(double number);
  void tell_of_leaving(const lanes::Rays& left, std::size_t k);
  lanes::Met met();
  lanes::Meeting meeting(double number, bool inside);
  lanes::Rays end_of(std::uint32_t stream, std::size_t most);
  void grow(std::uint32_t stream, std::size_t more);
  void come_in(std::uint32_t stream, std::size_t more, const Vec2& shift);
  void hand_over(const lanes::Rays& rays, std::size_t count, const std::vector<double>& which, double number,
                 bool inside, bool scattered);
  /// Direction and light of the ray k.
  static void set(const lanes::Rays& rays, std::size_t k, const Ray& ray);
  Ray ray_of(const lanes::Rays& rays, std::size_t k, bool inside, bool scattered) const;
  void waits(std::uint32_t stream);
  std::optional<std::uint32_t> fullest();
  void truncate_weak();
  void reserve(std::size_t count);
  double random() { return unit_interval(philox(key_, replicate_, sample_, choices_++)[0]); }

  const LightSetup& setup_;
  const PathPolicy& policy_;
  const CellArray& array_;
  Tally* tally_ = nullptr;
  Observer* observer_ = nullptr;
  geometry::Rectangle inner_;      ///< finite parts: where rays are followed, relative to the centre
  geometry::Rectangle outline_;    ///< finite parts: of the entrance face
  Vec2 anchor_mm_ = Vec2::Zero();  ///< where the array starts, relative to the centre
  std::vector<HandedOver> handed_over_;
  std::vector<Shape> shapes_;  ///< of the columns
  std::vector<Stream> streams_;
  std::vector<std::vector<std::uint32_t>> waiting_;  ///< streams by the binary logarithm of their rays
  std::vector<lanes::LinearForm> pieces_;            ///< edges of the array's pieces
  std::vector<std::uint32_t> piece_starts_;
  RayStore moved_;                    ///< of the stream at hand
  RayStore chosen_;                   ///< those of them that meet the same
  std::array<RayStore, 2> entering_;  ///< below a soiled entrance: not scattered, and scattered
  RayStore left_;                     ///< what leaves through the entrance, if it is scored or told of
  std::vector<double> met_;           ///< by `moved_`: number, normal
  std::vector<double> branches_;      ///< marks of `chosen_`, or of weak rays
  std::size_t capacity_ = 0;
  std::uint64_t batches_ = 0;
  std::optional<SoiledEntrance> soiled_;  ///< where the entrance face scatters
  SoiledReturn from_soiled_;
  RandomKey key_;
  std::uint32_t replicate_ = 0;
  std::uint32_t sample_ = 0;
  std::uint32_t choices_ = 0;
};

}  // namespace retrace::raytrace
