#include "fabrication/chisel/check/cavity.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/angle.h"
#include "core/overloaded.h"
#include "fabrication/job/cube_corner.h"
#include "geometry/centroid.h"
#include "geometry/elements/element_cells.h"

namespace retrace::fabrication {

using geometry::Vec3;

namespace {

/// Moves an element from its local frame to its position and orientation on the blank. The local frame is that of an
/// element on a flat blank, with the origin at the centre of its aperture.
void stand(DesignElement& design, const CutElement& element, double stock_mm) {
  design.zone = element.zone;
  design.axis = element.workpiece_from_element.col(2);
  design.face_mm = design.axis.dot(element.origin_mm) + stock_mm;
  design.stock_mm = stock_mm;
  design.root_mm = element.origin_mm + element.workpiece_from_element * design.root_mm;
  for (DesignFacet& facet : design.facets) {
    facet.normal = element.workpiece_from_element * facet.normal;
    facet.up_slope = element.workpiece_from_element * facet.up_slope;
    facet.offset_mm = facet.normal.dot(design.root_mm);
  }
}

/// Returns the distance of a point from the axis of an element, or nothing if the point is outside of the aperture. For
/// prisms, the distance is always 0, because their apertures do not overlap.
/// \param from_root position relative to the root, perpendicular to the axis
std::optional<double> distance_mm(const PrismGroove& groove, const Vec3& from_root) {
  const double along = groove.root_direction.dot(from_root);
  const double across = (from_root - groove.root_direction * along).norm();
  const bool is_inside = std::abs(along) <= groove.half_width_mm && across <= groove.half_base_mm;
  return is_inside ? std::optional(0.0) : std::nullopt;
}
std::optional<double> distance_mm(const CubeCavity& cavity, const Vec3& from_root) {
  const double distance_mm = from_root.norm();
  return distance_mm > cavity.radius_mm ? std::nullopt : std::optional(distance_mm);
}

}  // namespace

double CubeCavity::height_mm(const geometry::Vec2& point) const {
  const geometry::Vec2 from_apex = point - root_mm.head<2>();
  double height_mm = root_mm.z();
  for (const DesignFacet& facet : facets)
    height_mm = std::max(height_mm, root_mm.z() - facet.normal.head<2>().dot(from_apex) / facet.normal.z());
  return height_mm;
}

double half_size_mm(const Cavity& groove) {
  return std::visit(
      Overloaded{[](const PrismGroove& prism) { return std::max(prism.half_base_mm, prism.half_width_mm); },
                 [](const CubeCavity& cavity) { return cavity.radius_mm; }},
      groove);
}

std::vector<Vec3> facet_corners(const Cavity& groove, std::size_t facet) {
  const Vec3& root_mm = common(groove).root_mm;
  return std::visit(Overloaded{[&](const PrismGroove& prism) -> std::vector<Vec3> {
                                 const Vec3 up = prism.facet_length_mm * prism.facets[facet].up_slope;
                                 const Vec3 along = prism.half_width_mm * prism.root_direction;
                                 return {root_mm - along, root_mm + along, root_mm + up + along, root_mm + up - along};
                               },
                               [&](const CubeCavity& cavity) -> std::vector<Vec3> {
                                 const std::size_t next = (facet + 1) % 3;
                                 return {root_mm, root_mm + cavity.edge_length_mm(facet) * cavity.edges[facet],
                                         root_mm + cavity.edge_length_mm(next) * cavity.edges[next]};
                               }},
                    groove);
}

Vec3 facet_centre(const Cavity& groove, std::size_t facet) {
  return geometry::centroid(std::span<const Vec3>(facet_corners(groove, facet)));
}

PrismGroove groove_of(const CutElement& element, const geometry::RtpElement& size, double stock_mm) {
  const double half_apex = 0.5 * Angle::from_deg(size.apex_angle_deg).rad();
  const Vec3 across = element.rotated ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  PrismGroove groove;
  groove.half_base_mm = 0.5 * size.base_mm;
  groove.half_width_mm = 0.5 * size.width_mm;
  groove.facet_length_mm = groove.half_base_mm / std::sin(half_apex);
  groove.depth_mm = groove.half_base_mm / std::tan(half_apex);
  groove.root_mm = {0.0, 0.0, -groove.depth_mm};
  groove.root_direction = element.workpiece_from_element * (element.rotated ? Vec3(0, 1, 0) : Vec3(1, 0, 0));
  groove.facets.resize(2);
  for (std::size_t f = 0; f < 2; ++f) {
    // The first facet is on the positive side of the root, seen along `across`. Its normal points to the negative side.
    const double side = f == 0 ? 1.0 : -1.0;
    DesignFacet& facet = groove.facets[f];
    facet.normal = -side * std::cos(half_apex) * across + std::sin(half_apex) * Vec3::UnitZ();
    facet.up_slope = side * std::sin(half_apex) * across + std::cos(half_apex) * Vec3::UnitZ();
    facet.along = groove.root_direction;
  }
  stand(groove, element, stock_mm);
  return groove;
}

CubeCavity cavity_of(const CutElement& element, const geometry::Element& size, const geometry::AngleErrors& errors,
                     double stock_mm) {
  const CubeCorner corner = cube_corner(size, errors, element.rotated);
  CubeCavity cavity;
  cavity.depth_mm = corner.depth_mm;
  cavity.root_mm = {0.0, 0.0, -cavity.depth_mm};
  cavity.facet_length_mm = std::numbers::sqrt3 * cavity.depth_mm;
  cavity.radius_mm = geometry::element_cell(size).outline.front().norm();
  cavity.is_hexagonal = std::holds_alternative<geometry::HexagonalCube>(size);
  cavity.layer_rise = corner.layer_rise();
  for (std::size_t k = 0; k < 3; ++k) cavity.edges[k] = element.workpiece_from_element * corner.edges[k];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    DesignFacet facet;
    facet.normal = corner.normals[k];
    facet.up_slope = (corner.edges[k] + corner.edges[next]).normalized();
    facet.along = (cavity.edges[next] - cavity.edges[k]).normalized();
    cavity.facets.push_back(facet);
  }
  stand(cavity, element, stock_mm);
  return cavity;
}

Cavity groove_of(const CutElement& element, const Job& job, double stock_mm) {
  const geometry::Element size = blank_element(job, element.zone);
  const auto* const prism = std::get_if<geometry::RtpElement>(&size);
  if (prism != nullptr) return groove_of(element, *prism, stock_mm);
  return cavity_of(element, size, angle_errors_of(job, element.zone), stock_mm);
}

std::vector<Cavity> designed_cavities(const Job& job) {
  std::vector<Cavity> grooves;
  for (const CutElement& element : cut_elements(job)) grooves.push_back(groove_of(element, job));
  return grooves;
}

CavityMap::CavityMap(const std::vector<Cavity>& grooves) : cavities_(grooves) {
  for (const Cavity& groove : grooves) {
    // Seen along Z, the aperture of an inclined element is displaced from its root, so more cells must be searched.
    if (common(groove).axis != Vec3::UnitZ()) cells_around_ = 3;
    cell_mm_ = std::max(cell_mm_ == 1.0 ? 0.0 : cell_mm_, half_size_mm(groove));
  }
  cells_.reserve(grooves.size());
  for (std::size_t i = 0; i < grooves.size(); ++i) {
    const Vec3& root_mm = common(grooves[i]).root_mm;
    cells_.emplace(cell_of(root_mm.x(), root_mm.y(), 0, 0), i);
  }
}

CavityMap::Cell CavityMap::cell_of(double x_mm, double y_mm, int dx, int dy) const {
  constexpr double furthest = 1e9;  // limit that keeps the positions of faulty programs within the range of Cell
  const auto index = [&](double v) {
    return static_cast<Cell>(std::floor(std::clamp(v / cell_mm_, -furthest, furthest)));
  };
  return (index(x_mm) + dx) * (Cell{1} << 32) + index(y_mm) + dy;
}

std::optional<std::size_t> CavityMap::at(const Vec3& p) const {
  std::optional<std::size_t> nearest;
  double least_mm = 0.0;
  for (int dx = -cells_around_; dx <= cells_around_; ++dx)
    for (int dy = -cells_around_; dy <= cells_around_; ++dy) {
      const auto [first, last] = cells_.equal_range(cell_of(p.x(), p.y(), dx, dy));
      for (auto entry = first; entry != last; ++entry) {
        const DesignElement& element = common(cavities_[entry->second]);
        Vec3 from_root = p - element.root_mm;
        from_root -= element.axis * element.axis.dot(from_root);
        const auto distance =
            std::visit([&](const auto& groove) { return distance_mm(groove, from_root); }, cavities_[entry->second]);
        if (!distance || (nearest && *distance >= least_mm)) continue;
        nearest = entry->second;
        least_mm = *distance;
        if (least_mm == 0.0) return nearest;
      }
    }
  return nearest;
}

std::optional<std::size_t> CavityMap::deepest(double x_mm, double y_mm) const {
  if (cavities_.empty() || std::holds_alternative<PrismGroove>(cavities_.front())) return at(x_mm, y_mm);
  // The cavity of a hexagonal element extends from its apex by up to twice the radius of the aperture, which is two
  // cells.
  constexpr int kCells = 2;
  std::optional<std::size_t> best;
  double lowest_mm = 0.0;
  for (int dx = -kCells; dx <= kCells; ++dx)
    for (int dy = -kCells; dy <= kCells; ++dy) {
      const auto [first, last] = cells_.equal_range(cell_of(x_mm, y_mm, dx, dy));
      for (auto entry = first; entry != last; ++entry) {
        const double height_mm = std::get<CubeCavity>(cavities_[entry->second]).height_mm({x_mm, y_mm});
        if (height_mm >= lowest_mm) continue;
        lowest_mm = height_mm;
        best = entry->second;
      }
    }
  return best;
}

}  // namespace retrace::fabrication
