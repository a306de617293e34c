#pragma once

// Computes coefficients of retroreflection at the test points of a standard, and a verdict.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

/// Settings of a photometric test. They correspond to the options of `retrace photometry` (docs/commands.md). For empty
/// settings, the values of the standard are used.
struct PhotometryRequest {
  std::string standard = {};                   ///< name of a standard, such as "r150", or a limits file
  std::optional<std::string> part_class = {};  ///< class of the part; required if the standard has several classes
  std::optional<std::string> colour = {};      ///< colour of the part; required if the standard has several colours
  /// Area of the whole part, > 0; the design may contain only a section of the part.
  double area_cm2 = 0.0;
  std::optional<std::vector<double>> rotation_deg = {};  ///< rotations of the part about its normal
  std::optional<std::string> dye = {};                   ///< none, red, amber or a file
  std::optional<double> source_arcmin = {};              ///< angular diameter of the source
  std::optional<double> receiver_arcmin = {};            ///< angular diameter of the receiver
  double window_deg = 2.0;                               ///< half angle of the far field that is computed
  std::string light = "a";      ///< a or d65: CIE illuminant, weighted by the eye; design: light of the design
  std::string engine = "auto";  ///< auto, exact, montecarlo or embree
  /// Minimum power of a beam that is followed exactly, as a fraction of the power that falls on one element.
  std::optional<double> cutoff = {};
  std::optional<std::uint64_t> samples = {};  ///< number of rays per direction if rays are traced; empty: 2^20
  std::uint32_t seed = 1;
  bool diffraction = true;
  bool window_power = false;  ///< true: compute the power inside and outside of the far field's window, as a check
  /// True: if a test point fails, search for a change of the design with which all points pass.
  bool advice = true;
  bool pictures = false;  ///< true: make the drawings of the result
};

struct PhotometricPoint {
  double observation_deg = 0.0;
  double v_deg = 0.0, h_deg = 0.0;
  double rotation_deg = 0.0;    ///< rotation of the part at which the value is smallest
  double r_i_mcd_per_lx = 0.0;  ///< coefficient of luminous intensity (CIL)
  double r_a = 0.0;             ///< cd/(lx m^2)
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
  std::string json;     ///< JSON document retrace.photometry/1
  std::string csv;      ///< table with one line for each point
  std::string table;    ///< summary as text
  Drawing far_field;    ///< R_A around the direction to the source; empty unless PhotometryRequest::pictures is true
  Drawing observation;  ///< R_A over the observation angle; empty unless PhotometryRequest::pictures is true
};

/// Computes the coefficients at all test points and compares them with the limits of the standard.
/// \throw InputError; BudgetError if the ray tracer lost power
RETRACE_API PhotometryResult photometry(const Design& design, const PhotometryRequest& request,
                                        const Running& running = {});

}  // namespace retrace
