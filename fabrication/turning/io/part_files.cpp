#include "fabrication/turning/io/part_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/message_text.h"
#include "core/number_format.h"
#include "fabrication/turning/finish.h"
#include "fabrication/turning/io/lenslet_tables.h"
#include "fabrication/turning/io/sag_tables.h"

namespace retrace::fabrication::turning {
namespace {

constexpr NumberRange kPositive{.low = 0.0, .low_included = false, .high = 1e9};

std::optional<Extrapolation> read_extrapolation(TomlTable root) {
  if (!root.has("boundary")) {
    if (root.has("extrapolation")) root.fail("extrapolation", "needs a [boundary] beyond which to extrapolate");
    return std::nullopt;
  }
  TomlTable boundary = root.table("boundary");
  Extrapolation extrapolation{read_boundary(boundary), 2};
  TomlTable table = root.table("extrapolation");
  extrapolation.order = static_cast<int>(table.whole("order", {.low = 1, .high = kMostOrder}).value_or(2));
  return extrapolation;
}

TurningTool read_tool(TomlTable table, bool& skew_is_least) {
  TurningTool tool;
  tool.nose_radius_mm = table.required_number("nose_radius_mm", {.low = 1e-4, .high = 100.0});
  tool.window_deg = table.number("window_deg", {.low = 1.0, .high = 178.0}).value_or(120.0);
  tool.clearance_deg = table.required_number("clearance_deg", {.low = 0.0, .low_included = false, .high = 60.0});
  tool.rake_deg = table.number("rake_deg", {.low = -80.0, .high = 45.0}).value_or(0.0);
  if (table.has("find_least_skew") && table.has("skew_deg"))
    table.fail("find_least_skew", "must not be given together with skew_deg");
  skew_is_least = table.flag("find_least_skew").value_or(false);
  tool.skew_deg = table.number("skew_deg", {.low = -80.0, .high = 80.0}).value_or(0.0);
  return tool;
}

/// The feed: given, or that of a wanted scallop.
double read_feed_mm(TomlTable& table, const TurningTool& tool) {
  if (table.has("feed_um") == table.has("scallop_nm"))
    table.fail("feed_um", "must be given, or scallop_nm instead of it");
  if (table.has("feed_um")) return 1e-3 * table.required_number("feed_um", {.low = 1e-3, .high = 1e4});
  return feed_for_scallop_mm(effective_radius_mm(tool),
                             table.required_number("scallop_nm", {.low = 1e-3, .high = 1e6}));
}

PathOptions read_path(TomlTable table, const TurningTool& tool) {
  static constexpr std::string_view kStrategies[] = {"spiral", "raster"};
  static constexpr std::string_view kSamplings[] = {"angle", "arc"};
  static constexpr std::string_view kServos[] = {"slow", "fast"};
  PathOptions path;
  path.strategy = static_cast<Strategy>(table.choice("strategy", kStrategies).value_or(0));
  path.feed_mm = read_feed_mm(table, tool);
  path.clear_mm = table.number("clear_mm", {.low = 0.01, .high = 1e3}).value_or(1.0);
  if (path.strategy == Strategy::raster) {
    const std::vector<double> size = table.required_numbers("size_mm", 2, kPositiveMm);
    path.height_mm = size[0];
    path.width_mm = size[1];
    path.sampling = Sampling::arc;
    path.arc_mm = 1e-3 * table.required_number("arc_um", {.low = 0.1, .high = 1e4});
    path.cutting_mm_per_min = table.required_number("cutting_mm_per_min", {.low = 0.1, .high = 1e5});
    return path;
  }
  path.radius_mm = table.required_number("radius_mm", kPositiveMm);
  path.overrun_mm = table.number("overrun_mm", {.low = 0.0, .high = 1e3}).value_or(0.0);
  path.spindle_rpm = table.required_number("spindle_rpm", {.low = 0.01, .high = 1e5});
  path.sampling = static_cast<Sampling>(table.choice("sampling", kSamplings).value_or(0));
  if (path.sampling == Sampling::arc)
    path.arc_mm = 1e-3 * table.required_number("arc_um", {.low = 0.1, .high = 1e4});
  else
    path.points_per_turn = static_cast<int>(table.whole("points_per_turn", {.low = 8, .high = 100000}).value_or(360));
  path.servo = static_cast<Servo>(table.choice("servo", kServos).value_or(0));
  if (path.servo == Servo::fast && path.sampling == Sampling::arc)
    table.fail("servo",
               "must be \"slow\" with sampling = \"arc\", got \"fast\": a fast tool servo goes by the spindle's angle");
  return path;
}

AxisLimits read_limits(TomlTable table) {
  AxisLimits limits;
  if (const auto ends = table.numbers("travel_mm", 2, kLengthMm)) {
    if (!((*ends)[0] < (*ends)[1]))
      table.fail("travel_mm", fmt::format("must rise, got [{}, {}]", shortest((*ends)[0]), shortest((*ends)[1])));
    limits.low_mm = (*ends)[0];
    limits.high_mm = (*ends)[1];
  }
  limits.speed_mm_per_s = table.number("speed_mm_per_s", kPositive);
  limits.acceleration_mm_per_s2 = table.number("acceleration_mm_per_s2", kPositive);
  limits.jerk_mm_per_s3 = table.number("jerk_mm_per_s3", kPositive);
  return limits;
}

TurningMachine read_machine(TomlTable table) {
  TurningMachine machine;
  static constexpr std::string_view kAxes[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) machine.axes[i] = read_limits(table.table(kAxes[i]));
  machine.servo = read_limits(table.table("servo"));
  machine.spindle_rpm = table.number("spindle_rpm", kPositive);
  return machine;
}

/// How far the tool reaches: the path and the nose beyond it.
double reach_mm(const PathOptions& path, const TurningTool& tool) {
  const double radius = path.strategy == Strategy::spiral ? path.radius_mm + path.overrun_mm
                                                          : 0.5 * std::hypot(path.width_mm, path.height_mm);
  return radius + tool.nose_radius_mm;
}

void settle_skew(TurnedPart& part, const InputLocation& where) {
  const std::vector<SlopeSample> slopes = slopes_along(part.surface, part.path);
  if (part.skew_is_least) {
    const auto skew = least_skew_deg(part.tool, slopes, kTriedSkewDeg);
    if (!skew)
      throw InputError(where,
                       fmt::format("must have a clearance and a window that clear the surface at some skew within "
                                   "+-60 degrees, got {} and {} degrees, which do at none",
                                   shortest(part.tool.clearance_deg), shortest(part.tool.window_deg)));
    part.tool.skew_deg = *skew;
    return;
  }
  const ClearanceFigures figures = clearance_figures(part.tool, slopes);
  if (figures.clears(part.tool)) return;
  const auto skew = least_skew_deg(part.tool, slopes, kTriedSkewDeg);
  throw InputError(
      where,
      fmt::format(
          "must clear the surface, needs a clearance of {} and a window of {} degrees, got {} and {}; {}",
          fixed(std::max(0.0, figures.clearance_needed_deg), 2), fixed(figures.window_needed_deg, 2),
          shortest(part.tool.clearance_deg), shortest(part.tool.window_deg),
          skew ? fmt::format("a skew of {} degrees would clear", fixed(*skew, 2)) : std::string("no skew clears")));
}

}  // namespace

TurnedPart parse_turned_part(std::string_view text, const std::string& source_name) {
  static constexpr std::string_view kSchemas[] = {"retrace.turned_part/1"};
  TomlTable root = parse_toml(text, source_name);
  root.required_choice("schema", kSchemas);
  std::string title = root.text("title").value_or("");
  TomlTable base_table = root.required_table("base");
  const Sag base = read_sag(base_table, "kind");
  std::optional<Extrapolation> extrapolation = read_extrapolation(root);
  TomlTable tool_table = root.required_table("tool");
  bool skew_is_least = false;
  const TurningTool tool = read_tool(tool_table, skew_is_least);
  TomlTable path_table = root.required_table("path");
  const PathOptions path = read_path(path_table, tool);
  const TurnedSurface bare(base, extrapolation, {}, base_table.where("kind"));
  std::vector<Lenslet> lenslets = read_lenslets(root, bare);
  const TurningMachine machine = read_machine(root.table("machine"));
  TomlTable inspect = root.table("inspect");
  const double tolerance = inspect.number("form_tolerance_nm", kPositive).value_or(10.0);
  const auto pixels = inspect.whole("map_pixels", {.low = 11, .high = 2001}).value_or(101);
  const auto mesh_thickness = inspect.number("mesh_thickness_mm", kPositiveMm);
  const int mesh_rings = static_cast<int>(inspect.whole("mesh_rings", {.low = 2, .high = 1000}).value_or(100));
  if (mesh_thickness && path.strategy == Strategy::raster)
    inspect.fail("mesh_thickness_mm", "must not be given for a raster: meshes are round");
  root.finish();
  const InputLocation surface_where = root.where(lenslets.empty() ? "base" : "lenslets");
  TurnedPart part{std::move(title),
                  TurnedSurface(base, std::move(extrapolation), std::move(lenslets), surface_where),
                  tool,
                  skew_is_least,
                  path,
                  machine,
                  tolerance,
                  static_cast<std::size_t>(pixels),
                  mesh_thickness,
                  mesh_rings,
                  {}};
  check_surface(part.surface, reach_mm(part.path, part.tool), surface_where);
  settle_skew(part, tool_table.where("clearance_deg"));
  part.warnings = tool_warnings(part.tool);
  return part;
}

}  // namespace retrace::fabrication::turning
