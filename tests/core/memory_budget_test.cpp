// Tests of the memory budget and of parallel loops that share it.
#include "core/memory_budget.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "core/within_memory.h"

namespace retrace::testing::memory_budget_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

/// Sets the memory budget; the destructor restores the default.
struct Budget {
  explicit Budget(std::uint64_t bytes) { set_memory_budget_bytes(bytes); }
  ~Budget() { set_memory_budget_bytes(1024 * kMiB); }
};

/// Adds bytes to a sum. The destructor subtracts them again, even after an exception.
struct Share {
  std::atomic<std::uint64_t>& sum;
  std::uint64_t own = 0;
  ~Share() { sum -= own; }
  std::uint64_t add(std::uint64_t bytes) {
    own += bytes;
    return sum += bytes;
  }
};

/// Increases `most` to `value` if `value` is greater.
void raise(std::atomic<std::uint64_t>& most, std::uint64_t value) {
  std::uint64_t seen = most.load();
  while (seen < value && !most.compare_exchange_weak(seen, value)) {
  }
}

// Each of 64 tasks needs less than a quarter of the budget, which is the limit of one trace and also the common limit
// of parallel traces. Eight parallel tasks exceed the common limit, so some of them are aborted and repeated. All tasks
// must nevertheless be completed, with any number of threads.
TEST(MemoryBudget, WorkThatDoesNotFitSideBySideIsDoneAllTheSame) {
  const Budget budget(400 * kMiB);
  for (const unsigned threads : {1U, 8U}) {
    std::atomic<std::uint64_t> sum{0}, most{0};
    std::vector<int> done(64, 0);
    run_with_threads(threads, [&] {
      for_each_within_memory(done.size(), [&](std::size_t k) {
        BeamMemory memory;
        Share share{sum};
        for (int step = 0; step < 90; ++step) {
          memory.add(kMiB);
          raise(most, share.add(kMiB));
          ASSERT_FALSE(memory.is_exceeded());
          memory.require_shared();
        }
        memory.remove(90 * kMiB);
        ++done[k];
      });
    });
    EXPECT_EQ(done, std::vector<int>(64, 1)) << threads;
    // Parallel tasks use up to a quarter of the budget, and one repeated task another quarter: 200 MiB together. In
    // addition, each thread may have added one step and one unreported change of 1 MiB each.
    EXPECT_LE(most.load(), (200 + 2 * 8) * kMiB) << threads;
    EXPECT_GE(most.load(), 90 * kMiB) << threads;
  }
}

TEST(MemoryBudget, WorkThatIsTooLargeByItselfIsNotRepeated) {
  const Budget budget(40 * kMiB);
  int calls = 0;
  const auto too_large = [&](std::size_t) {
    ++calls;
    BeamMemory memory;
    memory.add(11 * kMiB);
    if (memory.is_exceeded()) throw TraceBudgetError("too large");
    memory.require_shared();
  };
  EXPECT_THROW(for_each_within_memory(1, too_large), TraceBudgetError);
  EXPECT_EQ(calls, 1);
}

TEST(MemoryBudget, MemoryIsFreeAgainWhenItsOwnerIsGone) {
  const Budget budget(40 * kMiB);
  for (int k = 0; k < 100; ++k) {
    const SharedMemoryScope scope;
    BeamMemory memory;
    memory.add(9 * kMiB);
    EXPECT_NO_THROW(memory.require_shared()) << k;
  }
}

}  // namespace
}  // namespace retrace::testing::memory_budget_test
