#include "studies/photometry/limits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.h"
#include "core/message_text.h"

namespace retrace::studies {
namespace {

// A lumen per square foot in lux: 1 / 0.3048^2.
constexpr double kLuxPerFootCandle = 1.0 / (0.3048 * 0.3048);

std::string known_colour(const std::string& name) {
  return name == "clear" ? "white" : name;
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Rows without classes are for a standard without them.
bool is_of_class(const std::vector<std::string>& classes, const std::string& name) {
  return classes.empty() || holds(classes, name);
}

/// The one that was requested, or the only one. \param option that chooses
std::string choice(const std::vector<std::string>& there_are, const std::optional<std::string>& asked,
                   const std::string& option, std::string_view of_what) {
  if (there_are.empty()) {
    if (asked)
      throw InputError({"", 0, option}, fmt::format("{} has none, got {}", printable(of_what), in_quotes(*asked)));
    return {};
  }
  if (!asked) {
    if (there_are.size() == 1) return there_are.front();
    throw InputError({"", 0, option}, fmt::format("is required for {}: {}", printable(of_what),
                                                  printable(fmt::format("{}", fmt::join(there_are, ", ")), 400)));
  }
  if (holds(there_are, *asked)) return *asked;
  throw InputError({"", 0, option}, fmt::format("must be {} for {}, got {}",
                                                printable(fmt::format("{}", fmt::join(there_are, ", ")), 400),
                                                printable(of_what), in_quotes(*asked)));
}

/// What a table holds of one standard.
struct Contents {
  std::vector<std::string> classes;
  std::vector<std::string> colours;
};

Contents contents_of(const LimitTable& table, const std::string& standard) {
  Contents contents;
  const auto add = [&](const auto& row) {
    if (row.standard != standard) return;
    for (const std::string& name : row.classes) add_once(contents.classes, name);
  };
  for (const LimitRow& row : table.rows) add(row);
  for (const LimitFactor& factor : table.factors) add(factor);
  return contents;
}

std::vector<std::string> colours_of(const LimitTable& table, const std::string& standard,
                                    const std::string& part_class) {
  std::vector<std::string> colours;
  const auto add = [&](const auto& row) {
    if (row.standard == standard && is_of_class(row.classes, part_class)) add_once(colours, known_colour(row.colour));
  };
  for (const LimitRow& row : table.rows) add(row);
  for (const LimitFactor& factor : table.factors) add(factor);
  return colours;
}

/// Every sign of a row is a point.
void add_points(const LimitRow& row, double factor, LimitStatus at_best, std::vector<TestPoint>& points) {
  for (const double v : row.v_deg)
    for (const double h : row.h_deg)
      points.push_back(
          {row.observation_deg, v, h, factor * row.minimum, row.unit, std::max(row.status, at_best), row.line});
}

bool same_geometry(const TestPoint& a, const TestPoint& b) {
  return a.observation_deg == b.observation_deg && a.v_deg == b.v_deg && a.h_deg == b.h_deg;
}

void refuse_doubles(const LimitTable& table, const std::vector<TestPoint>& points) {
  for (std::size_t k = 0; k < points.size(); ++k)
    for (std::size_t j = 0; j < k; ++j)
      if (same_geometry(points[j], points[k]))
        throw InputError({printable(table.source, std::string::npos), points[k].line, ""},
                         fmt::format("gives the point of line {} again", points[j].line));
}

}  // namespace

std::string_view unit_name(PhotometricUnit unit) {
  switch (unit) {
    case PhotometricUnit::mcd_per_lx: return "mcd/lx";
    case PhotometricUnit::cd_per_lx: return "cd/lx";
    case PhotometricUnit::cd_per_fc: return "cd/fc";
    case PhotometricUnit::cd_per_lx_per_m2: return "cd/lx/m2";
  }
  return {};
}

std::string_view status_name(LimitStatus status) {
  switch (status) {
    case LimitStatus::confirmed: return "confirmed";
    case LimitStatus::read: return "read";
    case LimitStatus::recalled: return "recalled";
  }
  return {};
}

double in_mcd_per_lx(double value, PhotometricUnit unit, double area_cm2) {
  switch (unit) {
    case PhotometricUnit::mcd_per_lx: return value;
    case PhotometricUnit::cd_per_lx: return 1e3 * value;
    case PhotometricUnit::cd_per_fc: return 1e3 * value / kLuxPerFootCandle;
    case PhotometricUnit::cd_per_lx_per_m2: return 1e3 * value * 1e-4 * area_cm2;
  }
  return 0.0;
}

TestProgramme programme_of(const LimitTable& table, const std::optional<std::string>& standard,
                           const std::optional<std::string>& part_class, const std::optional<std::string>& colour) {
  std::vector<std::string> standards;
  for (const LimitRow& row : table.rows) add_once(standards, row.standard);
  TestProgramme programme;
  programme.standard = choice(standards, standard, "--standard", table.source);
  programme.part_class =
      choice(contents_of(table, programme.standard).classes, part_class, "--class", programme.standard);
  const std::optional<std::string> asked = colour ? std::optional(known_colour(*colour)) : std::nullopt;
  programme.colour =
      choice(colours_of(table, programme.standard, programme.part_class), asked, "--colour", programme.standard);

  const auto add_rows = [&](const std::string& of_colour, double factor, LimitStatus at_best) {
    for (const LimitRow& row : table.rows)
      if (row.standard == programme.standard && is_of_class(row.classes, programme.part_class) &&
          known_colour(row.colour) == of_colour)
        add_points(row, factor, at_best, programme.points);
  };
  add_rows(programme.colour, 1.0, LimitStatus::confirmed);
  for (const LimitFactor& factor : table.factors) {
    if (factor.standard != programme.standard || !is_of_class(factor.classes, programme.part_class) ||
        known_colour(factor.colour) != programme.colour)
      continue;
    const std::size_t before = programme.points.size();
    add_rows(known_colour(factor.of_colour), factor.factor, factor.status);
    if (programme.points.size() == before)
      throw InputError(
          {printable(table.source, std::string::npos), factor.line, "minimum"},
          fmt::format("must be so many times a colour that the table holds, got {}", in_quotes(factor.of_colour)));
  }
  refuse_doubles(table, programme.points);
  for (const LimitGap& gap : table.gaps)
    if (gap.standard == programme.standard && is_of_class(gap.classes, programme.part_class) &&
        (gap.colour.empty() || known_colour(gap.colour) == programme.colour))
      programme.is_complete = false;
  return programme;
}

}  // namespace retrace::studies
