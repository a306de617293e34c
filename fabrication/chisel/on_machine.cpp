#include "fabrication/chisel/on_machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

void check_tilt(const Job& job, const Machine& machine) {
  const bool is_dmc = job.strategy == Strategy::dmc;
  if (is_dmc == (machine.tilt == Tilt::head)) return;
  throw InputError(
      job.where("machine"),
      is_dmc
          ? fmt::format("must be a machine whose head tilts (B), such as \"ideal-dmc\", for strategy \"dmc\", got {}",
                        machine.name)
          : fmt::format("must be a machine whose table tilts (A) for this strategy, got {}", machine.name));
}

}  // namespace

bool has_finishing_cuts(const Job& job) {
  return job.strategy == Strategy::two_step || job.strategy == Strategy::dmc;
}

void check_on_machine(const Job& job, const Machine& machine) {
  check_tilt(job, machine);
  const Process& p = job.process;
  if (has_finishing_cuts(job) && p.finishing_depth_um > p.roughing_depth_um)
    throw InputError(job.where("process.finishing_depth_um"),
                     fmt::format("must be at most roughing_depth_um, {}, got {}", shortest(p.roughing_depth_um),
                                 shortest(p.finishing_depth_um)));
  double most = machine.x.max_feed_mm_per_min.value;
  for (const LinearAxis* const axis : {&machine.y, &machine.z}) most = std::min(most, axis->max_feed_mm_per_min.value);
  for (const auto& [key, feed] : {std::pair{"process.roughing_feed_mm_per_min", p.roughing_feed_mm_per_min},
                                  {"process.finishing_feed_mm_per_min", p.finishing_feed_mm_per_min},
                                  {"process.retract_feed_mm_per_min", p.retract_feed_mm_per_min}})
    if (feed > most)
      throw InputError(job.where(key), fmt::format("must be at most the max_feed_mm_per_min of machine {}, {}, got {}",
                                                   machine.name, shortest(most), shortest(feed)));
}

}  // namespace retrace::fabrication
