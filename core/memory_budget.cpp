#include "core/memory_budget.h"

#include <fmt/format.h>

namespace retrace {
namespace {

constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;

std::atomic<std::uint64_t> budget_bytes{kGiB};
/// Minimum change of the memory of a trace, in bytes, that is added to `shared_bytes`. Smaller changes are accumulated
/// first, because frequent writes to this common counter would slow down all threads.
constexpr std::uint64_t kReportedStep = std::uint64_t{1} << 20;

/// Total memory, in bytes, of the beams of all traces that currently run within a SharedMemoryScope.
std::atomic<std::uint64_t> shared_bytes{0};
thread_local bool is_in_shared_scope = false;

}  // namespace

std::uint64_t memory_budget_bytes() {
  return budget_bytes.load();
}

void set_memory_budget_bytes(std::uint64_t bytes) {
  budget_bytes.store(bytes);
}

std::uint64_t element_memory_bytes() {
  return memory_budget_bytes() / 2;
}

std::uint64_t beam_memory_bytes() {
  return memory_budget_bytes() / 4;
}

std::string memory_budget_text() {
  return fmt::format("the memory budget of {:.3g} GiB ({})",
                     static_cast<double>(memory_budget_bytes()) / static_cast<double>(kGiB), reference({"memory_gib"}));
}

SharedMemoryScope::SharedMemoryScope() : was_shared_(is_in_shared_scope) {
  is_in_shared_scope = true;
}

SharedMemoryScope::~SharedMemoryScope() {
  is_in_shared_scope = was_shared_;
}

BeamMemory::BeamMemory() : is_shared_(is_in_shared_scope) {}

BeamMemory::~BeamMemory() {
  shared_bytes.fetch_sub(reported_bytes_);
}

void BeamMemory::add(std::uint64_t bytes) {
  bytes_.fetch_add(bytes, std::memory_order_relaxed);
}

void BeamMemory::remove(std::uint64_t bytes) {
  bytes_.fetch_sub(bytes, std::memory_order_relaxed);
}

bool BeamMemory::is_exceeded() const {
  return bytes_.load() > beam_memory_bytes();
}

void BeamMemory::require_shared() {
  if (!is_shared_) return;
  const std::uint64_t now = bytes_.load(std::memory_order_relaxed);
  if (now > reported_bytes_ + kReportedStep || now + kReportedStep < reported_bytes_) {
    // A negative difference wraps around; addition modulo 2^64 is still correct.
    shared_bytes.fetch_add(now - reported_bytes_);
    reported_bytes_ = now;
  }
  if (reported_bytes_ > 0 && shared_bytes.load(std::memory_order_relaxed) > beam_memory_bytes())
    throw SharedMemoryExceeded{};
}

std::mutex& exclusive_trace_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace retrace
