#pragma once

// Computes coefficients of retroreflection at the test points of a standard, and a verdict.

#include <cstddef>
#include <string>
#include <vector>

#include "core/warning.h"
#include "requests/photometry.h"
#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

struct PhotometricPoint {
  double observation_deg = 0.0;
  double v_deg = 0.0, h_deg = 0.0;
  double rotation_deg = 0.0;    ///< rotation of the part at which the value is smallest
  double r_i_mcd_per_lx = 0.0;  ///< coefficient of luminous intensity (CIL)
  double r_a = 0.0;             ///< coefficient of retroreflection R_A, in cd/(lx m^2)
  double std_error_mcd_per_lx = 0.0;
  double limit_mcd_per_lx = 0.0;
  std::string verdict;  ///< pass, unconfirmed, undetermined or fail
};

/// R_A over entrance and observation angle, for one design, rotation and presentation angle.
struct CoefficientMap {
  std::size_t design = 0;            ///< 0: the design; 1: the compared design
  double rotation_deg = 0.0;         ///< rotation of the part about its normal
  double presentation_deg = 0.0;     ///< angle about the direction to the source; 0: observer on the side of the normal
  std::vector<double> entrance_deg;  ///< ascending
  std::vector<double> observation_deg;         ///< ascending
  std::vector<std::vector<double>> r_a;        ///< in cd/(lx m^2), with the indices [entrance][observation]
  std::vector<std::vector<double>> std_error;  ///< as `r_a`
};

struct PhotometryResult {
  std::vector<PhotometricPoint> points;
  std::string verdict;
  bool passes = false;  ///< true if all points and the area pass and the colour does not fail
  Warnings warnings;
  bool complete = true;
  std::string json;     ///< JSON document retrace.photometry/2
  std::string csv;      ///< table with one line for each point
  std::string table;    ///< summary as text
  Drawing far_field;    ///< R_A around the direction to the source; empty unless PhotometryRequest::pictures is true
  Drawing observation;  ///< R_A over the observation angle; empty unless PhotometryRequest::pictures is true
  /// Maps over entrance and observation angle; empty unless PhotometryRequest::map is true and the run is complete.
  std::vector<CoefficientMap> maps;
  Drawing map;        ///< the maps, of R_A or of R_I if the standard limits R_I; empty if there are none
  Drawing map_ratio;  ///< ratio of the compared design to the design; empty unless there are two designs
};

/// Computes the coefficients at all test points and compares them with the limits of the standard.
/// \throw InputError
/// \throw BudgetError if the ray tracer lost power
RETRACE_API PhotometryResult photometry(const Design& design, const PhotometryRequest& request,
                                        const Running& running = {});

/// Computes the results of the first design, the maps of both designs, and the ratio of the second maps to the first.
/// \throw InputError if PhotometryRequest::map is false
/// \throw InputError, BudgetError in the same cases as the function for one design
RETRACE_API PhotometryResult photometry(const Design& design, const Design& compared, const PhotometryRequest& request,
                                        const Running& running = {});

}  // namespace retrace
