// Reads heights from text files: a matrix with one row per line, or a list of points. Header lines "key = value", "key:
// value" or "key value" may precede the heights, with or without # in front. Headers of two other programs are
// accepted: those of Gwyddion's text export ("# Width: 1.0 mm") and those of ESRI ASCII grids (ncols, nrows, cellsize,
// xllcorner, NODATA_value), whose first row has the largest y. docs/commands/metrology.md lists all
// keys.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/field.h"
#include "surface_models/io/raw_map.h"

namespace retrace::surface_models {
namespace {

/// Meaning of the columns of the text.
enum class Columns { matrix, xyz, xz };

/// Values of the header.
struct Header {
  std::optional<double> x_pixel_um, y_pixel_um;
  std::optional<double> cell_size;            ///< distance between neighbours, in the lateral unit
  std::optional<double> width_um, height_um;  ///< size of the whole map
  std::optional<double> height_unit_nm, lateral_unit_nm;
  std::optional<double> columns, rows, no_data;
  Columns layout = Columns::matrix;
  bool is_esri = false;  ///< true if a key of ESRI ASCII grids is given; their first row has the largest y
};

bool is_missing_word(std::string_view word) {
  static constexpr std::array<std::string_view, 7> words = {"nan", "-nan", "bad", "***", "-", "--", "null"};
  return word.empty() || std::find(words.begin(), words.end(), lower_case(word)) != words.end();
}

/// Returns the separator of a line: a semicolon if there is one, otherwise a comma, otherwise blanks.
char separator_of(std::string_view line) {
  return line.find(';') != std::string_view::npos ? ';' : line.find(',') != std::string_view::npos ? ',' : ' ';
}

/// Calls `use` for each value of a line. Between two consecutive separators there is an empty value.
template <class Use>
void for_each_value(std::string_view line, Use use) {
  const char separator = separator_of(line);
  line = trimmed(line);
  if (separator == ' ') {
    while (!line.empty()) {
      const std::string_view word = line.substr(0, line.find_first_of(" \t"));
      use(word);
      line = trimmed(line.substr(word.size()));
    }
    return;
  }
  for (;;) {
    const std::size_t end = line.find(separator);
    use(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

class TextReader {
 public:
  explicit TextReader(const Source& source) : source_(source), lines_(source.content) {}

  RawMap read() {
    if (lower_case(source_.name).ends_with(".xyz")) header_.layout = Columns::xyz;
    while (auto line = lines_.next()) {
      std::string_view text = trimmed(*line);
      if (text.empty()) continue;
      if (text.starts_with('#') || text.starts_with('%')) {
        while (text.starts_with('#') || text.starts_with('%')) text.remove_prefix(1);
        read_header_line(trimmed(text), true);
      } else if (is_header_line(text)) {
        read_header_line(text, false);
      } else {
        read_values(*line);
      }
    }
    if (values_.empty()) source_.fail(0, "the file contains no heights");
    return header_.layout == Columns::matrix ? matrix() : points();
  }

 private:
  /// Returns true if a line begins with a letter and its first word is not a mark for a missing height.
  static bool is_header_line(std::string_view text) {
    const char c = text.front();
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'))) return false;
    return !is_missing_word(text.substr(0, text.find_first_of(" \t,;")));
  }

  // ---- Reading of the header

  void read_header_line(std::string_view text, bool is_comment) {
    const std::size_t colon = text.find_first_of(":=");
    if (is_comment && colon == std::string_view::npos) return;  // a comment for people, which contains no key
    const std::size_t blank = text.find_first_of(" \t");
    const std::size_t end = colon != std::string_view::npos ? colon : blank;
    const std::string key = lower_case(trimmed(text.substr(0, end)));
    const std::string_view value = end == std::string_view::npos ? std::string_view{} : trimmed(text.substr(end + 1));
    if (!set(key, value) && !is_comment)
      source_.fail(
          lines_.number(),
          fmt::format("a line must contain heights, or one of the header keys (pixel_um, x_pixel_um, y_pixel_um, "
                      "height_unit, lateral_unit, columns, ncols, nrows, cellsize, nodata_value), got {}",
                      in_quotes(text)));
  }

  bool set(const std::string& key, std::string_view value) {
    if (key == "pixel_um") {
      header_.x_pixel_um = header_.y_pixel_um = positive(key, value);
    } else if (key == "x_pixel_um") {
      header_.x_pixel_um = positive(key, value);
    } else if (key == "y_pixel_um") {
      header_.y_pixel_um = positive(key, value);
    } else if (key == "cellsize") {
      header_.cell_size = positive(key, value);
      header_.is_esri = true;
    } else if (key == "width") {
      header_.width_um = length_um(key, value);
    } else if (key == "height") {
      header_.height_um = length_um(key, value);
    } else if (key == "height_unit" || key == "value units") {
      header_.height_unit_nm = unit(key, value);
    } else if (key == "lateral_unit") {
      header_.lateral_unit_nm = unit(key, value);
    } else if (key == "ncols") {
      header_.columns = positive(key, value);
      header_.is_esri = true;
    } else if (key == "nrows") {
      header_.rows = positive(key, value);
      header_.is_esri = true;
    } else if (key == "nodata_value") {
      header_.no_data = number(key, value);
    } else if (key == "columns") {
      header_.layout = layout(value);
    } else {
      // The position of the corner is ignored.
      const bool is_corner = key == "xllcorner" || key == "yllcorner" || key == "xllcenter" || key == "yllcenter";
      header_.is_esri |= is_corner;
      return is_corner;
    }
    return true;
  }

  double number(const std::string& key, std::string_view value) const {
    const std::optional<double> result = number_in(value);
    if (!result) source_.fail(lines_.number(), fmt::format("{}: must be a number, got {}", key, in_quotes(value)));
    return *result;
  }
  double positive(const std::string& key, std::string_view value) const {
    const double result = number(key, value);
    if (!(result > 0.0)) source_.fail(lines_.number(), fmt::format("{}: must be > 0, got {}", key, in_quotes(value)));
    return result;
  }
  double unit(const std::string& key, std::string_view value) const {
    const std::optional<double> nm = nm_per(value);
    if (!nm) source_.fail(lines_.number(), fmt::format("{}: must be {}, got {}", key, kUnits, in_quotes(value)));
    return *nm;
  }
  /// Converts a number with a unit, such as "1.5 mm".
  double length_um(const std::string& key, std::string_view value) const {
    const std::size_t blank = value.find(' ');
    if (blank == std::string_view::npos)
      source_.fail(lines_.number(), fmt::format("{}: must be a number and a unit, got {}", key, in_quotes(value)));
    return positive(key, value.substr(0, blank)) * unit(key, trimmed(value.substr(blank))) / kNmPerUm;
  }
  Columns layout(std::string_view value) const {
    if (value == "xyz") return Columns::xyz;
    if (value == "xz") return Columns::xz;
    source_.fail(lines_.number(), "columns: must be xyz or xz, got " + in_quotes(value));
  }

  // ---- Reading of heights in the form of a matrix

  void read_values(std::string_view line) {
    std::size_t count = 0;
    bool ends_empty = false;
    for_each_value(line, [&](std::string_view word) {
      if (values_.size() >= kMaxPoints * 3)
        check_size(source_, lines_.number(), static_cast<double>(values_.size()), 1.0);
      values_.push_back(height(word));
      ends_empty = word.empty();
      ++count;
    });
    if (columns_ == 0) columns_ = count;
    if (count != columns_)
      source_.fail(lines_.number(),
                   fmt::format("every row must have {} values, as the first row does (line {}), got {}", columns_,
                               first_line_, count));
    if (rows_ == 0) first_line_ = lines_.number();
    all_end_empty_ &= ends_empty;
    ++rows_;
    last_line_ = lines_.number();
  }

  double height(std::string_view word) const {
    if (is_missing_word(word)) return kMissing;
    const std::optional<double> value = number_in(word);
    if (!value)
      source_.fail(lines_.number(), "a height must be a number with a decimal point, or NaN, got " + in_quotes(word));
    return header_.no_data && *value == *header_.no_data ? kMissing : *value;
  }

  std::optional<double> lateral_um() const {
    const auto& option = source_.options.lateral_unit;
    const std::optional<double> nm = option ? nm_per(*option) : header_.lateral_unit_nm;
    return nm ? std::optional(*nm / kNmPerUm) : std::nullopt;
  }

  RawMap matrix() {
    // Some programs write a separator at the end of each line, which causes an empty last column.
    if (all_end_empty_ && columns_ > 1) drop_last_column();
    if ((header_.columns && *header_.columns != static_cast<double>(columns_)) ||
        (header_.rows && *header_.rows != static_cast<double>(rows_)))
      source_.fail(last_line_,
                   fmt::format("the header specifies {} columns and {} rows, but the file has {} columns and {} rows",
                               header_.columns.value_or(static_cast<double>(columns_)),
                               header_.rows.value_or(static_cast<double>(rows_)), columns_, rows_));
    check_size(source_, 0, static_cast<double>(columns_), static_cast<double>(rows_));
    RawMap raw;
    raw.format = "text grid";
    raw.columns = columns_;
    raw.rows = rows_;
    raw.x_pixel_um = spacing(header_.x_pixel_um, header_.width_um, columns_);
    raw.y_pixel_um = spacing(header_.y_pixel_um, header_.height_um, rows_);
    raw.nm_per_unit = header_.height_unit_nm;
    raw.heights = std::move(values_);
    if (header_.is_esri) reverse_rows(raw);
    return raw;
  }

  static void reverse_rows(RawMap& raw) {
    const auto row = [&](std::size_t k) { return raw.heights.begin() + static_cast<std::ptrdiff_t>(k * raw.columns); };
    for (std::size_t k = 0; k < raw.rows / 2; ++k) std::swap_ranges(row(k), row(k + 1), row(raw.rows - 1 - k));
  }

  std::optional<double> spacing(const std::optional<double>& pixel_um, const std::optional<double>& size_um,
                                std::size_t points) const {
    if (pixel_um) return pixel_um;
    if (header_.cell_size && lateral_um()) return *header_.cell_size * *lateral_um();
    if (size_um) return *size_um / static_cast<double>(points);
    return std::nullopt;
  }

  void drop_last_column() {
    std::vector<double> kept;
    kept.reserve(rows_ * (columns_ - 1));
    for (std::size_t i = 0; i < values_.size(); ++i)
      if (i % columns_ != columns_ - 1) kept.push_back(values_[i]);
    values_ = std::move(kept);
    --columns_;
  }

  // ---- Reading of lists of points

  /// Evenly spaced values of a coordinate.
  struct Grid {
    double first = 0.0;
    double step = 0.0;
    std::size_t count = 1;

    std::size_t index_of(double value) const {
      return count == 1 ? 0 : static_cast<std::size_t>(std::lround((value - first) / step));
    }
  };

  Grid grid_of(std::size_t column, const char* name) const {
    std::vector<double> all;
    for (std::size_t i = column; i < values_.size(); i += columns_) {
      if (std::isnan(values_[i]))
        source_.fail(0, fmt::format("each point must have a value of {}, but one value is NaN", name));
      all.push_back(values_[i]);
    }
    std::sort(all.begin(), all.end());
    const double range = all.back() - all.front();
    if (!std::isfinite(range)) source_.fail(0, fmt::format("the range of the values of {} is too large", name));
    // The last digits of a coordinate may differ from row to row because of rounding.
    const double tolerance = 1e-7 * range + 1e-12 * std::max(std::abs(all.front()), std::abs(all.back()));
    std::vector<double> distinct = {all.front()};
    for (const double value : all)
      if (value - distinct.back() > tolerance) distinct.push_back(value);
    Grid grid{all.front(), 0.0, distinct.size()};
    if (grid.count == 1) return grid;
    grid.step = range / static_cast<double>(grid.count - 1);
    for (std::size_t i = 0; i < grid.count; ++i)
      if (std::abs(distinct[i] - grid.first - static_cast<double>(i) * grid.step) > 0.05 * grid.step)
        source_.fail(
            0, fmt::format("the values of {} must be evenly spaced, but {} is not on the grid", name, distinct[i]));
    return grid;
  }

  RawMap points() {
    const bool has_y = header_.layout == Columns::xyz;
    const std::size_t wanted = has_y ? 3 : 2;
    if (columns_ != wanted)
      source_.fail(first_line_,
                   fmt::format("a list of points must have {} values on each line, got {}", wanted, columns_));
    const std::optional<double> um = lateral_um();
    if (!um)
      source_.fail(
          0, fmt::format("the unit of x{} is not known: give lateral_unit = UNIT in the file, or {} UNIT; UNIT is {}",
                         has_y ? " and y" : "", reference({"lateral_unit"}), kUnits));
    const Grid x = grid_of(0, "x");
    const Grid y = has_y ? grid_of(1, "y") : Grid{};
    check_size(source_, 0, static_cast<double>(x.count), static_cast<double>(y.count));
    RawMap raw;
    raw.format = "list of points";
    raw.columns = x.count;
    raw.rows = y.count;
    if (x.count > 1) raw.x_pixel_um = x.step * *um;
    if (y.count > 1) raw.y_pixel_um = y.step * *um;
    raw.nm_per_unit = header_.height_unit_nm;
    raw.heights.assign(x.count * y.count, kMissing);
    std::vector<bool> is_set(raw.heights.size(), false);
    for (std::size_t i = 0; i < values_.size(); i += columns_) {
      const std::size_t at = (has_y ? y.index_of(values_[i + 1]) * x.count : 0) + x.index_of(values_[i]);
      if (is_set[at]) source_.fail(0, fmt::format("point {} has the same position as another point", i / columns_ + 1));
      is_set[at] = true;
      raw.heights[at] = values_[i + columns_ - 1];
    }
    return raw;
  }

  const Source& source_;
  Lines lines_;
  Header header_;
  std::vector<double> values_;
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  int first_line_ = 0;  ///< first line with heights
  int last_line_ = 0;
  bool all_end_empty_ = true;
};

}  // namespace

RawMap parse_text_grid(const Source& source) {
  return TextReader(source).read();
}

}  // namespace retrace::surface_models
