#pragma once

// Queues of the rays that the cell engine traces, and the list of rays that leave the region in which it traces them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/cells/ray_batch.h"

namespace retrace::raytrace {

/// A ray that the cell engine receives from, or hands over to, another part of the program.
struct CellRay {
  Vec3 position = Vec3::Zero();  ///< relative to the centre of the entrance face
  Ray ray;
  std::uint32_t owner = 0;  ///< number of the path to which the ray belongs
};

/// Streams of rays that wait for their next step. In finite parts, rays that leave the inner region are handed over
/// instead: they are stored in a list, and another engine traces them further.
class RayStreams {
 public:
  /// \param numbers number of values per ray, see lanes::Rays
  /// \param inner_mm finite parts: inner region, relative to the centre of the entrance face
  RayStreams(std::size_t column_count, std::size_t numbers, const std::optional<geometry::Rectangle>& inner_mm);

  /// Returns the arrays behind the last ray of a stream, with memory for `most` rays.
  lanes::Rays end_of(const StreamKey& key, std::size_t most);
  /// Adds rays to a stream. Their values have already been written behind its last ray.
  void grow(const StreamKey& key, std::size_t more);
  /// Adds rays that come from another column in the same way.
  /// \param shift_mm added to the positions of the rays to get the coordinates of the column
  void come_in(const StreamKey& key, std::size_t more, const Vec2& shift_mm);
  /// Replaces `rays` by the rays of the stream with the most rays. Returns nothing if all streams are empty.
  std::optional<StreamKey> take_fullest(RayStore& rays);

  /// Hands over the rays that would be outside of the inner region after moving along their direction by the height
  /// difference `height_mm`. The other rays are moved to the front of the arrays, and their number is returned.
  std::size_t keep_inner(const lanes::Rays& rays, std::size_t count, double height_mm, bool inside, bool scattered);
  /// Moves the rays that have the given label to handed_over().
  void hand_over(const lanes::Rays& rays, std::size_t count, const lanes::Label* labels, lanes::Label label,
                 bool inside, bool scattered);
  const std::vector<CellRay>& handed_over() const { return handed_over_; }
  void clear_handed_over() { handed_over_.clear(); }

 private:
  static constexpr std::size_t kPlaces = 3;
  static constexpr std::size_t kStreamsOfColumn = 2 * kPlaces;  ///< separate streams for scattered light

  static std::size_t index_of(const StreamKey& key) {
    return kStreamsOfColumn * key.column + (key.scattered ? kPlaces : 0) + static_cast<std::size_t>(key.place);
  }
  static StreamKey key_of(std::size_t index);

  std::optional<geometry::Rectangle> inner_mm_;
  std::vector<RayStore> streams_;
  std::vector<std::vector<std::size_t>> waiting_;  ///< streams, indexed by the bit width of their number of rays
  std::vector<lanes::Label> labels_;
  std::vector<CellRay> handed_over_;
};

}  // namespace retrace::raytrace
