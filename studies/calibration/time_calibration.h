#pragma once

// Estimates accelerations, ramps and settling times of a machine's axes from measured program times. `retrace calibrate
// --times` runs this study.

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

/// Move that occurs several times. All occurrences take the same time.
struct RepeatedMove {
  fabrication::NcMotion motion;
  std::int64_t count = 0;
};

/// Measured time of a program, or of some of its lines.
struct TimedMoves {
  int line = 0;         ///< line in the table
  std::string program;  ///< name of the program, as given in the table
  double seconds = 0.0;
  double uncertainty_s = 0.0;  ///< standard uncertainty
  std::vector<RepeatedMove> moves;
  double dwell_s = 0.0;

  /// Returns the time that a machine takes for the moves and dwells.
  double predicted_s(const fabrication::Machine& machine) const;
};

/// Programs of a machine with their measured times.
struct TimedPrograms {
  std::string file;  ///< name of the table, for messages
  std::vector<TimedMoves> rows;
  std::size_t empty_rows = 0;  ///< number of rows without a time
};

/// Quantities that are determined from the run times of programs, in the order of TimeCalibration::quantities.
enum class TimeQuantity : std::uint8_t { settling, linear_acceleration, linear_ramp, rotary_acceleration };
inline constexpr std::size_t kTimeQuantities = 4;

struct TimeQuantityWords {
  std::string_view key;
  std::string_view description;
};
inline constexpr std::array<TimeQuantityWords, kTimeQuantities> kTimeQuantityWords = {{
    {"settling_s", "settling time at every exact stop, s"},
    {"linear_acceleration_factor", "factor on the accelerations of X, Y and Z"},
    {"linear_ramp_s", "time until X, Y and Z reach their acceleration, s"},
    {"rotary_acceleration_factor", "factor on the accelerations of the rotary axes"},
}};

struct CalibratedTime {
  bool is_observable = false;
  double value = 0.0;  ///< estimated value, or the value in the machine file if is_observable is false
  double uncertainty = 0.0;
};

struct TimeCalibration {
  TimedPrograms programs;
  fabrication::Machine nominal;
  fabrication::Machine machine;  ///< calibrated machine
  std::array<CalibratedTime, kTimeQuantities> quantities;
  /// Groups of quantities that the times do not separate, such as "settling_s, linear_ramp_s".
  std::vector<std::string> unobservable;
  std::vector<double> residuals;  ///< residuals of the rows, in standard uncertainties
  /// Square root of the residuals' sum of squares per degree of freedom. 1 if there are no degrees of freedom.
  double scatter = 1.0;
  std::size_t degrees_of_freedom = 0;  ///< degrees of freedom: number of rows minus number of estimated unknowns
  Warnings warnings;
};

/// Estimates the quantities by least squares with Gauss-Newton steps. Settling and ramp have the lower bound 0. If
/// TimeCalibration::scatter is above 1, the residuals are larger than the uncertainties of the rows explain. The
/// uncertainties of the results are then multiplied by this value.
/// \throw InputError if there are no rows
TimeCalibration calibrate_times(TimedPrograms programs, const fabrication::Machine& machine);

}  // namespace retrace::studies
