#include "studies/metrology/io/metrology_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/csv.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"

namespace retrace::studies {
namespace {

using namespace surface_models;
using Json = nlohmann::ordered_json;

const char* name_of(Axis axis) {
  return axis == Axis::x ? "x" : "y";
}

const char* name_of(EdgeShape shape) {
  return shape == EdgeShape::radius ? "radius" : "chamfer";
}

void put(Json& json, const std::string& prefix, const HeightParameters& p) {
  json[prefix + "sa_nm"] = p.sa_nm;
  json[prefix + "sq_nm"] = p.sq_nm;
  json[prefix + "sz_nm"] = p.sz_nm;
  json[prefix + "ssk"] = p.ssk;
  json[prefix + "sku"] = p.sku;
}

Json peaks_json(const MetrologyResult& result) {
  Json peaks = Json::array();
  for (const SpectralPeak& peak : result.peaks) {
    Json json = {{"axis", name_of(peak.axis)},
                 {"frequency_per_mm", peak.frequency_per_mm},
                 {"wavelength_um", 1e3 / peak.frequency_per_mm},
                 {"sq_nm", peak.sq_nm}};
    if (result.request.feed_mm_per_min)
      json["frequency_hz"] = frequency_hz(peak.frequency_per_mm, *result.request.feed_mm_per_min);
    peaks.push_back(std::move(json));
  }
  return peaks;
}

Json scratches_json(const MetrologyResult& result) {
  Json scratches = Json::array();
  for (const Scratch& s : result.scratches)
    scratches.push_back({{"along", name_of(s.along)},
                         {"position_um", s.position_um},
                         {"depth_nm", s.depth_nm},
                         {"width_um", s.width_um}});
  return scratches;
}

Json edge_json(const EdgeResult& edge) {
  return {{"radius_um", edge.radius_um.mean},
          {"radius_deviation_um", edge.radius_um.standard_deviation},
          {"radius_residual_nm", edge.radius_residual_nm},
          {"chamfer_um", edge.chamfer_um.mean},
          {"chamfer_deviation_um", edge.chamfer_um.standard_deviation},
          {"chamfer_residual_nm", edge.chamfer_residual_nm},
          {"better", name_of(edge.better)},
          {"dihedral_deg", edge.dihedral_deg.mean},
          {"profiles", edge.radius_um.count}};
}

/// Returns the keys of the table [surface] of a design and their values, in the order of the design format.
std::vector<std::pair<std::string, double>> surface_keys(const MetrologyResult& result) {
  std::vector<std::pair<std::string, double>> keys;
  if (result.edge) {
    const bool is_round = result.edge->better == EdgeShape::radius;
    keys.emplace_back(is_round ? "root_radius_um" : "root_chamfer_um",
                      is_round ? result.edge->radius_um.mean : result.edge->chamfer_um.mean);
    return keys;
  }
  const TextureModel& t = result.texture;
  keys.emplace_back("roughness_sq_nm", t.roughness_sq_nm);
  if (t.correlation_length_um) keys.emplace_back("correlation_length_um", *t.correlation_length_um);
  if (t.waviness_length_um) {
    keys.emplace_back("waviness_sq_nm", t.waviness_sq_nm);
    keys.emplace_back("waviness_length_um", *t.waviness_length_um);
  }
  return keys;
}

/// Rounds a value to five significant digits. No surface is measured more accurately.
double rounded(double value) {
  return std::stod(fmt::format("{:.5g}", value));
}

/// Returns the name of a file without its folder, as printable text for a comment.
std::string printable_name(const std::string& file) {
  return printable(std::filesystem::path(file).filename().string(), std::string::npos);
}

std::string row_of(const char* name, const HeightParameters& p) {
  return fmt::format("  {:<10} {:>10} {:>10} {:>10} {:>8} {:>8}\n", name, fixed(p.sa_nm, 3), fixed(p.sq_nm, 3),
                     fixed(p.sz_nm, 3), fixed(p.ssk, 3), fixed(p.sku, 3));
}

std::string peaks_text(const MetrologyResult& result) {
  if (result.peaks.empty()) return "  dominant waves      none\n";
  std::string text;
  for (const SpectralPeak& peak : result.peaks) {
    text += fmt::format("  dominant along {}    {} per mm, Sq {} nm", name_of(peak.axis),
                        fixed(peak.frequency_per_mm, 3), fixed(peak.sq_nm, 3));
    if (result.request.feed_mm_per_min)
      text += fmt::format(", {} Hz", fixed(frequency_hz(peak.frequency_per_mm, *result.request.feed_mm_per_min), 3));
    text += '\n';
  }
  return text;
}

std::string scratches_text(const MetrologyResult& result) {
  std::string text = fmt::format("  scratches           {}\n", result.scratches.size());
  for (const Scratch& s : result.scratches)
    text += fmt::format("    along {} at {} um: {} nm {}, {} um wide\n", name_of(s.along), fixed(s.position_um, 2),
                        fixed(std::abs(s.depth_nm), 2), s.depth_nm > 0.0 ? "deep" : "high", fixed(s.width_um, 2));
  return text;
}

std::string edge_text(const EdgeResult& edge) {
  return fmt::format(
      "  edge radius         {} um +- {} um, residual {} nm\n  chamfer             {} um +- {} um, residual {} nm\n"
      "  fits better         {}\n  facets              {} degrees, {} profiles\n",
      fixed(edge.radius_um.mean, 3), fixed(edge.radius_um.standard_deviation, 3), fixed(edge.radius_residual_nm, 1),
      fixed(edge.chamfer_um.mean, 3), fixed(edge.chamfer_um.standard_deviation, 3), fixed(edge.chamfer_residual_nm, 1),
      name_of(edge.better), fixed(edge.dihedral_deg.mean, 3), edge.radius_um.count);
}

void add_rows(CsvWriter& csv, const char* direction, const Spectrum& spectrum, const char* unit) {
  for (std::size_t k = 0; k < spectrum.density.size(); ++k)
    csv.row(direction, spectrum.frequency_per_mm[k], spectrum.density[k], unit);
}

}  // namespace

std::string metrology_json(const MetrologyResult& result) {
  const HeightMap& map = result.surface;
  Json json = {{"source", result.file},
               {"format", result.format},
               {"columns", map.columns},
               {"rows", map.rows},
               {"x_pixel_um", map.x_pixel_um}};
  if (!map.is_profile()) json["y_pixel_um"] = map.y_pixel_um;
  json["missing"] = result.missing;
  json["form"] = result.edge ? "edge" : result.request.form;
  json["cutoff_um"] = result.request.cutoff_um;
  put(json, "", result.of_surface);
  put(json, "roughness_", result.of_roughness);
  put(json, "waviness_", result.of_waviness);
  if (result.x_correlation_length_um) json["x_correlation_length_um"] = *result.x_correlation_length_um;
  if (result.y_correlation_length_um) json["y_correlation_length_um"] = *result.y_correlation_length_um;
  json["dominant_per_mm"] = Json::array();
  for (const SpectralPeak& peak : result.peaks) json["dominant_per_mm"].push_back(peak.frequency_per_mm);
  if (result.request.feed_mm_per_min) json["feed_mm_per_min"] = *result.request.feed_mm_per_min;
  json["dominant"] = peaks_json(result);
  json["scratches"] = scratches_json(result);
  if (result.edge) json["edge"] = edge_json(*result.edge);
  json["surface"] = Json::object();
  for (const auto& [key, value] : surface_keys(result)) json["surface"][key] = value;
  return result_text("retrace.metrology/1", json, result.warnings);
}

std::string surface_toml(const MetrologyResult& result) {
  std::string text = fmt::format("[surface]  # measured: {}, cut-off {} um\n", printable_name(result.file),
                                 shortest(result.request.cutoff_um));
  for (const auto& [key, value] : surface_keys(result)) text += fmt::format("{} = {}\n", key, shortest(rounded(value)));
  return text;
}

std::string metrology_text(const MetrologyResult& result) {
  const HeightMap& map = result.surface;
  std::string text = fmt::format("{}: {}\n", printable_name(result.file), result.format);
  text += map.is_profile() ? fmt::format("  points              {}, {} um apart, {} missing\n", map.columns,
                                         fixed(map.x_pixel_um, 4), result.missing)
                           : fmt::format("  points              {} x {}, {} x {} um apart, {} missing\n", map.columns,
                                         map.rows, fixed(map.x_pixel_um, 4), fixed(map.y_pixel_um, 4), result.missing);
  text += fmt::format("  form removed        {}\n", result.edge ? "edge" : result.request.form);
  text += fmt::format("  cut-off             {} um\n", shortest(result.request.cutoff_um));
  text += fmt::format("  {:<10} {:>10} {:>10} {:>10} {:>8} {:>8}\n", "", "Sa_nm", "Sq_nm", "Sz_nm", "Ssk", "Sku");
  text += row_of("surface", result.of_surface) + row_of("roughness", result.of_roughness) +
          row_of("waviness", result.of_waviness);
  text += peaks_text(result) + scratches_text(result);
  if (result.edge) text += edge_text(*result.edge);
  return text + "\n" + surface_toml(result);
}

std::string spectra_csv(const MetrologyResult& result) {
  CsvWriter csv("direction,frequency_per_mm,psd,unit");
  add_rows(csv, "x", result.along_x, "nm^2 mm");
  add_rows(csv, "y", result.along_y, "nm^2 mm");
  add_rows(csv, "radial", result.radial, "nm^2 mm^2");
  return csv.text();
}

}  // namespace retrace::studies
