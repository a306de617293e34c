#include "fabrication/planing/io/part_files.h"

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/schema/access.h"
#include "core/schema/conditions.h"
#include "core/schema/reader.h"
#include "fabrication/machine/control.h"
#include "fabrication/planing/plan/nose_path.h"

namespace retrace::fabrication {
namespace {

using namespace schema;

constexpr Kind kLength = Number{{.low = 0.1, .high = 1e4}};
constexpr Kind kFeed = Number{{.low = 1.0, .high = 1e6}};
/// Maximum tolerance and maximum half width, both in steps of the grid. For a mill, this is the grid of the machine.
/// For a lathe, a step is a tenth of the tolerance. The first maximum limits the planning time, because the planner
/// tries all depth increments from the tolerance down to one step.
constexpr double kMaxToleranceSteps = 200.0;
constexpr double kMaxHalfWidthSteps = 1e6;
/// Minimum width of a zone in steps of the grid. The profile of a narrower zone cannot be represented on the grid.
constexpr double kMinZoneSteps = 4.0;

constexpr Words kLenses = {"zone_lens", "round_zone_lens"};
constexpr Condition kMilledOnly[] = {is("element.kind", only(kLenses, "zone_lens"))};
constexpr Condition kTurnedOnly[] = {is("element.kind", only(kLenses, "round_zone_lens"))};
constexpr Condition kWithStart[] = {is_given("spindle_start")};
constexpr Condition kWithStop[] = {is_given("spindle_stop")};

constexpr Row kRows[] = {{"title", Text{}, kNone, "Title of the part. It is used as the title of plots."}};
constexpr Row kElementRows[] = {
    {"kind", Word{kLenses}, kRequired,
     "Kind of lens. `\"zone_lens\"`: cylindrical, made on a mill. `\"round_zone_lens\"`: round, made on a lathe."},
    {"focal_length_mm", kLength, kRequired, "Distance of the focus from the centre of the stepped face."},
    {"wavelength_mm", kLength, kRequired, "Wavelength in air."},
    {"refractive_index", Number{{.low = 1.01, .high = 5.0}}, kRequired, "Refractive index at this wavelength."},
    {"width_mm", kLength, kRequired, "Width of the lens across the zones. For a round lens, it is the diameter."},
    {"length_mm", kLength, kRequired, "Length of the lens along the zones.", kMilledOnly}};
constexpr Row kToleranceRows[] = {
    {"form_mm", Number{{.low = 1e-4, .high = 10.0}}, kRequired,
     "Form tolerance, at most half of the depth of a zone. Mill: tolerance of the depth, 2 to 200 steps of the grid. "
     "Lathe: maximum distance of the machined surface from the nearest surface that the round nose can produce without "
     "cutting below the profile."}};
constexpr double kMinMovesMm[] = {13.0, 13.0, 6.0};
constexpr double kTravelsMm[] = {350.0, 1500.0, 400.0};
constexpr Row kMillRows[] = {
    {"fast_feed_mm_per_min", kFeed, kRequired, "Feed of all moves."},
    renamed("frame_s", Row{"block_s", Number{{.low = 0.0, .high = 60.0}}, 0.0,
                           "Time that each block of a program takes in addition to its move."}),
    {"grid_mm", Number{{.low = 1e-3, .high = 1.0}}, 0.01, "Step of the grid of the machine's positions."},
    renamed("least_move_mm",
            Row{"min_move_mm", Numbers{3, {.low = 0.0, .high = 1e3}}, kMinMovesMm,
                "Minimum lengths of moves in fast feed, `[x, y, z]`. X is across the zones, Y is along them, and Z is "
                "up."}),
    {"travel_mm", Numbers{3, {.low = 0.1, .high = 1e4}}, kTravelsMm,
     "Travel of the axes, `[x, y, z]`. X is across the zones, Y is along them, and Z is up. `retrace plane` reports "
     "the travel that the part requires."},
    renamed("most_hours",
            Row{"max_hours", Number{{.low = 0.01, .high = 1000.0}}, 8.0, "Maximum run time of one program."}),
    renamed("run_out_mm", Row{"overrun_mm", kLength, 20.0, "Distance beyond the part at which strokes begin and end."}),
    {"clear_mm", kLength, 14.0,
     "Height, above the blank, of moves without cutting. It is at least the minimum move of Z."}};
constexpr std::string_view kSpindleText =
    "Program line that starts (`spindle_start`) or stops (`spindle_stop`) the spindle of a Power PMAC or an Aerotech "
    "control. A line has up to 200 printable ASCII characters and does not contain `//`. The two lines must differ. "
    "Both are required for `--dialect pmac`, `a3200` and `automation1`.";
constexpr Row kLatheRows[] = {
    {"feed_mm_per_min", kFeed, kRequired, "Feed of all cuts."},
    {"depth_of_cut_mm", Number{{.low = 0.01, .high = 100.0}}, 1.0, "Maximum depth of cut of a pass."},
    {"clear_mm", kLength, 2.0, "Height, above the blank, of moves without cutting."},
    {"nose_radius_mm", Number{{.low = 0.0, .high = 100.0}}, 0.0,
     "Radius of the tool's nose, which is round on both sides. The nose must be small enough to reach the bottom of "
     "every zone next to the wall of the zone."},
    // An S word has up to five digits.
    {"spindle_rpm", Integer{{.low = 1.0, .high = 99999.0}}, kRequired, "Speed of the spindle."},
    {"spindle_direction", Word{kSpindleDirectionWords}, kRequired,
     "Direction of rotation of the spindle: `\"clockwise\"` is `M3`, `\"counterclockwise\"` is `M4`."},
    {"spindle_start", Text{}, kNone, kSpindleText, kWithStop},
    {"spindle_stop", Text{}, kNone, kSpindleText, kWithStart},
    {"has_unchecked_lines", Flag{}, false,
     "Whether `spindle_start` and `spindle_stop` are accepted without a check. They can then be any text, even text "
     "that moves axes or waits. The header of each program names such lines."}};
constexpr Table kTables[] = {
    {.name = "element", .meaning = "Lens.", .rows = kElementRows},
    {.name = "tolerance", .meaning = "Tolerance of the form.", .rows = kToleranceRows},
    {.name = "mill", .meaning = "Mill on which the lens is planed.", .rows = kMillRows, .when = kMilledOnly},
    {.name = "lathe", .meaning = "Lathe on which the lens is turned.", .rows = kLatheRows, .when = kTurnedOnly}};
PlaningMill mill_of(const Document& file) {
  const auto number = [&](std::string_view key) { return file.number(path_in("mill", key)); };
  const std::vector<double> least = file.numbers("mill.min_move_mm");
  const std::vector<double> travel = file.numbers("mill.travel_mm");
  return {number("fast_feed_mm_per_min"),
          number("block_s"),
          number("grid_mm"),
          least[0],
          least[1],
          least[2],
          travel[0],
          travel[1],
          travel[2],
          number("max_hours"),
          number("overrun_mm"),
          number("clear_mm")};
}

PlaningLathe lathe_of(const Document& file) {
  const auto number = [&](std::string_view key) { return file.number(path_in("lathe", key)); };
  return {number("feed_mm_per_min"),
          number("depth_of_cut_mm"),
          number("clear_mm"),
          number("nose_radius_mm"),
          static_cast<std::int32_t>(number("spindle_rpm")),
          file.choice<SpindleDirection>("lathe.spindle_direction"),
          file.text_if("lathe.spindle_start"),
          file.text_if("lathe.spindle_stop"),
          file.where("lathe.spindle_start"),
          file.flag("lathe.has_unchecked_lines")};
}

PlanedPart part_of(const Document& file) {
  PlanedPart part;
  part.source = file.source();
  part.title = file.text_if("title");
  part.lens = {file.number("element.focal_length_mm"), file.number("element.wavelength_mm"),
               file.number("element.refractive_index"), 0.5 * file.number("element.width_mm")};
  part.length_mm = file.number_if("element.length_mm").value_or(0.0);
  part.tolerance_mm = file.number("tolerance.form_mm");
  if (file.has("mill")) part.mill = mill_of(file);
  if (file.has("lathe")) part.lathe = lathe_of(file);
  return part;
}

// Checks that involve several keys.

constexpr std::string_view kStart = "lathe.spindle_start";
constexpr std::string_view kStop = "lathe.spindle_stop";

void check_clearance(const Document& file) {
  if (!file.has("mill")) return;
  const double least_mm = file.numbers("mill.min_move_mm")[2];
  const double clear_mm = file.number("mill.clear_mm");
  if (clear_mm < least_mm)
    file.fail("mill.clear_mm", fmt::format("must be at least the minimum move of Z ({} mm), got {}", shortest(least_mm),
                                           shortest(clear_mm)));
}

void check_spindle_texts(const Document& file) {
  for (const std::string_view key : {kStart, kStop}) {
    const std::string fault = file.has(key) ? line_error(file.text(key)) : "";
    if (!fault.empty()) file.fail(key, fault + ", got " + in_quotes(file.text(key)));
    const std::string unknown = file.has(key) ? line_form_error(file.text(key), LineUse::output) : "";
    if (!unknown.empty() && !file.flag("lathe.has_unchecked_lines"))
      file.fail(key, fmt::format("{}; any other line requires lathe.has_unchecked_lines = true, got {}", unknown,
                                 in_quotes(file.text(key))));
  }
  if (file.has(kStop) && file.text_if(kStart) == file.text(kStop))
    file.fail(kStop, "must differ from spindle_start, got " + in_quotes(file.text(kStop)));
}

ZoneProfile profile_of(const Document& file, const ZoneLens& lens) {
  try {
    return ZoneProfile(lens);
  } catch (const InputError& error) {
    file.fail("element.focal_length_mm", error.what());
  }
}

/// Checks that the part is not too large to be computed, and that its zones can be represented on the machine's grid.
void check_sizes(const Document& file) {
  const PlanedPart part = part_of(file);
  const double grid = part.mill ? part.mill->grid_mm : 0.1 * part.tolerance_mm;
  const double step_mm = part.lens.wavelength_mm / (part.lens.refractive_index - 1.0);
  const auto refuse_form = [&](std::string_view limit, double limit_mm) {
    file.fail("tolerance.form_mm",
              fmt::format("must be {} ({} mm), got {}", limit, fixed_apart(limit_mm, part.tolerance_mm, 6),
                          shortest(part.tolerance_mm)));
  };
  if (part.tolerance_mm > 0.5 * step_mm) refuse_form("at most half the depth of a zone", 0.5 * step_mm);
  if (part.mill && part.tolerance_mm < 2.0 * grid) refuse_form("at least two times mill.grid_mm", 2.0 * grid);
  if (part.mill && part.tolerance_mm > kMaxToleranceSteps * grid)
    refuse_form(fmt::format("at most {} times mill.grid_mm", kMaxToleranceSteps), kMaxToleranceSteps * grid);
  const double width_mm = 2.0 * part.lens.half_width_mm;
  if (width_mm > 2.0 * kMaxHalfWidthSteps * grid)
    file.fail(
        "element.width_mm",
        fmt::format("must be <= {} with a {} of {}, got {}", fixed_apart(2.0 * kMaxHalfWidthSteps * grid, width_mm, 3),
                    part.mill ? "grid_mm" : "form_mm", shortest(part.mill ? grid : part.tolerance_mm),
                    fixed_apart(width_mm, 2.0 * kMaxHalfWidthSteps * grid, 3)));
}

void check_zones(const Document& file) {
  const PlanedPart part = part_of(file);
  const ZoneProfile profile = profile_of(file, part.lens);
  const double least_mm = kMinZoneSteps * (part.mill ? part.mill->grid_mm : 0.1 * part.tolerance_mm);
  for (const Zone& zone : profile.zones())
    if (zone.to_mm - zone.from_mm < least_mm && zone.to_mm < part.lens.half_width_mm)
      file.fail(
          "element.width_mm",
          fmt::format("zones must be at least {} mm wide, got a zone of {} mm at a distance of {} mm from the centre",
                      fixed(least_mm, 4), fixed_apart(zone.to_mm - zone.from_mm, least_mm, 4), fixed(zone.from_mm, 3)));
  if (part.lathe && !nose_fits(profile, part.lathe->nose_radius_mm))
    file.fail("lathe.nose_radius_mm",
              fmt::format("must be <= {}, otherwise the nose does not reach the bottom of every zone, got {}",
                          fixed_apart(largest_nose_mm(profile), part.lathe->nose_radius_mm, 3),
                          shortest(part.lathe->nose_radius_mm)));
}

constexpr Words kClearKeys = {"mill.clear_mm", "mill.min_move_mm"};
constexpr Words kSpindleKeys = {kStart, kStop, "lathe.has_unchecked_lines"};
constexpr Words kSizeKeys = {"tolerance.form_mm", "mill.grid_mm", "element.width_mm"};
constexpr Words kZoneKeys = {"element.focal_length_mm", "element.width_mm", "lathe.nose_radius_mm"};
constexpr Rule kRules[] = {
    Check{kClearKeys, "`clear_mm` must be at least the minimum move of Z.", check_by<check_clearance>},
    Check{kSpindleKeys,
          "`spindle_start` and `spindle_stop` must differ. Unless `has_unchecked_lines` is true, each line sets an "
          "output or a variable, or is an M code of the machine's builder (see `docs/nc_dialects.md`).",
          check_by<check_spindle_texts>},
    Check{kSizeKeys,
          "The tolerance is at most half of the depth of a zone and, for a mill, 2 to 200 steps of its grid. The width "
          "is at most 2 million steps. For a lathe, a step is a tenth of the tolerance.",
          check_by<check_sizes>},
    Check{kZoneKeys,
          "Zones must be at least four steps of the grid wide (lathe: four tenths of the tolerance). The nose must "
          "reach the bottom of each zone.",
          check_by<check_zones>}};
constexpr Format kFormat = {
    "planed_part",
    "retrace.planed_part/1",
    "Flat lens of zones, planed or turned",
    {"", "Lens with zones, its tolerance, and the machine that makes it.", kRows, kTables, kRules},
    true};

}  // namespace

const Format& planed_part_format() {
  return kFormat;
}

PlanedPart parse_planed_part(std::string_view text, const std::string& source_name) {
  const Document file = read_document(kFormat, text, source_name);
  check(file, kFormat.root, "", &file);
  PlanedPart part = part_of(file);
  part.warnings = schema::renamed_keys(file);
  return part;
}

PlanedPart read_planed_part(const std::filesystem::path& file) {
  return parse_planed_part(read_file(file), file.string());
}

}  // namespace retrace::fabrication
