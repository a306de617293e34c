// Tests of compositions of traced cells: comparison with an exhaustive search over a grid and with `optimise`. The
// designs that are written for the zones are also traced.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "design/io/design_reader.h"
#include "studies/compose/compose.h"
#include "studies/compose/io/compose_reader.h"
#include "studies/compose/io/zone_designs.h"
#include "studies/optimise/io/optimise_reader.h"
#include "studies/quantity/io/study_reader.h"

namespace retrace::testing::real_cells_test {
namespace {

using namespace studies;

constexpr std::size_t kGoals = 4;
using Goals = std::array<double, kGoals>;

/// Returns a study of canted, rotated cube corners. The goals are the RRE at an incidence of 35 degrees, for several
/// azimuths.
Study study_of_corners(const std::string& keys) {
  return parse_study(
      "design = \"../honeycomb_infinite.toml\"\n"
      "[[parameter]]\nkey = \"element.cant_deg\"\nname = \"cant\"\nfrom = 0\nto = 12\n"
      "[[parameter]]\nkey = \"analysis.rotation_deg\"\nname = \"turn\"\nfrom = 0\nto = 360\n"
      "[[quantity]]\nkind = \"rre\"\nname = \"g\"\nover_directions = \"each\"\n"
      "incidence_deg = 35\nazimuth_deg = [0, 60, 120, 210]\n"
      "[analysis]\nengine = \"exact\"\ncutoff = 1e-2\n" +
          keys,
      std::string(RETRACE_SOURCE_DIR) + "/examples/studies/study.toml");
}

Composition composed(const Study& study) {
  compute::ResultStore store("", compose_layout(study), compute::IfExists::refuse);
  return compose(study, read_compose(study), store, nullptr, nullptr);
}

Goals goals_of(const Study& study, const Candidate& candidate) {
  Goals goals{};
  for (std::size_t k = 0; k < kGoals; ++k) goals[k] = *study.quantities[k]->measure(candidate, nullptr)->value;
  return goals;
}

/// Returns the maximum of the smallest goal over all mixtures of three cells, in steps of a twentieth of the area.
double best_in_twentieths(const Goals& a, const Goals& b, const Goals& c) {
  double best = 0.0;
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; i + j <= 20; ++j) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < kGoals; ++k)
        least = std::min(least, (i * a[k] + j * b[k] + (20 - i - j) * c[k]) / 20.0);
      best = std::max(best, least);
    }
  return best;
}

/// A study and its composition.
struct Composed {
  Study study;
  Composition composition;
};

/// Returns a composition of up to three zones. It is computed only one time, because the computation takes long.
const Composed& three_zones() {
  static const Composed result = [] {
    Study study = study_of_corners("[compose]\nmaximize = \"g\"\nmax_zones = 3\n");
    Composition composition = composed(study);
    return Composed{std::move(study), std::move(composition)};
  }();
  return result;
}

TEST(RealCells, AreNeverWorseThanThreeZonesOnAGrid) {
  const Study& study = three_zones().study;
  const Composition& composition = three_zones().composition;
  std::vector<Goals> cells;
  for (const double cant : {0.0, 4.0, 8.0, 12.0})
    for (const double turn : {0.0, 60.0, 120.0, 180.0, 240.0, 300.0}) {
      const PointValues values = {Parameter::value_of(cant), Parameter::value_of(turn)};
      cells.push_back(goals_of(study, make_candidate(study, values)));
    }
  double best = 0.0;
  for (std::size_t a = 0; a < cells.size(); ++a)
    for (std::size_t b = a + 1; b < cells.size(); ++b)
      for (std::size_t c = b + 1; c < cells.size(); ++c)
        best = std::max(best, best_in_twentieths(cells[a], cells[b], cells[c]));
  ASSERT_TRUE(composition.best.has_value());
  EXPECT_LE(composition.best->zones.size(), 3U);
  EXPECT_GE(composition.best->mixture.min_goal, best);
  EXPECT_GT(composition.best->mixture.min_goal, composition.by_zones.front().mixture.min_goal);
}

TEST(RealCells, OfOneZoneAreWhatOptimiseFinds) {
  const std::string one = "[compose]\nmaximize = \"g\"\nmax_zones = 1\nrounds = 0\n";
  const Study study = study_of_corners(one);
  const Composition composition = composed(study);
  ASSERT_TRUE(composition.best && composition.single);
  ASSERT_EQ(composition.best->zones.size(), 1U);
  // `optimize` maximizes a single quantity, which is defined as the minimum RRE of the same directions.
  const Study least = study_of_corners(
      "[[quantity]]\nkind = \"rre\"\nname = \"least\"\nover_directions = \"min\"\nincidence_deg = 35\n"
      "azimuth_deg = [0, 60, 120, 210]\n[optimize]\nmaximize = \"least\"\n");
  compute::ResultStore store("", optimise_layout(least), compute::IfExists::refuse);
  const Optimum optimum = optimise(least, read_optimise(least), store, nullptr, nullptr);
  ASSERT_TRUE(optimum.best.has_value());
  EXPECT_EQ(composition.best->mixture.min_goal, *optimum.best->objective);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(composition.single->values[k].shown, optimum.best->values[k].shown);
}

TEST(RealCells, AreWrittenAsTheDesignsOfTheirZones) {
  const Study& study = three_zones().study;
  const Composition& composition = three_zones().composition;
  ASSERT_TRUE(composition.best.has_value());
  Goals part{};
  for (std::size_t z = 0; z < composition.best->zones.size(); ++z) {
    const Zone& zone = composition.best->zones[z];
    const std::string text = zone_design_text(study, composition.best->zones, z);
    EXPECT_TRUE(text.starts_with("# Zone " + std::to_string(z + 1) + " of ")) << text;
    const Candidate in_study = make_candidate(study, zone.cell.values);
    const Goals goals =
        goals_of(study, {design::parse_design(text, "zone.toml"), in_study.analysis(), in_study.machining()});
    for (std::size_t k = 0; k < kGoals; ++k) part[k] += zone.area_fraction * goals[k];
  }
  for (std::size_t k = 0; k < kGoals; ++k) EXPECT_NEAR(part[k], composition.best->mixture.goals[k], 1e-9);
}

TEST(RealCells, AreWrittenAsOnePartOfZones) {
  const Study& study = three_zones().study;
  const Composition& composition = three_zones().composition;
  ASSERT_TRUE(composition.best && composition.best->zones.size() > 1);
  for (const ZoneLayout layout : {ZoneLayout::stripes, ZoneLayout::blocks, ZoneLayout::rows}) {
    const ZonedDesignRequest request{layout, geometry::Vec2(80.0, 60.0)};
    const design::Design design =
        design::parse_design(zoned_design_text(study, composition.best->zones, request), "part.toml");
    ASSERT_NE(design.zoned(), nullptr);
    const geometry::ZonedSpec& spec = design.zoned()->spec;
    ASSERT_EQ(spec.zones.size(), composition.best->zones.size());
    for (std::size_t z = 0; z < spec.zones.size(); ++z) {
      const Zone& zone = composition.best->zones[z];
      const Candidate cell = make_candidate(study, zone.cell.values);
      double area_mm2 = 0.0;
      for (const geometry::Polygon& region : spec.zones[z].regions) area_mm2 += geometry::area(region);
      EXPECT_NEAR(area_mm2 / spec.area_mm2(), zone.area_fraction, 1e-9);
      EXPECT_EQ(spec.zones[z].rotation_deg, cell.analysis().rotation_deg);
      EXPECT_EQ(geometry::cant_of(spec.zones[z].elements.element).deg,
                geometry::cant_of(cell.design().part().element).deg);
    }
  }
}

// The RRE of the whole part is compared with the mean RRE of its zones, weighted by their areas. The RRE of a zone is
// the RRE of an infinite array of its cells. Borders between zones cause a difference that is inversely proportional to
// the size of the part.
TEST(RealCells, TracedAsOnePartAreTheSumOfZones) {
  const Study& study = three_zones().study;
  const Composition& composition = three_zones().composition;
  ASSERT_TRUE(composition.best && composition.best->zones.size() > 1);
  const auto by_rays = [&](const design::Design& design, double rotation_deg, raytrace::Engine engine) {
    AnalysisSettings analysis = make_candidate(study, composition.best->zones[0].cell.values).analysis();
    analysis.rotation_deg = rotation_deg;
    analysis.engine = engine;
    analysis.cutoff.reset();
    analysis.target_error = 1e-3;
    return goals_of(study, {design, analysis, {}});
  };
  Goals sum{};
  for (const Zone& zone : composition.best->zones) {
    const Candidate cell = make_candidate(study, zone.cell.values);
    const Goals goals = by_rays(cell.design(), cell.analysis().rotation_deg, raytrace::Engine::cell);
    for (std::size_t k = 0; k < kGoals; ++k) sum[k] += zone.area_fraction * goals[k];
  }
  const ZonedDesignRequest request{ZoneLayout::stripes, geometry::Vec2(480.0, 360.0)};
  const Goals whole =
      by_rays(design::parse_design(zoned_design_text(study, composition.best->zones, request), "part.toml"), 0.0,
              raytrace::Engine::embree);
  for (std::size_t k = 0; k < kGoals; ++k) EXPECT_NEAR(whole[k], sum[k], 0.02 * sum[k]) << k;
}

}  // namespace
}  // namespace retrace::testing::real_cells_test
