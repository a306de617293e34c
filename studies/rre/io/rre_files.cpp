#include "studies/rre/io/rre_files.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/version.h"
#include "studies/design/design_json.h"
#include "studies/rre/io/derivative_files.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;
using raytrace::kAccountCount;
using raytrace::kAccountNames;

Json ledger_json(const raytrace::Ledger& ledger) {
  Json json = Json::object();
  for (std::size_t k = 0; k < kAccountCount; ++k) json[std::string(kAccountNames[k])] = ledger.power[k];
  return json;
}

Json by_wavelength_json(const std::vector<SpectralRre>& points) {
  Json json = Json::array();
  for (const SpectralRre& p : points)
    json.push_back({{"wavelength_nm", p.wavelength_nm},
                    {"weight", p.weight},
                    {"rre", p.rre},
                    {"std_error", p.std_error},
                    {"engine", p.engine}});
  return json;
}

/// The design as it was read, and the wavelengths that stood for its spectrum.
Json design_json(const RreResult& result, std::size_t d) {
  Json json = to_json(result.designs[d]);
  if (result.designs[d].light.spectrum()) json["spectrum"] = spectrum_json(result.light[d]);
  return json;
}

/// Empty where the JSON leaves the key out.
std::string csv_number(double value) {
  return std::isfinite(value) ? shortest(value) : std::string();
}

bool has_several_cones(const RreResult& result) {
  for (const Design& design : result.designs)
    if (design.detector.acceptance_half_angle_deg.size() > 1) return true;
  return false;
}

}  // namespace

std::string rre_json(const RreResult& result) {
  Json json = {{"schema", "retrace.rre/1"}, {"engine", result.engine}, {"engine_requested", result.engine_requested}};
  json["designs"] = Json::array();
  for (std::size_t d = 0; d < result.designs.size(); ++d) json["designs"].push_back(design_json(result, d));
  json["seed"] = result.seed;
  json["points"] = Json::array();
  for (const RrePoint& p : result.points) {
    json["points"].push_back({{"design", p.design},
                              {"incidence_deg", p.incidence_deg},
                              {"azimuth_deg", p.azimuth_deg},
                              {"wavelength_nm", p.wavelength_nm},
                              {"acceptance_half_angle_deg", p.acceptance_half_angle_deg},
                              {"rre", p.rre},
                              {"std_error", p.std_error},
                              {"stokes", p.stokes.values()},
                              {"ledger", ledger_json(p.ledger)},
                              {"engine", p.engine}});
    if (!p.by_wavelength.empty()) json["points"].back()["by_wavelength"] = by_wavelength_json(p.by_wavelength);
    if (p.engine != "exact") continue;
    json["points"].back()["beams"] = p.beams;
    json["points"].back()["depth"] = p.depth;
    if (!p.derivatives.empty()) json["points"].back()["derivatives"] = derivatives_json(p.derivatives);
  }
  json["elapsed_s"] = result.elapsed_s;
  json["rays"] = result.rays;
  json["version"] = kVersion;
  json["warnings"] = result.warnings;
  json["complete"] = result.complete;
  return to_text(json);
}

std::string rre_csv(const RreResult& result) {
  std::string csv = "design,incidence_deg,azimuth_deg,wavelength_nm,acceptance_half_angle_deg,rre,std_error";
  for (const auto name : kAccountNames) csv += fmt::format(",{}", name);
  csv += ",engine\n";
  for (const RrePoint& p : result.points) {
    csv += std::to_string(p.design);
    for (const double value :
         {p.incidence_deg, p.azimuth_deg, p.wavelength_nm, p.acceptance_half_angle_deg, p.rre, p.std_error})
      csv += ',' + csv_number(value);
    for (const double power : p.ledger.power) csv += ',' + csv_number(power);
    csv += ',' + p.engine + '\n';
  }
  return csv;
}

std::string rre_table(const RreResult& result) {
  const bool several_designs = result.designs.size() > 1;
  const bool several_cones = has_several_cones(result);
  std::string table;
  if (several_designs)
    for (std::size_t d = 0; d < result.designs.size(); ++d)
      table += fmt::format("design {}: {}\n", d, printable(short_name(result.designs[d])));
  if (several_designs) table += "design  ";
  table += "incidence_deg  azimuth_deg  ";
  if (several_cones) table += "acceptance_deg  ";
  table += "    RRE_%    +-_%   cut_%  engine\n";
  for (const RrePoint& p : result.points) {
    if (several_designs) table += fmt::format("{:>6}  ", p.design);
    table += fmt::format("{:>13}  {:>11}  ", shortest(p.incidence_deg), shortest(p.azimuth_deg));
    if (several_cones) table += fmt::format("{:>14}  ", shortest(p.acceptance_half_angle_deg));
    table += fmt::format("{:>9}  {}  {}  {}\n", fixed(100.0 * p.rre, 4), fixed(100.0 * p.std_error, 4),
                         fixed(100.0 * p.ledger[raytrace::Account::truncated], 4), p.engine);
  }
  return table;
}

}  // namespace retrace::studies
