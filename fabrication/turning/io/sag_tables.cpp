#include "fabrication/turning/io/sag_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/number_format.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::Vec2;
using schema::Document;

Asphere conic_of(const Document& file, const std::string& table) {
  const double radius = file.number(table + ".radius_mm");
  if (radius == 0.0) file.fail(table + ".radius_mm", "must not be 0, got 0");
  return {1.0 / radius, file.number(table + ".conic"), {}};
}

/// Coefficients of r^4, r^6, ...
std::vector<double> even_terms(const Document& file, const std::string& key) {
  constexpr int kMostPower = 20;
  std::vector<double> terms;
  for (const auto& row : file.rows(key)) {
    const int power = static_cast<int>(row[0]);
    if (power != row[0] || power % 2 != 0 || power < 4 || power > kMostPower)
      file.fail(key, fmt::format("must have rows [power, coefficient] with even powers from 4 to {}, got power {}",
                                 kMostPower, shortest(row[0])));
    const auto index = static_cast<std::size_t>(power / 2 - 2);
    if (terms.size() <= index) terms.resize(index + 1, 0.0);
    terms[index] += row[1];
  }
  return terms;
}

/// Two whole numbers and a coefficient.
struct Term {
  int i = 0;
  int j = 0;
  double coefficient = 0.0;
};

/// \param is_signed the second number may be from minus the first to the first
std::vector<Term> terms_of(const Document& file, const std::string& key, bool is_signed) {
  const auto whole = [&](double value, int low, int high) {
    if (value != std::floor(value) || value < low || value > high)
      file.fail(key, fmt::format("must have whole numbers from {} to {} in front of its coefficients, got {}", low,
                                 high, shortest(value)));
    return static_cast<int>(value);
  };
  std::vector<Term> terms;
  for (const auto& row : file.rows(key)) {
    const int i = whole(row[0], 0, kMostPolynomialDegree);
    terms.push_back({i, is_signed ? whole(row[1], -i, i) : whole(row[1], 0, kMostPolynomialDegree), row[2]});
  }
  return terms;
}

XyPolynomial xy_polynomial(const Document& file, const std::string& table) {
  const std::string key = table + ".terms";
  const std::vector<Term> terms = terms_of(file, key, false);
  XyPolynomial p;
  p.scale_mm = file.number(table + ".scale_mm");
  for (const Term& term : terms) p.degree = std::max(p.degree, term.i + term.j);
  if (p.degree > kMostPolynomialDegree)
    file.fail(key, fmt::format("must have a degree of at most {}, got {}", kMostPolynomialDegree, p.degree));
  p.coefficients.assign(XyPolynomial::count(p.degree), 0.0);
  for (const Term& term : terms) p.coefficients[p.index(term.i, term.j)] += term.coefficient;
  return p;
}

XyPolynomial zernike(const Document& file, const std::string& table) {
  const std::string key = table + ".terms";
  std::vector<ZernikeTerm> terms;
  for (const auto& [n, m, coefficient] : terms_of(file, key, true)) {
    if ((n - m) % 2 != 0) file.fail(key, fmt::format("must have n - m even, got n = {} and m = {}", n, m));
    terms.push_back({n, m, coefficient});
  }
  return polynomial_of(terms, file.number(table + ".aperture_radius_mm"));
}

/// \param variables in their order
Formula formula_of(const Document& file, const std::string& key, const std::vector<std::string>& variables) {
  return parse_formula(file.text(key), variables, file.where(key));
}

}  // namespace

Sag read_sag(const Document& file, const std::string& table) {
  const std::string kind = file.text(table + ".kind");
  Sag sag;
  if (file.has(table + ".radius_mm")) sag.asphere = conic_of(file, table);
  if (kind == "asphere") sag.asphere.even = even_terms(file, table + ".even");
  if (kind == "xy_polynomial") sag.polynomial = xy_polynomial(file, table);
  if (kind == "zernike") sag.polynomial = zernike(file, table);
  if (kind == "formula") sag.formula = formula_of(file, table + ".formula", sag_variables());
  return sag;
}

std::vector<Vec2> read_points(const Document& file, std::string_view key) {
  std::vector<Vec2> points;
  for (const auto& row : file.rows(key)) points.emplace_back(row[0], row[1]);
  return points;
}

Boundary read_boundary(const Document& file) {
  const auto number = [&](const char* key) { return file.number(schema::path_in("boundary", key)); };
  const std::string kind = file.text("boundary.kind");
  BoundaryOptions options;
  options.degree = static_cast<int>(number("degree"));
  std::optional<Vec2> centre;
  if (file.has("boundary.centre_mm")) centre = Vec2(file.numbers("boundary.centre_mm").data());
  if (kind == "points")
    return boundary_from_points(read_points(file, "boundary.points_mm"), centre, file.flag("boundary.scattered"),
                                options.degree, file.where("boundary.points_mm"));
  const Vec2 middle = centre.value_or(Vec2::Zero());
  if (kind == "circle") return circle_boundary(middle, number("radius_mm"), options.degree);
  options.samples = static_cast<int>(number("samples"));
  if (kind == "rectangle") {
    const std::vector<double> size = file.numbers("boundary.size_mm");
    return rectangle_boundary(middle, size[0], size[1], number("corner_mm"), options, file.where("boundary.size_mm"));
  }
  const Formula r = formula_of(file, "boundary.formula", {"theta"});
  return boundary_from_radius(
      middle, [&](double theta) { return r.evaluate(&theta); }, options, file.where("boundary.formula"));
}

}  // namespace retrace::fabrication::turning
