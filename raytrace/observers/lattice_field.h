#pragma once

// Diffraction orders of an infinite array whose cells interfere.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/progress.h"
#include "geometry/vec.h"
#include "raytrace/light/aperture_kernel.h"
#include "raytrace/observers/cell_interference.h"
#include "raytrace/observers/coherent_group.h"
#include "raytrace/observers/field_lanes.h"

namespace retrace::raytrace {

/// Light of an array in its diffraction orders (docs/theory/coherence_between_cells.md).
///
/// The fields of all cells of one period are added with their positions. A perfect array returns light only in its
/// orders, whose directions q fulfil k (q + s) = G. Here q and s are the direction cosines of the order and of the
/// source, and G is a vector of the reciprocal lattice. Random differences between cells reduce the power of an order
/// to the coherent fraction. The remaining light is diffuse and has the intensities of the cells, which this class does
/// not contain.
///
/// If the source moves by d, an order moves by -d. The pattern of a cell moves with the source, so that the power of
/// the order changes. Both are taken into account in averages over the discs of source and receiver.
class LatticeField {
 public:
  struct Setting {
    Eigen::Matrix2d periods_mm;  ///< columns: two vectors that span a period
    geometry::Vec2 source_cosines;
    double wavelength_mm = 0.0;
    Eigen::Matrix2cd coherency;        ///< coherency matrix of the incident light along the axes of the source
    double coherence_length_mm = 0.0;  ///< light whose paths differ by more does not interfere
    CellInterference cells;
  };

  /// \param groups light of the cells; groups of resampled beams are ignored
  /// \pre CoherentGroup::positions_mm is set
  LatticeField(const Setting& setting, const std::vector<CoherentGroup>& groups);

  /// Returns the fraction of the diffracted light that is coherent between cells, in one direction.
  double coherent_fraction(const geometry::Vec2& cosines) const;

  /// Returns the intensity per steradian of all orders, averaged over the discs of source and receiver and over the
  /// band of wavelengths. Returns an invalid value if the computation was cancelled. \param cosines direction cosines
  /// of the centre of the receiver \param cosines_per_rad derivatives of the direction cosines with respect to two
  /// angles that rotate the direction
  double per_sr(const geometry::Vec2& cosines, const Eigen::Matrix2d& cosines_per_rad, const ApertureKernel& kernel,
                const Cancellation* cancel) const;

  struct Order {
    geometry::Vec2 cosines;
    double power = 0.0;  ///< fraction of the incident power
  };
  enum class Light { band, single_wavelength };
  /// Returns the orders within a distance of a direction, in the plane of direction cosines, for a point source. It
  /// includes orders beyond the horizon.
  /// \param light `band`: each order is repeated at several wavelengths of the band, which share its power
  std::vector<Order> orders_near(const geometry::Vec2& centre, double radius, Light light,
                                 const Cancellation* cancel) const;
  /// Returns the power of all orders outside of a distance from a direction. The power of a large number of orders is
  /// computed as an integral over directions.
  /// \pre the circle contains many orders
  double power_beyond(const geometry::Vec2& centre, double radius, const Cancellation* cancel) const;
  /// Returns the largest radius for which orders_near() returns at most this number of orders at a single wavelength.
  double radius_of_orders(double count) const;

 private:
  /// A plane wave through a polygon.
  struct Wave {
    field_lanes::Outline outline;
    geometry::Vec2 cosines;
    geometry::Vec2 entry_mm;  ///< entry point of the light that leaves at the reference point, relative to this point
    Eigen::Matrix2d entry_slope;
    double path_mm = 0.0;  ///< optical path relative to that of the cell
  };
  /// Light of equal cells that follows paths of nearly equal length.
  struct Cell {
    std::vector<Wave> waves;
    std::vector<geometry::Vec2> positions_mm;
    double path_mm = 0.0;
  };
  /// Cells whose light interferes.
  struct Class {
    std::vector<Cell> cells;
    std::vector<field_lanes::Use> uses;  ///< one for each wave, in the order of the cells
  };
  /// Argument of the field of a period.
  struct Node {
    geometry::Vec2 g_per_mm;      ///< k (q + s) in radians per mm
    geometry::Vec2 source_shift;  ///< displacement of the source, in direction cosines
  };

  std::vector<double> period_power(std::span<const Node> nodes, double wavelength_mm, const Cancellation* cancel) const;
  std::vector<double> wavelengths_mm(double shift_of_band, double step) const;
  /// Calls visit(direction cosines, reciprocal lattice vector) for all orders in a parallelogram that contains a
  /// circle.
  template <class Visit>
  void for_each_order(const geometry::Vec2& centre, double radius, double wavelength_mm, const Visit& visit) const;

  Setting setting_;
  std::array<double, 4> coherency_{};
  std::vector<Class> classes_;
  double extent_mm_ = 0.0;  ///< largest extent of the light of a cell
};

}  // namespace retrace::raytrace
