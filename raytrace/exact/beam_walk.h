#pragma once

// A run of the exact engine: traces beams until the remaining power is small enough.

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "raytrace/exact/beam_queue.h"
#include "raytrace/exact/beam_record.h"
#include "raytrace/exact/beam_scene.h"
#include "raytrace/exact/visible_facets.h"

namespace retrace::raytrace {

/// Traces beams through a part until the remaining power is small enough. An object is used for one trace.
class BeamWalk {
 public:
  BeamWalk(const BeamScene& scene, BeamObserver observer)
      : scene_(scene), record_(scene, std::move(observer)), facets_(scene) {}

  enum class CutoffMode { decreasing, fixed, deferring };
  /// Starts the trace.
  /// \param cutoff minimum power of traced beams. CutoffMode::fixed does not change it. CutoffMode::decreasing lowers
  /// it
  ///        until the truncated power is small enough. CutoffMode::deferring keeps weaker beams until
  ///        lower_cutoff_to() is called.
  void enter(double cutoff, CutoffMode approach);
  enum class End { done, paused, cancelled, cutoff_too_high };
  /// Traces beams above the cut-off until the goal is reached, the total work is `max_work`, or the number of kept
  /// beams reaches the limit of pause_at_deferred().
  End run(std::uint64_t max_work, const Cancellation* cancel);

  /// Returns the beams below the cut-off, in the order in which they were found.
  /// \pre the mode is CutoffMode::deferring, and run() has returned End::done
  const WaitingBeams& deferred() const { return queue_.deferred(); }
  /// Makes run() pause when this number of beams below the cut-off is kept. Then call take_deferred().
  void pause_at_deferred(std::size_t most) { max_deferred_ = most; }
  WaitingBeams take_deferred() { return queue_.take_deferred(); }
  /// Lowers the cut-off. The next run() traces the kept beams that are not below the new cut-off.
  /// \pre the mode is CutoffMode::deferring, and run() has returned End::done
  void lower_cutoff_to(double cutoff);
  /// Traces a single beam to the next faces. The resulting beams are queued, see take_waiting().
  void step(const Beam& beam, const Cancellation* cancel);
  /// Removes and returns the beams queued by step().
  WaitingBeams take_waiting();
  /// See BeamRecord::set_replicate().
  void set_replicate(std::uint32_t replicate) { record_.set_replicate(replicate); }
  /// See BeamRecord::collect_scatter_sites().
  void collect_scatter_sites(std::vector<ScatterSite>& sites) { record_.collect_scatter_sites(sites); }
  /// Adds power that is not traced further to the ledger.
  void add_truncated(double power) { record_.add_truncated(power); }
  const Tally& tally() const { return record_.tally(); }
  /// Returns the power that is compared with the cut-off (see BeamPolicy::cutoff).
  double power_for_cutoff(const Beam& beam) const { return scene_.setup.infinite() ? beam.power : beam.total_power(); }
  /// Returns one of the copies that a beam represents. The returned beam represents only itself.
  /// \param index index in Beam::instance_offsets
  Beam instance(const Beam& beam, std::size_t index) const;

  BeamResult result() const;
  std::uint64_t beams() const { return beams_; }
  std::uint32_t depth() const { return depth_; }
  double cutoff() const { return cutoff_; }
  double deferred_power() const { return queue_.deferred_power(); }
  /// Returns the work done so far. The unit is a test of a facet's bounding box, about 20 ns. The number does not
  /// depend on the machine.
  std::uint64_t work() const { return work_ + facets_.work() + queue_.work(); }
  /// Returns the total work until the goal is reached, extrapolated from the work done so far.
  double expected_work() const;

 private:
  void split_instances(Beam& beam);
  bool may_stop() const;
  void lower_cutoff();
  void close();
  void advance(const Beam& beam, const Cancellation* cancel);
  [[noreturn]] void fail_on_budget() const;

  BeamScene scene_;
  BeamRecord record_;
  BeamQueue queue_;
  VisibleFacets facets_;
  std::size_t max_deferred_ = std::numeric_limits<std::size_t>::max();
  double cutoff_ = 0.0;
  CutoffMode mode_ = CutoffMode::fixed;
  /// State at the start of the pass with the present cut-off.
  struct Pass {
    double work = 0.0;
    double power = 1.0;  ///< open power
  };
  Pass pass_;
  std::uint64_t beams_ = 0;
  std::uint64_t work_ = 0;  ///< work other than that of `facets_` and `queue_`
  std::uint32_t depth_ = 0;
};

}  // namespace retrace::raytrace
