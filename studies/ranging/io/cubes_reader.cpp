#include "studies/ranging/io/cubes_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "core/atomic_file.h"
#include "core/csv.h"
#include "core/field.h"
#include "core/named_file.h"
#include "core/schema/access.h"
#include "core/schema/reader.h"
#include "core/text.h"

namespace retrace::studies {
namespace {

using schema::access, schema::Number, schema::Numbers, schema::kNone, schema::kRequired;

constexpr std::size_t kMaxCubes = 100000;
constexpr std::size_t kMaxCubeBytes = std::size_t{1} << 24;
constexpr NumberRange kPosition{.low = -1e6, .high = 1e6};
constexpr NumberRange kRadius{.low = 0.0, .high = 1e6};
constexpr NumberRange kPitch{.low = 0.0, .low_included = false, .high = 1e6};
constexpr NumberRange kComponent{.low = -1e6, .high = 1e6};
constexpr NumberRange kLatitude{.low = -90.0, .high = 90.0};
constexpr NumberRange kRotation{.low = -360.0, .high = 360.0};
constexpr NumberRange kCount{.low = 1.0, .high = static_cast<double>(kMaxCubes)};
constexpr NumberRange kErrorArcsec{.low = -3600.0, .high = 3600.0};

constexpr std::array<double, 3> kUp = {0.0, 0.0, 1.0};

/// Table [[cube]] of a file of cubes.
struct CubeEntry {
  std::array<double, 3> position_mm{};
  std::array<double, 3> axis = kUp;
  double clocking_deg = 0.0;
  std::optional<std::array<double, 3>> dihedral_error_arcsec;
};

/// Tables of a file of cubes.
struct CubesFile {
  std::vector<CubeRing> rings;
  std::vector<CubeGrid> grids;
  std::vector<CubeEntry> cubes;
};

constexpr schema::Row kRingRows[] = {
    {"radius_mm", Number{kRadius}, kRequired, "Distance of the entrance faces from the centre of the sphere.",
     access<&CubeRing::radius_mm>},
    {"latitude_deg", Number{kLatitude}, 0.0, "Angle between the axes of the cubes and the plane z = 0.",
     access<&CubeRing::latitude_deg>},
    {"count", schema::Integer{kCount}, kRequired, "Number of cubes, at equal distances.", access<&CubeRing::count>},
    {"azimuth_deg", Number{kRotation}, 0.0, "Azimuth of the first cube.", access<&CubeRing::azimuth_deg>},
    {"clocking_deg", Number{kRotation}, 0.0, "Rotation of the cubes about their axes.",
     access<&CubeRing::clocking_deg>},
    {"clocking_step_deg", Number{kRotation}, 0.0, "Additional rotation from one cube to the next.",
     access<&CubeRing::clocking_step_deg>}};

constexpr schema::Row kGridRows[] = {
    {"columns", schema::Integer{kCount}, kRequired, "Number of cubes along x.", access<&CubeGrid::columns>},
    {"rows", schema::Integer{kCount}, kRequired, "Number of cubes along y.", access<&CubeGrid::rows>},
    {"pitch_mm", Number{kPitch}, kRequired, "Distance between neighbouring cubes along x and y.",
     access<&CubeGrid::pitch_mm>},
    {"height_mm", Number{kPosition}, 0.0, "Height of the entrance faces (z).", access<&CubeGrid::height_mm>},
    {"clocking_deg", Number{kRotation}, 0.0, "Rotation of the cubes about their axes.",
     access<&CubeGrid::clocking_deg>},
    {"clocking_step_deg", Number{kRotation}, 0.0, "Additional rotation from one cube to the next, row by row.",
     access<&CubeGrid::clocking_step_deg>}};

constexpr schema::Row kCubeRows[] = {
    {"position_mm", Numbers{3, kPosition}, kRequired,
     "Position of the point of the entrance face that is in front of the apex.", access<&CubeEntry::position_mm>},
    {"axis", Numbers{3, kComponent}, std::span<const double>(kUp),
     "Vector of any length along the axis of the cube, out of its entrance face.", access<&CubeEntry::axis>},
    {"clocking_deg", Number{kRotation}, 0.0, "Rotation of the cube about its axis.", access<&CubeEntry::clocking_deg>},
    {"dihedral_error_arcsec", Numbers{3, kErrorArcsec}, kNone,
     "Errors of the dihedral angles of this cube, instead of those of the design.",
     access<&CubeEntry::dihedral_error_arcsec>}};

std::string missing_axis(const CubeEntry& cube) {
  return geometry::Vec3(cube.axis.data()).norm() > 0.0 ? "" : "must not be zero in all components";
}
constexpr std::string_view kAxisKeys[] = {"axis"};
constexpr schema::Rule kCubeRules[] = {
    schema::Check{kAxisKeys, "`axis` has at least one component that is not 0.", schema::check_by<missing_axis>}};

constexpr schema::Table kCubeTables[] = {
    {.name = "ring",
     .meaning = "Ring of cubes on a sphere around the origin. Their axes point away from the origin.",
     .rows = kRingRows,
     .child = schema::children<&CubesFile::rings>,
     .presence = schema::Presence::list},
    {.name = "grid",
     .meaning = "Rectangular grid of cubes on a plate, centred at x = y = 0. Their axes are +z.",
     .rows = kGridRows,
     .child = schema::children<&CubesFile::grids>,
     .presence = schema::Presence::list},
    {.name = "cube",
     .meaning = "A single cube.",
     .rows = kCubeRows,
     .rules = kCubeRules,
     .child = schema::children<&CubesFile::cubes>,
     .presence = schema::Presence::list}};

constexpr schema::Format kCubesFormat = {
    "cubes", "retrace.cubes/1", "Cubes of an array for ranging", {"", "Positions and axes of cubes.", {}, kCubeTables}};

void append(std::vector<ArrayCube>& all, const std::vector<ArrayCube>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

[[noreturn]] void refuse_count(const InputLocation& where, std::size_t count) {
  throw InputError(where, fmt::format("must contain 1 to {} cubes, got {}", kMaxCubes, count));
}

std::size_t count_in(const CubesFile& file) {
  std::size_t count = file.cubes.size();
  for (const CubeRing& ring : file.rings) count += static_cast<std::size_t>(ring.count);
  for (const CubeGrid& grid : file.grids)
    count += static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.columns);
  return count;
}

constexpr std::array<std::string_view, 6> kCubeColumns = {"x_mm", "y_mm", "z_mm", "axis_x", "axis_y", "axis_z"};
constexpr std::string_view kClockingColumn = "clocking_deg";
constexpr std::array<std::string_view, 3> kErrorColumns = {"dihedral_error_1_arcsec", "dihedral_error_2_arcsec",
                                                           "dihedral_error_3_arcsec"};
constexpr std::size_t kAxisColumn = 3;

/// Indices of the columns in a table of cubes.
struct CubeColumns {
  std::vector<std::string_view> names;
  std::optional<std::size_t> clocking;
  std::optional<std::size_t> errors;  ///< index of the first of three columns with angle errors
};

/// Returns the columns that a table must have. The three columns of angle errors must be given together or not at all.
CubeColumns columns_of(std::string_view text, const std::string& source_name) {
  const CsvReader table(text, source_name, kMaxCubeBytes);
  CubeColumns columns{{kCubeColumns.begin(), kCubeColumns.end()}, {}, {}};
  if (table.find(kClockingColumn)) {
    columns.clocking = columns.names.size();
    columns.names.push_back(kClockingColumn);
  }
  if (std::ranges::any_of(kErrorColumns, [&](std::string_view name) { return table.find(name).has_value(); })) {
    columns.errors = columns.names.size();
    columns.names.insert(columns.names.end(), kErrorColumns.begin(), kErrorColumns.end());
  }
  return columns;
}

ArrayCube cube_in(const CsvReader& row, const CubeColumns& columns) {
  ArrayCube cube;
  for (std::size_t k = 0; k < 3; ++k) {
    cube.position_mm[static_cast<Eigen::Index>(k)] = row.number(k, kPosition);
    cube.axis[static_cast<Eigen::Index>(k)] = row.number(kAxisColumn + k, kComponent);
  }
  if (!(cube.axis.norm() > 0.0)) row.fail(kAxisColumn, "the axis must not be zero in all components");
  cube.axis.normalize();
  if (columns.clocking) cube.clocking_deg = row.number(*columns.clocking, kRotation);
  if (!columns.errors) return cube;
  std::array<double, 3> errors{};
  for (std::size_t k = 0; k < 3; ++k) errors[k] = row.number(*columns.errors + k, kErrorArcsec);
  cube.dihedral_error_arcsec = errors;
  return cube;
}

}  // namespace

const schema::Format& cubes_format() {
  return kCubesFormat;
}

std::vector<ArrayCube> parse_cubes(std::string_view text, const std::string& source_name) {
  CubesFile file;
  schema::read_object(kCubesFormat, text, source_name, &file);
  const std::size_t count = count_in(file);
  if (count == 0 || count > kMaxCubes) refuse_count({source_name, 0, ""}, count);
  std::vector<ArrayCube> cubes;
  for (const CubeRing& ring : file.rings) append(cubes, cubes_of(ring));
  for (const CubeGrid& grid : file.grids) append(cubes, cubes_of(grid));
  for (const CubeEntry& entry : file.cubes)
    cubes.push_back({geometry::Vec3(entry.position_mm.data()), geometry::Vec3(entry.axis.data()).normalized(),
                     entry.clocking_deg, entry.dihedral_error_arcsec});
  return cubes;
}

std::vector<ArrayCube> parse_cube_table(std::string_view text, const std::string& source_name) {
  const CubeColumns columns = columns_of(text, source_name);
  CsvReader table(text, source_name, kMaxCubeBytes, columns.names);
  std::vector<ArrayCube> cubes;
  while (table.next()) {
    cubes.push_back(cube_in(table, columns));
    if (cubes.size() > kMaxCubes) refuse_count({source_name, 0, ""}, cubes.size());
  }
  if (cubes.empty()) refuse_count({source_name, 0, ""}, 0);
  return cubes;
}

std::vector<ArrayCube> read_cubes(const std::filesystem::path& file) {
  return read_named(Field{"cubes"}, [&] {
    const std::string text = read_file(file, kMaxCubeBytes);
    return ending_of(file) == ".csv" ? parse_cube_table(text, file.string()) : parse_cubes(text, file.string());
  });
}

}  // namespace retrace::studies
