#pragma once

// Internal to surface_models/io/: types and functions that the readers of all formats use.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/message_text.h"
#include "core/text.h"
#include "core/warning.h"
#include "surface_models/io/height_map_reader.h"

namespace retrace::surface_models {

inline constexpr double kNmPerUm = 1e3;

/// Content and name of a file that is read.
struct Source {
  std::string_view content;
  const std::string& name;
  const HeightMapOptions& options;

  /// \param line number of the line; 0 for formats without lines
  [[noreturn]] void fail(int line, std::string_view text) const;
};

/// Content of a file before its units are resolved. Lengths without a unit are in the unit of
/// `HeightMapOptions::lateral_unit`.
struct RawMap {
  std::string format;
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::optional<double> x_pixel_um;
  std::optional<double> y_pixel_um;
  std::optional<double> nm_per_unit;  ///< nanometres per unit of the heights
  std::vector<double> heights;        ///< columns * rows values; NaN where missing
  Warnings warnings;
};

/// Returns the number of nanometres in a unit: m, mm, um (also with the Greek letter), nm, pm. Returns nothing if
/// `unit` is not one of these units.
std::optional<double> nm_per(std::string_view unit);
/// Names of the units for messages.
inline constexpr std::string_view kUnits = "m, mm, um, nm or pm";

/// Refuses impossible numbers of columns and rows.
/// \param line line of the file that contains them, or 0 if unknown
void check_size(const Source& source, int line, double columns, double rows);

/// Reads a text line by line. The end of a line (LF or CR LF) is removed.
class Lines {
 public:
  explicit Lines(std::string_view text) : remainder_(text) {}
  std::optional<std::string_view> next();
  int number() const { return number_; }  ///< number of the line that next() returned last
  std::string_view remainder() const { return remainder_; }

 private:
  std::string_view remainder_;
  int number_ = 0;
  bool ended_ = false;
};

RawMap parse_text_grid(const Source& source);
RawMap parse_sdf(const Source& source);
RawMap parse_gsf(const Source& source);
RawMap parse_gwy(const Source& source);

}  // namespace retrace::surface_models
