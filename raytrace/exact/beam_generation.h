#pragma once

// Population control of weak beams: they are resampled generation by generation in independent replicates.

#include <cstdint>
#include <functional>
#include <vector>

#include "core/progress.h"
#include "geometry/part/part.h"
#include "raytrace/exact/beam.h"

namespace retrace::raytrace {

class BeamWalk;

/// A generation of weak beams, from which a few survivors are selected at random. Beams are weak if their power is
/// below the threshold of exact tracing. All beams of a generation have met the same number of interfaces since they
/// became weak. The beams are sorted by direction and position, and the survivors are selected in this order. Similar
/// beams lead to similar results, so that this order reduces the variance (Array-RQMC: L'Ecuyer, Lecot and Tuffin,
/// Operations Research 56, 958, 2008).
///
/// A beam may represent copies at several positions (Beam::instance_offsets). In a finite part, each copy may survive
/// separately. In an infinite part, a survivor represents all copies of its beam.
class BeamGeneration {
 public:
  /// \param part the part, whose period or outline is used to compare positions
  /// \param beams beams of the generation; must outlive this object
  BeamGeneration(const geometry::Part& part, const WaitingBeams& beams);

  double power() const { return power_; }
  /// Returns true if the generation has enough power to be traced.
  bool is_significant() const;
  /// Returns the number of survivors if the power of a survivor must not exceed `max_power`.
  double survivor_count(double max_power) const;
  /// Selects survivors by systematic resampling and calls `follow` for each of them. Each survivor has at most the
  /// power `max_power`, and their total power is that of the generation. There are no survivors if is_significant() is
  /// false.
  /// \param offset position of the first of the equally spaced sampling points, in [0, 1)
  /// \param walk computes the copy of a beam at another position
  /// \param follow receives the survivors in order; each reference is valid only during the call
  /// \return the number of survivors
  std::size_t for_each_survivor(double max_power, double offset, const BeamWalk& walk,
                                const std::function<void(const Beam&)>& follow) const;

 private:
  struct Entry {
    /// Sorting key: rank of the direction (upper bits) and Morton code of the position (lower bits).
    std::uint64_t order;
    std::size_t beam;
    double power_up_to;  ///< cumulative power: sum over all entries up to and including this entry
  };
  const WaitingBeams& beams_;
  bool is_infinite_;
  std::vector<Entry> entries_;
  double power_ = 0.0;
};

/// Parameters of the resampling of weak beams in one replicate.
struct Resampling {
  double max_power = 0.0;  ///< maximum power of a survivor
  std::uint32_t seed = 1;
  std::uint32_t replicate = 0;
  std::uint32_t round = 0;  ///< number of the round; each round has its own first generation

  /// Returns the random offset for for_each_survivor(). Each generation has an independent offset.
  double offset(std::uint32_t generation) const;
};

/// Traces the survivors of a generation, then the survivors of the beams into which these split, and so on. The
/// function ends when the remaining power is negligible, and adds this power to `truncated`.
/// \param after_each is called after each generation
/// \return false if the trace was cancelled
bool follow_survivors(BeamWalk& walk, const geometry::Part& part, const BeamGeneration& first, const Resampling& how,
                      const Cancellation* cancel, const std::function<void()>& after_each = {});

}  // namespace retrace::raytrace
