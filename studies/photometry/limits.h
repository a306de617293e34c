#pragma once

// Photometric limits as data, with their units and how well each is confirmed, and the test points of one class and
// colour.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace retrace::studies {

/// In what a limit is given.
enum class PhotometricUnit {
  mcd_per_lx,        ///< R_I
  cd_per_lx,         ///< R_I
  cd_per_fc,         ///< R_I; a foot-candle is a lumen per square foot
  cd_per_lx_per_m2,  ///< R_A
};

/// How well a limit is confirmed.
enum class LimitStatus {
  confirmed,  ///< checked against the standard's text
  read,       ///< seen in a secondary source
  recalled    ///< not confirmed against the standard's text
};

std::string_view unit_name(PhotometricUnit unit);
std::string_view status_name(LimitStatus status);

/// A limit as R_I in mcd/lx. \param area_cm2 of the part; matters to R_A alone
double in_mcd_per_lx(double value, PhotometricUnit unit, double area_cm2);

/// One line of a limits file.
struct LimitRow {
  std::string standard;
  std::vector<std::string> classes;  ///< empty: the standard has none
  std::string colour;
  double observation_deg = 0.0;
  std::vector<double> v_deg;  ///< one, or one of either sign
  std::vector<double> h_deg;
  double minimum = 0.0;
  PhotometricUnit unit = PhotometricUnit::mcd_per_lx;
  LimitStatus status = LimitStatus::recalled;
  int line = 0;
};

/// A line that gives the limits of a colour as so many times those of another.
struct LimitFactor {
  std::string standard;
  std::vector<std::string> classes;
  std::string colour;
  double factor = 1.0;
  std::string of_colour;
  LimitStatus status = LimitStatus::recalled;
  int line = 0;
};

/// A line that marks what the file holds of a standard as not all of it.
struct LimitGap {
  std::string standard;
  std::vector<std::string> classes;  ///< empty: all
  std::string colour;                ///< empty: all
  int line = 0;
};

/// A limits file. `clear` is another word for `white`.
struct LimitTable {
  std::string source;  ///< its name
  std::vector<LimitRow> rows;
  std::vector<LimitFactor> factors;
  std::vector<LimitGap> gaps;
};

/// A test point: one geometry and the least value there.
struct TestPoint {
  double observation_deg = 0.0;
  double v_deg = 0.0;
  double h_deg = 0.0;
  double minimum = 0.0;  ///< in its unit
  PhotometricUnit unit = PhotometricUnit::mcd_per_lx;
  LimitStatus status = LimitStatus::recalled;
  int line = 0;  ///< of the table
};

/// What is asked of one class and colour.
struct TestProgramme {
  std::string standard;
  std::string part_class;  ///< empty if the standard has none
  std::string colour;
  std::vector<TestPoint> points;
  bool is_complete = true;  ///< false: the table does not hold all that the standard asks
};

/// Chooses from a table. \param standard as the table names it; none if the table holds one only
/// \param part_class, colour none if there is only one \throw InputError naming the option and what there is
TestProgramme programme_of(const LimitTable& table, const std::optional<std::string>& standard,
                           const std::optional<std::string>& part_class, const std::optional<std::string>& colour);

}  // namespace retrace::studies
