// Reads files in the format Gwyddion Simple Field 1.0 (http://gwyddion.net/documentation/user-guide-en/gsf.html). A
// file begins with header lines "key = value". One to four zero bytes fill up the header to a multiple of four bytes.
// The heights follow as 32-bit floats, row by row. Lengths are in units without prefix.

#include <cmath>
#include <map>

#include "surface_models/io/byte_reader.h"
#include "surface_models/io/raw_map.h"

namespace retrace::surface_models {
namespace {

constexpr std::string_view kMagic = "Gwyddion Simple Field 1.0";
struct Value {
  std::string_view text;
  int line = 0;
};

class GsfReader {
 public:
  explicit GsfReader(const Source& source) : source_(source) {}

  RawMap read() {
    const std::size_t header = source_.content.find('\0');
    if (header == std::string_view::npos)
      source_.fail(0, "the file is cut short: its header is not terminated by a zero byte");
    read_header(source_.content.substr(0, header));
    RawMap raw;
    raw.format = "Gwyddion Simple Field (GSF)";
    const double columns = number("XRes").value_or(0.0);
    const double rows = number("YRes").value_or(0.0);
    check_size(source_, keys_.contains("XRes") ? keys_.at("XRes").line : 0, columns, rows);
    raw.columns = static_cast<std::size_t>(columns);
    raw.rows = static_cast<std::size_t>(rows);
    raw.x_pixel_um = pixel_um("XReal", columns);
    raw.y_pixel_um = pixel_um("YReal", rows);
    if (keys_.contains("ZUnits")) raw.nm_per_unit = unit("ZUnits");
    read_heights(raw, header + 4 - header % 4);
    return raw;
  }

 private:
  void read_header(std::string_view text) {
    Lines lines(text);
    if (trimmed(*lines.next()) != kMagic) source_.fail(1, "must be \"Gwyddion Simple Field 1.0\"");
    while (const auto line = lines.next()) {
      if (trimmed(*line).empty()) continue;
      const std::size_t equals = line->find('=');
      if (equals == std::string_view::npos)
        source_.fail(lines.number(), "must be \"key = value\", got " + in_quotes(*line));
      keys_[std::string(trimmed(line->substr(0, equals)))] = {trimmed(line->substr(equals + 1)), lines.number()};
    }
  }

  std::optional<double> number(const std::string& key) const {
    const auto found = keys_.find(key);
    if (found == keys_.end()) return std::nullopt;
    const std::optional<double> value = number_in(found->second.text);
    if (!value || !(*value > 0.0))
      source_.fail(found->second.line,
                   fmt::format("{}: must be a number > 0, got {}", key, in_quotes(found->second.text)));
    return value;
  }

  double unit(const std::string& key) const {
    const Value& value = keys_.at(key);
    const std::optional<double> nm = nm_per(value.text);
    if (!nm) source_.fail(value.line, fmt::format("{}: must be {}, got {}", key, kUnits, in_quotes(value.text)));
    return *nm;
  }

  /// Returns the distance between neighbouring points if the file contains a size and a unit.
  std::optional<double> pixel_um(const std::string& key, double points) const {
    const std::optional<double> size = number(key);
    if (!size || !keys_.contains("XYUnits")) return std::nullopt;
    return *size * unit("XYUnits") / kNmPerUm / points;
  }

  void read_heights(RawMap& raw, std::size_t start) const {
    const std::size_t wanted = raw.columns * raw.rows;
    if (source_.content.size() < start || (source_.content.size() - start) / 4 < wanted)
      source_.fail(
          0,
          fmt::format(
              "the file is cut short: {} x {} heights require {} bytes from byte {} on, but the file ends at byte {}",
              raw.columns, raw.rows, 4 * wanted, start, source_.content.size()));
    if (source_.content.size() - start != 4 * wanted)
      source_.fail(0, fmt::format("the file has {} bytes after the last of {} x {} heights",
                                  source_.content.size() - start - 4 * wanted, raw.columns, raw.rows));
    ByteReader bytes(source_, source_.content.substr(start), start);
    raw.heights.reserve(wanted);
    for (std::size_t i = 0; i < wanted; ++i) {
      const double z = bytes.f32();
      raw.heights.push_back(std::isfinite(z) ? z : kMissing);
    }
  }

  const Source& source_;
  std::map<std::string, Value> keys_;
};

}  // namespace

RawMap parse_gsf(const Source& source) {
  return GsfReader(source).read();
}

}  // namespace retrace::surface_models
