#pragma once

// Estimates the errors of a machine from height maps of a part that it cut, and predicts the deviations of the next
// part. `retrace correct` runs this study.

#include <string>
#include <vector>

#include "studies/calibration/calibration.h"
#include "studies/calibration/facet_maps.h"

namespace retrace::studies {

/// Maximum deviations of the measured facets.
struct DeviationPrediction {
  double distance_nm = 0.0;  ///< deviation of a facet's centre from the design, along the normal
  double tilt_arcsec = 0.0;  ///< tilt about either axis of the facet
};

struct Correction {
  std::vector<FacetMap> maps;
  std::vector<RegisteredMap> registered;  ///< registrations, in the order of the maps
  Calibration calibration;                ///< calibration in which each map counts as a part
  /// Predicted deviations of the next part if it is cut with the present programs. They are computed for the calibrated
  /// machine, which is the machine with its estimated errors.
  DeviationPrediction before;
  /// Common waves of the facets, the highest first. They are reported, not corrected.
  std::vector<FacetWave> waves;
  std::vector<FacetMark> marks;  ///< common marks of the facets; they are reported, not corrected
  std::size_t facets = 0;        ///< number of facets that were searched for waves and marks
  /// Expected maximum deviations of a part whose programs are made for the calibrated machine: twice the standard
  /// uncertainty of these deviations.
  DeviationPrediction after;
};

/// Returns a description of a wave.
/// \param facets number of facets that were searched
std::string description_of(const FacetWave& wave, std::size_t facets);
std::string description_of(const FacetMark& mark);

/// Registers the maps, calibrates the machine and predicts the deviations of the next part.
/// \throw InputError for maps that fit no position on the part, show no facet or contradict each other
Correction correct(const FabricationResult& plan, std::vector<FacetMap> maps);

}  // namespace retrace::studies
