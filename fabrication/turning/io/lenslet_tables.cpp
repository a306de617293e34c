#include "fabrication/turning/io/lenslet_tables.h"

#include <fmt/format.h>

#include <cmath>

#include "core/number_format.h"
#include "fabrication/turning/io/part_files.h"
#include "fabrication/turning/io/sag_tables.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::Vec2;
using schema::Document;

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

std::vector<Vec2> read_places(const Document& file) {
  if (file.has("lenslets.positions_mm")) return read_points(file, "lenslets.positions_mm");
  const bool hexagonal = file.has("lenslets.hexagonal_pitch_mm");
  const std::string_view key = hexagonal ? "lenslets.hexagonal_pitch_mm" : "lenslets.square_pitch_mm";
  const double pitch = file.number(key);
  const double within = file.number("lenslets.within_mm");
  if (!(within / pitch < std::sqrt(static_cast<double>(kMostLenslets)) / 2.0))
    file.fail(key, fmt::format("must leave at most {} lenslets, got {}", kMostLenslets, shortest(pitch)));
  return grid(pitch, within, hexagonal);
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

BoundaryRequest read_request(const Document& file) {
  const auto number = [&](const char* key) { return file.number_if(schema::path_in("lenslets", key)).value_or(0.0); };
  const double inner = number("inner_share");
  const double outer = number("outer_share");
  if (!(inner < outer))
    file.fail("lenslets.outer_share", fmt::format("must be above inner_share, or the boundaries cross, got {} and {}",
                                                  shortest(inner), shortest(outer)));
  const BoundaryOptions options = {static_cast<int>(number("degree")), static_cast<int>(number("samples"))};
  return {file.text("lenslets.boundary") == "intersection",
          options,
          number("boundary_radius_mm"),
          number("search_mm"),
          inner,
          outer,
          file.where("lenslets.boundary")};
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

std::vector<Lenslet> read_lenslets(const Document& file, const TurnedSurface& base) {
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
    lenslet.sag.place_mm = {place.x(), place.y()};
    lenslet.blend_order = order;
    place_on_base(lenslet, base, place.x(), place.y(), height, tilted, request.where);
    set_boundaries(lenslet, base, place, request);
    lenslets.push_back(std::move(lenslet));
  }
  return lenslets;
}

}  // namespace retrace::fabrication::turning
