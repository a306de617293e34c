#pragma once

// The cell engine. It moves groups of rays from column to column of an infinite array and records where power ends.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/random.h"
#include "raytrace/cells/cell_array.h"
#include "raytrace/cells/cell_lanes.h"
#include "raytrace/cells/ray_store.h"
#include "raytrace/faces/formed_facet.h"
#include "raytrace/faces/soiled_entrance.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/light/path_policy.h"

namespace retrace::raytrace {

/// Returns a vector of a ray.
/// \param first array of the x component; the arrays of y and z follow
inline Vec3 vector_of(const lanes::Rays& rays, std::size_t first, std::size_t k) {
  return {rays[first][k], rays[first + 1][k], rays[first + 2][k]};
}

/// Returns the position of a ray on the part.
/// \pre rays.have_periods()
inline Vec3 place_of(const lanes::Rays& rays, std::size_t k) {
  return vector_of(rays, lanes::kX, k) + Vec3(rays[lanes::kOx][k], rays[lanes::kOy][k], 0.0);
}

inline std::uint32_t owner_of(const lanes::Rays& rays, std::size_t k) {
  return rays.numbers == lanes::kRayNumbers ? static_cast<std::uint32_t>(rays[lanes::kOwner][k]) : 0;
}

/// Traces light through an infinite array, column by column, with many rays at a time. Rays wait in streams. Each
/// stream contains the rays on one side of the surface of one column. The stream with the most rays is processed first,
/// with SIMD. Rays that leave the inner region of a finite part are handed over to PathWalker. One walker serves one
/// thread.
class CellWalker {
 public:
  /// A ray that the walker does not trace further.
  struct HandedOver {
    Vec3 position = Vec3::Zero();  ///< relative to the centre of the entrance face
    Ray ray;
    std::uint32_t owner = 0;
  };
  /// A ray that starts just below the entrance face. The number of its owner identifies the path to which it belongs.
  using Start = HandedOver;
  /// Receives the light that leaves, with the owner of each ray.
  class Observer {
   public:
    virtual ~Observer() = default;
    /// Called when light leaves through the entrance face, see ExitObserver::leaves().
    virtual void leaves(std::uint32_t owner, const Vec3& position, const Vec3& direction, double power) = 0;
    /// Called when light leaves through the back.
    virtual void is_transmitted(std::uint32_t owner, double power) = 0;
  };

  /// \param centre_mm centre of the entrance face; used for finite parts
  /// \param has_owners true if follow() will be used, false if trace() will be used
  CellWalker(const LightSetup& setup, const PathPolicy& policy, const CellArray& array, const Vec2& centre_mm,
             bool has_owners = false);
  CellWalker(const CellWalker&) = delete;
  CellWalker(CellWalker&&) = default;

  /// Traces light that enters at the points `first` to `first + count - 1` of SobolSquare(key_x, key_y), each with
  /// power 1. The points are mapped to the rectangle `entrance_mm` (relative to the centre), or to one period of an
  /// infinite part. Random choices depend only on `key`, `replicate` and `first`.
  void trace(const geometry::Rectangle& entrance_mm, std::uint64_t key_x, std::uint64_t key_y, std::uint32_t first,
             std::size_t count, RandomKey key, std::uint32_t replicate, Tally& tally);

  /// Traces rays that start in the part.
  /// \param entrance_mm entrance face of the whole part, as in trace()
  /// \pre the entrance face is plane and does not scatter; the walker has owners
  void follow(const std::vector<Start>& starts, const geometry::Rectangle& entrance_mm, RandomKey key,
              std::uint32_t replicate, std::uint32_t first, Tally& tally, Observer& observer);

  /// Returns the rays that the last trace() or follow() has not traced to their end. There are none in infinite parts.
  const std::vector<HandedOver>& handed_over() const { return handed_over_; }
  /// Returns the number of random choices that the last trace() or follow() has made. Each choice uses the number of
  /// earlier choices and the number of the first point as counters of the random generator.
  std::uint32_t choices() const { return choices_; }

 private:
  /// Values of `which` that lanes::advance_inside() and lanes::advance_outside() return.
  static constexpr double kFacet = 0.0;
  static constexpr double kTopOrNothing = 1.0;

  /// Location of rays relative to the surface of a column. The surface is convex. Light that leaves it can therefore
  /// meet only the surfaces of other columns.
  enum class Place : std::uint8_t { inside, below, below_after_leaving };
  static constexpr std::size_t kPlaces = 3;
  static constexpr std::size_t kStreamsOfColumn = 2 * kPlaces;  ///< separate streams for scattered light

  /// A neighbouring column behind a border.
  struct Crossing {
    std::uint32_t column = 0;
    Vec2 shift_mm = Vec2::Zero();
    Vec3 wall_normal = Vec3::Zero();  ///< normal of the wall, which points out of the part
  };
  /// Border of a column that needs the additional test lanes::refine(), because it has several neighbours or a wall.
  /// The results of this test are numbered from `to` on.
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
    std::vector<std::optional<Crossing>> borders;  ///< set for borders with a single neighbour of the same height
    std::vector<Refinement> refinements;
    std::vector<Crossing> crossings;  ///< neighbours behind the borders of `refinements`
  };
  struct Shape {
    std::vector<lanes::Plane> facets;
    std::vector<lanes::Plane> borders;
    std::vector<lanes::LinearForm> heights;
    std::vector<std::optional<FacetFrame>> frames;  ///< set for facets with a form
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
  /// Sets the direction and the light of ray k.
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
  geometry::Rectangle inner_;      ///< finite parts: region in which rays are traced, relative to the centre
  geometry::Rectangle outline_;    ///< finite parts: outline of the entrance face
  Vec2 anchor_mm_ = Vec2::Zero();  ///< origin of the array, relative to the centre
  std::vector<HandedOver> handed_over_;
  std::vector<Shape> shapes_;  ///< indexed by column
  std::vector<Stream> streams_;
  std::vector<std::vector<std::uint32_t>> waiting_;  ///< streams, indexed by the bit width of their number of rays
  std::vector<lanes::LinearForm> pieces_;            ///< edges of CellArray::pieces() as linear forms
  std::vector<std::uint32_t> piece_starts_;
  RayStore moved_;                    ///< rays of the current stream
  RayStore chosen_;                   ///< rays of `moved_` that have met the same kind of face
  std::array<RayStore, 2> entering_;  ///< rays just below a contaminated entrance: [0] unscattered, [1] scattered
  RayStore left_;                     ///< rays that leave through the entrance, if they are scored or observed
  std::vector<double> met_;           ///< number and normal of the face that each ray of `moved_` has met
  std::vector<double> branches_;      ///< marks (`which`) of rays of `chosen_`, or of weak rays of `moved_`
  std::size_t capacity_ = 0;
  std::uint64_t batches_ = 0;
  std::optional<SoiledEntrance> soiled_;  ///< set if the entrance face scatters
  SoiledReturn from_soiled_;
  RandomKey key_;
  std::uint32_t replicate_ = 0;
  std::uint32_t sample_ = 0;
  std::uint32_t choices_ = 0;
};

}  // namespace retrace::raytrace
