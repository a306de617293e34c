#include "surface_models/io/raw_map.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace retrace::surface_models {

void Source::fail(int line, std::string_view text) const {
  throw InputError({name, line, ""}, text);
}

std::optional<double> nm_per(std::string_view unit) {
  if (unit == "m") return 1e9;
  if (unit == "mm") return 1e6;
  // Instruments write the micro sign or the Greek letter in UTF-8, or the micro sign in Latin-1.
  if (unit == "um" || unit == "\xc2\xb5m" || unit == "\xce\xbcm" || unit == "\xb5m") return 1e3;
  if (unit == "nm") return 1.0;
  if (unit == "pm") return 1e-3;
  return std::nullopt;
}

void check_size(const Source& source, int line, double columns, double rows) {
  const bool is_whole = columns == std::floor(columns) && rows == std::floor(rows);
  if (!is_whole || columns < 1.0 || rows < 1.0 || columns * rows > static_cast<double>(kMaxPoints))
    source.fail(
        line, fmt::format("a map must have whole numbers of columns and rows, and 1 to {} points in total, got {} x {}",
                          kMaxPoints, columns, rows));
}

std::optional<std::string_view> Lines::next() {
  if (ended_) return std::nullopt;
  const std::size_t end = remainder_.find('\n');
  std::string_view line = remainder_.substr(0, end);
  ended_ = end == std::string_view::npos;
  remainder_ = ended_ ? std::string_view{} : remainder_.substr(end + 1);
  ++number_;
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

}  // namespace retrace::surface_models
