#include "fabrication/turning/io/lenslet_tables.h"

#include <fmt/format.h>

#include <cmath>

#include "core/number_format.h"
#include "fabrication/turning/io/sag_tables.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::Vec2;
constexpr std::size_t kMostLenslets = 100000;

/// Centres of a hexagonal or square grid within a circle round the origin.
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

std::vector<Vec2> read_places(TomlTable& table) {
  const int given = static_cast<int>(table.has("positions_mm")) + static_cast<int>(table.has("hexagonal_pitch_mm")) +
                    static_cast<int>(table.has("square_pitch_mm"));
  if (given != 1)
    table.fail("positions_mm", "must be given, or one of hexagonal_pitch_mm and square_pitch_mm instead of it");
  std::vector<Vec2> places;
  if (table.has("positions_mm")) {
    for (const auto& row : table.required_number_rows("positions_mm", 2, kLengthMm))
      places.emplace_back(row[0], row[1]);
  } else {
    const bool hexagonal = table.has("hexagonal_pitch_mm");
    const std::string_view key = hexagonal ? "hexagonal_pitch_mm" : "square_pitch_mm";
    const double pitch = table.required_number(key, kPositiveMm);
    const double within = table.required_number("within_mm", kPositiveMm);
    if (!(within / pitch < std::sqrt(static_cast<double>(kMostLenslets)) / 2.0))
      table.fail(key, fmt::format("must leave at most {} lenslets, got {}", kMostLenslets, shortest(pitch)));
    places = grid(pitch, within, hexagonal);
  }
  if (places.empty() || places.size() > kMostLenslets)
    table.fail("positions_mm", fmt::format("must be 1 to {} places, got {}", kMostLenslets, places.size()));
  return places;
}

/// What is asked of the boundaries of all lenslets.
struct BoundaryRequest {
  bool is_intersection = false;
  BoundaryOptions options;
  double radius_mm = 0.0;    ///< of circles
  double within_mm = 0.0;    ///< search for the intersection
  double inner_share = 1.0;  ///< of the curve's radius, where the blend leaves the lenslet
  double outer_share = 1.0;  ///< where it reaches the base
  InputLocation where;
};

BoundaryRequest read_request(TomlTable& table) {
  static constexpr std::string_view kKinds[] = {"circle", "intersection"};
  BoundaryRequest request;
  request.is_intersection = table.required_choice("boundary", kKinds) == 1;
  request.where = table.where("boundary");
  request.options.degree = static_cast<int>(table.whole("degree", {.low = 2, .high = kMostSplineDegree}).value_or(3));
  if (request.is_intersection) {
    request.within_mm = table.required_number("search_mm", kPositiveMm);
    request.options.samples = static_cast<int>(table.whole("samples", {.low = 16, .high = 4000}).value_or(60));
  } else {
    request.radius_mm = table.required_number("boundary_radius_mm", kPositiveMm);
  }
  request.inner_share = table.required_number("inner_share", {.low = 0.01, .high = 10.0});
  request.outer_share = table.required_number("outer_share", {.low = 0.01, .high = 10.0});
  if (!(request.inner_share < request.outer_share))
    table.fail("outer_share", fmt::format("must be above inner_share, or the boundaries cross, got {} and {}",
                                          shortest(request.inner_share), shortest(request.outer_share)));
  return request;
}

void set_boundaries(Lenslet& lenslet, const TurnedSurface& base, const Vec2& centre, const BoundaryRequest& request) {
  Boundary curve;
  if (request.is_intersection) {
    const auto difference = [&](double x, double y) { return lenslet.evaluate(x, y) - base.height_mm(x, y); };
    curve = boundary_of_intersection(centre, difference, request.within_mm, request.options, request.where);
  } else {
    curve = circle_boundary(centre, request.radius_mm, request.options.degree);
  }
  lenslet.inner = scaled(curve, request.inner_share, 0.0, request.where);
  lenslet.outer = scaled(curve, request.outer_share, 0.0, request.where);
  check_nested(lenslet.inner, lenslet.outer, request.where);
}

}  // namespace

std::vector<Lenslet> read_lenslets(TomlTable& root, const TurnedSurface& base) {
  if (!root.has("lenslets")) return {};
  TomlTable table = root.table("lenslets");
  const std::vector<Vec2> places = read_places(table);
  const Sag sag = read_sag(table, "kind");
  const BoundaryRequest request = read_request(table);
  const double height = table.number("height_mm", kLengthMm).value_or(0.0);
  const bool tilted = table.flag("tilted").value_or(true);
  const int order = static_cast<int>(table.whole("blend_order", {.low = 1, .high = kMostBlendOrder}).value_or(2));
  std::vector<Lenslet> lenslets;
  for (const Vec2& place : places) {
    Lenslet lenslet;
    lenslet.sag = sag;
    lenslet.sag.place_mm = {place.x(), place.y()};
    lenslet.blend_order = order;
    place_on_base(lenslet, base, place.x(), place.y(), height, tilted, request.where);
    set_boundaries(lenslet, base, place, request);
    lenslets.push_back(std::move(lenslet));
  }
  return lenslets;
}

}  // namespace retrace::fabrication::turning
