#include "fabrication/planing/io/part_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/toml_file.h"
#include "fabrication/planing/nose_path.h"

namespace retrace::fabrication {
namespace {

constexpr std::string_view kSchema = "retrace.planed_part/1";
constexpr std::array<std::string_view, 2> kKinds = {"zone_lens", "round_zone_lens"};
constexpr NumberRange kLength{.low = 0.1, .high = 1e4};
constexpr NumberRange kIndex{.low = 1.01, .high = 5.0};
constexpr NumberRange kTolerance{.low = 1e-4, .high = 10.0};
constexpr NumberRange kFeed{.low = 1.0, .high = 1e6};
constexpr NumberRange kFrame{.low = 0.0, .high = 60.0};
constexpr NumberRange kGrid{.low = 1e-3, .high = 1.0};
constexpr NumberRange kLeastMove{.low = 0.0, .high = 1e3};
constexpr NumberRange kHours{.low = 0.01, .high = 1000.0};
constexpr NumberRange kNose{.low = 0.0, .high = 100.0};
constexpr NumberRange kDepthOfCut{.low = 0.01, .high = 100.0};
/// A word S has up to five digits.
constexpr NumberRange kSpindleSpeed{.low = 1.0, .high = 99999.0};
constexpr std::size_t kLongestSpindleText = 200;
/// Quanta are tried from the tolerance down, step by step of the grid, and places are counted in such steps.
constexpr double kMostQuanta = 200.0;
constexpr double kMostSteps = 1e6;
/// Zones that are narrower than this many steps have no profile.
constexpr double kLeastStepsOfZone = 4.0;

ZoneLens read_lens(TomlTable& element) {
  ZoneLens lens;
  lens.focal_length_mm = element.required_number("focal_length_mm", kLength);
  lens.wavelength_mm = element.required_number("wavelength_mm", kLength);
  lens.refractive_index = element.required_number("refractive_index", kIndex);
  lens.half_width_mm = 0.5 * element.required_number("width_mm", kLength);
  return lens;
}

PlaningMill read_mill(TomlTable& table) {
  PlaningMill mill;
  mill.fast_feed_mm_per_min = table.required_number("fast_feed_mm_per_min", kFeed);
  mill.frame_s = table.number("frame_s", kFrame).value_or(0.0);
  mill.grid_mm = table.number("grid_mm", kGrid).value_or(mill.grid_mm);
  if (const auto least = table.numbers("least_move_mm", 3, kLeastMove)) {
    mill.least_x_mm = (*least)[0];
    mill.least_y_mm = (*least)[1];
    mill.least_z_mm = (*least)[2];
  }
  if (const auto travel = table.numbers("travel_mm", 3, kLength)) {
    mill.travel_x_mm = (*travel)[0];
    mill.travel_y_mm = (*travel)[1];
    mill.travel_z_mm = (*travel)[2];
  }
  mill.most_hours = table.number("most_hours", kHours).value_or(mill.most_hours);
  mill.run_out_mm = table.number("run_out_mm", kLength).value_or(mill.run_out_mm);
  mill.clear_mm = table.number("clear_mm", kLength).value_or(mill.clear_mm);
  if (mill.clear_mm < mill.least_z_mm)
    table.fail("clear_mm", fmt::format("must be at least the least move of Z, {}, got {}", shortest(mill.least_z_mm),
                                       shortest(mill.clear_mm)));
  table.finish();
  return mill;
}

/// One line of a PMAC program that is written as it is. Whatever follows two slashes would be a comment.
std::string read_spindle_text(TomlTable& table, std::string_view key) {
  std::string text = table.required_text(key);
  const bool is_printable = std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (text.empty() || text.size() > kLongestSpindleText || !is_printable || text.front() == ' ' || text.back() == ' ' ||
      text.find("//") != std::string::npos)
    table.fail(key, fmt::format("must be one line of 1 to {} printable ASCII characters, without // and without blanks "
                                "at its ends, got {}",
                                kLongestSpindleText, in_quotes(text)));
  return text;
}

void read_spindle(TomlTable& table, PlaningLathe& lathe) {
  table.required_number("spindle_rpm", kSpindleSpeed);
  lathe.spindle_rpm = static_cast<std::int32_t>(table.whole("spindle_rpm", kSpindleSpeed).value());
  lathe.spindle_direction =
      static_cast<SpindleDirection>(table.required_choice("spindle_direction", kSpindleDirectionWords));
  lathe.spindle_start_at = table.where("spindle_start");
  if (!table.has("spindle_start") && !table.has("spindle_stop")) return;
  lathe.spindle_start = read_spindle_text(table, "spindle_start");
  lathe.spindle_stop = read_spindle_text(table, "spindle_stop");
  if (lathe.spindle_start == lathe.spindle_stop)
    table.fail("spindle_stop", "must not be spindle_start, got " + in_quotes(lathe.spindle_stop));
}

PlaningLathe read_lathe(TomlTable& table) {
  PlaningLathe lathe;
  lathe.feed_mm_per_min = table.required_number("feed_mm_per_min", kFeed);
  lathe.depth_of_cut_mm = table.number("depth_of_cut_mm", kDepthOfCut).value_or(lathe.depth_of_cut_mm);
  lathe.clear_mm = table.number("clear_mm", kLength).value_or(lathe.clear_mm);
  lathe.nose_radius_mm = table.number("nose_radius_mm", kNose).value_or(lathe.nose_radius_mm);
  read_spindle(table, lathe);
  table.finish();
  return lathe;
}

void check_nose(TomlTable& table, const PlanedPart& part) {
  const ZoneProfile profile(part.lens);
  if (nose_fits(profile, part.lathe->nose_radius_mm)) return;
  table.fail("nose_radius_mm", fmt::format("must be <= {}, or the nose does not reach the bottom of every zone, got {}",
                                           fixed(largest_nose_mm(profile), 3), shortest(part.lathe->nose_radius_mm)));
}

/// What would take beyond measure, or has no profile on the machine's grid.
void check_sizes(TomlTable& element, TomlTable& tolerance, const PlanedPart& part) {
  const double step_mm = part.lens.wavelength_mm / (part.lens.refractive_index - 1.0);
  if (part.tolerance_mm > 0.5 * step_mm)
    tolerance.fail("form_mm", fmt::format("must be <= half the depth of a zone, {}, got {}", shortest(0.5 * step_mm),
                                          shortest(part.tolerance_mm)));
  const double grid = part.mill ? part.mill->grid_mm : 0.1 * part.tolerance_mm;
  if (part.mill && part.tolerance_mm < 2.0 * grid)
    tolerance.fail("form_mm", fmt::format("must be >= two steps of the machine's grid, {}, got {}",
                                          shortest(2.0 * grid), shortest(part.tolerance_mm)));
  if (part.mill && part.tolerance_mm > kMostQuanta * grid)
    tolerance.fail("form_mm", fmt::format("must be <= {} steps of the machine's grid, {}, got {}", kMostQuanta,
                                          shortest(kMostQuanta * grid), shortest(part.tolerance_mm)));
  if (part.lens.half_width_mm > kMostSteps * grid)
    element.fail("width_mm",
                 fmt::format("must be <= {} with a {} of {}, got {}", shortest(2.0 * kMostSteps * grid),
                             part.mill ? "grid_mm" : "form_mm", shortest(part.mill ? grid : part.tolerance_mm),
                             shortest(2.0 * part.lens.half_width_mm)));
  try {
    const ZoneProfile profile(part.lens);
    for (const Zone& zone : profile.zones())
      if (zone.to_mm - zone.from_mm < kLeastStepsOfZone * grid && zone.to_mm < part.lens.half_width_mm)
        element.fail("width_mm",
                     fmt::format("zones must be >= {} wide, got one of {} at {}", shortest(kLeastStepsOfZone * grid),
                                 fixed(zone.to_mm - zone.from_mm, 4), fixed(zone.from_mm, 3)));
  } catch (const InputError& error) {
    const std::string text = error.what();
    if (text.find("zone ") == std::string::npos || text.find("focus") == std::string::npos) throw;
    element.fail("focal_length_mm", text);
  }
}

}  // namespace

PlanedPart parse_planed_part(std::string_view text, const std::string& source_name) {
  TomlTable top = parse_toml(text, source_name);
  const auto schema = top.text("schema");
  if (schema && *schema != kSchema)
    top.fail("schema", fmt::format("must be {}, got {}", in_quotes(kSchema), in_quotes(*schema)));
  PlanedPart part;
  part.source = source_name;
  part.title = top.text("title").value_or("");
  TomlTable element = top.required_table("element");
  const bool is_round = element.required_choice("kind", kKinds) == 1;
  part.lens = read_lens(element);
  if (!is_round) part.length_mm = element.required_number("length_mm", kLength);
  element.finish();
  TomlTable tolerance = top.required_table("tolerance");
  part.tolerance_mm = tolerance.required_number("form_mm", kTolerance);
  tolerance.finish();
  TomlTable machine = top.required_table(is_round ? "lathe" : "mill");
  if (is_round)
    part.lathe = read_lathe(machine);
  else
    part.mill = read_mill(machine);
  top.finish();
  check_sizes(element, tolerance, part);
  if (is_round) check_nose(machine, part);
  return part;
}

PlanedPart read_planed_part(const std::filesystem::path& file) {
  return parse_planed_part(read_file(file), file.string());
}

}  // namespace retrace::fabrication
