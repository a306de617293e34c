#pragma once

// The cell engine. It moves groups of rays from column to column of an infinite array and adds their power to the
// accounts of the ledger.

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "raytrace/cells/cell_array.h"
#include "raytrace/cells/cell_entrance.h"
#include "raytrace/cells/cell_step.h"
#include "raytrace/cells/column_faces.h"
#include "raytrace/cells/ray_streams.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/light/path_policy.h"

namespace retrace::raytrace {

/// Traces light through an infinite array, column by column, with many rays at a time. Rays wait in streams. Each
/// stream contains the rays on one side of the surface of one column. The stream with the most rays is processed first,
/// with SIMD. Rays that leave the inner region of a finite part are not traced further. The caller continues them with
/// PathWalker, see handed_over(). One walker serves one thread.
class CellWalker {
 public:
  /// \param centre_mm centre of the entrance face; used for finite parts
  /// \param has_owners true if follow() will be used, false if trace() will be used
  CellWalker(const LightSetup& setup, const PathPolicy& policy, const CellArray& array, const Vec2& centre_mm,
             bool has_owners = false);
  CellWalker(const CellWalker&) = delete;
  CellWalker(CellWalker&&) = default;

  /// Traces light that enters at the points `first` to `first + count - 1` of SobolSquare(key_x, key_y), each with
  /// power 1. The points are mapped to the rectangle `entrance_mm` (relative to the centre of the entrance face), or to
  /// one period of an infinite part. Random choices depend only on `key`, `replicate` and `first`.
  void trace(const geometry::Rectangle& entrance_mm, std::uint64_t key_x, std::uint64_t key_y, std::uint32_t first,
             std::size_t count, RandomKey key, std::uint32_t replicate, Tally& tally);

  /// Traces rays that start just below the entrance face.
  /// \param entrance_mm entrance face of the whole part, as in trace()
  /// \pre the entrance face is plane and does not scatter; the walker was constructed with `has_owners`
  void follow(const std::vector<CellRay>& starts, const geometry::Rectangle& entrance_mm, RandomKey key,
              std::uint32_t replicate, std::uint32_t first, Tally& tally, CellObserver& observer);

  /// Returns the rays that the last trace() or follow() has not traced to their end. There are none in infinite parts.
  const std::vector<CellRay>& handed_over() const { return streams_.handed_over(); }
  /// Returns the number of random choices that the last trace() or follow() has made, see CellRun.
  std::uint32_t choices() const { return choices_; }

 private:
  void reserve(std::size_t count);
  void begin(std::size_t count);
  void advance_all(CellRun& run);
  void advance(CellRun& run);
  void truncate_weak(Tally& tally);

  const LightSetup& setup_;
  const PathPolicy& policy_;
  const CellArray& array_;
  Vec2 anchor_mm_;  ///< origin of the array, relative to the centre of the entrance face
  ColumnFaces faces_;
  RayStreams streams_;
  CellEntrance entrance_;
  RayBatch batch_;  ///< rays of the present step
  std::uint32_t choices_ = 0;
};

}  // namespace retrace::raytrace
