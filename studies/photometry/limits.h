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

/// For what a line of a limits file holds, and where it comes from.
struct LimitLine {
  std::string standard;
  std::vector<std::string> classes;  ///< empty: all, or the standard has none
  std::string colour;                ///< empty: all
  LimitStatus status = LimitStatus::recalled;
  std::string source;  ///< where the values were read; empty: not told
  int line = 0;
};

/// A test point of a limits file. \pre its colour is told
struct LimitRow : LimitLine {
  double observation_deg = 0.0;
  std::vector<double> v_deg;           ///< one, or one of either sign
  std::vector<double> v_beside_deg{};  ///< where it is measured instead if the face mirrors at v_deg; may be empty
  std::vector<double> h_deg;
  double minimum = 0.0;
  PhotometricUnit unit = PhotometricUnit::mcd_per_lx;
};

/// A line that gives the limits of a colour as so many times those of another.
struct LimitFactor : LimitLine {
  double factor = 1.0;
  std::string of_colour;
};

/// A line that says how large a part may be, or must.
struct LimitArea : LimitLine {
  bool is_most = true;  ///< else the least
  double area_cm2 = 0.0;

  bool holds(double part_cm2) const { return is_most ? part_cm2 <= area_cm2 : part_cm2 >= area_cm2; }
  std::string text() const;  ///< "at most 100 cm2"
};

/// A line that bounds the chromaticity of the returned light: of_x x + of_y y <= most.
struct ColourBoundary : LimitLine {
  double observation_deg = 0.0;
  double v_deg = 0.0;
  std::vector<double> v_beside_deg{};  ///< as of a test point
  double h_deg = 0.0;
  double of_x = 0.0, of_y = 0.0, most = 0.0;
  std::string text;  ///< as given: "y <= 0.335"
};

/// A line that marks what the file holds of a standard as not all of it.
struct LimitGap : LimitLine {};

/// A limits file. `clear` is another word for `white`.
struct LimitTable {
  std::string source;  ///< its name
  std::vector<LimitRow> rows;
  std::vector<LimitFactor> factors;
  std::vector<LimitArea> areas;
  std::vector<ColourBoundary> boundaries;
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
  int line = 0;                        ///< of the table
  std::string source = {};             ///< empty: not told
  std::vector<double> v_beside_deg{};  ///< where it is measured instead if the face mirrors at v_deg: the least counts
};

/// What is asked of one class and colour.
struct TestProgramme {
  std::string standard;
  std::string part_class;  ///< empty if the standard has none
  std::string colour;
  std::vector<TestPoint> points;
  std::vector<LimitArea> areas{};
  std::vector<ColourBoundary> boundaries{};  ///< of one geometry; may be none
  bool is_complete = true;                   ///< false: the table does not hold all that the standard asks
};

/// Chooses from a table. \param standard as the table names it; none if the table holds one only
/// \param part_class, colour none if there is only one \throw InputError naming the option and what there is
TestProgramme programme_of(const LimitTable& table, const std::optional<std::string>& standard,
                           const std::optional<std::string>& part_class, const std::optional<std::string>& colour);

}  // namespace retrace::studies
