#include "surface_models/io/height_map_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/number_format.h"
#include "surface_models/io/raw_map.h"

namespace retrace::surface_models {
namespace {

constexpr std::string_view kFormats = "a text grid, a list of points, SDF in ASCII (ISO 25178-71), Gwyddion GSF or GWY";
/// Maximum height: one kilometre. Larger values are caused by a wrong unit.
constexpr double kMaxHeightNm = 1e12;
constexpr double kMinPixelUm = 1e-6;
constexpr double kMaxPixelUm = 1e6;

RawMap parse_known(const Source& source) {
  const std::string_view content = source.content;
  const auto refuse = [&](std::string_view what) {
    source.fail(0, fmt::format("{}; allowed formats: {}", what, kFormats));
  };
  if (content.empty()) refuse("the file is empty");
  if (content.starts_with("GWYP")) return parse_gwy(source);
  if (content.starts_with("Gwyddion Simple Field")) return parse_gsf(source);
  if (content.starts_with("aISO-") || content.starts_with("aBCR-")) return parse_sdf(source);
  if (content.starts_with("bISO-") || content.starts_with("bBCR-")) refuse("binary SDF is not supported");
  if (content.starts_with("GWYO")) refuse("Gwyddion files before version 2 are not supported");
  if (content.starts_with("PK\x03\x04")) refuse("X3P and other zip archives are not supported");
  const std::string_view start = content.substr(0, 1024);
  if (std::any_of(start.begin(), start.end(),
                  [](char c) { return c >= 0 && c < ' ' && c != '\t' && c != '\n' && c != '\r'; }))
    refuse("the format is unknown");
  return parse_text_grid(source);
}

/// Returns the spacing from the option, or else from the file.
/// \throw InputError if neither is given
double pixel_um(const Source& source, const std::optional<double>& option, const std::optional<double>& in_file,
                const char* axis, Warnings& warnings) {
  if (!option && !in_file)
    source.fail(0, fmt::format("the spacing along {0} is not known: give {0}_pixel_um in the file{1}", axis,
                               source.options.suggests_options ? ", or " + reference({"pixel_um"}) : ""));
  if (option && in_file && std::abs(*option - *in_file) > 1e-6 * *option)
    warnings.push_back(
        {"spacing_of_file_ignored",
         fmt::format("the given spacing of {} um is used instead of the file's spacing along {} of {} um",
                     shortest(*option), axis, shortest(*in_file))});
  const double pixel = option ? *option : *in_file;
  if (!(pixel >= kMinPixelUm && pixel <= kMaxPixelUm))
    source.fail(0, fmt::format("the spacing along {} must be from 1e-6 to 1e6 um, got {}", axis, pixel));
  return pixel;
}

double nm_per_unit(const Source& source, RawMap& raw) {
  if (!source.options.height_unit) {
    if (!raw.nm_per_unit)
      source.fail(0, fmt::format("the unit of heights is not known: give height_unit = UNIT in the file{}; UNIT is {}",
                                 source.options.suggests_options ? ", or " + reference({"height_unit"}) + " UNIT" : "",
                                 kUnits));
    return *raw.nm_per_unit;
  }
  const std::optional<double> given = nm_per(*source.options.height_unit);
  if (!given)
    throw InputError(Field{"height_unit"},
                     fmt::format("must be {}, got {}", kUnits, in_quotes(*source.options.height_unit)));
  if (raw.nm_per_unit && *raw.nm_per_unit != *given)
    raw.warnings.push_back(
        {"unit_of_file_ignored",
         fmt::format("the given unit {} is used instead of the file's unit of heights", *source.options.height_unit)});
  return *given;
}

/// Converts a single column to a profile along x.
void lay_along_x(RawMap& raw) {
  if (raw.columns != 1 || raw.rows == 1) return;
  std::swap(raw.columns, raw.rows);
  std::swap(raw.x_pixel_um, raw.y_pixel_um);
}

HeightMapFile finish(const Source& source, RawMap raw) {
  lay_along_x(raw);
  if (raw.columns < kMinColumns)
    source.fail(0, fmt::format("a map must have at least {} points along x, got {}", kMinColumns, raw.columns));
  HeightMapFile file;
  const bool is_profile = raw.rows == 1;
  file.map.columns = raw.columns;
  file.map.rows = raw.rows;
  file.map.x_pixel_um = pixel_um(source, source.options.x_pixel_um, raw.x_pixel_um, "x", raw.warnings);
  file.map.y_pixel_um =
      is_profile ? file.map.x_pixel_um : pixel_um(source, source.options.y_pixel_um, raw.y_pixel_um, "y", raw.warnings);
  const double scale = nm_per_unit(source, raw);
  for (double& height : raw.heights) {
    height *= scale;
    if (std::isinf(height) || std::abs(height) > kMaxHeightNm)
      source.fail(0, fmt::format("heights must be within 1 km, got {} nm; check the unit of heights", height));
  }
  file.map.heights_nm = std::move(raw.heights);
  if (measured_points(file.map) < kMinColumns)
    source.fail(0, fmt::format("at least {} points must have a measured height, got {} of {}", kMinColumns,
                               measured_points(file.map), file.map.heights_nm.size()));
  file.format = raw.format;
  file.warnings = std::move(raw.warnings);
  return file;
}

}  // namespace

HeightMapFile read_height_map(const std::filesystem::path& file, const HeightMapOptions& options) {
  return parse_height_map(read_file(file, kMaxDataBytes), file.string(), options);
}

HeightMapFile parse_height_map(std::string_view content, const std::string& name, const HeightMapOptions& options) {
  if (options.lateral_unit && !nm_per(*options.lateral_unit))
    throw InputError(Field{"lateral_unit"},
                     fmt::format("must be {}, got {}", kUnits, in_quotes(*options.lateral_unit)));
  const Source source{without_byte_order_mark(content), name, options};
  return finish(source, parse_known(source));
}

}  // namespace retrace::surface_models
