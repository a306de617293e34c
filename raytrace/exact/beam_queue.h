#pragma once

// Queues of the beams of a run. They also record the total power and the memory use of the beams.

#include <cstdint>
#include <memory>
#include <utility>

#include "core/memory_budget.h"
#include "raytrace/exact/beam.h"

namespace retrace::raytrace {

/// Beams of a run that have not been traced yet. Pending beams are traced next. Deferred beams are below the cut-off
/// and wait for a lower cut-off.
class BeamQueue {
 public:
  /// Sets the power of a beam and adds it to the pending beams.
  void push(Beam&& beam);
  /// Removes and returns the pending beam that was added last.
  Beam pop();
  bool has_pending() const { return !pending_.beams.empty(); }
  std::size_t pending_count() const { return pending_.beams.size(); }
  double pending_power() const { return pending_.power; }
  /// Removes and returns all pending beams.
  WaitingBeams take_pending() { return taken(pending_).beams; }

  /// Adds a beam below the cut-off to the deferred beams.
  /// \param may_discard true: the beam is discarded if is_full(); deferred_power() then still includes its power
  void defer(Beam&& beam, bool may_discard);
  /// Returns true if the list of deferred beams is full. Further beams may then be discarded, and a lower cut-off
  /// requires a new run.
  bool is_full() const;
  const WaitingBeams& deferred() const { return deferred_.beams; }
  /// Returns the power of all deferred beams, including those that have been discarded.
  double deferred_power() const { return deferred_.power; }
  /// Removes and returns all deferred beams.
  WaitingBeams take_deferred() { return taken(deferred_).beams; }
  /// Makes all deferred beams pending.
  /// \pre no beam is pending
  void resume_deferred();
  /// Discards the pending beams. Their power is added to that of the deferred beams.
  void discard_pending();

  /// Returns the power of all pending and deferred beams, including the discarded beams.
  double open_power() const { return pending_.power + deferred_.power; }
  /// Returns a shared list of displacements (Beam::instance_offsets), or null for a single displacement. The list
  /// counts as memory of this run until the last beam that uses it is destroyed.
  std::shared_ptr<const InstanceOffsets> shared(InstanceOffsets offsets);
  /// Returns the work of making the lists Beam::instance_offsets, in units of BeamWalk::work().
  std::uint64_t work() const { return work_; }
  /// Checks that the beams fit into the memory.
  /// \throw BudgetError if the beams of this run exceed the memory budget
  /// \throw SharedMemoryExceeded if all parallel traces together exceed their limit, see BeamMemory::require_shared()
  void require_memory() const;

 private:
  /// List of beams, with their total power and their memory use in bytes.
  struct Waiting {
    WaitingBeams beams;
    double power = 0.0;
    std::uint64_t bytes = 0;

    void swap(Waiting& other) {
      beams.swap(other.beams);
      std::swap(power, other.power);
      std::swap(bytes, other.bytes);
    }
  };
  /// Empties a list and returns its previous content.
  Waiting taken(Waiting& list);

  Waiting pending_;
  Waiting deferred_;
  std::shared_ptr<BeamMemory> memory_ = std::make_shared<BeamMemory>();
  std::uint64_t work_ = 0;
};

}  // namespace retrace::raytrace
