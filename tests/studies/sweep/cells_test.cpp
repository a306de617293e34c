// Tests of example studies that compare the RRE of different cells over the angle of incidence. The reference values
// were computed independently with many rays.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "studies/quantity/io/study_reader.h"
#include "studies/sweep/sweep.h"
#include "tests/support/analytic_study.h"

namespace retrace::studies::cells_test {
namespace {

/// Returns a quantity of an example study as a function of the angle of incidence.
/// \param only if given, only points with this value of the first parameter
std::map<double, compute::StoredOutput> curve(const std::string& file, std::size_t quantity,
                                              const std::vector<std::string>& overrides = {},
                                              const std::string& only = "",
                                              const std::vector<double>& incidence_deg = {}) {
  Study study = read_study(test::kStudies + file, overrides);
  if (!incidence_deg.empty()) {
    study.parameters.back().values.clear();
    for (const double t : incidence_deg) study.parameters.back().values.push_back(Parameter::value_of(t));
  }
  study.quantities = {study.quantities.at(quantity)};
  const Sweep sweep(std::move(study), Combine::grid, 0);
  compute::ResultStore store("", sweep.layout(), compute::IfExists::refuse);
  run_sweep(sweep, store, nullptr, nullptr);
  std::map<double, compute::StoredOutput> values;
  for (const compute::StoredPoint& point : store.points()) {
    EXPECT_FALSE(point.failed) << point.reason;
    if (only.empty() || point.inputs.front() == compute::StoredValue(only))
      values[std::get<double>(point.inputs.back())] = point.outputs.at(0);
  }
  return values;
}

/// Reference values of the RRE for n = 1.4917, an acceptance of 0.5 degrees, a plate of 1 mm and infinite arrays. They
/// were traced by a different program with many rays, and have errors of half of the last digit and up to 5e-3.
struct Reference {
  double incidence_deg, rtp, full_cube, triangle;
};
constexpr Reference kReference[] = {{0, 1.000, 1.000, 0.919},    {2.5, 0.899, 0.882, 0.649}, {5, 0.422, 0.843, 0.624},
                                    {10, 0.122, 0.759, 0.630},   {15, 0.067, 0.679, 0.614},  {20, 0.057, 0.523, 0.497},
                                    {22.5, 0.049, 0.371, 0.368}, {25, 0.035, 0.280, 0.282},  {30, 0.026, 0.169, 0.178},
                                    {40, 0.019, 0.068, 0.080}};
constexpr double kWithin = 2e-3;

TEST(Cells, FullCubes) {
  const auto rre = curve("cells_hexagonal.toml", 0);
  for (const Reference& at : kReference)
    EXPECT_NEAR(rre.at(at.incidence_deg).value.value(), at.full_cube, kWithin) << at.incidence_deg;
}

TEST(Cells, Triangles) {
  auto rre = curve("cells_triangular.toml", 0);
  // At normal incidence all azimuths are equal, and light is divided into few beams. The exact engine therefore gives
  // the value without noise; up to 2e-4 of the power is truncated.
  rre[0.0] = curve("cells_triangular.toml", 0,
                   {"analysis.engine=exact", "analysis.cutoff=1e-7", "analysis.target_error="}, "", {0.0})
                 .at(0.0);
  for (const Reference& at : kReference)
    EXPECT_NEAR(rre.at(at.incidence_deg).value.value(), at.triangle, kWithin) << at.incidence_deg;
}

TEST(Cells, PrismsAcrossTheirRoof) {
  const auto rre = curve("cells_rtp.toml", 0, {}, "smooth");
  for (const Reference& at : kReference)
    EXPECT_NEAR(rre.at(at.incidence_deg).value.value(), at.rtp, kWithin) << at.incidence_deg;
}

TEST(Cells, TheOrderOfTheCellsIsThatOfTheThesis) {
  const std::vector<double> at = {2.0, 6.0, 15.0, 20.0, 28.0, 40.0};
  const auto rtp = curve("cells_rtp.toml", 0, {}, "smooth", at);
  const auto full = curve("cells_hexagonal.toml", 0, {}, "", at);
  const auto triangle = curve("cells_triangular.toml", 0, {}, "", at);
  EXPECT_GT(rtp.at(2.0).value, full.at(2.0).value) << "prisms lead below about 4 degrees";
  for (const double t : {6.0, 15.0, 20.0}) {
    EXPECT_GT(full.at(t).value, rtp.at(t).value) << t;
    EXPECT_GT(full.at(t).value, triangle.at(t).value) << "full cubes lead to about 20 degrees, at " << t;
  }
  for (const double t : {28.0, 40.0}) EXPECT_GT(triangle.at(t).value, full.at(t).value) << "triangles beyond, at " << t;
}

TEST(Cells, PrismsOverAllAzimuthsLiveByTheirEndWalls) {
  const double t = 20.0;
  const std::vector<std::string> few = {"analysis.samples=4096"};
  const double across = curve("cells_rtp.toml", 0, few, "absorbing", {t}).at(t).value.value();
  const double dull = curve("cells_rtp.toml", 1, few, "absorbing", {t}).at(t).value.value();
  const double smooth = curve("cells_rtp.toml", 1, few, "smooth", {t}).at(t).value.value();
  // A prism reverses the light component across its roof edge and keeps the component along it. The returned light
  // deviates from the source by twice the angle along the edge. Of the 180 azimuths of the mean, only those up to
  // asin(sin 0.25 / sin t) = 0.73 degrees are therefore within the cone.
  constexpr double deg = std::numbers::pi / 180.0;
  const double widest_deg = std::asin(std::sin(0.25 * deg) / std::sin(t * deg)) / deg;
  const double azimuths = std::floor(widest_deg / 0.5 + 0.5);  // azimuths are 0.25, 0.75, ...
  EXPECT_EQ(azimuths, 1.0);
  EXPECT_NEAR(dull, across * azimuths / 180.0, 0.05 * dull);
  // Smooth end walls form cube corners with the facets.
  EXPECT_GT(smooth, 20.0 * dull);
}

}  // namespace
}  // namespace retrace::studies::cells_test
