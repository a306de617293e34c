#include "fabrication/machine/io/machine_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/data_directory.h"
#include "core/message_text.h"
#include "core/named_file.h"
#include "core/number_format.h"
#include "core/schema/access.h"
#include "core/schema/reader.h"
#include "core/schema/writer.h"

namespace retrace::fabrication {
namespace {

namespace fs = std::filesystem;
using namespace schema;
using geometry::Vec3;

constexpr NumberRange kPositive{.low = 0.0, .low_included = false, .high = 1e6};
constexpr NumberRange kLength{.low = -1e4, .high = 1e4};
constexpr NumberRange kComponent{.low = -1e6, .high = 1e6};
constexpr NumberRange kDegrees{.low = -3600.0, .high = 3600.0};
/// Minimum determinant of the directions of the three linear axes. It is also the minimum sine of the angle between the
/// two rotary axes, which corresponds to an angle of 30 degrees.
constexpr double kMinDeterminant = 0.5;

/// Minimum length of a vector that is accepted as a direction. Shorter vectors are refused.
constexpr double kMinLength = 1e-6;
/// Maximum deviation of a direction's length from 1. A direction with a larger deviation is normalised when it is read.
/// A direction that was written with length 1 is therefore read back unchanged.
constexpr double kUnitTolerance = 1e-15;
constexpr double kMinVolumeMm3 = 1e-6;

// Conversions between members of Machine and values in files.

Vec3 vector_of(const std::vector<double>& values) {
  return {values[0], values[1], values[2]};
}
std::vector<double> numbers_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Value get_point(const Sourced<Vec3>& item) {
  return numbers_of(item.value);
}
void set_point(Sourced<Vec3>& item, const Value& value) {
  item.value = vector_of(std::get<std::vector<double>>(value));
}
void set_direction(Sourced<Vec3>& item, const Value& value) {
  set_point(item, value);
  const double length = item.value.norm();
  if (length > kMinLength && std::abs(length - 1.0) > kUnitTolerance) item.value /= length;
}

Value get_interval(const Sourced<Interval>& item) {
  return std::vector<double>{item.value.low, item.value.high};
}
void set_interval(Sourced<Interval>& item, const Value& value) {
  const auto& ends = std::get<std::vector<double>>(value);
  item.value = {ends[0], ends[1]};
}

using Points = std::vector<Vec3>;

Value get_points(const Sourced<Points>& item) {
  std::vector<std::vector<double>> rows;
  for (const Vec3& point : item.value) rows.push_back(numbers_of(point));
  return rows;
}
void set_points(Sourced<Points>& item, const Value& value) {
  item.value.clear();
  for (const auto& row : std::get<std::vector<std::vector<double>>>(value)) item.value.push_back(vector_of(row));
}
/// Sets the points of a body to the corners of the box [x_min, y_min, z_min, x_max, y_max, z_max].
void set_box(Sourced<Points>& item, const Value& value) {
  const auto& ends = std::get<std::vector<double>>(value);
  item.value.clear();
  for (std::size_t i = 0; i < 8; ++i)
    item.value.emplace_back(ends[(i & 1U) != 0 ? 3 : 0], ends[(i & 2U) != 0 ? 4 : 1], ends[(i & 4U) != 0 ? 5 : 2]);
}
/// Returns no value, because bodies are written as points and not as boxes.
Value get_no_box(const Sourced<Points>&) {
  return {};
}

template <class Type, Basis basis>
Value get_source(const Sourced<Type>& item) {
  return item.basis == basis ? Value(item.source) : Value();
}
template <class Type, Basis basis>
void set_source(Sourced<Type>& item, const Value& value) {
  item.basis = basis;
  item.source = std::get<std::string>(value);
}

// Checks of single values. They return an error message, or an empty text if the value is valid.

template <class Type>
std::string nameless_source(const Sourced<Type>& item) {
  return item.source.empty() ? "must contain the source of the value, got \"\"" : "";
}
std::string no_direction(const Sourced<Vec3>& item) {
  if (item.value.norm() > kMinLength) return {};
  return fmt::format("must be a vector with a length above 0, got [{}, {}, {}]", shortest(item.value.x()),
                     shortest(item.value.y()), shortest(item.value.z()));
}
std::string falling(const Sourced<Interval>& item) {
  if (item.value.low < item.value.high) return {};
  return fmt::format("the first number must be less than the second, got [{}, {}]", shortest(item.value.low),
                     shortest(item.value.high));
}
std::string no_sign(const Sourced<double>& item) {
  return std::abs(item.value) == 1.0 ? "" : "must be 1 or -1, got " + shortest(item.value);
}
std::string falling_box(const Sourced<Points>& item) {
  if ((item.value.front().array() < item.value.back().array()).all()) return {};
  return "must be [x_min, y_min, z_min, x_max, y_max, z_max] with each minimum less than its maximum";
}
std::string flat_hull(const Sourced<Points>& item) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : item.value) spread += (p - item.value.front()) * (p - item.value.front()).transpose();
  if (std::sqrt(std::max(spread.determinant(), 0.0)) > kMinVolumeMm3) return {};
  return "must not have all points in one plane";
}
std::string skew_linear_axes(const Machine& m) {
  const double volume = m.x.direction.value.cross(m.y.direction.value).dot(m.z.direction.value);
  return volume > kMinDeterminant
             ? ""
             : "the directions of X, Y and Z must be right-handed and nearly perpendicular to each other";
}
std::string aligned_rotary_axes(const Machine& m) {
  const double across = m.a.direction.value.cross(m.c.direction.value).norm();
  return across > kMinDeterminant ? ""
                                  : std::string("the direction of C must not be nearly parallel to ") + m.tilt_letter();
}

// Tables with a value and its origin: { value = ..., measured = "source" } or { value = ..., assumed = "reason" }.

constexpr std::string_view kSourceKeys[] = {"measured", "assumed"};
constexpr std::string_view kValueKeys[] = {"value"};
constexpr std::string_view kSourcedShape =
    "{ value = ..., measured = \"source\" } or { value = ..., assumed = \"reason\" }";

template <class Type>
constexpr std::array<Row, 3> sourced(Kind kind, Access value) {
  return {{{"value", kind, kRequired, "Value.", value},
           {"measured", Text{}, kNone, "Source of a measured value.",
            access_by<get_source<Type, Basis::measured>, set_source<Type, Basis::measured>>},
           {"assumed", Text{}, kNone, "Reason for an assumed value.",
            access_by<get_source<Type, Basis::assumed>, set_source<Type, Basis::assumed>>}}};
}

template <class Type, class... More>
constexpr std::array<Rule, 2 + sizeof...(More)> source_rules(More... more) {
  return {{more..., OneOf{kSourceKeys, "must have either measured = \"source\" or assumed = \"reason\""},
           Check{{}, "The source must not be empty.", check_by<nameless_source<Type>>}}};
}

template <auto complaint>
constexpr Check value_check(std::string_view meaning) {
  return {kValueKeys, meaning, check_by<complaint>};
}

/// Description of a table of a file that contains one type of value: its keys (rows), and the rules for their values.
struct ValueTable {
  std::span<const Row> rows;
  std::span<const Rule> rules;
};

constexpr auto kPositiveRows = sourced<double>(Number{kPositive}, access<&Sourced<double>::value>);
constexpr auto kPositiveRules = source_rules<double>();
constexpr ValueTable kPositiveValue = {kPositiveRows, kPositiveRules};

constexpr NumberRange kJerkRange{.low = 0.0, .low_included = false, .high = 1e12};
constexpr auto kJerkRows = sourced<double>(Number{kJerkRange}, access<&Sourced<double>::value>);
constexpr ValueTable kJerk = {kJerkRows, kPositiveRules};
constexpr std::string_view kJerkMeaning = "Maximum jerk: maximum rate of change of the acceleration.";

constexpr NumberRange kSettlingRange{.low = 0.0, .high = 10.0};
constexpr auto kSettlingRows = sourced<double>(Number{kSettlingRange}, access<&Sourced<double>::value>);
constexpr ValueTable kSettling = {kSettlingRows, kPositiveRules};
constexpr NumberRange kWarmUpRange{.low = 0.0, .high = 36000.0};
constexpr auto kWarmUpRows = sourced<double>(Number{kWarmUpRange}, access<&Sourced<double>::value>);
constexpr ValueTable kWarmUp = {kWarmUpRows, kPositiveRules};

constexpr auto kHeightRows = sourced<double>(Number{kLength}, access<&Sourced<double>::value>);
constexpr ValueTable kHeight = {kHeightRows, kPositiveRules};

constexpr auto kSignRows = sourced<double>(Number{}, access<&Sourced<double>::value>);
constexpr auto kSignRules = source_rules<double>(value_check<no_sign>("It must be 1 or -1."));
constexpr ValueTable kSign = {kSignRows, kSignRules};

constexpr auto kDirectionRows = sourced<Vec3>(Numbers{3, kComponent}, access_by<get_point, set_direction>);
constexpr auto kDirectionRules = source_rules<Vec3>(value_check<no_direction>("Its length must be above 0."));
constexpr ValueTable kDirection = {kDirectionRows, kDirectionRules};

constexpr auto kPointRows = sourced<Vec3>(Numbers{3, kLength}, access_by<get_point, set_point>);
constexpr auto kPointRules = source_rules<Vec3>();
constexpr ValueTable kPoint = {kPointRows, kPointRules};

constexpr auto kLimitsMmRows = sourced<Interval>(Numbers{2, kLength}, access_by<get_interval, set_interval>);
constexpr auto kLimitsDegRows = sourced<Interval>(Numbers{2, kDegrees}, access_by<get_interval, set_interval>);
constexpr auto kLimitsRules =
    source_rules<Interval>(value_check<falling>("The first number must be less than the second."));
constexpr ValueTable kLimitsMm = {kLimitsMmRows, kLimitsRules};
constexpr ValueTable kLimitsDeg = {kLimitsDegRows, kLimitsRules};

constexpr auto kBoxRows = sourced<Points>(Numbers{6, kLength}, access_by<get_no_box, set_box>);
constexpr auto kBoxRules =
    source_rules<Points>(value_check<falling_box>("Each minimum must be less than its maximum."));
constexpr ValueTable kBox = {kBoxRows, kBoxRules};

constexpr auto kHullRows =
    sourced<Points>(NumberRows{3, kLength, 4, 1000, "points"}, access_by<get_points, set_points>);
constexpr auto kHullRules = source_rules<Points>(value_check<flat_hull>("The points must not lie in one plane."));
constexpr ValueTable kHull = {kHullRows, kHullRules};

/// \param former name of the table in former versions; empty if it has not been renamed
constexpr Table value(std::string_view name, const ValueTable& type, Child child, std::string_view meaning,
                      std::string_view otherwise = {}, std::string_view former = {}) {
  return {.name = name,
          .meaning = meaning,
          .rows = type.rows,
          .rules = type.rules,
          .child = child,
          .presence = otherwise.empty() ? Presence::always : Presence::optional,
          .layout = Layout::in_line,
          .shape = kSourcedShape,
          .default_text = otherwise,
          .former = former};
}

/// Access to a member that is written to a file only if it differs from its default.
template <auto member, auto is_written>
constexpr Child child_if = {
    [](const void* parent) -> std::size_t {
      return is_written(*static_cast<const typename MemberTypes<decltype(member)>::Object*>(parent)) ? 1 : 0;
    },
    child_at<member>, child_of<member>};

template <auto jerk>
constexpr Child kJerkOf = child_if<jerk, [](const auto& axis) { return std::isfinite((axis.*jerk).value); }>;

constexpr Table kLinearTables[] = {
    value("direction", kDirection, child<&LinearAxis::direction>,
          "Direction in which increasing positions move the tool relative to the workpiece. The vector is scaled to "
          "length 1."),
    value("limits_mm", kLimitsMm, child<&LinearAxis::limits_mm>, "Minimum and maximum position."),
    value("max_feed_mm_per_min", kPositiveValue, child<&LinearAxis::max_feed_mm_per_min>, "Maximum feed."),
    value("rapid_mm_per_min", kPositiveValue, child<&LinearAxis::rapid_mm_per_min>, "Speed of rapid moves."),
    value("acceleration_mm_per_s2", kPositiveValue, child<&LinearAxis::acceleration_mm_per_s2>,
          "Acceleration of the axis."),
    value("jerk_mm_per_s3", kJerk, kJerkOf<&LinearAxis::jerk_mm_per_s3>, kJerkMeaning, "no limit")};

constexpr Table kRotaryTables[] = {
    value("direction", kDirection, child<&RotaryAxis::direction>,
          "Direction of the axis of rotation. The vector is scaled to length 1."),
    value("point_mm", kPoint, child<&RotaryAxis::point_mm>,
          "Point on the axis of rotation. For B, its coordinates are relative to the tool reference point at B = 0.",
          "the origin"),
    value("sign", kSign, child<&RotaryAxis::sign>,
          "Sense of rotation. 1: increasing positions rotate the workpiece (B: the tool) by the right-hand rule about "
          "`direction`. -1: by the left-hand rule.",
          "1"),
    value("limits_deg", kLimitsDeg, child<&RotaryAxis::limits_deg>, "Minimum and maximum position."),
    value("speed_deg_per_s", kPositiveValue, child<&RotaryAxis::speed_deg_per_s>, "Speed of rapid moves."),
    value("acceleration_deg_per_s2", kPositiveValue, child<&RotaryAxis::acceleration_deg_per_s2>,
          "Acceleration of the axis."),
    value("jerk_deg_per_s3", kJerk, kJerkOf<&RotaryAxis::jerk_deg_per_s3>, kJerkMeaning, "no limit")};

constexpr std::string_view kCarrierWords[] = {"workpiece", "cradle", "tool"};
constexpr Row kBodyRows[] = {
    {"name", Text{}, kRequired, "Name of the body.", access<&MachineBody::name>},
    {"moves_with", Word{kCarrierWords}, kRequired,
     "Part of the machine with which the body moves. `\"workpiece\"`: A and C rotate the body, for example the table "
     "or a clamp. `\"cradle\"`: A rotates the body, but C does not; on a machine with a tilting head, the body does "
     "not move. `\"tool\"`: the body holds the diamond, and its points are relative to the tool reference point.",
     access<&MachineBody::link>}};
constexpr Table kBodyTables[] = {value("box_mm", kBox, child_only_read<&MachineBody::points_mm>,
                                       "Box [x_min, y_min, z_min, x_max, y_max, z_max].", "none"),
                                 value("points_mm", kHull, child<&MachineBody::points_mm>,
                                       "Points [[x, y, z], ...]. The body is their convex hull.", "none")};
constexpr std::string_view kBodyShapes[] = {"box_mm", "points_mm"};
constexpr Rule kBodyRules[] = {OneOf{kBodyShapes, "must contain either the key box_mm or the key points_mm"}};

/// Access to the tilting axis, which is [a] for a tilting table and [b] for a tilting head.
template <Tilt tilt>
constexpr Child kTilting = {
    [](const void* machine) -> std::size_t { return static_cast<const Machine*>(machine)->tilt == tilt ? 1 : 0; },
    [](const void* machine, std::size_t) -> const void* { return &static_cast<const Machine*>(machine)->a; },
    [](void* machine) -> void* {
      static_cast<Machine*>(machine)->tilt = tilt;
      return &static_cast<Machine*>(machine)->a;
    }};

constexpr Table linear(std::string_view name, std::string_view meaning, Child child) {
  return {.name = name, .meaning = meaning, .tables = kLinearTables, .child = child};
}
constexpr Table rotary(std::string_view name, std::string_view meaning, Child child, Presence presence) {
  return {.name = name, .meaning = meaning, .tables = kRotaryTables, .child = child, .presence = presence};
}

/// Range of each component of the rotation vector of a mounted tool.
constexpr NumberRange kMountDegrees{.low = -5.0, .high = 5.0};
constexpr NumberRange kMountLength{.low = -10.0, .high = 10.0};
constexpr auto kMountOffsetRows = sourced<Vec3>(Numbers{3, kMountLength}, access_by<get_point, set_point>);
constexpr ValueTable kMountOffset = {kMountOffsetRows, kPointRules};
constexpr auto kMountTurnRows = sourced<Vec3>(Numbers{3, kMountDegrees}, access_by<get_point, set_point>);
constexpr ValueTable kMountTurn = {kMountTurnRows, kPointRules};
constexpr Table kMountTables[] = {
    value("offset_mm", kMountOffset, child<&ToolMount::offset_mm>,
          "Displacement, along X, Y and Z, of the tool reference point from its nominal position. For a tilting head, "
          "it is the displacement at B = 0.",
          "0"),
    value("rotation_deg", kMountTurn, child<&ToolMount::rotation_deg>,
          "Orientation of the mounted tool: a rotation vector by the right-hand rule. The tool is touched off after "
          "mounting, so the rotation does not move its reference point. A rotation about X changes the clearance, one "
          "about Y tilts the edge, and one about Z rotates the edge away from X.",
          "0", "turn_deg")};

bool is_mounted_askew(const Machine& m) {
  return m.mount.offset_mm.value != Vec3::Zero() || m.mount.rotation_deg.value != Vec3::Zero();
}

template <std::string Control::*line>
std::string unfit_text(const Control& control) {
  const std::string& text = control.*line;
  if (text.empty()) return {};
  if (const std::string fault = line_error(text); !fault.empty()) return fault + ", got " + in_quotes(text);
  const bool is_stop = &text == &control.stop || &text == &control.optional_stop;
  const std::string fault = line_form_error(text, is_stop ? LineUse::stop : LineUse::output);
  if (!control.has_unchecked_lines && !fault.empty())
    return fmt::format("{}; any other line requires control.has_unchecked_lines = true, got {}", fault,
                       in_quotes(text));
  const std::string* const lines[] = {&control.mist_on, &control.mist_off, &control.optional_stop, &control.stop};
  const bool is_other = std::any_of(std::begin(lines), std::end(lines),
                                    [&](const auto* other) { return other != &text && *other == text; });
  return is_other ? "must differ from the lines of the other keys (mist_on, mist_off, optional_stop, stop), got " +
                        in_quotes(text)
                  : "";
}
std::string unknown_modulo_axes(const Control& control) {
  if (control.modulo_axes.find_first_not_of("ABC") == std::string::npos) return {};
  return "must be letters of rotary axes, such as \"C\" or \"\", got " + in_quotes(control.modulo_axes);
}

constexpr Row kControlRows[] = {
    {"increment_system", Word{kIncrementSystemWords}, "E",
     "Increment system of a Fanuc control. With B, C, D and E, words have 3, 4, 5 and 6 decimals, respectively. All "
     "words have at "
     "most nine digits.",
     access<&Control::increment_system>},
    {"has_rotation", Flag{}, false,
     "Whether a Fanuc control can rotate coordinates. If it can, programs cancel the rotation with `G69`.",
     access<&Control::has_rotation>},
    {"has_mirror", Flag{}, false,
     "Whether a Fanuc control can mirror coordinates. If it can, programs cancel the mirroring with `G50.1`.",
     access<&Control::has_mirror>},
    {"modulo_axes", Text{}, "C",
     "Letters of the modulo axes of a Sinumerik (MD30310). A modulo axis is a rotary axis that rotates without limits "
     "and whose position is counted within one rotation.",
     access<&Control::modulo_axes>},
    {"coordinate_system", Integer{{.low = 1.0, .high = 127.0}}, 1.0,
     "Number of the coordinate system of a Power PMAC that contains the axes X to C.",
     access<&Control::coordinate_system>},
    {"mist_on", Text{}, kNone, "Program line that switches mist on, for a Power PMAC or an Aerotech control.",
     access<&Control::mist_on>},
    {"mist_off", Text{}, kNone, "Program line that switches mist off, for a Power PMAC or an Aerotech control.",
     access<&Control::mist_off>},
    {"optional_stop", Text{}, kNone,
     "Program line of an optional stop, which the operator can switch on and off, for a Power PMAC or an Aerotech "
     "control.",
     access<&Control::optional_stop>},
    {"stop", Text{}, kNone,
     "Program line at which a program waits until the operator continues it, for a Power PMAC or an Aerotech control.",
     access<&Control::stop>},
    {"has_unchecked_lines", Flag{}, false,
     "Whether the lines for mist and stops, for a Power PMAC or an Aerotech control, are accepted without a check. "
     "They can then be any text, even text that moves axes or waits. The header of each program names such lines.",
     access<&Control::has_unchecked_lines>},
    {"rapids_are_straight", Flag{}, false,
     "Whether all axes of a rapid move arrive at the same time (Fanuc 1401#1, 840D `RTLIOF`). The path is then a "
     "straight line. Otherwise, the tool must not collide anywhere in the box between the two ends of the move.",
     access<&Control::rapids_are_straight>}};
constexpr std::string_view kMistOnKeys[] = {"mist_on"};
constexpr std::string_view kMistOffKeys[] = {"mist_off"};
constexpr std::string_view kOptionalStopKeys[] = {"optional_stop"};
constexpr std::string_view kStopKeys[] = {"stop"};
constexpr std::string_view kModuloKeys[] = {"modulo_axes"};
constexpr Rule kControlRules[] = {
    Check{
        kMistOnKeys,
        "`mist_on` is a line of 1 to 200 printable ASCII characters. Unless `has_unchecked_lines` is true, it sets an "
        "output or a variable, or is an M code of the machine's builder (see `docs/nc_dialects.md`).",
        check_by<unfit_text<&Control::mist_on>>},
    Check{kMistOffKeys, "`mist_off` follows the rule for `mist_on`, and differs from the other lines.",
          check_by<unfit_text<&Control::mist_off>>},
    Check{kOptionalStopKeys,
          "`optional_stop` follows the rule for `mist_on` or is `M0` or `M1`, and differs from the other lines.",
          check_by<unfit_text<&Control::optional_stop>>},
    Check{kStopKeys, "`stop` follows the rule for `mist_on` or is `M0` or `M1`, and differs from the other lines.",
          check_by<unfit_text<&Control::stop>>},
    Check{kModuloKeys, "`modulo_axes` may contain only letters of rotary axes.", check_by<unknown_modulo_axes>}};

bool has_safe_z(const Machine& m) {
  return m.safe_z_mm.value <= m.z.limits_mm.value.high;
}
bool settles(const Machine& m) {
  return m.settling_s.value > 0.0;
}
bool warms_up(const Machine& m) {
  return m.warm_up_s.value > 0.0;
}

constexpr Row kRows[] = {{"name", Text{}, kRequired, "Name of the machine.", access<&Machine::name>},
                         {"title", Text{}, kNone, "Description of the machine, for readers.", access<&Machine::title>}};
constexpr Table kTables[] = {
    value("safe_z_mm", kHeight, child_if<&Machine::safe_z_mm, has_safe_z>,
          "Z position of the first move of a program, before any other axis moves. At this Z position, the tool is "
          "clear of everything on the table, at all positions of the other axes.",
          "the upper limit of Z"),
    value("settling_s", kSettling, child_if<&Machine::settling_s, settles>,
          "Time that the control waits after every move until the axes are at rest (exact stop).", "0"),
    value("warm_up_s", kWarmUp, child_if<&Machine::warm_up_s, warms_up>,
          "Warm-up time. X and Y move back and forth for this time, at the height of the first move, before the first "
          "cut of a program and after a stop. It is the time in which the machine reaches a steady temperature.",
          "0"),
    linear("x", "Linear axis X.", child<&Machine::x>),
    linear("y", "Linear axis Y.", child<&Machine::y>),
    linear("z", "Linear axis Z.", child<&Machine::z>),
    rotary("a", "Rotary axis A, about which the table tilts. Either A or B is required.", kTilting<Tilt::table>,
           Presence::optional),
    rotary("b", "Rotary axis B, about which the head tilts. Either A or B is required.", kTilting<Tilt::head>,
           Presence::optional),
    rotary("c", "Rotary axis C of the table.", child<&Machine::c>, Presence::always),
    {.name = "mount",
     .meaning = "Deviation of the mounted tool from its nominal position and orientation.",
     .tables = kMountTables,
     .child = child_if<&Machine::mount, is_mounted_askew>,
     .presence = Presence::optional},
    {.name = "control",
     .meaning = "Properties of the control on which programs depend. Each dialect uses only some of them.",
     .rows = kControlRows,
     .rules = kControlRules,
     .child = child<&Machine::control>,
     .presence = Presence::optional},
    {.name = "body",
     .meaning = "Convex body of the machine, for collision checks.",
     .rows = kBodyRows,
     .tables = kBodyTables,
     .rules = kBodyRules,
     .child = children<&Machine::bodies>,
     .presence = Presence::list}};
constexpr std::string_view kTiltingKeys[] = {"a", "b"};
constexpr std::string_view kZKeys[] = {"z"};
constexpr std::string_view kCKeys[] = {"c"};
constexpr Rule kRules[] = {OneOf{kTiltingKeys, "must have either [a], if the table tilts, or [b], if the head tilts"},
                           Check{kZKeys, "X, Y and Z must be right-handed and nearly perpendicular to each other.",
                                 check_by<skew_linear_axes>},
                           Check{kCKeys, "C must not be nearly parallel to A or B.", check_by<aligned_rotary_axes>}};

constexpr schema::Format kFormat = {
    "machine",
    "retrace.machine/1",
    "Machine with five axes",
    {"", "Axes of a machine, in the workpiece frame at A = C = 0, and bodies for collision checks.", kRows, kTables,
     kRules}};

}  // namespace

const schema::Format& machine_format() {
  return kFormat;
}

Machine parse_machine(std::string_view text, const std::string& source_name) {
  Machine machine;
  machine.warnings = schema::renamed_keys(schema::read_object(kFormat, text, source_name, &machine));
  return machine;
}

std::string machine_text(const Machine& machine) {
  return schema::object_text(kFormat, &machine);
}

std::vector<Machine> shipped_machines() {
  std::vector<Machine> machines;
  for (const fs::path& file : shipped_files("machines"))
    machines.push_back(parse_machine(read_file(file), file.string()));
  return machines;
}

Machine load_machine(const std::string& name_or_file, const InputLocation& where) {
  if (fs::path(name_or_file).has_extension())
    return read_named(where, [&] { return parse_machine(read_file(name_or_file), name_or_file); });
  std::vector<std::string> names;
  for (Machine& machine : shipped_machines()) {
    if (machine.name == name_or_file) return std::move(machine);
    names.push_back(machine.name);
  }
  throw InputError(where, fmt::format("must be the name of a file or one of the names {}, got {}",
                                      fmt::join(names, ", "), in_quotes(name_or_file)));
}

}  // namespace retrace::fabrication
