#include "studies/photometry/limits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>

#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"

namespace retrace::studies {
namespace {

// Illuminance of one lumen per square foot in lux: 1 / 0.3048^2.
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

/// Returns true if a line applies to a class. Lines without classes apply to all classes.
bool is_of_class(const LimitLine& line, const std::string& name) {
  return line.classes.empty() || holds(line.classes, name);
}

/// Returns true if a line applies to a test plan. Lines without a colour apply to all colours.
bool concerns(const LimitLine& line, const TestPlan& test_plan) {
  return line.standard == test_plan.standard && is_of_class(line, test_plan.part_class) &&
         (line.colour.empty() || known_colour(line.colour) == test_plan.colour);
}

/// Returns the requested name, or the only available name if no name was requested. Returns an empty name if there are
/// no available names.
/// \param there_are available names
/// \param asked requested name
/// \param field field of the request that contains the requested name, for error messages
/// \param of_what object that the names belong to, for error messages
/// \throw InputError at `field` if the requested name is not available, or if a name is required but missing
std::string choice(const std::vector<std::string>& there_are, const std::optional<std::string>& asked, Field field,
                   std::string_view of_what) {
  if (there_are.empty()) {
    if (asked)
      throw InputError(field, fmt::format("must be left out for {}, got {}", printable(of_what), in_quotes(*asked)));
    return {};
  }
  if (!asked) {
    if (there_are.size() == 1) return there_are.front();
    throw InputError(field, fmt::format("is required for {}; give one of {}", printable(of_what),
                                        printable(fmt::format("{}", fmt::join(there_are, ", ")), 400)));
  }
  if (holds(there_are, *asked)) return *asked;
  throw InputError(field, fmt::format("must be one of {} for {}, got {}",
                                      printable(fmt::format("{}", fmt::join(there_are, ", ")), 400), printable(of_what),
                                      in_quotes(*asked)));
}

std::vector<std::string> classes_of(const LimitTable& table, const std::string& standard) {
  std::vector<std::string> classes;
  const auto add = [&](const auto& row) {
    if (row.standard != standard) return;
    for (const std::string& name : row.classes) add_once(classes, name);
  };
  for (const LimitRow& row : table.rows) add(row);
  for (const LimitFactor& factor : table.factors) add(factor);
  return classes;
}

std::vector<std::string> colours_of(const LimitTable& table, const std::string& standard,
                                    const std::string& part_class) {
  std::vector<std::string> colours;
  const auto add = [&](const auto& row) {
    if (row.standard == standard && is_of_class(row, part_class)) add_once(colours, known_colour(row.colour));
  };
  for (const LimitRow& row : table.rows) add(row);
  for (const LimitFactor& factor : table.factors) add(factor);
  return colours;
}

/// Adds the test points of a row, one for each combination of signs.
/// \param by line with the factor by which the limits of the row are multiplied; null: no factor
void add_points(const LimitRow& row, const LimitFactor* by, std::vector<TestPoint>& points) {
  const double minimum = by != nullptr ? by->factor * row.minimum : row.minimum;
  const LimitStatus status = by != nullptr ? std::max(row.status, by->status) : row.status;
  const bool has_two_sources = by != nullptr && !by->source.empty();
  const std::string source = has_two_sources ? fmt::format("{}; {}", row.source, by->source) : row.source;
  for (const double v : row.v_deg)
    for (const double h : row.h_deg)
      points.push_back({row.observation_deg, v, h, minimum, row.unit, status, row.line, source, row.substitute_v_deg});
}

bool same_geometry(const TestPoint& a, const TestPoint& b) {
  return a.observation_deg == b.observation_deg && a.v_deg == b.v_deg && a.h_deg == b.h_deg;
}

/// Adds a boundary of the colour. All boundaries must have one geometry, because the colour is measured only one time.
void add_boundary(const LimitTable& table, const ColourBoundary& boundary, TestPlan& test_plan) {
  const auto geometry = [](const ColourBoundary& b) {
    return std::tie(b.observation_deg, b.v_deg, b.substitute_v_deg, b.h_deg);
  };
  if (!test_plan.boundaries.empty() && geometry(test_plan.boundaries.front()) != geometry(boundary))
    throw InputError({printable(table.source, std::string::npos), boundary.line, ""},
                     fmt::format("must have the same observation_deg, v_deg and h_deg as line {}, because the colour "
                                 "is measured only one time",
                                 test_plan.boundaries.front().line));
  test_plan.boundaries.push_back(boundary);
}

void refuse_doubles(const LimitTable& table, const std::vector<TestPoint>& points) {
  for (std::size_t k = 0; k < points.size(); ++k)
    for (std::size_t j = 0; j < k; ++j)
      if (same_geometry(points[j], points[k]))
        throw InputError({printable(table.source, std::string::npos), points[k].line, ""},
                         fmt::format("this line repeats the test point of line {}", points[j].line));
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

std::string LimitArea::text() const {
  return fmt::format("{} {} cm2", is_maximum ? "at most" : "at least", shortest(area_cm2));
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

TestPlan test_plan_of(const LimitTable& table, const std::optional<std::string>& standard,
                      const std::optional<std::string>& part_class, const std::optional<std::string>& colour) {
  std::vector<std::string> standards;
  for (const LimitRow& row : table.rows) add_once(standards, row.standard);
  TestPlan test_plan;
  test_plan.standard = choice(standards, standard, {"standard"}, table.source);
  test_plan.part_class = choice(classes_of(table, test_plan.standard), part_class, {"part_class"}, test_plan.standard);
  const std::optional<std::string> asked = colour ? std::optional(known_colour(*colour)) : std::nullopt;
  test_plan.colour =
      choice(colours_of(table, test_plan.standard, test_plan.part_class), asked, {"colour"}, test_plan.standard);

  const auto add_rows = [&](const std::string& of_colour, const LimitFactor* by) {
    for (const LimitRow& row : table.rows)
      if (row.standard == test_plan.standard && is_of_class(row, test_plan.part_class) &&
          known_colour(row.colour) == of_colour)
        add_points(row, by, test_plan.points);
  };
  add_rows(test_plan.colour, nullptr);
  for (const LimitFactor& factor : table.factors) {
    if (!concerns(factor, test_plan)) continue;
    const std::size_t before = test_plan.points.size();
    add_rows(known_colour(factor.reference_colour), &factor);
    if (test_plan.points.size() == before)
      throw InputError({printable(table.source, std::string::npos), factor.line, "minimum"},
                       fmt::format("must be a multiple of a colour that the table contains, got the colour {}",
                                   in_quotes(factor.reference_colour)));
  }
  refuse_doubles(table, test_plan.points);
  for (const LimitArea& area : table.areas)
    if (concerns(area, test_plan)) test_plan.areas.push_back(area);
  for (const ColourBoundary& boundary : table.boundaries)
    if (concerns(boundary, test_plan)) add_boundary(table, boundary, test_plan);
  for (const LimitGap& gap : table.gaps)
    if (concerns(gap, test_plan)) test_plan.is_complete = false;
  return test_plan;
}

}  // namespace retrace::studies
