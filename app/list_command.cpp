#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/output.h"
#include "core/json_text.h"
#include "core/number_format.h"
#include "core/version.h"
#include "materials/io/material_library.h"

namespace retrace::app {
namespace {

// The sodium d line of tables, and the default wavelength of a design.
constexpr double kShownWavelengthNm = 587.56;

}  // namespace

ExitCode run_list_command(const CommandLine& line) {
  if (line.what != "materials")
    throw InputError(fmt::format("list: this version ships materials only, got {}", line.what));
  const auto library = materials::MaterialLibrary::shipped();
  std::string text = fmt::format("{:<16} {:<10} {:<12} {}\n", "name", "n 588 nm", "data (nm)", "description");
  nlohmann::ordered_json json = {{"schema", "retrace.materials/1"}, {"materials", nlohmann::ordered_json::array()}};
  for (const materials::Material& m : library.all()) {
    const double n = materials::refractive_index(m.dispersion, kShownWavelengthNm);
    const std::string range = shortest(m.valid_from_nm) + "-" + shortest(m.valid_to_nm);
    text += fmt::format("{:<16} {:<10} {:<12} {}\n", m.name, fixed(n, 5), range, m.description);
    json["materials"].push_back({{"name", m.name},
                                 {"description", m.description},
                                 {"refractive_index", n},
                                 {"wavelength_nm", kShownWavelengthNm},
                                 {"relative_to", m.relative_to_vacuum ? "vacuum" : "air"},
                                 {"valid_from_nm", m.valid_from_nm},
                                 {"valid_to_nm", m.valid_to_nm},
                                 {"absorption_per_mm", m.absorption_per_mm},
                                 {"source", m.source}});
  }
  json["metals"] = nlohmann::ordered_json::array();
  for (const materials::Metal& m : library.metals()) {
    const std::complex<double> n = materials::complex_index(m.model, kShownWavelengthNm);
    const std::string range = shortest(m.valid_from_nm) + "-" + shortest(m.valid_to_nm);
    text += fmt::format("{:<16} {:<10} {:<12} {}\n", m.name,
                        fmt::format("{}+{}i", fixed(n.real(), 2), fixed(n.imag(), 2)), range, m.description);
    json["metals"].push_back({{"name", m.name},
                              {"description", m.description},
                              {"refractive_index", n.real()},
                              {"extinction_coefficient", n.imag()},
                              {"wavelength_nm", kShownWavelengthNm},
                              {"relative_to", "vacuum"},
                              {"valid_from_nm", m.valid_from_nm},
                              {"valid_to_nm", m.valid_to_nm},
                              {"source", m.source}});
  }
  json["version"] = kVersion;
  json["warnings"] = nlohmann::ordered_json::array();
  json["complete"] = true;
  prepare_outputs(line.common, {{}, "materials.json", {}});
  write_outputs(line.common, to_text(json), {{"materials.json", to_text(json)}}, text);
  return ExitCode::done;
}

}  // namespace retrace::app
