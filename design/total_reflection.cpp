#include "design/total_reflection.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/direction.h"

namespace retrace::design {
namespace {

/// Largest number of faces of a cell for which all orders of reflections are considered. Ruled cells with more faces
/// are irregular, and light that is reflected by all of them does not return.
constexpr std::size_t kMaxReflectingFaces = 4;

/// Adds the directions of square_directions() for one cell.
void add_square_directions(const geometry::Cell& cell, std::vector<geometry::Vec3>& directions) {
  std::vector<geometry::Vec3> normals;
  for (const geometry::CellFacet& facet : cell.facets)
    if (!facet.is_flat && !facet.is_edge)
      normals.push_back(geometry::Vec3(facet.plane.slope.x(), facet.plane.slope.y(), -1.0).normalized());
  if (normals.empty() || normals.size() > kMaxReflectingFaces) return;
  std::vector<std::size_t> order(normals.size());
  std::iota(order.begin(), order.end(), 0U);
  do {
    Eigen::Matrix3d image = Eigen::Matrix3d::Identity();
    for (const std::size_t k : order) {
      const geometry::Vec3 seen = image * normals[k];
      directions.push_back(seen.z() < 0.0 ? geometry::Vec3(-seen) : seen);
      image = image * (Eigen::Matrix3d::Identity() - 2.0 * normals[k] * normals[k].transpose());
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

/// Returns the directions inside the part from which light is incident normally on a facet. There is one direction for
/// each facet and each order of reflections. A facet that light hits after reflections is replaced by its mirror image,
/// which unreflected light hits at the same angle.
std::vector<geometry::Vec3> square_directions(const geometry::PartSpec& part) {
  std::vector<geometry::Vec3> directions;
  for (const geometry::Cell& cell : geometry::distinct_cells(part.element, part.angle_errors))
    add_square_directions(cell, directions);
  return directions;
}

/// Returns the azimuth from 0 to below 360 degrees. It is rounded so that equivalent facets have equal azimuths.
double azimuth_deg(const geometry::Vec3& direction) {
  const double deg = Angle::from_rad(std::atan2(direction.y(), direction.x())).deg();
  const double rounded = 1e-9 * std::round(1e9 * std::remainder(deg, 360.0));
  return rounded < 0.0 ? rounded + 360.0 : std::abs(rounded);
}

double critical_rad(double index, double back_index) {
  return std::asin(std::min(1.0, back_index / index));
}

/// Range of angles inside the part, for light at one azimuth, at which a facet does not reflect totally.
struct TransmittingRange {
  double from_rad = 0.0;
  double to_rad = 0.0;
};

std::vector<TransmittingRange> shut_out_by(const std::vector<geometry::Vec3>& directions, double critical_angle_rad,
                                           Angle azimuth) {
  const double cos_critical = std::cos(critical_angle_rad);
  const geometry::Vec2 along = geometry::direction_at(azimuth);
  std::vector<TransmittingRange> shut_out;
  for (const geometry::Vec3& direction : directions) {
    const double in_plane = direction.head<2>().dot(along);
    const double size = std::hypot(in_plane, direction.z());
    if (size <= cos_critical) continue;
    const double middle = std::atan2(in_plane, direction.z());
    const double half_width = std::acos(cos_critical / size);
    shut_out.push_back({middle - half_width, middle + half_width});
  }
  return shut_out;
}

}  // namespace

std::optional<double> tir_limit_deg(const geometry::PartSpec& part, double index, double back_index) {
  double least = Angle::from_deg(90.0).rad();
  for (const geometry::Vec3& direction : square_directions(part)) least = std::min(least, std::acos(direction.z()));
  const double inside = least - critical_rad(index, back_index);
  if (!(inside >= 0.0)) return std::nullopt;
  const double sine = index * std::sin(inside);
  return sine >= 1.0 ? 90.0 : Angle::from_rad(std::asin(sine)).deg();
}

double tir_limit_azimuth_deg(const geometry::PartSpec& part) {
  constexpr double rounding = 1e-12;
  double highest = -1.0;
  double azimuth = 0.0;
  for (const geometry::Vec3& direction : square_directions(part)) {
    if (direction.z() < highest - rounding) continue;
    const double here = azimuth_deg(direction);
    if (direction.z() > highest + rounding || here < azimuth) azimuth = here;
    highest = std::max(highest, direction.z());
  }
  return azimuth;
}

std::optional<double> total_reflection_from_deg(const geometry::PartSpec& part, double index, double back_index,
                                                Angle azimuth) {
  constexpr double rounding = 1e-12;
  const std::vector<geometry::Vec3> directions = square_directions(part);
  const std::vector<TransmittingRange> shut_out = shut_out_by(directions, critical_rad(index, back_index), azimuth);
  double inside = 0.0;
  for (bool moved = true; moved;) {
    moved = false;
    for (const auto& [from, to] : shut_out) {
      if (inside <= from + rounding || inside >= to - rounding) continue;
      inside = to;
      moved = true;
    }
  }
  const double sine = index * std::sin(inside);
  const geometry::Vec3 light = geometry::direction_at(Angle::from_rad(inside), azimuth);
  for (const geometry::Vec3& direction : directions)
    if (direction.dot(light) <= 0.0) return std::nullopt;  // the light does not reach all facets
  return sine < 1.0 ? std::optional(Angle::from_rad(std::asin(sine)).deg()) : std::nullopt;
}

std::vector<double> total_reflection_edges_deg(const geometry::PartSpec& part, double index, double back_index,
                                               Angle azimuth) {
  std::vector<double> edges;
  for (const auto& [from, to] : shut_out_by(square_directions(part), critical_rad(index, back_index), azimuth))
    for (const double inside : {from, to}) {
      const double sine = index * std::sin(inside);
      if (std::cos(inside) > 0.0 && std::abs(sine) < 1.0) edges.push_back(Angle::from_rad(std::asin(sine)).deg());
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::vector<double> total_reflection_margins(const geometry::PartSpec& part, const geometry::Vec3& to_source,
                                             double index, double back_index) {
  const geometry::Vec2 across = to_source.head<2>() / index;
  const double along = std::sqrt(std::max(0.0, 1.0 - across.squaredNorm()));
  const double critical = std::cos(critical_rad(index, back_index));
  std::vector<double> margins;
  for (const geometry::Vec3& direction : square_directions(part)) {
    const geometry::Vec2 plan = direction.head<2>();
    const auto add = [&](const geometry::Vec2& turned) {
      margins.push_back(turned.dot(across) + direction.z() * along - critical);
    };
    add(plan);
    if (part.array.arrangement == geometry::Arrangement::triangular) add(-plan);
    if (part.array.arrangement == geometry::Arrangement::checker) add({-plan.y(), plan.x()});
  }
  return margins;
}

}  // namespace retrace::design
