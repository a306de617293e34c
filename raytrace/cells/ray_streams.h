#pragma once

// Queues of the rays that the cell engine traces, and the list of rays that leave the region in which it can trace
// rays.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/cells/ray_batch.h"

namespace retrace::raytrace {

/// A ray that the cell engine receives from its caller or returns to it.
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

  /// Returns the arrays of a stream, starting behind its last ray, with memory for `most` further rays.
  lanes::Rays end_of(const StreamKey& key, std::size_t most);
  /// Adds `more` rays to a stream. Their values must have been written behind the last ray of the stream, see end_of().
  void grow(const StreamKey& key, std::size_t more);
  /// Adds `more` rays that come from another column, in the same way as grow(). Rays outside of the inner region are
  /// handed over instead.
  /// \param shift_mm shift from the coordinates of the rays to the coordinates of the column
  void grow_from_neighbour(const StreamKey& key, std::size_t more, const Vec2& shift_mm);
  /// Moves the rays of the fullest stream to `rays` and returns the key of the stream. The sizes of streams are
  /// compared by their bit widths. Returns nothing if all streams are empty.
  std::optional<StreamKey> take_fullest(RayStore& rays);

  /// Hands over the rays that would be outside of the inner region after moving along their direction by the height
  /// difference `height_mm`. Moves the other rays to the front of the arrays and returns their number.
  std::size_t keep_inner(const lanes::Rays& rays, std::size_t count, double height_mm, bool inside, bool scattered);
  /// Appends the rays that have the given label to handed_over().
  void hand_over(const lanes::Rays& rays, std::size_t count, const lanes::Label* labels, lanes::Label label,
                 bool inside, bool scattered);
  const std::vector<CellRay>& handed_over() const { return handed_over_; }
  void clear_handed_over() { handed_over_.clear(); }

 private:
  static constexpr std::size_t kLocations = 3;
  static constexpr std::size_t kStreamsOfColumn = 2 * kLocations;  ///< scattered light has separate streams

  static std::size_t index_of(const StreamKey& key) {
    return kStreamsOfColumn * key.column + (key.scattered ? kLocations : 0) + static_cast<std::size_t>(key.location);
  }
  static StreamKey key_of(std::size_t index);

  std::optional<geometry::Rectangle> inner_mm_;
  std::vector<RayStore> streams_;
  std::vector<std::vector<std::size_t>> waiting_;  ///< indices of streams, by the bit width of their size
  std::vector<lanes::Label> labels_;
  std::vector<CellRay> handed_over_;
};

}  // namespace retrace::raytrace
