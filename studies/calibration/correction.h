#pragma once

// From height maps of a part to the machine that cut it, and to what its next part will be. The study behind `retrace
// correct`.

#include <filesystem>
#include <string>
#include <vector>

#include "studies/calibration/calibration.h"
#include "studies/calibration/facet_maps.h"

namespace retrace::studies {

/// What facets that were measured are at most.
struct FacetOutlook {
  double distance_nm = 0.0;  ///< of a facet's middle along its normal
  double tilt_arcsec = 0.0;  ///< either way
};

struct Correction {
  std::vector<FacetMap> maps;
  std::vector<RegisteredMap> registered;  ///< in their order
  Calibration calibration;                ///< its parts are the maps
  FacetOutlook before;                    ///< that the job's programs leave on the calibrated machine
  std::vector<FacetWave> waves;           ///< that facets have, the highest first: told, not corrected
  std::vector<FacetMark> marks;           ///< likewise
  std::size_t facets = 0;                 ///< that are looked at for them
  FacetOutlook after;  ///< twice the standard uncertainty of what programs for the calibrated machine leave
};

/// In words. \param facets that were looked at
std::string words_of(const FacetWave& wave, std::size_t facets);
std::string words_of(const FacetMark& mark);

/// \throw InputError for maps that lie nowhere on the part, show no facet or contradict each other
Correction correct(const FabricationResult& plan, std::vector<FacetMap> maps);

}  // namespace retrace::studies
