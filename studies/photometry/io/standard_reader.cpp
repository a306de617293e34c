#include "studies/photometry/io/standard_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/data_directory.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/named_file.h"
#include "materials/io/spectrum_reader.h"
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

}  // namespace

fs::path limits_file_of(const std::string& standard) {
  if (find_standard(standard) != nullptr) return data_directory() / "photometry_limits.csv";
  std::error_code ignored;
  if (!fs::exists(standard, ignored))
    throw InputError({"", 0, "--standard"}, fmt::format("must be {} or a file that exists, got {}",
                                                        fmt::join(names_of_standards(), ", "), in_quotes(standard)));
  return standard;
}

PhotometryRequest photometry_request(const StandardChoice& choice) {
  const fs::path file = limits_file_of(choice.standard);
  const ShippedStandard* const shipped = find_standard(choice.standard);
  const auto in_table = shipped != nullptr ? std::optional(std::string(shipped->in_table)) : std::nullopt;
  PhotometryRequest request;
  const auto limits = read_named({"", 0, "--standard"}, [&] { return read_limits(file); });
  request.programme = programme_of(limits, in_table, choice.part_class, choice.colour);
  request.limits_source = shipped != nullptr ? choice.standard : file.string();
  request.apertures = shipped != nullptr ? shipped->apertures : default_apertures();
  if (shipped != nullptr) request.rotation_deg = shipped->rotation_deg;
  return request;
}

fs::path dye_file_of(const std::optional<std::string>& dye, bool design_is_coloured, const std::string& colour) {
  const std::string name = dye ? *dye : (design_is_coloured ? "none" : colour);
  if (name == "red" || name == "amber") return data_directory() / ("dye_" + name + ".csv");
  if (name == "none" || !dye) return {};
  std::error_code ignored;
  if (!fs::exists(name, ignored))
    throw InputError({"", 0, "--dye"},
                     fmt::format("must be none, red, amber or a file that exists, got {}", in_quotes(name)));
  return name;
}

void set_dye(PhotometryRequest& request, const std::optional<std::string>& dye, const fs::path& file) {
  if (file.empty()) return;
  request.dye = dye.value_or(request.programme.colour);
  request.dye_absorption_per_mm =
      read_named({"", 0, "--dye"}, [&] { return materials::read_spectral_absorption(file); });
}

}  // namespace retrace::studies
