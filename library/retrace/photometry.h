#pragma once

// Computes coefficients of retroreflection at the test points of a standard, and a verdict.

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
};

/// Computes the coefficients at all test points and compares them with the limits of the standard.
/// \throw InputError
/// \throw BudgetError if the ray tracer lost power
RETRACE_API PhotometryResult photometry(const Design& design, const PhotometryRequest& request,
                                        const Running& running = {});

}  // namespace retrace
