#include "fabrication/turning/io/part_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/number_format.h"
#include "core/schema/reader.h"
#include "fabrication/turning/finish.h"
#include "geometry/io/surface_tables.h"

namespace retrace::fabrication::turning {
namespace {

using schema::Document;

TurningTool read_tool(const Document& file) {
  return {file.number("tool.nose_radius_mm"), file.number("tool.window_deg"), file.number("tool.clearance_deg"),
          file.number("tool.rake_deg"), file.number_if("tool.skew_deg").value_or(0.0)};
}

/// Returns the path tolerance of blending, in mm. It is a tenth of the form tolerance, rounded down to whole nanometres
/// but at least 1 nm. Programs contain the same rounded value. The check adds it to the form error.
double blend_mm(double form_tolerance_nm) {
  return 1e-6 * std::max(1.0, std::floor(0.1 * form_tolerance_nm));
}

PathOptions read_path(const Document& file, const TurningTool& tool) {
  const auto number = [&](const char* key) { return file.number(schema::path_in("path", key)); };
  PathOptions path;
  path.strategy = file.choice<Strategy>("path.strategy");
  path.feed_mm = file.has("path.feed_um") ? 1e-3 * number("feed_um")
                                          : feed_for_scallop_mm(effective_radius_mm(tool), number("scallop_nm"));
  path.clearance_mm = number("clear_mm");
  path.approach_mm_per_min = number("approach_mm_per_min");
  path.blend_mm = blend_mm(file.number("inspect.form_tolerance_nm"));
  if (path.strategy == Strategy::raster) {
    const std::vector<double> size = file.numbers("path.size_mm");
    path.height_mm = size[0];
    path.width_mm = size[1];
    path.sampling = Sampling::arc;
    path.cutting_mm_per_min = number("cutting_mm_per_min");
  } else {
    path.radius_mm = number("radius_mm");
    path.overrun_mm = number("overrun_mm");
    path.spindle_rpm = number("spindle_rpm");
    path.sampling = file.choice<Sampling>("path.sampling");
    path.servo = file.choice<Servo>("path.servo");
    path.spin_deg_per_s2 = file.number_if("machine.c_acceleration_deg_per_s2");
    path.cubic_error_nm = file.number_if("path.cubic_error_nm");
    if (path.cubic_error_nm && !path.spin_deg_per_s2)
      file.fail(
          "path.cubic_error_nm",
          "requires the key machine.c_acceleration_deg_per_s2, because moves with velocities begin and end at rest");
    if (path.cubic_error_nm && path.servo == Servo::fast)
      file.fail("path.cubic_error_nm",
                "not allowed with a fast tool servo, because its strokes require straight moves");
  }
  if (path.sampling == Sampling::arc)
    path.arc_mm = 1e-3 * number("arc_um");
  else
    path.points_per_turn = static_cast<int>(number("points_per_turn"));
  return path;
}

AxisLimits read_limits(const Document& file, const std::string& table) {
  AxisLimits limits = {{},
                       {},
                       file.number_if(table + ".speed_mm_per_s"),
                       file.number_if(table + ".acceleration_mm_per_s2"),
                       file.number_if(table + ".jerk_mm_per_s3")};
  const std::string key = table + ".travel_mm";
  if (!file.has(key)) return limits;
  const std::vector<double> ends = file.numbers(key);
  if (!(ends[0] < ends[1]))
    file.fail(key, fmt::format("the first number must be less than the second, got [{}, {}]", shortest(ends[0]),
                               shortest(ends[1])));
  limits.low_mm = ends[0];
  limits.high_mm = ends[1];
  return limits;
}

TurningMachine read_machine(const Document& file) {
  return {{read_limits(file, "machine.x"), read_limits(file, "machine.y"), read_limits(file, "machine.z")},
          file.number_if("machine.spindle_rpm"),
          file.number_if("machine.c_acceleration_deg_per_s2"),
          file.number_if("machine.blocks_per_s"),
          read_limits(file, "machine.servo")};
}

/// Returns the maximum distance of the tool from the spindle's axis: the radius of the path plus the nose radius.
double reach_mm(const PathOptions& path, const TurningTool& tool) {
  const double radius = path.strategy == Strategy::spiral ? path.radius_mm + path.overrun_mm
                                                          : 0.5 * std::hypot(path.width_mm, path.height_mm);
  return radius + tool.nose_radius_mm;
}

void settle_skew(TurnedPart& part, const InputLocation& where) {
  const std::vector<SlopeSample> slopes = slopes_along(part.surface, part.path);
  if (part.skew_is_min) {
    const auto skew = min_skew_deg(part.tool, slopes, kTestedSkewDeg);
    if (!skew)
      throw InputError(where,
                       fmt::format("the tool collides with the surface at every skew within +-60 degrees, because its "
                                   "clearance angle is {} degrees and its window angle is {} degrees",
                                   shortest(part.tool.clearance_deg), shortest(part.tool.window_deg)));
    part.tool.skew_deg = *skew;
    return;
  }
  const ClearanceFigures figures = clearance_figures(part.tool, slopes);
  if (figures.clears(part.tool)) return;
  const auto skew = min_skew_deg(part.tool, slopes, kTestedSkewDeg);
  throw InputError(
      where,
      fmt::format("the tool collides with the surface: a clearance angle of {} degrees and a window angle of {} "
                  "degrees are required, got {} and {}; {}",
                  fixed(std::max(0.0, figures.clearance_needed_deg), 2), fixed(figures.window_needed_deg, 2),
                  shortest(part.tool.clearance_deg), shortest(part.tool.window_deg),
                  skew ? fmt::format("the given angles are sufficient with a skew of {} degrees", fixed(*skew, 2))
                       : std::string("the given angles are not sufficient at any skew")));
}

}  // namespace

TurnedPart parse_turned_part(std::string_view text, const std::string& source_name) {
  const Document file = schema::read_document(turned_part_format(), text, source_name);
  geometry::FreeformSurface surface = geometry::read_surface(file);
  const InputLocation surface_where = geometry::surface_location(file);
  const TurningTool tool = read_tool(file);
  const PathOptions path = read_path(file, tool);
  TurnedPart part{file.text_if("title"),
                  std::move(surface),
                  tool,
                  file.flag("tool.find_min_skew"),
                  path,
                  read_machine(file),
                  file.number("inspect.form_tolerance_nm"),
                  static_cast<std::size_t>(file.number("inspect.map_pixels")),
                  file.number_if("inspect.mesh_thickness_mm"),
                  static_cast<int>(file.number("inspect.mesh_rings")),
                  {}};
  geometry::check_surface(part.surface, reach_mm(part.path, part.tool), surface_where);
  settle_skew(part, file.where("tool.clearance_deg"));
  part.warnings = schema::renamed_keys(file);
  append(part.warnings, tool_warnings(part.tool));
  return part;
}

}  // namespace retrace::fabrication::turning
