#include "studies/appearance/light_lattice.h"

#include <algorithm>
#include <cmath>

#include "geometry/direction.h"

namespace retrace::studies {
namespace {

// Maximum extents, in entrance angle and azimuth, of the cells of the table before refinement.
constexpr double kFirstEntranceDeg = 20.0;
constexpr double kFirstAzimuthDeg = 30.0;
// Maximum number of times that a first cell is halved along each of its sides.
constexpr int kMaxHalvings = 8;
// Number of lattice steps along each side of a first cell. With this number, the directions of a cell are lattice
// points even after all halvings.
constexpr int kFirstSize = 3 << kMaxHalvings;

}  // namespace

LightLattice::LightLattice(double entrance_deg, const ReflectionTable& table)
    : entrance_cells_(static_cast<int>(std::ceil(entrance_deg / kFirstEntranceDeg))),
      is_full_circle_(!table.mirrors[0] && !table.mirrors[1]) {
  const std::array<Angle, 2> range = table.azimuths();
  azimuth_cells_ = static_cast<int>(std::ceil((range[1].deg() - range[0].deg()) / kFirstAzimuthDeg - 1e-9));
  first_azimuth_ = range[0];
  entrance_step_ = Angle::from_rad(table.max_entrance.rad() / (entrance_cells_ * kFirstSize));
  azimuth_step_ = Angle::from_rad((range[1].rad() - range[0].rad()) / (azimuth_cells_ * kFirstSize));
}

std::vector<PlannedCell> LightLattice::first_cells() const {
  std::vector<PlannedCell> cells;
  for (int e = 0; e < entrance_cells_; ++e)
    for (int a = 0; a < azimuth_cells_; ++a)
      cells.push_back({{e * kFirstSize, a * kFirstSize}, {kFirstSize, kFirstSize}});
  return cells;
}

std::vector<LatticeIndex> LightLattice::indices_of(const PlannedCell& cell) const {
  std::vector<LatticeIndex> places;
  const int full_circle = azimuth_cells_ * kFirstSize;
  for (int a = 0; a < static_cast<int>(kDirectionsPerSide); ++a)
    for (int e = 0; e < static_cast<int>(kDirectionsPerSide); ++e) {
      const int entrance = cell.corner[0] + e * cell.size[0] / 3;
      const int azimuth = cell.corner[1] + a * cell.size[1] / 3;
      places.emplace_back(entrance, entrance == 0 ? 0 : is_full_circle_ && azimuth == full_circle ? 0 : azimuth);
    }
  return places;
}

geometry::Vec3 LightLattice::to_source(const PlannedCell& cell, double entrance_fraction,
                                       double azimuth_fraction) const {
  return geometry::direction_at(entrance_at(cell.corner[0] + entrance_fraction * cell.size[0]),
                                azimuth_at(cell.corner[1] + azimuth_fraction * cell.size[1]));
}

double LightLattice::min_extent_deg(const std::vector<PlannedCell>& cells) const {
  int least = kFirstSize;
  for (const PlannedCell& cell : cells) least = std::min(least, cell.size[0]);
  return least * entrance_step_.deg();
}

}  // namespace retrace::studies
