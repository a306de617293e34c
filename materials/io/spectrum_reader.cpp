#include "materials/io/spectrum_reader.h"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "core/atomic_file.h"
#include "core/csv.h"
#include "core/data_directory.h"
#include "core/number_format.h"

namespace retrace::materials {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
constexpr NumberRange kWavelengthNm{.low = 1.0, .high = 1e5};
constexpr NumberRange kValue{.low = 0.0};

/// Reads a table of numbers. The wavelengths in its first column must be ascending.
std::vector<std::vector<double>> read_columns(std::string_view text, const std::string& name,
                                              std::span<const std::string_view> header) {
  CsvReader table(text, name, kMaxBytes, header);
  std::vector<std::vector<double>> columns(header.size());
  while (table.next()) {
    for (std::size_t k = 0; k < header.size(); ++k)
      columns[k].push_back(table.number(k, k == 0 ? kWavelengthNm : kValue));
    const std::size_t count = columns[0].size();
    if (count > 1 && !(columns[0][count - 1] > columns[0][count - 2]))
      table.fail(0, fmt::format("the values must be in ascending order, got {} after {}",
                                shortest(columns[0][count - 1]), shortest(columns[0][count - 2])));
  }
  if (table.rows() < 2) table.fail(fmt::format("must contain at least two wavelengths, got {}", table.rows()));
  return columns;
}

SpectralCurve parse_curve(std::string_view text, const std::string& name, std::string_view quantity) {
  auto columns = read_columns(text, name, std::array<std::string_view, 2>{"wavelength_nm", quantity});
  return {std::move(columns[0]), std::move(columns[1])};
}

}  // namespace

CieTable shipped_cie_table() {
  return read_cie_table(data_directory() / "cie_v_a_d65_5nm.csv");
}

CieTable read_cie_table(const fs::path& file) {
  const auto columns =
      read_columns(read_file(file), file.string(),
                   std::array<std::string_view, 4>{"wavelength_nm", "v_photopic", "illuminant_a", "illuminant_d65"});
  return {{columns[0], columns[1]}, {columns[0], columns[2]}, {columns[0], columns[3]}};
}

ColourMatching shipped_colour_matching() {
  return read_colour_matching(data_directory() / "cie_xyz_1931_5nm.csv");
}

ColourMatching read_colour_matching(const fs::path& file) {
  const auto columns = read_columns(read_file(file), file.string(),
                                    std::array<std::string_view, 4>{"wavelength_nm", "x_bar", "y_bar", "z_bar"});
  return {{{columns[0], columns[1]}, {columns[0], columns[2]}, {columns[0], columns[3]}}};
}

SpectralCurve read_spectral_power(const fs::path& file) {
  return parse_spectral_power(read_file(file, kMaxBytes), file.string());
}

SpectralCurve parse_spectral_power(std::string_view text, const std::string& name) {
  return parse_curve(text, name, "power");
}

SpectralCurve read_spectral_absorption(const fs::path& file) {
  return parse_spectral_absorption(read_file(file, kMaxBytes), file.string());
}

SpectralCurve parse_spectral_absorption(std::string_view text, const std::string& name) {
  return parse_curve(text, name, "absorption_per_mm");
}

}  // namespace retrace::materials
