#pragma once

// From how long programs took to how the axes of the machine speed up and settle. The study behind
// `retrace calibrate --times`.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/warning.h"
#include "fabrication/check/program_time.h"
#include "fabrication/machine/machine.h"

namespace retrace::studies {

/// Moves that are alike: of one of them the time of all follows.
struct AlikeMoves {
  fabrication::NcMotion motion;
  std::int64_t count = 0;
};

/// How long a program took, or some of its lines.
struct TimedMoves {
  int line = 0;         ///< of the table
  std::string program;  ///< as the table has it
  double seconds = 0.0;
  double uncertainty_s = 0.0;  ///< standard
  std::vector<AlikeMoves> moves;
  double dwell_s = 0.0;

  /// As long as that machine takes.
  double on_s(const fabrication::Machine& machine) const;
};

/// Programs of a machine with their times.
struct TimedPrograms {
  std::string file;  ///< of the table, for messages
  std::vector<TimedMoves> rows;
  std::size_t empty_rows = 0;  ///< that have no time yet
};

/// What times tell, in the order of TimeCalibration::quantities.
enum class TimeQuantity : std::uint8_t { settling, linear_acceleration, linear_ramp, rotary_acceleration };
inline constexpr std::size_t kTimeQuantities = 4;

struct TimeQuantityWords {
  std::string_view key;
  std::string_view words;
};
inline constexpr std::array<TimeQuantityWords, kTimeQuantities> kTimeQuantityWords = {{
    {"settling_s", "settling at every exact stop, s"},
    {"linear_acceleration_factor", "accelerations of X, Y and Z, times the file's"},
    {"linear_ramp_s", "until X, Y and Z have their acceleration, s"},
    {"rotary_acceleration_factor", "accelerations of the rotary axes, times the file's"},
}};

struct CalibratedTime {
  bool is_told = false;
  double value = 0.0;  ///< of one that is not told: the file's
  double uncertainty = 0.0;
};

struct TimeCalibration {
  TimedPrograms programs;
  fabrication::Machine nominal;
  fabrication::Machine machine;  ///< the calibrated one
  std::array<CalibratedTime, kTimeQuantities> quantities;
  std::vector<std::string> untold;  ///< quantities that the rows do not tell apart: "settling_s, linear_ramp_s"
  std::vector<double> residuals;    ///< of the rows, in standard uncertainties
  double scatter = 1.0;             ///< root mean square of the residuals, by the rows to spare; 1 without any
  std::size_t freedom = 0;          ///< rows less what is estimated
  Warnings warnings;
};

/// Least squares by Gauss and Newton; neither settling nor ramp falls below 0. Where rows scatter more than their
/// uncertainties say, the uncertainties of what is told are larger by as much. \throw InputError for no rows
TimeCalibration calibrate_times(TimedPrograms programs, const fabrication::Machine& machine);

}  // namespace retrace::studies
