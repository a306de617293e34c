#include "fabrication/turning/io/sag_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/number_format.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::Vec2;
constexpr NumberRange kCoefficient{.low = -1e9, .high = 1e9};
constexpr NumberRange kRadius{.low = -1e9, .high = 1e9};
constexpr std::size_t kMostTerms = 200;
constexpr std::size_t kMostTablePoints = 4000;

void read_conic(TomlTable& table, Sag& sag) {
  const double radius = table.required_number("radius_mm", kRadius);
  if (radius == 0.0) table.fail("radius_mm", "must not be 0, got 0");
  sag.asphere.curvature_per_mm = 1.0 / radius;
  sag.asphere.conic = table.number("conic", kCoefficient).value_or(0.0);
}

/// Rows [power, coefficient] of r^4, r^6, ...
void read_even(TomlTable& table, Sag& sag) {
  constexpr int kMostPower = 20;
  for (const auto& row : table.required_number_rows("even", 2, kCoefficient)) {
    const int power = static_cast<int>(row[0]);
    if (power != row[0] || power % 2 != 0 || power < 4 || power > kMostPower)
      table.fail("even", fmt::format("must have rows [power, coefficient] with even powers from 4 to {}, got power {}",
                                     kMostPower, shortest(row[0])));
    const auto index = static_cast<std::size_t>(power / 2 - 2);
    if (sag.asphere.even.size() <= index) sag.asphere.even.resize(index + 1, 0.0);
    sag.asphere.even[index] += row[1];
  }
}

int whole_in(TomlTable& table, double value, int low, int high) {
  if (value != std::floor(value) || value < low || value > high)
    table.fail("terms", fmt::format("must have whole numbers from {} to {} in front of its coefficients, got {}", low,
                                    high, shortest(value)));
  return static_cast<int>(value);
}

std::vector<std::vector<double>> term_rows(TomlTable& table) {
  auto rows = table.required_number_rows("terms", 3, kCoefficient);
  if (rows.empty() || rows.size() > kMostTerms)
    table.fail("terms", fmt::format("must have 1 to {} rows, got {}", kMostTerms, rows.size()));
  return rows;
}

void read_polynomial(TomlTable& table, Sag& sag) {
  const auto rows = term_rows(table);
  XyPolynomial p;
  p.scale_mm = table.number("scale_mm", kPositiveMm).value_or(1.0);
  for (const auto& row : rows) {
    const int i = whole_in(table, row[0], 0, kMostPolynomialDegree);
    const int j = whole_in(table, row[1], 0, kMostPolynomialDegree);
    if (i + j > kMostPolynomialDegree)
      table.fail("terms", fmt::format("must have a degree of at most {}, got {}", kMostPolynomialDegree, i + j));
    p.degree = std::max(p.degree, i + j);
  }
  p.coefficients.assign(XyPolynomial::count(p.degree), 0.0);
  for (const auto& row : rows) p.coefficients[p.index(static_cast<int>(row[0]), static_cast<int>(row[1]))] += row[2];
  sag.polynomial = p;
}

void read_zernike(TomlTable& table, Sag& sag) {
  std::vector<ZernikeTerm> terms;
  for (const auto& row : term_rows(table)) {
    const int n = whole_in(table, row[0], 0, kMostPolynomialDegree);
    const int m = whole_in(table, row[1], -n, n);
    if ((n - m) % 2 != 0) table.fail("terms", fmt::format("must have n - m even, got n = {} and m = {}", n, m));
    terms.push_back({n, m, row[2]});
  }
  sag.polynomial = polynomial_of(terms, table.required_number("aperture_radius_mm", kPositiveMm));
}

}  // namespace

Sag read_sag(TomlTable& table, std::string_view kind_key) {
  static constexpr std::string_view kKinds[] = {"plane", "conic", "asphere", "xy_polynomial", "zernike", "formula"};
  enum Kind { plane, conic, asphere, xy_polynomial, zernike, formula };
  const auto kind = static_cast<Kind>(table.required_choice(kind_key, kKinds));
  Sag sag;
  switch (kind) {
    case plane:
      break;
    case conic:
      read_conic(table, sag);
      break;
    case asphere:
      read_conic(table, sag);
      read_even(table, sag);
      break;
    case xy_polynomial:
    case zernike:
      if (table.has("radius_mm")) read_conic(table, sag);
      kind == zernike ? read_zernike(table, sag) : read_polynomial(table, sag);
      break;
    case formula:
      sag.formula = parse_formula(table.required_text("formula"), sag_variables(), table.where("formula"));
      break;
  }
  return sag;
}

Boundary read_boundary(TomlTable& table) {
  static constexpr std::string_view kKinds[] = {"circle", "rectangle", "points", "formula"};
  enum Kind { circle, rectangle, points, formula };
  const auto kind = static_cast<Kind>(table.required_choice("kind", kKinds));
  BoundaryOptions options;
  options.degree = static_cast<int>(table.whole("degree", {.low = 2, .high = kMostSplineDegree}).value_or(3));
  if (kind == rectangle || kind == formula)
    options.samples = static_cast<int>(table.whole("samples", {.low = 16, .high = kMostTablePoints}).value_or(180));
  std::optional<Vec2> centre;
  if (const auto c = table.numbers("centre_mm", 2, kLengthMm)) centre = Vec2((*c)[0], (*c)[1]);
  const Vec2 middle = centre.value_or(Vec2::Zero());
  switch (kind) {
    case circle:
      return circle_boundary(middle, table.required_number("radius_mm", kPositiveMm), options.degree);
    case rectangle: {
      const std::vector<double> size = table.required_numbers("size_mm", 2, kPositiveMm);
      return rectangle_boundary(middle, size[0], size[1], table.required_number("corner_mm", kPositiveMm), options,
                                table.where("size_mm"));
    }
    case points: {
      std::vector<Vec2> list;
      for (const auto& row : table.required_number_rows("points_mm", 2, kLengthMm)) list.emplace_back(row[0], row[1]);
      if (list.size() > kMostTablePoints)
        table.fail("points_mm", fmt::format("must have at most {} points, got {}", kMostTablePoints, list.size()));
      const bool scattered = table.flag("scattered").value_or(false);
      return boundary_from_points(std::move(list), centre, scattered, options.degree, table.where("points_mm"));
    }
    case formula: {
      const InputLocation where = table.where("formula");
      const Formula r = parse_formula(table.required_text("formula"), {"theta"}, where);
      return boundary_from_radius(
          middle, [&](double theta) { return r.evaluate(&theta); }, options, where);
    }
  }
  return {};
}

}  // namespace retrace::fabrication::turning
