#include "studies/image/io/lamp_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/text.h"

namespace retrace::studies {
namespace {

constexpr std::size_t kMaxLampBytes = std::size_t{16} << 20;
constexpr double kMaxAngles = 3601;  ///< maximum number of planes, and of angles in a plane
constexpr double kFullTurnDeg = 360.0;

/// Text that is read line by line. The object stores the current position for messages.
class Lines {
 public:
  Lines(std::string_view text, const std::string& file)
      : file_(file), lines_(split(without_byte_order_mark(text), '\n')) {}

  bool at_end() const { return next_ == lines_.size(); }
  std::string_view next(std::string_view what) {
    if (at_end())
      throw InputError({file_, static_cast<int>(lines_.size()), ""},
                       fmt::format("the file is incomplete: it ends before {}", what));
    return lines_[next_++];
  }
  [[noreturn]] void fail(std::string_view key, std::string_view text) const {
    throw InputError({file_, static_cast<int>(next_), std::string(key)}, text);
  }
  /// Reads a line that consists of one finite number within a range. A decimal comma is accepted.
  double number(std::string_view key, double least, double most) {
    std::string text(next(key));
    std::replace(text.begin(), text.end(), ',', '.');
    return checked(number_in(text), text, key, least, most);
  }
  /// Reads the next number of a list. The list may contain several numbers per line and continue over several lines.
  double word(std::string_view key, double least, double most) {
    constexpr const char* kBetween = " \t\r,";
    while (word_ == std::string_view::npos) word_ = next(key).find_first_not_of(kBetween);
    const std::string_view line = lines_[next_ - 1];
    const std::size_t end = std::min(line.find_first_of(kBetween, word_), line.size());
    const std::string text(line.substr(word_, end - word_));
    word_ = line.find_first_not_of(kBetween, end);
    return checked(number_in(text), text, key, least, most);
  }
  void leave_line() { word_ = std::string_view::npos; }

  // These functions read whole numbers in the same way as number() and word() read numbers.
  std::size_t count(std::string_view key, double least, double most) { return whole(key, number(key, least, most)); }
  std::size_t count_word(std::string_view key, double least, double most) { return whole(key, word(key, least, most)); }

 private:
  double checked(std::optional<double> value, const std::string& text, std::string_view key, double least,
                 double most) const {
    if (value && *value >= least && *value <= most) return *value;
    fail(key, fmt::format("must be a number from {} to {}, got {}", shortest(least), shortest(most), in_quotes(text)));
  }

  std::size_t whole(std::string_view key, double value) const {
    if (value != std::floor(value)) fail(key, fmt::format("must be a whole number, got {}", shortest(value)));
    return static_cast<std::size_t>(value);
  }

  const std::string& file_;
  std::vector<std::string_view> lines_;
  std::size_t next_ = 0;
  std::size_t word_ = std::string_view::npos;  ///< position of the next number in the last line that was read
};

constexpr double kMost = 1e12;

using Row = std::vector<double>;

/// Planes, and the intensities in candela in each plane.
struct Table {
  std::vector<double> planes_deg;
  std::vector<double> angles_deg;
  std::vector<Row> rows;
};

void check_ascending(const Lines& lines, const std::vector<double>& angles, std::string_view key) {
  for (std::size_t k = 1; k < angles.size(); ++k)
    if (!(angles[k] > angles[k - 1]))
      lines.fail(key, fmt::format("the values must be in ascending order, got {} after {}", shortest(angles[k]),
                                  shortest(angles[k - 1])));
}

/// Adds the planes on the other side of a plane of symmetry. Their angles are 2 * mirror_deg minus the present angles.
/// \param in_front true: the new planes come before the present planes
void mirror(Table& table, double mirror_deg, bool in_front) {
  Table made{{}, table.angles_deg, {}};
  const std::size_t count = table.planes_deg.size();
  for (std::size_t k = count; k-- > 0;) {
    const double other = 2.0 * mirror_deg - table.planes_deg[k];
    if (other == table.planes_deg[k]) continue;  // this plane is the plane of symmetry
    made.planes_deg.push_back(other);
    made.rows.push_back(table.rows[k]);
  }
  if (in_front) std::swap(made, table);
  table.planes_deg.insert(table.planes_deg.end(), made.planes_deg.begin(), made.planes_deg.end());
  table.rows.insert(table.rows.end(), made.rows.begin(), made.rows.end());
}

/// Converts planes with negative angles to planes from 0 to 360 degrees, in ascending order.
void turn_to_zero(Table& table) {
  std::vector<std::pair<double, Row>> planes;
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const double at = table.planes_deg[k];
    planes.emplace_back(at < 0.0 ? at + kFullTurnDeg : at, table.rows[k]);
  }
  std::stable_sort(planes.begin(), planes.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  table.planes_deg.clear();
  table.rows.clear();
  for (auto& [at, row] : planes) {
    if (!table.planes_deg.empty() && at == table.planes_deg.back()) continue;
    table.planes_deg.push_back(at);
    table.rows.push_back(std::move(row));
  }
  if (table.planes_deg.back() != kFullTurnDeg) {
    table.planes_deg.push_back(kFullTurnDeg);
    table.rows.push_back(table.rows.front());
  }
}

LuminousIntensity intensity_of(LuminousIntensity::Planes kind, Table table, double factor) {
  std::vector<double> cd;
  for (const Row& row : table.rows)
    for (const double value : row) cd.push_back(factor * value);
  return {kind, std::move(table.planes_deg), std::move(table.angles_deg), std::move(cd)};
}

/// Adds planes by the symmetry that the first and the last plane determine (LM-63-2002, 5.3; LM-63-19, 5.3).
void complete_ies(Lines& lines, Table& table, LuminousIntensity::Planes kind) {
  constexpr std::string_view key = "horizontal angles";
  const double first = table.planes_deg.front();
  const double last = table.planes_deg.back();
  const auto refuse = [&](std::string_view allowed) {
    lines.fail(key, fmt::format("must {}, got {} to {}", allowed, shortest(first), shortest(last)));
  };
  if (kind != LuminousIntensity::Planes::c) {
    const double most = kind == LuminousIntensity::Planes::a ? 180.0 : 90.0;
    if (table.planes_deg.size() < 2 || last > most || first < -most)
      refuse(fmt::format("be two or more angles from -{0} to {0}", shortest(most)));
    if (first == 0.0)
      mirror(table, 0.0, true);
    else if (!(first < 0.0 && last > 0.0))
      refuse("begin at 0 (symmetric distribution), or reach from a negative to a positive angle");
    return;
  }
  if (table.planes_deg.size() == 1 && first == 0.0) return;
  if (first == 0.0 && last == 90.0) {
    mirror(table, 90.0, false);
    mirror(table, 180.0, false);
  } else if (first == 0.0 && last == 180.0) {
    mirror(table, 180.0, false);
  } else if (first == 90.0 && last == 270.0) {
    mirror(table, 90.0, true);
    turn_to_zero(table);
  } else if (first == 0.0 && last > 180.0 && last <= kFullTurnDeg) {
    if (last < kFullTurnDeg) turn_to_zero(table);  // adds the first plane again at 360 degrees
  } else {
    refuse("reach from 0 to 0, 90, 180 or 360, or from 90 to 270");
  }
}

/// Year of the first edition of the standard LM-63. Files of this edition have no header line.
constexpr int kFirstEdition = 1986;
/// Year of the last edition of LM-63 in which the number after the ballast factor multiplies the intensities. In later
/// editions, this number is reserved or states how the file was generated.
constexpr int kLastWithLampFactor = 1991;

/// Removes `word` and the separators that follow it from the start of a line. Returns false and changes nothing if the
/// line does not start with `word`.
/// \param line a line in lower case
bool skip(std::string_view& line, std::string_view word) {
  if (!line.starts_with(word)) return false;
  line.remove_prefix(word.size());
  line.remove_prefix(std::min(line.find_first_not_of(" \t:;,_/.-"), line.size()));
  return true;
}

/// Returns the year of the LM-63 edition that a header line names. Examples: "IESNA91", "IESNA:LM-63-2002", "ANSI/IES
/// LM-63-19", in upper or lower case. Returns 0 for other lines, such as the labels in files of 1986.
/// \throw InputError if the line names LM-63 without a year
int edition_in(const Lines& lines, std::string_view line) {
  const std::string lower = lower_case(line);
  std::string_view rest = lower;
  skip(rest, "");
  skip(rest, "ansi");
  const bool is_ies = skip(rest, "iesna") || skip(rest, "ies");
  const bool is_standard = skip(rest, "lm") && skip(rest, "63");
  if (!is_ies && !is_standard) return 0;
  const std::size_t digits = std::min(rest.find_first_not_of("0123456789"), rest.size());
  const bool ends = digits == rest.size() || !(rest[digits] >= 'a' && rest[digits] <= 'z');
  const double number = digits == 2 || digits == 4 ? number_in(rest.substr(0, digits)).value_or(0.0) : 0.0;
  const int year = static_cast<int>(number) + (digits != 2 ? 0 : number >= kFirstEdition % 100 ? 1900 : 2000);
  constexpr std::array editions = {kFirstEdition, kLastWithLampFactor, 1995, 2002, 2019};
  if (ends && (is_standard ? year >= kFirstEdition : std::ranges::count(editions, year) > 0)) return year;
  if (is_ies && is_standard)
    lines.fail("header", "must contain the year of LM-63, as in IESNA:LM-63-2002, got " + in_quotes(line));
  return 0;
}

/// Returns the text after a keyword at the start of a line, for example "Headlamp" in "[LUMINAIRE] Headlamp". Upper and
/// lower case are equal. Returns an empty text if the line starts with another text.
std::string text_behind(std::string_view line, std::string_view keyword) {
  const bool is_there = lower_case(line.substr(0, keyword.size())) == lower_case(keyword);
  return is_there ? printable(trimmed(line.substr(keyword.size()))) : std::string();
}

/// Returns VALUE of a line "TILT=VALUE", or an empty text for other lines.
std::string tilt_in(std::string_view line) {
  const std::string rest = text_behind(line, "TILT");
  return rest.starts_with('=') ? std::string(trimmed(std::string_view(rest).substr(1))) : std::string();
}

/// Reads and ignores the factors for lamps that are operated in tilted positions.
void pass_tilt(Lines& lines, const std::string& tilt) {
  const std::string word = lower_case(tilt);
  if (word != "none" && word != "include")
    lines.fail("TILT", fmt::format("must be NONE or INCLUDE, got {}", in_quotes(tilt)));
  if (word == "none") return;
  lines.word("tilt", 1, 3);
  lines.leave_line();
  const std::size_t pairs = lines.count_word("tilt", 1, kMaxAngles);
  for (std::size_t k = 0; k < 2 * pairs; ++k) lines.word("tilt", -kMost, kMost);
  lines.leave_line();
}

Table read_ies_table(Lines& lines, LuminousIntensity::Planes kind, std::size_t angles, std::size_t planes) {
  Table table;
  const double least = kind == LuminousIntensity::Planes::c ? 0.0 : -90.0;
  const double most = kind == LuminousIntensity::Planes::c ? 180.0 : 90.0;
  for (std::size_t k = 0; k < angles; ++k) table.angles_deg.push_back(lines.word("vertical angles", least, most));
  check_ascending(lines, table.angles_deg, "vertical angles");
  for (std::size_t k = 0; k < planes; ++k)
    table.planes_deg.push_back(lines.word("horizontal angles", -kFullTurnDeg, kFullTurnDeg));
  check_ascending(lines, table.planes_deg, "horizontal angles");
  for (std::size_t k = 0; k < planes; ++k) {
    Row row;
    for (std::size_t j = 0; j < angles; ++j) row.push_back(lines.word("candela", 0, kMost));
    table.rows.push_back(std::move(row));
  }
  complete_ies(lines, table, kind);
  return table;
}

/// Returns the table with angles and planes exchanged.
Table turned_over(const Table& table) {
  Table turned{table.angles_deg, table.planes_deg,
               std::vector<Row>(table.angles_deg.size(), Row(table.planes_deg.size()))};
  for (std::size_t k = 0; k < table.planes_deg.size(); ++k)
    for (std::size_t j = 0; j < table.angles_deg.size(); ++j) turned.rows[j][k] = table.rows[k][j];
  return turned;
}

}  // namespace

PhotometricLamp parse_ies(std::string_view text, const std::string& file) {
  Lines lines(text, file);
  std::string title;
  std::string tilt;
  int edition = 0;
  while (tilt.empty()) {
    const std::string_view line = lines.next("a line TILT=");
    if (edition == 0) edition = edition_in(lines, line);
    if (std::string found = text_behind(line, "[LUMINAIRE]"); !found.empty()) title = std::move(found);
    tilt = tilt_in(line);
  }
  pass_tilt(lines, tilt);
  const double lamps = lines.word("number of lamps", 1, 1e6);
  const double lumens = lines.word("lumens per lamp", -1, kMost);
  const double multiplier = lines.word("candela multiplier", 1e-12, kMost);
  const std::size_t angles = lines.count_word("number of vertical angles", 2, kMaxAngles);
  const std::size_t planes = lines.count_word("number of horizontal angles", 1, kMaxAngles);
  const std::size_t type = lines.count_word("photometric type", 1, 3);
  lines.word("units", 1, 2);
  for (const char* const size : {"width", "length", "height"}) lines.word(size, -kMost, kMost);
  const double ballast = lines.word("ballast factor", 1e-12, kMost);
  const double lamp_factor = lines.word("ballast-lamp factor", 0, kMost);
  const double with_lamp = edition <= kLastWithLampFactor ? lamp_factor : 1.0;
  lines.word("input watts", 0, kMost);
  using enum LuminousIntensity::Planes;
  const auto kind = type == 1 ? c : type == 2 ? b : a;
  Table table = read_ies_table(lines, kind, angles, planes);
  // The horizontal angle of type A is the angle of its planes. In type B, it is the angle within the planes.
  if (kind == b) table = turned_over(table);
  return {file, title, intensity_of(kind, std::move(table), multiplier * ballast * with_lamp),
          lumens > 0.0 ? lamps * lumens : 0.0};
}

namespace {

/// Returns the luminous flux of the first set of light sources.
double read_ldt_lumens(Lines& lines) {
  const std::size_t sets = lines.count("number of sets", 1, 20);
  double lumens = 0.0;
  for (std::size_t k = 0; k < sets; ++k) {
    lines.number("number of light sources", -1e6, 1e6);  // negative if intensities are absolute
    lines.next("the type of light sources");
    const double of_set = lines.number("luminous flux", 1e-9, kMost);
    if (k == 0) lumens = of_set;
    for (const char* const what : {"the colour", "the colour rendering"}) lines.next(what);
    lines.number("power", 0, kMost);
  }
  return lumens;
}

Table read_ldt_table(Lines& lines, std::size_t symmetry, std::size_t planes, std::size_t angles) {
  std::vector<double> all_planes;
  for (std::size_t k = 0; k < planes; ++k) all_planes.push_back(lines.number("C planes", 0, kFullTurnDeg));
  check_ascending(lines, all_planes, "C planes");
  Table table;
  for (std::size_t k = 0; k < angles; ++k) table.angles_deg.push_back(lines.number("angles", 0, 180));
  check_ascending(lines, table.angles_deg, "angles");
  // First plane with intensities in the file, and number of such planes. The index is the symmetry code of the file: 0
  // none, 1 about the axis, 2 about the plane C0 - C180, 3 about the plane C90 - C270, 4 about both planes.
  const std::size_t begins[] = {0, 0, 0, 3 * planes / 4, 0};
  const std::size_t counts[] = {planes, 1, planes / 2 + 1, planes / 2 + 1, planes / 4 + 1};
  if ((symmetry > 1 && planes % (symmetry == 2 ? 2 : 4) != 0) || all_planes.front() != 0.0)
    lines.fail("C planes", fmt::format("must begin at 0, and their number must be even for symmetry 2 and a multiple "
                                       "of 4 for symmetry 3 and 4, got symmetry {} and {} planes",
                                       symmetry, planes));
  for (std::size_t k = 0; k < counts[symmetry]; ++k) {
    const std::size_t plane = begins[symmetry] + k;
    // The planes of symmetry 3 go from 270 degrees through 0 to 90 degrees.
    table.planes_deg.push_back(all_planes[plane % planes] - (symmetry == 3 && plane < planes ? kFullTurnDeg : 0.0));
    Row row;
    for (std::size_t j = 0; j < angles; ++j) row.push_back(lines.number("luminous intensity", 0, kMost));
    table.rows.push_back(std::move(row));
  }
  check_ascending(lines, table.planes_deg, "C planes");
  return table;
}

/// Adds the planes that follow from the symmetry code of the file.
void complete_ldt(Table& table, std::size_t symmetry) {
  if (symmetry == 3 || symmetry == 4) mirror(table, 90.0, false);
  if (symmetry == 2 || symmetry == 4) mirror(table, 180.0, false);
  if (symmetry == 0 || symmetry == 3) turn_to_zero(table);
}

}  // namespace

PhotometricLamp parse_ldt(std::string_view text, const std::string& file) {
  Lines lines(text, file);
  lines.next("the company");
  lines.number("type indicator", 0, 3);
  const std::size_t symmetry = lines.count("symmetry indicator", 0, 4);
  const std::size_t planes = lines.count("number of C planes", 1, kMaxAngles);
  lines.number("distance of C planes", 0, kFullTurnDeg);
  const std::size_t angles = lines.count("number of angles", 2, kMaxAngles);
  lines.number("distance of angles", 0, 180);
  lines.next("the report's number");
  const std::string title = printable(lines.next("the luminaire's name"));
  for (const char* const what : {"the luminaire's number", "the file's name", "the date"}) lines.next(what);
  for (int k = 0; k < 9; ++k) lines.number("size", 0, kMost);
  lines.number("downward flux fraction", 0, 100);
  const double light_output_percent = lines.number("light output ratio", 0, 1000);
  const double conversion = lines.number("conversion factor", 1e-12, kMost);
  lines.number("tilt", -kFullTurnDeg, kFullTurnDeg);
  const double lumens = read_ldt_lumens(lines);
  for (int k = 0; k < 10; ++k) lines.number("direct ratio", 0, kMost);
  Table table = read_ldt_table(lines, symmetry, planes, angles);
  complete_ldt(table, symmetry);
  return {file, title, intensity_of(LuminousIntensity::Planes::c, std::move(table), 1e-3 * lumens * conversion),
          1e-2 * light_output_percent * lumens};
}

PhotometricLamp read_lamp(const std::filesystem::path& file, Field field) {
  const std::string ending = ending_of(file);
  if (ending != ".ies" && ending != ".ldt")
    throw InputError(field, fmt::format("must end in .ies or .ldt, got {}", in_quotes(file.string())));
  const std::string text = read_file(file, kMaxLampBytes);
  return ending == ".ies" ? parse_ies(text, file.string()) : parse_ldt(text, file.string());
}

}  // namespace retrace::studies
