#include "geometry/io/surface_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/number_format.h"
#include "core/schema/reader.h"

namespace retrace::geometry {
namespace {

using schema::Document;

Asphere conic_of(const Document& file, const std::string& table) {
  const double radius = file.number(table + ".radius_mm");
  if (radius == 0.0) file.fail(table + ".radius_mm", "must not be 0, got 0");
  return {1.0 / radius, file.number(table + ".conic"), {}};
}

/// Returns the coefficients of r^4, r^6, ...
std::vector<double> even_terms(const Document& file, const std::string& key) {
  constexpr int kMaxPower = 20;
  std::vector<double> terms;
  for (const auto& row : file.rows(key)) {
    const int power = static_cast<int>(row[0]);
    if (power != row[0] || power % 2 != 0 || power < 4 || power > kMaxPower)
      file.fail(key, fmt::format("must have rows [power, coefficient] with even powers from 4 to {}, got power {}",
                                 kMaxPower, shortest(row[0])));
    const auto index = static_cast<std::size_t>(power / 2 - 2);
    if (terms.size() <= index) terms.resize(index + 1, 0.0);
    terms[index] += row[1];
  }
  return terms;
}

/// Term of a polynomial: two exponents (or two indices of a Zernike term) and a coefficient.
struct Term {
  int i = 0;
  int j = 0;
  double coefficient = 0.0;
};

/// Reads the terms of a polynomial.
/// \param is_signed true if the second number can be negative, down to minus the first number
std::vector<Term> terms_of(const Document& file, const std::string& key, bool is_signed) {
  const auto whole = [&](double value, int low, int high) {
    if (value != std::floor(value) || value < low || value > high)
      file.fail(key, fmt::format("must have whole numbers from {} to {} in front of its coefficients, got {}", low,
                                 high, shortest(value)));
    return static_cast<int>(value);
  };
  std::vector<Term> terms;
  for (const auto& row : file.rows(key)) {
    const int i = whole(row[0], 0, kMaxPolynomialDegree);
    terms.push_back({i, is_signed ? whole(row[1], -i, i) : whole(row[1], 0, kMaxPolynomialDegree), row[2]});
  }
  return terms;
}

XyPolynomial xy_polynomial(const Document& file, const std::string& table) {
  const std::string key = table + ".terms";
  const std::vector<Term> terms = terms_of(file, key, false);
  XyPolynomial p;
  p.scale_mm = file.number(table + ".scale_mm");
  for (const Term& term : terms) p.degree = std::max(p.degree, term.i + term.j);
  if (p.degree > kMaxPolynomialDegree)
    file.fail(key, fmt::format("must have a degree of at most {}, got {}", kMaxPolynomialDegree, p.degree));
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

/// Reads a formula.
/// \param variables names of the variables, in the order in which Formula::evaluate() takes their values
Formula formula_of(const Document& file, const std::string& key, const std::vector<std::string>& variables) {
  return parse_formula(file.text(key), variables, file.where(key));
}

/// Reads the sag of `[base]` or `[lenslets]`.
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

/// Reads the points of a key whose value is a list of rows [x, y].
std::vector<Vec2> read_points(const Document& file, std::string_view key) {
  std::vector<Vec2> points;
  for (const auto& row : file.rows(key)) points.emplace_back(row[0], row[1]);
  return points;
}

/// Reads the curve of `[boundary]`.
/// \pre the table exists
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

/// Returns the points of a hexagonal or square grid that are inside a circle about the origin.
/// \param within radius of the circle
std::vector<Vec2> grid(double pitch, double within, bool hexagonal) {
  const double row_pitch = hexagonal ? pitch * std::sqrt(0.75) : pitch;
  std::vector<Vec2> places;
  const long rows = static_cast<long>(within / row_pitch);
  for (long row = -rows; row <= rows; ++row) {
    const double y = static_cast<double>(row) * row_pitch;
    const double shift = hexagonal && row % 2 != 0 ? 0.5 * pitch : 0.0;
    const long columns = static_cast<long>(within / pitch) + 1;
    for (long column = -columns; column <= columns; ++column) {
      const double x = static_cast<double>(column) * pitch + shift;
      if (std::hypot(x, y) <= within) places.emplace_back(x, y);
    }
  }
  return places;
}

std::vector<Vec2> read_places(const Document& file) {
  if (file.has("lenslets.positions_mm")) return read_points(file, "lenslets.positions_mm");
  const bool hexagonal = file.has("lenslets.hexagonal_pitch_mm");
  const std::string_view key = hexagonal ? "lenslets.hexagonal_pitch_mm" : "lenslets.square_pitch_mm";
  const double pitch = file.number(key);
  const double within = file.number("lenslets.within_mm");
  if (!(within / pitch < std::sqrt(static_cast<double>(kMaxLenslets)) / 2.0))
    file.fail(key, fmt::format("must be large enough for at most {} lenslets, got {}", kMaxLenslets, shortest(pitch)));
  return grid(pitch, within, hexagonal);
}

/// Specification of the boundaries of all lenslets.
struct BoundaryRequest {
  bool is_intersection = false;
  BoundaryOptions options;
  double radius_mm = 0.0;           ///< radius of circles
  double within_mm = 0.0;           ///< radius within which the intersection is searched
  double inner_radius_ratio = 1.0;  ///< radius at which the blend leaves the lenslet, relative to the curve's radius
  double outer_radius_ratio = 1.0;  ///< radius at which the blend reaches the base, relative to the curve's radius
  InputLocation where;
};

BoundaryRequest read_request(const Document& file) {
  const auto number = [&](const char* key) { return file.number_if(schema::path_in("lenslets", key)).value_or(0.0); };
  const double inner = number("inner_radius_ratio");
  const double outer = number("outer_radius_ratio");
  if (!(inner < outer))
    file.fail("lenslets.outer_radius_ratio",
              fmt::format("must be greater than inner_radius_ratio ({}), got {}", shortest(inner), shortest(outer)));
  const BoundaryOptions options = {static_cast<int>(number("degree")), static_cast<int>(number("samples"))};
  return {file.text("lenslets.boundary") == "intersection",
          options,
          number("boundary_radius_mm"),
          number("search_mm"),
          inner,
          outer,
          file.where("lenslets.boundary")};
}

void set_boundaries(Lenslet& lenslet, const FreeformSurface& base, const Vec2& centre, const BoundaryRequest& request) {
  Boundary curve;
  if (request.is_intersection) {
    const auto difference = [&](double x, double y) { return lenslet.evaluate(x, y) - base.height_mm(x, y); };
    curve = boundary_of_intersection(centre, difference, request.within_mm, request.options, request.where);
  } else {
    curve = circle_boundary(centre, request.radius_mm, request.options.degree);
  }
  lenslet.inner = scaled(curve, request.inner_radius_ratio, 0.0, request.where);
  lenslet.outer = scaled(curve, request.outer_radius_ratio, 0.0, request.where);
  check_nested(lenslet.inner, lenslet.outer, request.where);
}

/// Reads the positions of the lenslets, their common sag and their boundaries. The formula of the sag can depend on the
/// position.
std::vector<Lenslet> read_lenslets(const Document& file, const FreeformSurface& base) {
  if (!file.has("lenslets")) return {};
  const std::vector<Vec2> places = read_places(file);
  const Sag sag = read_sag(file, "lenslets");
  const BoundaryRequest request = read_request(file);
  const double height = file.number("lenslets.height_mm");
  const bool tilted = file.flag("lenslets.tilted");
  const int order = static_cast<int>(file.number("lenslets.blend_order"));
  std::vector<Lenslet> lenslets;
  for (const Vec2& place : places) {
    Lenslet lenslet;
    lenslet.sag = sag;
    lenslet.sag.position_mm = {place.x(), place.y()};
    lenslet.blend_order = order;
    place_on_base(lenslet, base, place.x(), place.y(), height, tilted, request.where);
    set_boundaries(lenslet, base, place, request);
    lenslets.push_back(std::move(lenslet));
  }
  return lenslets;
}

std::optional<Extrapolation> read_extrapolation(const Document& file) {
  if (!file.has("boundary")) return std::nullopt;
  return Extrapolation{read_boundary(file), static_cast<int>(file.number("extrapolation.order"))};
}

/// Describes a table whose keys are not checked here, because other functions read them.
constexpr schema::Table left_to_others(std::string_view name) {
  return {.name = name, .meaning = "Manufacture of the part.", .presence = schema::Presence::optional, .is_open = true};
}
constexpr schema::Row kTitle[] = {{"title", schema::Text{}, schema::kNone, "Title of the part, in one line."}};
constexpr schema::Row kRegionRows[] = {kStrategyRow, kRegionRadiusRow, kRegionSizeRow};
constexpr schema::Table kMade[] = {
    left_to_others("tool"),
    {.name = "path", .meaning = "Path of the tool.", .rows = kRegionRows, .is_open = true},
    left_to_others("machine"),
    left_to_others("inspect")};

/// Returns the format of files of turned parts, with only those keys that the functions of this source file read.
const schema::Format& front_format() {
  static const std::vector<schema::Table> tables = [] {
    std::vector<schema::Table> all(surface_tables().begin(), surface_tables().end());
    all.insert(all.end(), std::begin(kMade), std::end(kMade));
    return all;
  }();
  static const schema::Format format = {"turned_part",
                                        kTurnedPartId,
                                        "Freeform surface, turned",
                                        {"", "Surface and region of a turned part.", kTitle, tables}};
  return format;
}

}  // namespace

FreeformSurface read_surface(const Document& file) {
  const Sag base = read_sag(file, "base");
  std::optional<Extrapolation> extrapolation = read_extrapolation(file);
  const FreeformSurface bare(base, extrapolation, {}, file.where("base.kind"));
  return {base, std::move(extrapolation), read_lenslets(file, bare), surface_location(file)};
}

InputLocation surface_location(const Document& file) {
  return file.where(file.has("lenslets") ? "lenslets" : "base");
}

TurnedEntrance parse_turned_entrance(std::string_view text, const std::string& source_name) {
  const Document file = schema::read_document(front_format(), text, source_name);
  TurnedEntrance front{read_surface(file)};
  front.is_round = file.text("path.strategy") == kStrategies[0];
  if (front.is_round)
    front.radius_mm = file.number("path.radius_mm");
  else
    front.size_mm = Vec2(file.numbers("path.size_mm").data());
  check_surface(front.surface, front.is_round ? front.radius_mm : 0.5 * front.size_mm.norm(), surface_location(file));
  return front;
}

}  // namespace retrace::geometry
