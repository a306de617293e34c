#include "fabrication/chisel/on_machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/number_format.h"
#include "fabrication/job/cube_corner.h"
#include "fabrication/job/fins.h"

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

/// Cuts whose positions are rounded by a good part of their depth take chips of any thickness.
void check_increments(const Job& job, const Machine& machine) {
  constexpr double kLeastDiagonals = 10.0;
  const double step_um = 1e-3 * static_cast<double>(machine.increments.linear_nm);
  const double least_um = kLeastDiagonals * std::numbers::sqrt3 * step_um;
  const auto check = [&](const char* key, double depth_um) {
    if (depth_um < least_um)
      throw InputError(
          job.where(key),
          fmt::format("must be at least {}, as the control of machine {} rounds positions to {} um, got {}",
                      fixed(least_um, 2), machine.name, shortest(step_um), shortest(depth_um)));
  };
  check("process.roughing_depth_um", job.process.roughing_depth_um);
  if (has_finishing_cuts(job)) check("process.finishing_depth_um", job.process.finishing_depth_um);
}

/// Refuses a V-shaped tool if rounding of positions may leave a fin that is higher than the edge strip.
void check_fin(const Job& job, const Machine& machine) {
  const double step_mm = 1e-6 * static_cast<double>(machine.increments.linear_nm);
  const double limit_mm = max_fin_mm(step_mm);
  for (std::size_t zone = 0; zone < zone_count(job); ++zone) {
    const CubeCorner corner = blank_corner(job, zone);
    const double fin_mm = highest_fin_mm(edge_covers(corner.normals, spines_of(corner, job.tool)), step_mm);
    if (fin_mm <= limit_mm) continue;
    throw InputError(
        job.where("tool.wedge_deg"),
        fmt::format(
            "must be larger, or the increments of the control smaller: machine {} rounds positions to {} um, so "
            "that {} may remain between the cuts of its facets; at most {} um are allowed, got {}",
            machine.name, shortest(1e3 * step_mm), fin_text(fin_mm), shortest(1e3 * limit_mm),
            shortest(job.tool.wedge_deg)));
  }
}

}  // namespace

bool has_finishing_cuts(const Job& job) {
  return job.strategy == Strategy::two_step || job.strategy == Strategy::dmc;
}

void check_on_machine(const Job& job, const Machine& machine) {
  check_tilt(job, machine);
  check_increments(job, machine);
  if (job.strategy == Strategy::dmc) check_fin(job, machine);
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
