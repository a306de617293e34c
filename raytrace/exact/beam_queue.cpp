#include "raytrace/exact/beam_queue.h"

#include <fmt/format.h>

#include "raytrace/exact/beam_scene.h"

namespace retrace::raytrace {
namespace {

// Maximum number of beams below the cut-off that are kept for a later pass with a lower cut-off. They take about 150
// MB. Their memory is also limited to three quarters of beam_memory_bytes().
constexpr std::size_t kMaxDeferred = 200'000;
// Work of storing one displacement in a list Beam::instance_offsets, in units of BeamWalk::work().
constexpr std::uint64_t kWorkOfPlace = 1;

/// Returns the memory in bytes of a queued beam, without its list of positions.
std::uint64_t bytes_of(const Beam& beam) {
  return sizeof(Beam) + beam.hits.capacity() * sizeof(TexturedHit);
}

}  // namespace

void BeamQueue::push(Beam&& beam) {
  beam.power = power_of(beam);
  pending_.power += beam.total_power();
  pending_.bytes += bytes_of(beam);
  memory_->add(bytes_of(beam));
  pending_.beams.push_back(std::move(beam));
}

Beam BeamQueue::pop() {
  Beam beam = std::move(pending_.beams.back());
  pending_.beams.pop_back();
  pending_.power -= beam.total_power();
  pending_.bytes -= bytes_of(beam);
  memory_->remove(bytes_of(beam));
  return beam;
}

BeamQueue::Waiting BeamQueue::taken(Waiting& list) {
  memory_->remove(list.bytes);
  Waiting taken;  // a new list replaces the old one, because clear() of an empty boost deque adds to a null pointer
  list.swap(taken);
  return taken;
}

void BeamQueue::defer(Beam&& beam, bool may_discard) {
  deferred_.power += beam.total_power();
  if (may_discard && is_full()) return;
  deferred_.bytes += bytes_of(beam);
  memory_->add(bytes_of(beam));
  deferred_.beams.push_back(std::move(beam));
}

bool BeamQueue::is_full() const {
  return deferred_.beams.size() > kMaxDeferred || deferred_.bytes > beam_memory_bytes() / 4 * 3;
}

void BeamQueue::resume_deferred() {
  pending_.swap(deferred_);
  deferred_.power = 0.0;
}

void BeamQueue::discard_pending() {
  for (const Beam& beam : take_pending()) deferred_.power += beam.total_power();
}

std::shared_ptr<const InstanceOffsets> BeamQueue::shared(InstanceOffsets offsets) {
  if (offsets.size() <= 1) return nullptr;
  offsets.shrink_to_fit();
  const std::uint64_t bytes = offsets.size() * sizeof(Vec2);
  work_ += kWorkOfPlace * offsets.size();
  memory_->add(bytes);
  return {new InstanceOffsets(std::move(offsets)), [memory = memory_, bytes](const InstanceOffsets* gone) {
            memory->remove(bytes);
            delete gone;
          }};
}

void BeamQueue::require_memory() const {
  if (memory_->is_exceeded())
    throw TraceBudgetError(
        fmt::format("the beams exceed {} before all power is traced; the remaining fraction of the power is {:.3g}: "
                    "use a larger {} to follow fewer beams, a larger memory budget, or {} montecarlo",
                    memory_budget_text(), open_power(), reference({"cutoff"}), reference({"engine"})));
  memory_->require_shared();
}

}  // namespace retrace::raytrace
