#include "fabrication/machine/io/machine_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/data_directory.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/toml_file.h"

namespace retrace::fabrication {
namespace {

namespace fs = std::filesystem;
using geometry::Vec3;

constexpr NumberRange kPositive{.low = 0.0, .low_included = false, .high = 1e6};
constexpr NumberRange kLength{.low = -1e4, .high = 1e4};
constexpr NumberRange kComponent{.low = -1e6, .high = 1e6};
constexpr NumberRange kDegrees{.low = -3600.0, .high = 3600.0};
/// Directions that are nearer to each other than this do not span what the axes must span (about 30 degrees).
constexpr double kLeastDeterminant = 0.5;

/// An inline table { value = ..., measured = "by whom" } or { value = ..., assumed = "why" }.
template <class Value, class Read>
Sourced<Value> sourced(TomlTable& axis, std::string_view key, Read read) {
  if (!axis.has(key)) axis.fail(key, "missing, must be { value = ..., measured = \"source\" } or with assumed");
  TomlTable entry = axis.table(key);
  Sourced<Value> result;
  result.value = read(entry);
  const auto measured = entry.text("measured");
  const auto assumed = entry.text("assumed");
  if (measured.has_value() == assumed.has_value())
    axis.fail(key, "must say either measured = \"source\" or assumed = \"why\"");
  result.basis = measured ? Basis::measured : Basis::assumed;
  result.source = measured ? *measured : *assumed;
  if (result.source.empty()) axis.fail(key, "must name its source, got \"\"");
  return result;
}

Sourced<double> positive(TomlTable& axis, std::string_view key) {
  return sourced<double>(axis, key, [](TomlTable& entry) { return entry.required_number("value", kPositive); });
}

Vec3 vector_of(const std::vector<double>& values) {
  return {values[0], values[1], values[2]};
}

Sourced<Vec3> direction(TomlTable& axis) {
  return sourced<Vec3>(axis, "direction", [](TomlTable& entry) {
    const std::vector<double> given = entry.required_numbers("value", 3, kComponent);
    const double length = vector_of(given).norm();
    if (!(length > 1e-6))
      entry.fail("value", fmt::format("must be a vector of a length above 0, got [{}, {}, {}]", shortest(given[0]),
                                      shortest(given[1]), shortest(given[2])));
    return Vec3(vector_of(given) / length);
  });
}

Sourced<Interval> limits(TomlTable& axis, std::string_view key, const NumberRange& range) {
  return sourced<Interval>(axis, key, [&](TomlTable& entry) {
    const std::vector<double> ends = entry.required_numbers("value", 2, range);
    if (!(ends[0] < ends[1]))
      entry.fail("value", fmt::format("must rise, got [{}, {}]", shortest(ends[0]), shortest(ends[1])));
    return Interval{ends[0], ends[1]};
  });
}

LinearAxis linear_axis(TomlTable table) {
  LinearAxis axis;
  axis.direction = direction(table);
  axis.limits_mm = limits(table, "limits_mm", kLength);
  axis.max_feed_mm_per_min = positive(table, "max_feed_mm_per_min");
  axis.rapid_mm_per_min = positive(table, "rapid_mm_per_min");
  axis.acceleration_mm_per_s2 = positive(table, "acceleration_mm_per_s2");
  return axis;
}

RotaryAxis rotary_axis(TomlTable table) {
  RotaryAxis axis;
  axis.direction = direction(table);
  axis.point_mm = {Vec3::Zero(), Basis::assumed, "the origin of the workpiece, as for every machine that names none"};
  if (table.has("point_mm"))
    axis.point_mm = sourced<Vec3>(
        table, "point_mm", [](TomlTable& entry) { return vector_of(entry.required_numbers("value", 3, kLength)); });
  axis.sign = {1.0, Basis::assumed, "positive words turn the workpiece by the right hand"};
  if (table.has("sign"))
    axis.sign = sourced<double>(table, "sign", [](TomlTable& entry) {
      const double sign = entry.required_number("value");
      if (std::abs(sign) != 1.0) entry.fail("value", "must be 1 or -1, got " + shortest(sign));
      return sign;
    });
  axis.limits_deg = limits(table, "limits_deg", kDegrees);
  axis.speed_deg_per_s = positive(table, "speed_deg_per_s");
  axis.acceleration_deg_per_s2 = positive(table, "acceleration_deg_per_s2");
  return axis;
}

/// The corners of a box from [x_min, y_min, z_min, x_max, y_max, z_max].
std::vector<Vec3> box_corners(TomlTable& entry) {
  const std::vector<double> ends = entry.required_numbers("value", 6, kLength);
  for (std::size_t i = 0; i < 3; ++i)
    if (!(ends[i] < ends[i + 3]))
      entry.fail("value", "must be [x_min, y_min, z_min, x_max, y_max, z_max], each rising");
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < 8; ++i)
    corners.emplace_back(ends[(i & 1U) != 0 ? 3 : 0], ends[(i & 2U) != 0 ? 4 : 1], ends[(i & 4U) != 0 ? 5 : 2]);
  return corners;
}

/// Points that span a body: at least four, not in one plane.
std::vector<Vec3> hull_points(TomlTable& entry) {
  constexpr std::size_t kMost = 1000;
  constexpr double kLeastVolumeMm3 = 1e-6;
  std::vector<Vec3> points;
  for (const std::vector<double>& row : entry.required_number_rows("value", 3, kLength))
    points.push_back(vector_of(row));
  if (points.size() < 4 || points.size() > kMost)
    entry.fail("value", fmt::format("must be 4 to {} points, got {}", kMost, points.size()));
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) spread += (p - points.front()) * (p - points.front()).transpose();
  if (!(std::sqrt(std::max(spread.determinant(), 0.0)) > kLeastVolumeMm3))
    entry.fail("value", "must be points that do not lie in one plane");
  return points;
}

MachineBody body(TomlTable table) {
  static constexpr std::string_view kCarriers[] = {"workpiece", "cradle", "tool"};
  MachineBody result;
  result.name = table.required_text("name");
  result.carrier = static_cast<Carrier>(table.required_choice("moves_with", kCarriers));
  if (table.has("points_mm") && table.has("box_mm")) table.fail("points_mm", "must not be given together with box_mm");
  result.points_mm = table.has("points_mm") ? sourced<std::vector<Vec3>>(table, "points_mm", hull_points)
                                            : sourced<std::vector<Vec3>>(table, "box_mm", box_corners);
  return result;
}

void check_axes(const Machine& machine, const TomlTable& root) {
  Eigen::Matrix3d linear;
  linear << machine.x.direction.value, machine.y.direction.value, machine.z.direction.value;
  const double volume = linear.col(0).cross(linear.col(1)).dot(linear.col(2));
  if (!(volume > kLeastDeterminant)) root.fail("z", "X, Y and Z must be right-handed and near to square to each other");
  const double across = machine.a.direction.value.cross(machine.c.direction.value).norm();
  if (!(across > kLeastDeterminant)) root.fail("c", std::string("C must lie across ") + machine.tilt_letter());
}

}  // namespace

Machine parse_machine(std::string_view text, const std::string& source_name) {
  static constexpr std::string_view kSchemas[] = {"retrace.machine/1"};
  TomlTable root = parse_toml(text, source_name);
  root.required_choice("schema", kSchemas);
  Machine machine;
  machine.name = root.required_text("name");
  machine.title = root.text("title").value_or("");
  machine.x = linear_axis(root.required_table("x"));
  machine.y = linear_axis(root.required_table("y"));
  machine.z = linear_axis(root.required_table("z"));
  if (root.has("b")) {
    if (root.has("a")) root.fail("b", "not allowed together with [a]: either the table tilts or the head");
    machine.tilt = Tilt::head;
  }
  machine.a = rotary_axis(root.required_table(machine.tilt == Tilt::table ? "a" : "b"));
  machine.c = rotary_axis(root.required_table("c"));
  for (const TomlTable& table : root.tables("body")) machine.bodies.push_back(body(table));
  root.finish();
  check_axes(machine, root);
  return machine;
}

std::vector<Machine> shipped_machines() {
  const fs::path folder = data_directory() / "machines";
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  if (error) throw InputError(folder.string() + ": cannot be read");
  std::sort(files.begin(), files.end());
  std::vector<Machine> machines;
  for (const fs::path& file : files) machines.push_back(parse_machine(read_file(file), file.string()));
  return machines;
}

Machine load_machine(const std::string& name_or_file, const InputLocation& where) {
  if (fs::path(name_or_file).has_extension()) return parse_machine(read_file(name_or_file), name_or_file);
  std::vector<std::string> names;
  for (Machine& machine : shipped_machines()) {
    if (machine.name == name_or_file) return std::move(machine);
    names.push_back(machine.name);
  }
  throw InputError(where,
                   fmt::format("must be a file or one of {}, got {}", fmt::join(names, ", "), in_quotes(name_or_file)));
}

}  // namespace retrace::fabrication
