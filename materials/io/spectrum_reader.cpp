#include "materials/io/spectrum_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "core/atomic_file.h"
#include "core/data_directory.h"
#include "core/error.h"

namespace retrace::materials {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 20;
constexpr double kLeastWavelengthNm = 1.0;
constexpr double kMostWavelengthNm = 1e5;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const std::size_t first = text.find_first_not_of(blank);
  return first == std::string_view::npos ? std::string_view{}
                                         : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// Text of a file as a message may show it: on one line, and short.
std::string shown(std::string_view text) {
  constexpr std::size_t most = 40;
  std::string result = "\"";
  for (const char c : text.substr(0, most)) result += c >= 0x20 && c < 0x7f ? c : '?';
  return result + (text.size() > most ? "...\"" : "\"");
}

std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Columns of numbers over ascending wavelengths, under a header that is known.
class ColumnReader {
 public:
  ColumnReader(const std::string& name, std::vector<std::string_view> header)
      : name_(name), header_(std::move(header)), columns_(header_.size()) {}

  /// \return one column of numbers for each word of the header
  std::vector<std::vector<double>> read(std::string_view text) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      ++line_;
      read_line(trimmed(text.substr(at, end - at)));
      at = end + 1;
    }
    line_ = 0;
    if (!has_header_) fail("", fmt::format("must begin with the header {}", fmt::join(header_, ",")));
    if (columns_[0].size() < 2) fail("", fmt::format("must hold at least two wavelengths, got {}", columns_[0].size()));
    return std::move(columns_);
  }

 private:
  [[noreturn]] void fail(std::string_view column, const std::string& text) const {
    throw InputError({name_, line_, std::string(column)}, text);
  }

  void read_line(std::string_view line) {
    if (line.empty() || line.front() == '#') return;
    const std::vector<std::string_view> words = split(line);
    if (!has_header_) {
      if (words != header_)
        fail("", fmt::format("must be the header {}, got {}", fmt::join(header_, ","), shown(line)));
      has_header_ = true;
      return;
    }
    if (words.size() != header_.size())
      fail("", fmt::format("must be {} numbers ({}), got {}", header_.size(), fmt::join(header_, ","), shown(line)));
    for (std::size_t k = 0; k < words.size(); ++k) columns_[k].push_back(value(k, words[k]));
  }

  static std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> words;
    for (;;) {
      const std::size_t comma = line.find(',');
      words.push_back(trimmed(line.substr(0, comma)));
      if (comma == std::string_view::npos) return words;
      line.remove_prefix(comma + 1);
    }
  }

  double value(std::size_t column, std::string_view word) const {
    const std::optional<double> given = number_in(word);
    if (!given || !std::isfinite(*given))
      fail(header_[column], fmt::format("must be a finite number, got {}", shown(word)));
    if (column > 0) {
      if (!(*given >= 0.0)) fail(header_[column], fmt::format("must be >= 0, got {}", *given));
      return *given;
    }
    if (!(*given >= kLeastWavelengthNm && *given <= kMostWavelengthNm))
      fail(header_[column],
           fmt::format("must be >= {} and <= {}, got {}", kLeastWavelengthNm, kMostWavelengthNm, *given));
    if (!columns_[0].empty() && !(*given > columns_[0].back()))
      fail(header_[column], fmt::format("must ascend, got {} after {}", *given, columns_[0].back()));
    return *given;
  }

  const std::string& name_;
  std::vector<std::string_view> header_;
  std::vector<std::vector<double>> columns_;
  bool has_header_ = false;
  int line_ = 0;
};

}  // namespace

CieTable shipped_cie_table() {
  return read_cie_table(data_directory() / "cie_v_a_d65_5nm.csv");
}

CieTable read_cie_table(const fs::path& file) {
  const std::string name = file.string();
  const auto columns =
      ColumnReader(name, {"wavelength_nm", "v_photopic", "illuminant_a", "illuminant_d65"}).read(read_file(file));
  return {{columns[0], columns[1]}, {columns[0], columns[2]}, {columns[0], columns[3]}};
}

namespace {

SpectralCurve parse_curve(std::string_view text, const std::string& name, std::string_view quantity) {
  require_short_text(text, name, kMostBytes);
  auto columns = ColumnReader(name, {"wavelength_nm", quantity}).read(text);
  return {std::move(columns[0]), std::move(columns[1])};
}

}  // namespace

SpectralCurve read_spectral_power(const fs::path& file) {
  return parse_spectral_power(read_file(file, kMostBytes), file.string());
}

SpectralCurve parse_spectral_power(std::string_view text, const std::string& name) {
  return parse_curve(text, name, "power");
}

SpectralCurve read_spectral_absorption(const fs::path& file) {
  return parse_spectral_absorption(read_file(file, kMostBytes), file.string());
}

SpectralCurve parse_spectral_absorption(std::string_view text, const std::string& name) {
  return parse_curve(text, name, "absorption_per_mm");
}

}  // namespace retrace::materials
