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
///
/// A beam that has not been traced is pending (it is traced next) or deferred (its power is below the cut-off). If the
/// list of deferred beams is full, further beams are discarded and only their power is stored. The open power is the
/// power of all pending, deferred and discarded beams. Power that is never traced is added to `truncated` in the
/// ledger. The goal is BeamPolicy::truncated_goal.
///
/// There are two ways to use an object. enter() and run() trace all beams that enter the part. step() and
/// take_waiting() trace given beams one interface at a time; resampling uses them for the survivors (see
/// follow_survivors()).
class BeamWalk {
 public:
  BeamWalk(const BeamScene& scene, BeamObserver observer)
      : scene_(scene), record_(scene, std::move(observer)), facets_(scene) {}

  /// Treatment of the cut-off, which is the minimum power of traced beams.
  enum class CutoffMode {
    decreasing,  ///< run() lowers the cut-off until the open power is at most the goal
    fixed,       ///< the power of all weaker beams is added to `truncated`
    deferring    ///< all weaker beams are stored, until the caller takes them or lowers the cut-off
  };
  /// Starts the trace.
  /// \param cutoff minimum power of traced beams. With CutoffMode::decreasing and a goal above kFinestGoal, it is a
  ///        multiple of the mean power of the beams that enter the part.
  void enter(double cutoff, CutoffMode approach);
  enum class End {
    done,            ///< the trace has ended; with CutoffMode::deferring, no beam above the cut-off is left
    paused,          ///< `max_work` or the limit of pause_at_deferred() was reached; run() can be called again
    cancelled,       ///< the user cancelled the computation
    cutoff_too_high  ///< a lower cut-off is required, but the list of deferred beams is full; a new trace is required
  };
  /// Traces beams above the cut-off until the trace ends, the total work is `max_work`, or the number of deferred beams
  /// reaches the limit of pause_at_deferred(). With CutoffMode::decreasing, the trace ends when the open power is at
  /// most the goal. With the other modes, it ends when no beam above the cut-off is left.
  End run(std::uint64_t max_work, const Cancellation* cancel);

  /// Returns the deferred beams, in the order in which they were found.
  /// \pre the mode is CutoffMode::deferring, and run() has returned End::done
  const WaitingBeams& deferred() const { return queue_.deferred(); }
  /// Makes run() pause when this number of beams is deferred. Then call take_deferred().
  void pause_at_deferred(std::size_t most) { max_deferred_ = most; }
  WaitingBeams take_deferred() { return queue_.take_deferred(); }
  /// Lowers the cut-off. The next run() traces the deferred beams that are not below the new cut-off.
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
  /// Returns the number of traced beams.
  std::uint64_t beams() const { return beams_; }
  /// Returns the maximum number of interfaces on the path of a traced beam.
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
  /// State at the start of the present pass. A pass traces all beams above one cut-off.
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
