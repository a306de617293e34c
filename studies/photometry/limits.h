#pragma once

// Photometric limits with their units and their degree of confirmation, and the test points for one class and colour.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace retrace::studies {

/// Unit of a limit.
enum class PhotometricUnit {
  mcd_per_lx,        ///< R_I
  cd_per_lx,         ///< R_I
  cd_per_fc,         ///< R_I; a foot-candle is a lumen per square foot
  cd_per_lx_per_m2,  ///< R_A
};

/// Degree of confirmation of a limit.
enum class LimitStatus {
  confirmed,  ///< compared with the text of the standard
  read,       ///< found in a secondary source
  recalled    ///< not confirmed by any text
};

std::string_view unit_name(PhotometricUnit unit);
std::string_view status_name(LimitStatus status);

/// Converts a limit to R_I in mcd/lx.
/// \param area_cm2 area of the part; used only for limits of R_A
double in_mcd_per_lx(double value, PhotometricUnit unit, double area_cm2);

/// Scope and source of a line in a limits file.
struct LimitLine {
  std::string standard;
  std::vector<std::string> classes;  ///< empty: all classes, or the standard has no classes
  std::string colour;                ///< empty: all colours
  LimitStatus status = LimitStatus::recalled;
  std::string source;  ///< source of the values; empty: not given
  int line = 0;
};

/// Test point of a limits file. Its colour is always given.
struct LimitRow : LimitLine {
  double observation_deg = 0.0;
  std::vector<double> v_deg;               ///< one angle, or both signs of an angle
  std::vector<double> substitute_v_deg{};  ///< angles that replace v_deg if the face reflects the lamp to the receiver
                                           ///< at v_deg; may be empty
  std::vector<double> h_deg;
  double minimum = 0.0;
  PhotometricUnit unit = PhotometricUnit::mcd_per_lx;
};

/// Line that defines the limits of a colour as multiples of the limits of another colour.
struct LimitFactor : LimitLine {
  double factor = 1.0;
  std::string reference_colour;
};

/// Line that limits the area of a part.
struct LimitArea : LimitLine {
  bool is_maximum = true;  ///< true: maximum; false: minimum
  double area_cm2 = 0.0;

  bool holds(double part_cm2) const { return is_maximum ? part_cm2 <= area_cm2 : part_cm2 >= area_cm2; }
  std::string text() const;  ///< returns a text such as "at most 100 cm2"
};

/// Line that limits the chromaticity (x, y) of the returned light: x_coefficient * x + y_coefficient * y <= limit.
struct ColourBoundary : LimitLine {
  double observation_deg = 0.0;
  double v_deg = 0.0;
  std::vector<double> substitute_v_deg{};  ///< see LimitRow::substitute_v_deg
  double h_deg = 0.0;
  double x_coefficient = 0.0, y_coefficient = 0.0, limit = 0.0;
  std::string text;  ///< text of the limit in the file, such as "y <= 0.335"
};

/// Line that states that the file contains only a part of a standard.
struct LimitGap : LimitLine {};

/// Content of a limits file. The colour `clear` is a synonym of `white`.
struct LimitTable {
  std::string source;  ///< name of the file
  std::vector<LimitRow> rows;
  std::vector<LimitFactor> factors;
  std::vector<LimitArea> areas;
  std::vector<ColourBoundary> boundaries;
  std::vector<LimitGap> gaps;
};

/// Test point: geometry and minimum value.
struct TestPoint {
  double observation_deg = 0.0;
  double v_deg = 0.0;
  double h_deg = 0.0;
  double minimum = 0.0;  ///< minimum value in the unit of the limit
  PhotometricUnit unit = PhotometricUnit::mcd_per_lx;
  LimitStatus status = LimitStatus::recalled;
  int line = 0;             ///< line of the table
  std::string source = {};  ///< source of the value; empty: not given
  /// Angles that replace v_deg if the face reflects the lamp directly to the receiver. The minimum of their readings
  /// counts.
  std::vector<double> substitute_v_deg{};
};

/// Test plan: requirements of a standard for one class and colour.
struct TestPlan {
  std::string standard;
  std::string part_class;  ///< empty if the standard has no classes
  std::string colour;
  std::vector<TestPoint> points;
  std::vector<LimitArea> areas{};
  std::vector<ColourBoundary> boundaries{};  ///< boundaries of the colour, all for one geometry; may be empty
  bool is_complete = true;                   ///< false: the table does not contain all requirements of the standard
};

/// Selects a test plan from a table.
/// \param standard name of the standard in the table; may be omitted if the table has only one
/// \param part_class, colour may be omitted if the standard has only one
/// \throw InputError at the field `standard`, `part_class` or `colour` of PhotometryRequest, with the available names
TestPlan test_plan_of(const LimitTable& table, const std::optional<std::string>& standard,
                      const std::optional<std::string>& part_class, const std::optional<std::string>& colour);

}  // namespace retrace::studies
