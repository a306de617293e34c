#pragma once

// Quantities of studies that come from photometric standards, such as the margin to a limit.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "studies/photometry/photometry.h"
#include "studies/quantity/quantity.h"

namespace retrace::studies {

/// What a photometric quantity tells of a test point.
enum class PhotometricFigure {
  margin,          ///< value over limit - 1: >= 0 passes
  r_i_mcd_per_lx,  ///< coefficient of luminous intensity
  r_a              ///< coefficient of retroreflection, cd/(lx m^2)
};

/// A standard as a study asks it of every design. Engine, samples, cut-off and seed are those of the analysis.
struct PhotometricTable {
  std::string key;  ///< tells it from other tables of the study
  PhotometryRequest request;
  /// Without a dye that the study names, that of the colour goes into designs that are not coloured themselves.
  bool dye_unless_coloured = false;
};

/// Which of the values of a table is meant.
struct PhotometricChoice {
  std::optional<std::size_t> point;  ///< of the standard's programme, from 0; none: the least over all
  /// One reading of a test point. If it is not set, the minimum of all readings of the point is used.
  /// `beside` is the index of the angle V. There are several such angles for V = 0, because readings are taken beside
  /// the mirror image of the lamp. For a part without a mirror image, all these angles are equal to V of the point.
  /// `turn` is the index of the rotation of the part.
  struct Reading {
    std::size_t beside = 0;
    std::size_t turn = 0;
  };
  std::optional<Reading> reading;
};

/// Quantities of one table measure a candidate once.
std::shared_ptr<const Quantity> make_photometric(std::string name, std::shared_ptr<const PhotometricTable> table,
                                                 const PhotometricChoice& choice, PhotometricFigure figure);

/// One quantity for each reading of each point, named after point and reading.
Quantities make_photometric_readings(const std::string& name, const std::shared_ptr<const PhotometricTable>& table,
                                     PhotometricFigure figure);

}  // namespace retrace::studies
