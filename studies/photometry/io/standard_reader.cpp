#include "studies/photometry/io/standard_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tuple>
#include <utility>

#include "core/data_directory.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/named_file.h"
#include "materials/io/spectrum_reader.h"
#include "requests/descriptions.h"
#include "studies/photometry/coefficient_map.h"
#include "studies/photometry/io/limits_reader.h"
#include "studies/photometry/standards.h"

namespace retrace::studies {
namespace fs = std::filesystem;

namespace {

std::vector<std::string_view> names_of_standards() {
  std::vector<std::string_view> names;
  for (const ShippedStandard& standard : shipped_standards()) names.push_back(standard.name);
  return names;
}

/// Returns default settings in which the limits, apertures and rotations are those of the requested standard.
PhotometrySettings settings_of_standard(const PhotometryRequest& request) {
  const fs::path file = limits_file_of(request.standard);
  const ShippedStandard* const shipped = find_standard(request.standard);
  const auto in_table = shipped != nullptr ? std::optional(std::string(shipped->table_name)) : std::nullopt;
  PhotometrySettings settings;
  const auto limits = read_named(Field{"standard"}, [&] { return read_limits(file); });
  settings.test_plan = test_plan_of(limits, in_table, request.part_class, request.colour);
  settings.limits_source = shipped != nullptr ? request.standard : file.string();
  settings.apertures = shipped != nullptr ? shipped->apertures : default_apertures();
  if (shipped != nullptr) settings.rotation_deg = shipped->rotation_deg;
  return settings;
}

/// Returns the name and the absorption of the dye of a design. Both are empty if no dye is used.
/// \param colour colour of the part in the test plan
std::pair<std::string, materials::SpectralCurve> dye_of(const PhotometryRequest& request, bool design_is_coloured,
                                                        const std::string& colour) {
  const fs::path file = dye_file_of(request.dye, design_is_coloured, colour);
  if (file.empty()) return {};
  return {request.dye.value_or(colour),
          read_named(Field{"dye"}, [&] { return materials::read_spectral_absorption(file); })};
}

}  // namespace

fs::path limits_file_of(const std::string& standard) {
  if (find_standard(standard) != nullptr) return data_directory() / "photometry_limits.csv";
  std::error_code ignored;
  if (!fs::exists(standard, ignored))
    throw InputError(Field{"standard"}, fmt::format("must be {} or the name of an existing file, got {}",
                                                    fmt::join(names_of_standards(), ", "), in_quotes(standard)));
  return standard;
}

fs::path dye_file_of(const std::optional<std::string>& dye, bool design_is_coloured, const std::string& colour) {
  const std::string name = dye ? *dye : (design_is_coloured ? "none" : colour);
  if (name == "red" || name == "amber") return data_directory() / ("dye_" + name + ".csv");
  if (name == "none" || !dye) return {};
  std::error_code ignored;
  if (!fs::exists(name, ignored))
    throw InputError(Field{"dye"},
                     fmt::format("must be none, red, amber or the name of an existing file, got {}", in_quotes(name)));
  return name;
}

PhotometrySettings resolve(const PhotometryRequest& request, bool design_is_coloured) {
  requests::check(request);
  PhotometrySettings settings = settings_of_standard(request);
  std::tie(settings.dye, settings.dye_absorption_per_mm) =
      dye_of(request, design_is_coloured, settings.test_plan.colour);
  settings.area_cm2 = request.area_cm2;
  if (request.rotation_deg) settings.rotation_deg = *request.rotation_deg;
  if (request.source_arcmin) settings.apertures.source = Angle::from_deg(*request.source_arcmin / 60.0);
  if (request.receiver_arcmin) settings.apertures.receiver = Angle::from_deg(*request.receiver_arcmin / 60.0);
  settings.window_deg = request.window_deg;
  settings.window_power = request.window_power;
  settings.pictures = request.pictures;
  settings.light = light_from_name(request.light);
  settings.diffraction = request.diffraction;
  settings.engine = raytrace::engine_from_name(request.engine);
  settings.cutoff = request.cutoff;
  settings.rays = request.samples;
  settings.seed = request.seed;
  settings.advice = request.advice;
  if (request.map)
    settings.map_grid = resolve_grid(
        {request.map_entrance_deg, request.map_observation_deg, request.map_presentation_deg}, settings.window_deg);
  settings.colour = true;
  return settings;
}

ComparedDesign compared_design(const PhotometryRequest& request, design::Design design, const std::string& colour) {
  auto [dye, absorption_per_mm] = dye_of(request, design.substance.is_coloured(), colour);
  return {std::move(design), std::move(dye), std::move(absorption_per_mm)};
}

}  // namespace retrace::studies
