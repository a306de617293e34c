#pragma once

// Table of the coefficient of retroreflection over the directions of light and view.

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/angle.h"
#include "geometry/vec.h"

namespace retrace::studies {

/// Linear red, green and blue of IEC 61966-2-1 (sRGB). The values 1, 1, 1 are the colour of the light, CIE D65.
/// Components may be negative, for colours outside the sRGB gamut.
using Rgb = std::array<double, 3>;

/// Returns CIE Y, the luminous component, of linear red, green and blue.
double luminous(const Rgb& rgb);

/// Number of points that determine a cubic polynomial. It is also the number of directions along each side of a cell.
inline constexpr std::size_t kDirectionsPerSide = 4;

/// Table of the coefficient of retroreflection R_A, in cd/(lx m^2), for views close to a central direction. For cube
/// corners, the central direction is the direction to the source. For prisms, it is the direction into which they
/// reflect the light.
/// Let s and o be the x and y components of the unit vectors to source and observer, in the part frame. For each
/// direction of light, the table has a square grid of R_A over the deviation o - back s. Refraction at the entrance
/// face scales all these components by one factor. In these coordinates, R_A therefore varies slowly with the direction
/// of light (docs/theory/appearance.md).
/// Cells divide the range of light directions in entrance angle and azimuth. Each cell has 4 x 4 directions, at its
/// corners and at thirds of its sides. Values between grid points and between directions are interpolated with cubics
/// through four points per axis.
struct ReflectionTable {
  /// Values of R_A for one direction of light. The grid is stored row by row, with ascending y and then ascending x.
  struct Direction {
    Angle entrance;
    Angle azimuth;
    std::vector<Rgb> r_a;
  };
  struct Cell {
    std::array<Angle, 2> entrance;  ///< lower and upper limit
    std::array<Angle, 2> azimuth;
    /// Indices in `directions`, ordered by azimuth and then by entrance angle.
    std::array<std::size_t, kDirectionsPerSide * kDirectionsPerSide> directions{};
  };

  double half_width = 0.0;  ///< half-width of the square of deviations, in components of a unit vector
  std::size_t columns = 0;  ///< number of columns, and of rows; >= 4
  Angle max_entrance;
  /// Signs for x and y: 1 if the part reverses the component of the direction of light along this axis, otherwise -1.
  geometry::Vec2 back = geometry::Vec2::Ones();
  /// Flags for x and y: true if the part is mirror-symmetric along this axis.
  std::array<bool, 2> mirrors{};
  std::vector<Direction> directions;
  std::vector<Cell> cells;

  double step() const { return 2.0 * half_width / static_cast<double>(columns - 1); }
  geometry::Vec2 deviation(std::size_t index) const;
  /// Returns the x and y components of the central direction of view. This is the direction to the source, or for
  /// prisms its mirror image along x or y.
  geometry::Vec2 central_direction(const geometry::Vec3& to_source) const {
    return back.cwiseProduct(to_source.head<2>());
  }
  /// Returns the interpolated value of a grid at a deviation. The deviation must be within the grid.
  Rgb between(const std::vector<Rgb>& grid, const geometry::Vec2& deviation) const;
  /// Returns the range of azimuths that the cells cover. Other azimuths follow from mirror symmetry.
  std::array<Angle, 2> azimuths() const;

  /// Directions of light and their weights, from which the grid for another direction is interpolated.
  struct Weighted {
    /// Signs by which x and y of a deviation are multiplied before the deviation is looked up in the grids of these
    /// directions. -1 mirrors the deviation.
    geometry::Vec2 signs = geometry::Vec2::Ones();
    std::array<std::size_t, kDirectionsPerSide * kDirectionsPerSide> directions{};
    std::array<double, kDirectionsPerSide * kDirectionsPerSide> weights{};
  };
  std::optional<Weighted> at(const geometry::Vec3& to_source) const;
  /// Returns R_A for directions to source and observer in the part frame. Returns nothing outside the table.
  std::optional<Rgb> r_a(const geometry::Vec3& to_source, const geometry::Vec3& to_observer) const;

  /// Calls visit(view, fraction) for every grid point. `view` contains x and y of the view direction. `fraction` is the
  /// fraction of the power from `to_source` that goes into the grid point's part of the square, weighted by the eye's
  /// response: R_A / (cos beta cos nu) times the area of this part.
  /// \pre the table covers the direction `to_source`
  template <class Visit>
  void for_each_power(const geometry::Vec3& to_source, Visit visit) const;
  /// Returns the sum of the fractions of for_each_power(): the fraction of the power that returns within the square.
  /// \pre the table covers the direction `to_source`
  double returned(const geometry::Vec3& to_source) const;
};

template <class Visit>
void ReflectionTable::for_each_power(const geometry::Vec3& to_source, Visit visit) const {
  const Weighted among = at(to_source).value();
  const auto at_border = [&](std::size_t k) { return k == 0 || k + 1 == columns ? 0.5 : 1.0; };
  for (std::size_t place = 0; place < columns * columns; ++place) {
    const geometry::Vec2 view = central_direction(to_source) + deviation(place).cwiseProduct(among.signs);
    if (view.squaredNorm() >= 1.0) continue;
    double r_a = 0.0;
    for (std::size_t k = 0; k < among.directions.size(); ++k)
      r_a += among.weights[k] * luminous(directions[among.directions[k]].r_a[place]);
    const double area = step() * step() * at_border(place % columns) * at_border(place / columns);
    visit(view, area * r_a / (to_source.z() * std::sqrt(1.0 - view.squaredNorm())));
  }
}

}  // namespace retrace::studies
