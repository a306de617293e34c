// Tests of quantities that consist of separate readings or directions, whose values can be added for mixtures of cells.
// They are compared with the quantities that are the minimum or the mean of all readings or directions.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "studies/compose/io/compose_reader.h"
#include "studies/quantity/io/study_reader.h"
#include "tests/support/analytic_study.h"
#include "tests/support/refusals.h"

namespace retrace::testing::readings_test {
namespace {

using namespace studies;

/// Returns the values of a study's quantities at its first point.
std::map<std::string, double> measured(const std::string& text) {
  const Study study = parse_study(text, test::kStudies + "study.toml");
  const Candidate candidate = make_candidate(study, example_values(study));
  std::map<std::string, double> values;
  for (const auto& quantity : study.quantities)
    values[quantity->name()] = *quantity->measure(candidate, nullptr)->value;
  return values;
}

std::string reflector(const std::string& turn, const std::string& quantities) {
  return "design = \"../reflex_reflector.toml\"\n[[parameter]]\nkey = \"surface.dihedral_error_arcmin\"\nvalues = "
         "[2]\n[analysis]\ncutoff = 1e-3\nrotation_deg = " +
         turn + "\n" + quantities;
}

std::string photometry(const std::string& name, const std::string& keys) {
  return "[[quantity]]\nkind = \"photometry\"\nname = \"" + name +
         "\"\nstandard = \"r150\"\nclass = \"IA\"\ncolour = \"red\"\narea_cm2 = 30\n" + keys;
}

double least(const std::map<std::string, double>& values, const std::string& stem) {
  double found = INFINITY;
  for (const auto& [name, value] : values)
    if (name.starts_with(stem)) found = std::min(found, value);
  return found;
}

TEST(Readings, OfAPointHaveItsValueAsTheirLeast) {
  const std::string turns = "rotation_deg = [-5, 5]\n";
  const auto values =
      measured(reflector("0", photometry("r", turns + "points = \"each_reading\"\n") +
                                  photometry("p", turns + "points = \"each\"\n") + photometry("w", turns)));
  for (int point = 1; point <= 14; ++point)
    EXPECT_EQ(least(values, "r." + std::to_string(point) + "."), values.at("p." + std::to_string(point))) << point;
  EXPECT_EQ(least(values, "r."), values.at("w"));
  // Two of the points are each measured at both V = 5 and V = -5. Every geometry is measured at two rotations of the
  // part.
  EXPECT_EQ(std::ranges::count_if(values, [](const auto& v) { return v.first.starts_with("r."); }), 12 * 2 + 2 * 4);
}

TEST(Readings, OfATurnedPartAreThoseOfItsTurn) {
  const auto turned = measured(reflector("30", photometry("r", "points = \"each_reading\"\n")));
  const auto asked = measured(reflector("0", photometry("r", "points = \"each_reading\"\nrotation_deg = 30\n")));
  EXPECT_EQ(turned, asked);
}

TEST(Readings, OfRreAreItsDirections) {
  const std::string window = "incidence_deg = [0, 20]\nazimuth_deg = [10, 50]\n";
  const auto rre = [&](const std::string& name, const std::string& over) {
    return "[[quantity]]\nkind = \"rre\"\nname = \"" + name + "\"\nover_directions = \"" + over + "\"\n" + window;
  };
  const auto values = measured(reflector("0", rre("each", "each") + rre("mean", "mean") + rre("least", "min")));
  double sum = 0.0;
  for (int k = 1; k <= 4; ++k) sum += values.at("each." + std::to_string(k));
  EXPECT_NEAR(sum / 4.0, values.at("mean"), 1e-4);
  EXPECT_NEAR(least(values, "each."), values.at("least"), 1e-4);
  // A rotation of the part by 10 degrees has the same effect as a rotation of the light by -10 degrees, from an azimuth
  // of 50 to 40 degrees.
  const auto turned = measured(reflector("10", "[[quantity]]\nkind = \"rre\"\nincidence_deg = 20\nazimuth_deg = 50\n"));
  const auto asked = measured(reflector("0", "[[quantity]]\nkind = \"rre\"\nincidence_deg = 20\nazimuth_deg = 40\n"));
  EXPECT_EQ(turned, asked);
}

TEST(Readings, TellWhatTheyAreOfAndWhatTheLimitIs) {
  const Study study = parse_study(
      reflector("0", photometry("r", "points = \"each_reading\"\nrotation_deg = [-5, 0]\n") +
                         "[[quantity]]\nkind = \"rre\"\nover_directions = \"each\"\nincidence_deg = [0, 20]\n"),
      test::kStudies + "study.toml");
  EXPECT_EQ(study.quantities[0]->label(), "20' V 5 H 0, rotated -5");
  EXPECT_EQ(study.quantities[3]->label(), "20' V -5 H 0");
  EXPECT_EQ(study.quantities[0]->limit()->value, 300.0);
  EXPECT_EQ(study.quantities[0]->limit()->unit, "mcd/lx");
  EXPECT_EQ(study.quantities.back()->label(), "rre.2 incidence 20");
}

TEST(Readings, LeastsAreNoGoalsOfMixtures) {
  for (const std::string& quantity :
       {photometry("g", ""), photometry("g", "points = \"each\"\n"),
        std::string(
            "[[quantity]]\nkind = \"rre\"\nname = \"g\"\nover_directions = \"min\"\nincidence_deg = [0, 9]\n")}) {
    const Study study =
        parse_study(reflector("0", quantity + "[compose]\nmaximize = \"g\"\n"), test::kStudies + "study.toml");
    try {
      read_compose(study);
      FAIL() << quantity;
    } catch (const InputError& error) {
      EXPECT_TRUE(recorded_place_of(error).ends_with(": compose.maximize"));
    }
  }
}

}  // namespace
}  // namespace retrace::testing::readings_test
