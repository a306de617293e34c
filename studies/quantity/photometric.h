#pragma once

// Quantities of studies that are defined by photometric standards, such as the margin to a limit.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "studies/photometry/photometry.h"
#include "studies/quantity/quantity.h"

namespace retrace::studies {

/// Value of a test point that a photometric quantity returns.
enum class PhotometricFigure {
  margin,          ///< value / limit - 1; the point passes if it is >= 0
  r_i_mcd_per_lx,  ///< coefficient of luminous intensity
  r_a              ///< coefficient of retroreflection, cd/(lx m^2)
};

/// Photometric measurement of every design of a study by one standard. Engine, samples, cut-off and seed are those of
/// the analysis.
struct PhotometricTable {
  std::string key;  ///< identifier of the measurement within the study
  PhotometrySettings request;
  /// True if the study names no dye. The dye of the standard's colour then applies to designs without a spectral
  /// absorption of their own.
  bool dye_unless_coloured = false;
};

/// Selection of a value from a table of readings.
struct PhotometricChoice {
  std::optional<std::size_t> point;  ///< index of the test point, from 0; none: the minimum over all points
  /// Selection of one reading of a test point. If it is not set, the minimum of all readings of the point is used.
  /// `v_index` is the index of the angle V. A test point has several such angles if V is 0 and the entrance face
  /// reflects the lamp directly to the receiver there: readings are then taken at angles near 0. For a part without
  /// this mirror image, all these angles are equal to V of the point. `rotation_index` is the index of the rotation of
  /// the part.
  struct Reading {
    std::size_t v_index = 0;
    std::size_t rotation_index = 0;
  };
  std::optional<Reading> reading;
};

/// Returns a photometric quantity. For each candidate, all quantities with the same table share one measurement.
std::shared_ptr<const Quantity> make_photometric(std::string name, std::shared_ptr<const PhotometricTable> table,
                                                 const PhotometricChoice& choice, PhotometricFigure figure);

/// Returns a quantity for each reading of each test point. Names contain the point and the reading.
Quantities make_photometric_readings(const std::string& name, const std::shared_ptr<const PhotometricTable>& table,
                                     PhotometricFigure figure);

}  // namespace retrace::studies
