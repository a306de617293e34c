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

/// \param point of the standard's programme, from 0; none: the least over all
/// Quantities of one table measure a candidate once.
std::shared_ptr<const Quantity> make_photometric(std::string name, std::shared_ptr<const PhotometricTable> table,
                                                 std::optional<std::size_t> point, PhotometricFigure figure);

}  // namespace retrace::studies
