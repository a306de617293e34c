#include "studies/appearance/io/appearance_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/text.h"
#include "design/io/design_json.h"
#include "geometry/direction.h"
#include "studies/appearance/io/glsl_file.h"
#include "studies/appearance/io/radiance_file.h"
#include "studies/appearance/lobes.h"
#include "studies/appearance/table_errors.h"
#include "studies/appearance/tensor_tree.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

Json range_json(const std::array<Angle, 2>& range) {
  return Json::array({range[0].deg(), range[1].deg()});
}

Json error_json(const AppearanceError& error) {
  return {{"geometries", error.geometries},
          {"median", error.median},
          {"of_95_percent", error.percentile_95},
          {"max", error.max},
          {"floor", kErrorFloor}};
}

/// Returns the request and the ranges that the table covers.
Json request_json(const AppearanceResult& result) {
  const MaterialRequest& request = result.request;
  return {{"illuminant", "D65"},
          {"source_arcmin", request.source_arcmin},
          {"receiver_arcmin", request.receiver_arcmin},
          {"max_entrance_deg", request.entrance_deg},
          {"window_deg", request.window_deg},
          {"error_requested", request.error}};
}

std::string table_text(const AppearanceResult& result, const std::string& values_name) {
  const ReflectionTable& table = result.table;
  Json json = {{"design", design::to_json(result.design)}, {"values", values_name}, {"unit", "cd/(lx m2)"}};
  json["bands"] = {"red", "green", "blue"};
  json.update(request_json(result));
  json["error"] = error_json(result.error);
  json["half_width"] = table.half_width;
  json["columns"] = table.columns;
  json["back"] = {table.back.x(), table.back.y()};
  json["mirror_x"] = table.mirrors[0];
  json["mirror_y"] = table.mirrors[1];
  Json directions = Json::array();
  for (const ReflectionTable::Direction& at : table.directions)
    directions.push_back({{"entrance_deg", at.entrance.deg()},
                          {"azimuth_deg", at.azimuth.deg()},
                          {"returned", table.returned(geometry::direction_at(at.entrance, at.azimuth))}});
  json["directions"] = directions;
  Json cells = Json::array();
  for (const ReflectionTable::Cell& cell : table.cells)
    cells.push_back({{"entrance_deg", range_json(cell.entrance)},
                     {"azimuth_deg", range_json(cell.azimuth)},
                     {"directions", cell.directions}});
  json["cells"] = cells;
  return result_text("retrace.material/2", std::move(json), result.warnings);
}

/// Returns the values of all grids as CSV, direction by direction and row by row.
std::string values_text(const ReflectionTable& table) {
  std::string text = "direction,row,column,red,green,blue\n";
  for (std::size_t k = 0; k < table.directions.size(); ++k)
    for (std::size_t point = 0; point < table.columns * table.columns; ++point) {
      const Rgb& rgb = table.directions[k].r_a[point];
      fmt::format_to(std::back_inserter(text), "{},{},{},{:.7g},{:.7g},{:.7g}\n", k, point / table.columns,
                     point % table.columns, rgb[0], rgb[1], rgb[2]);
    }
  return text;
}

std::string percent(double share) {
  return fixed(100.0 * share, share < 0.1 ? 2 : 0) + " %";
}

std::string error_text(const AppearanceError& error) {
  return fmt::format("median {}, 95th percentile {}, maximum {}", percent(error.median), percent(error.percentile_95),
                     percent(error.max));
}

/// Returns a description of the central direction of view, for the header of a file.
std::string_view where_of(const ReflectionTable& table) {
  if (table.back == geometry::Vec2::Ones()) return "back to the source";
  return table.back.y() < 0.0 ? "that is reversed along x and unchanged along y"
                              : "that is reversed along y and unchanged along x";
}

AppearanceText radiance(const AppearanceResult& result) {
  const TensorTree tree = tensor_tree_of(result.table);
  const double leaf_deg = Angle::from_rad(tree.leaf_width()).deg();
  AppearanceText text;
  text.approximation =
      fmt::format("{} leaves of a tensor tree, each a mean over {} degrees of the directions of light and view",
                  tree.leaves.size(), fixed_visible(leaf_deg, 2));
  text.text = radiance_text(tree, printable(design::short_name(result.design), 60));
  return text;
}

AppearanceText glsl(const AppearanceResult& result) {
  const ReflectionLobes lobes = fitted_lobes(result.table);
  std::vector<double> told;
  for (const AppearanceProbe& probe : result.probes)
    told.push_back(luminous(lobes.r_a(probe.to_source, probe.to_observer)));
  AppearanceText text;
  text.error = appearance_error(result.probes, told);
  text.approximation =
      fmt::format("{} lobes; deviation from the photometer: {}", lobes.lobes.size(), error_text(*text.error));
  text.text = glsl_text(lobes, {printable(design::short_name(result.design), 60), text.approximation});
  return text;
}

}  // namespace

std::optional<AppearanceFormat> appearance_format(const std::string& file) {
  const std::string ending = ending_of(file);
  if (ending == ".json") return AppearanceFormat::table;
  if (ending == ".xml") return AppearanceFormat::radiance;
  if (ending == ".glsl") return AppearanceFormat::glsl;
  return std::nullopt;
}

AppearanceText appearance_text(const AppearanceResult& result, AppearanceFormat format,
                               const std::string& values_name) {
  if (format == AppearanceFormat::radiance) return radiance(result);
  if (format == AppearanceFormat::glsl) return glsl(result);
  return {table_text(result, values_name), values_text(result.table), {}, {}};
}

std::string appearance_json(const AppearanceResult& result, const AppearanceText& text, const std::string& file) {
  Json json = {{"what", "material"}, {"file", file}};
  json.update(request_json(result));
  json["directions"] = result.table.directions.size();
  json["cells"] = result.table.cells.size();
  json["columns"] = result.table.columns;
  json["returned"] = result.table.returned(geometry::Vec3::UnitZ());
  json["error"] = error_json(result.error);
  if (text.error) json["error_of_lobes"] = error_json(*text.error);
  json["elapsed_s"] = result.elapsed_s;
  json["design"] = design::to_json(result.design);
  return result_text("retrace.export/2", json, result.warnings);
}

std::string appearance_table(const AppearanceResult& result, const AppearanceText& text) {
  const MaterialRequest& request = result.request;
  std::string lines = fmt::format(
      "material of {}: R_A around the direction {}, CIE D65, source disc {} arcmin, receiver disc {} arcmin\n",
      printable(design::short_name(result.design), 60), where_of(result.table), shortest(request.source_arcmin),
      shortest(request.receiver_arcmin));
  lines += fmt::format(
      "  light      entrance angles up to {} degrees: {} directions in {} cells, the smallest {} degrees wide\n",
      shortest(request.entrance_deg), result.table.directions.size(), result.table.cells.size(),
      shortest(result.min_cell_deg));
  lines += fmt::format("  views      deviations up to {} degrees: {} x {} points\n", shortest(request.window_deg),
                       result.table.columns, result.table.columns);
  lines += fmt::format("  returned   {} of the light at normal incidence\n",
                       percent(result.table.returned(geometry::Vec3::UnitZ())));
  lines += fmt::format(
      "  error      {}, relative to the larger of the value and {} of the brightest view; {} random geometries\n",
      error_text(result.error), percent(kErrorFloor), result.error.geometries);
  if (!text.approximation.empty()) lines += "  file       " + text.approximation + '\n';
  return lines;
}

}  // namespace retrace::studies
