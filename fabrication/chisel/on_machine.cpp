#include "fabrication/chisel/on_machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "core/limit_error.h"
#include "core/number_format.h"
#include "fabrication/job/fins.h"
#include "fabrication/job/v_tool.h"

namespace retrace::fabrication {
namespace {

void check_tilt(const Job& job, const Machine& machine) {
  const bool is_dmc = !cuts_prisms(job);
  if (is_dmc == (machine.tilt == Tilt::head)) return;
  throw InputError(
      job.where("machine"),
      is_dmc ? fmt::format(
                   "must be a machine with a tilting head (B), such as \"ideal-dmc\", for strategy \"dmc\", got {}",
                   machine.name)
             : fmt::format("must be a machine with a tilting table (A) for this strategy, got {}", machine.name));
}

/// Checks that the depths of cut are large compared to the increments of the control. Otherwise, rounded positions
/// change the chip thickness too much.
void check_increments(const Job& job, const Machine& machine) {
  constexpr double kMinDiagonals = 10.0;
  const double step_um = 1e-3 * static_cast<double>(machine.increments.linear_nm);
  const double least_um = kMinDiagonals * std::numbers::sqrt3 * step_um;
  const auto check = [&](const char* key, double depth_um) {
    if (depth_um < least_um)
      throw InputError(
          job.where(key),
          fmt::format("must be at least {} um, because the control of machine {} rounds positions to {} um, got {}",
                      fixed(least_um, 2), machine.name, shortest(step_um), shortest(depth_um)));
  };
  check("process.roughing_depth_um", job.process.roughing_depth_um);
  if (has_finishing_cuts(job)) check("process.finishing_depth_um", job.process.finishing_depth_um);
}

/// Returns true if a tool can cut the elements of all zones, assuming exact positions.
bool fits_all_zones(const Job& job, const Tool& tool) {
  bool fits = true;
  const auto refuse = [&](std::string_view, const std::string&) { fits = false; };
  for (std::size_t zone = 0; zone < zone_count(job); ++zone)
    check_v_tool(blank_element(job, zone), angle_errors_of(job, zone), tool, refuse);
  return fits;
}

/// Searches for the smallest sufficient wedge angle in steps of 0.1 degrees, beginning at the wedge angle of the job.
/// The tool must fit all zones. Its fins (thin ridges that remain along dihedral edges) must not be higher than
/// `max_mm`.
/// \param fin_mm function that returns the maximum height of a fin for a tool
/// \return the wedge angle, or nullopt if no angle is sufficient
std::optional<double> allowed_wedge_deg(const Job& job, double max_mm,
                                        const std::function<double(const Tool&)>& fin_mm) {
  constexpr double kStepsPerDeg = 10.0;
  Tool tool = job.tool;
  for (double step = std::ceil(tool.wedge_deg * kStepsPerDeg); step <= kMaxWedgeDeg * kStepsPerDeg; ++step) {
    tool.wedge_deg = step / kStepsPerDeg;
    if (fin_mm(tool) <= max_mm && fits_all_zones(job, tool)) return tool.wedge_deg;
  }
  return std::nullopt;
}

}  // namespace

void check_fins(const Job& job, const Machine& machine, const CubeCorner& corner,
                const std::array<Angle, 3>& root_tilts, const std::string& who) {
  const auto fin_mm = [&](const Tool& tool, double step_mm) {
    return highest_fin_mm(edge_covers(corner.normals, spines_of(corner, tool, root_tilts)), step_mm);
  };
  const double step_mm = 1e-6 * static_cast<double>(machine.increments.linear_nm);
  const double max_mm = max_fin_mm(step_mm);
  const double left_mm = fin_mm(job.tool, step_mm);
  if (left_mm <= max_mm) return;
  const std::string step_text = shortest(1e-3 * static_cast<double>(machine.increments.linear_nm));
  const std::string fin = fmt::format("{} may remain between the cuts of the facets, but at most {} um are allowed",
                                      fin_text(left_mm), fixed(1e3 * std::max(0.0, max_mm), 3));
  const auto at_step = [&](const Tool& tool) { return fin_mm(tool, step_mm); };
  if (const std::optional<double> wedge_deg = allowed_wedge_deg(job, max_mm, at_step))
    throw LimitError(job.where("tool.wedge_deg"),
                     fmt::format("{}must be at least {}, because machine {} rounds positions to {} um and {}, got {}",
                                 who, shortest(*wedge_deg), machine.name, step_text, fin, shortest(job.tool.wedge_deg)),
                     *wedge_deg);
  const std::string none = fmt::format("no tool.wedge_deg up to {} is large enough", shortest(kMaxWedgeDeg));
  if (machine.increments.linear_nm <= Increments{}.linear_nm)
    throw InputError(job.where("tool.nose_angle_deg"),
                     fmt::format("{}with the given tool.nose_angle_deg and tool.clearance_deg, the tool does not fit "
                                 "the element: {}, and {}, got {}",
                                 who, fin, none, shortest(job.tool.nose_angle_deg)));
  // The height of a fin is proportional to the increment. Compute the maximum increment that is allowed.
  const double max_step_um = 1e3 * kEdgeStripMm / (fin_mm(job.tool, 1.0) + kEdgeStripMm - max_fin_mm(1.0));
  const double allowed_um = std::floor(1e4 * max_step_um) * 1e-4;
  throw LimitError(
      job.where("machine"),
      fmt::format("{}the rounding of positions (control.increment_system) must be at most {} um for this tool, but "
                  "machine {} rounds to {} um: {}, and {}",
                  who, fixed(allowed_um, 4), machine.name, step_text, fin, none),
      allowed_um);
}

void check_on_machine(const Job& job, const Machine& machine) {
  check_tilt(job, machine);
  check_increments(job, machine);
  if (!cuts_prisms(job))
    for (std::size_t zone = 0; zone < zone_count(job); ++zone) check_fins(job, machine, blank_corner(job, zone));
  const Process& p = job.process;
  if (has_finishing_cuts(job) && p.finishing_depth_um > p.roughing_depth_um)
    throw InputError(job.where("process.finishing_depth_um"),
                     fmt::format("must be at most roughing_depth_um ({}), got {}", shortest(p.roughing_depth_um),
                                 shortest(p.finishing_depth_um)));
  double most = machine.x.max_feed_mm_per_min.value;
  for (const LinearAxis* const axis : {&machine.y, &machine.z}) most = std::min(most, axis->max_feed_mm_per_min.value);
  for (const auto& [key, feed] : {std::pair{"process.roughing_feed_mm_per_min", p.roughing_feed_mm_per_min},
                                  {"process.finishing_feed_mm_per_min", p.finishing_feed_mm_per_min},
                                  {"process.retract_feed_mm_per_min", p.retract_feed_mm_per_min}})
    if (feed > most)
      throw InputError(job.where(key),
                       fmt::format("must be at most {1} mm/min, the value max_feed_mm_per_min of machine {0}, got {2}",
                                   machine.name, shortest(most), shortest(feed)));
}

}  // namespace retrace::fabrication
