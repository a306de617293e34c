#pragma once

// Beams too weak to be followed one by one: resampled generation by generation, in independent replicates.

#include <cstdint>
#include <functional>
#include <vector>

#include "core/progress.h"
#include "geometry/part/part.h"
#include "raytrace/exact/beam.h"

namespace retrace::raytrace {

class BeamWalk;

/// A generation of weak beams, from which a few survivors are selected at random. All beams of a generation have met
/// the same number of interfaces since their power fell below the threshold of exact tracing. They are sorted by
/// direction and position, because similar beams lead to similar results, and the survivors are selected in this order
/// (Array-RQMC: L'Ecuyer, Lecot and Tuffin, Operations Research 56, 958, 2008).
/// A beam may represent copies at several positions (Beam::places). It then has one entry per position, and each
/// survivor has a single position. In an infinite part, a survivor starts at the first position and represents all of
/// them.
class BeamGeneration {
 public:
  /// \param part whose periods or outline places are compared by \param beams outlive this
  BeamGeneration(const geometry::Part& part, const WaitingBeams& beams);

  double power() const { return power_; }
  /// Whether there is enough of it to be followed.
  bool counts() const;
  /// How many survive if each may stand for so much.
  double survivor_count(double most_power) const;
  /// Chosen by systematic resampling: each stands for `most_power` or less, and all together for what the generation
  /// has. None if it does not count.
  /// \param offset in [0, 1): where the first of equally spaced marks falls
  /// \param walk knows beams at other places
  /// \param follow is called for each, in their order, with a beam that is good until it returns \return their number
  std::size_t for_each_survivor(double most_power, double offset, const BeamWalk& walk,
                                const std::function<void(const Beam&)>& follow) const;

 private:
  struct Entry {
    std::uint64_t order;  ///< of direction and place
    std::size_t beam;
    double power_up_to;  ///< sum of the powers of all entries up to and including this entry
  };
  const WaitingBeams& beams_;
  bool is_endless_;
  std::vector<Entry> entries_;
  double power_ = 0.0;
};

/// What one replicate keeps of weak beams.
struct Resampling {
  double most_power = 0.0;  ///< that a survivor stands for
  std::uint32_t seed = 1;
  std::uint32_t replicate = 0;
  std::uint32_t round = 0;  ///< of as many first generations as share seed and replicate

  /// A random number of its own for each generation.
  double offset(std::uint32_t generation) const;
};

/// Follows the survivors of a generation, those of the parts that they fall into, and so on, until nothing is left that
/// counts; that is booked as `truncated`. \param after_each is called after each generation \return false if it was
/// cancelled
bool follow_survivors(BeamWalk& walk, const geometry::Part& part, const BeamGeneration& first, const Resampling& how,
                      const Cancellation* cancel, const std::function<void()>& after_each = {});

}  // namespace retrace::raytrace
