#pragma once

// Coefficients of retroreflection at the test points of a standard, and the verdict.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/running.h"

namespace retrace {

/// What is asked, as the options of `retrace photometry` (docs/commands.md). What is not given is as the standard asks.
struct PhotometryRequest {
  std::string standard = {};                   ///< such as r150, or a limits file
  std::optional<std::string> part_class = {};  ///< needed where the standard has several
  std::optional<std::string> colour = {};      ///< likewise
  double area_cm2 = 0.0;                       ///< of the part, > 0; the design shows its make
  std::optional<std::vector<double>> rotation_deg = {};
  std::optional<std::string> dye = {};         ///< none, red, amber or a file
  std::optional<double> source_arcmin = {};    ///< diameter of the source
  std::optional<double> receiver_arcmin = {};  ///< of the receiver
  double window_deg = 2.0;                     ///< half angle of the far field that is computed
  std::string light = "a";                     ///< a, d65: a CIE illuminant as the eye sees it; design: the design's
  std::string engine = "auto";                 ///< auto, exact, montecarlo or embree
  std::optional<double> cutoff = {};           ///< least power that is followed, as a share of what falls on an element
  std::optional<std::uint64_t> samples = {};   ///< number of rays per direction of the Monte Carlo engine; empty: 2^20
  std::uint32_t seed = 1;
  bool diffraction = true;
  bool window_power = false;  ///< power in the far field's window and outside of it, as a check
  bool advice = true;         ///< what to change if a point fails
  bool pictures = false;      ///< the drawings of the result
};

struct PhotometricPoint {
  double observation_deg = 0.0;
  double v_deg = 0.0, h_deg = 0.0;
  double rotation_deg = 0.0;    ///< at which the value is least
  double r_i_mcd_per_lx = 0.0;  ///< coefficient of luminous intensity (CIL)
  double r_a = 0.0;             ///< cd/(lx m^2)
  double std_error_mcd_per_lx = 0.0;
  double limit_mcd_per_lx = 0.0;
  std::string verdict;  ///< pass, unconfirmed, undetermined or fail
};

struct PhotometryResult {
  std::vector<PhotometricPoint> points;
  std::string verdict;
  bool passes = false;  ///< every point and the area, and the colour is none that fails
  std::vector<std::string> warnings;
  bool complete = true;
  std::string json;     ///< document retrace.photometry/1
  std::string csv;      ///< one line a point
  std::string table;    ///< for people
  Drawing far_field;    ///< R_A round the direction back to the source; none unless pictures were asked for
  Drawing observation;  ///< R_A over the observation angle, likewise
};

/// \throw InputError, BudgetError if power was lost
RETRACE_API PhotometryResult photometry(const Design& design, const PhotometryRequest& request,
                                        const Running& running = {});

}  // namespace retrace
