#include "raytrace/engines/wavelengths.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/within_memory.h"

namespace retrace::raytrace {

std::uint32_t seed_at(std::uint32_t seed, std::size_t wavelength) {
  constexpr std::uint32_t kGolden = 0x9e3779b9U;  // odd; all wavelengths therefore have different seeds
  return seed + kGolden * static_cast<std::uint32_t>(wavelength);
}

Sampling sampling_at(Sampling all, double weight, std::size_t wavelength) {
  all.seed = seed_at(all.seed, wavelength);
  all.target_error /= std::sqrt(weight);
  if (all.rays)
    all.rays =
        std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(weight * static_cast<double>(*all.rays))));
  return all;
}

bool trace_wavelengths(std::size_t directions, std::size_t wavelengths, bool in_parallel, TaskProgress& all,
                       const std::function<bool(std::size_t, std::size_t, Progress&)>& trace) {
  const auto trace_one = [&](std::size_t k) {
    TaskProgress::Task task(all);
    const bool is_traced = trace(k / wavelengths, k % wavelengths, task);
    if (is_traced) task.finish();
    return is_traced;
  };
  const std::size_t count = directions * wavelengths;
  if (!in_parallel) {
    for (std::size_t k = 0; k < count; ++k)
      if (!trace_one(k)) return false;
    return true;
  }
  std::atomic<bool> is_complete = true;
  for_each_within_memory(count, [&](std::size_t k) {
    if (!trace_one(k)) is_complete = false;
  });
  return is_complete;
}

}  // namespace retrace::raytrace
