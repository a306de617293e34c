// Tests of light that is traced only one time for all equal elements. Ledgers, far fields and resampled light must
// equal those of elements that are traced separately.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "geometry/elements/lattice.h"
#include "geometry/part/zones.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/exact/translational_symmetry.h"
#include "raytrace/observers/far_field.h"
#include "tests/support/designs.h"
#include "tests/support/light_traps.h"
#include "tests/support/return_frames.h"
#include "tests/support/statistics.h"
#include "tests/support/traced_far_fields.h"

namespace retrace::testing::equal_places_test {
namespace {

using namespace geometry;
using namespace raytrace;
using Elements = BeamTracer::Elements;

using Question = PartInLight;

PartZone zone(const Element& element, Arrangement arrangement, double rotation_deg, const Rectangle& region) {
  return {{to_polygon(region)}, rotation_deg, finite(element, arrangement, 1.0, 1.0, 1.0)};
}

/// Returns a part with different lattices side by side. One lattice is oblique to the border.
Part patchwork() {
  const PartZone left = zone(HexagonalCube{1.0}, Arrangement::honeycomb, 25.0, {{0.0, 0.0}, {9.0, 10.0}});
  PartZone middle = zone(HexagonalCube{0.8}, Arrangement::honeycomb, 0.0, {{9.0, 0.0}, {14.0, 10.0}});
  middle.elements.angle_errors.dihedral_error_arcmin = {4.0, 4.0, 4.0};
  const PartZone right = zone(RtpElement{0.5, 0.5, 90.0}, Arrangement::checker, 0.0, {{14.0, 0.0}, {18.0, 10.0}});
  return build_part(ZonedSpec{{18.0, 10.0}, 1.0, {left, middle, right}});
}

/// Returns an array of triangular cube corners. If `in_turn` is true, every third column has dihedral errors.
/// Otherwise, randomly chosen elements have dihedral errors.
Part columns(bool in_turn) {
  PartZone first = {{}, 0.0, finite(TriangularCube{1.0}, Arrangement::triangular, 1.0, 1.0, 1.0)};
  PartZone other = first;
  other.elements.angle_errors.dihedral_error_arcmin = {9.0, 3.0, 0.0};
  ZonedSpec spec{{9.0, 8.0}, 1.0, {first, other}, true};
  const double period_mm = make_lattice(first.elements, true).period_mm.x();
  std::uint32_t state = 1;
  for (const ArrayCell& cell : plan_of_array(array_of_cells(spec, first)).cells) {
    state = 1664525 * state + 1013904223;
    const double column = std::floor(centroid(cell.outline).x() / period_mm + 0.1);
    const bool is_other = in_turn ? std::fmod(column, 3.0) == 0.0 : state % 3 == 0;
    spec.zones[is_other && cell.is_element ? 1 : 0].cells.push_back(cell.number);
  }
  return build_part(spec);
}

/// Returns arrays whose borders differ from each other and from the inner region.
std::vector<Question> questions() {
  const RtpElement prism{0.5, 0.4, 90.0};
  PartSpec land = finite(prism, Arrangement::aligned, 4.3, 3.1, 1.0);
  land.array.x_gap_mm = 0.1;
  land.array.y_offset_mm = 0.2;
  PartSpec omitted = finite(HexagonalCube{0.8}, Arrangement::honeycomb, 6.1, 7.0, 1.0);
  omitted.array.partial_elements = PartialElements::omit;
  PartSpec checker = finite(RtpElement{0.5, 0.5, 90.0}, Arrangement::checker, 4.0, 4.5, 1.0);
  checker.edges.rim_chamfer_mm = 0.02;
  PartSpec errors = finite(TriangularCube{1.0}, Arrangement::triangular, 5.0, 6.0, 1.0);
  errors.angle_errors.dihedral_error_arcmin = {3.0, 1.0, 2.0};
  return {
      {"honeycomb", build_part(finite(HexagonalCube{1.0}, Arrangement::honeycomb, 7.0, 8.0, 1.0)), from(15.0, 40.0)},
      {"omitted", build_part(omitted), from(5.0, 200.0)},
      {"triangles with errors", build_part(errors), from(10.0, 100.0)},
      {"bricks", build_part(finite(prism, Arrangement::offset, 4.2, 4.4, 1.0)), from(20.0, 25.0)},
      {"land between", build_part(land), from(30.0, 300.0)},
      {"checker with flats", build_part(checker), from(10.0, 10.0)},
      {"patchwork", patchwork(), from(10.0, 70.0)},
      {"columns in turn", columns(true), from(5.0, 10.0)}};
}

BeamPolicy policy_at(double cutoff) {
  BeamPolicy policy;
  policy.cutoff = cutoff;
  policy.separate_cells = true;
  return policy;
}

using Seen = TracedFarField;

Seen seen(const Part& part, const Illumination& light, const BeamPolicy& beams, Elements elements) {
  return traced_far_field(part, pmma(), light, {}, beams, {0.5}, elements);
}

/// Results of a question if each element is traced separately, and if equal elements are traced only one time.
struct Pair {
  Question question;
  Seen alone;
  Seen shared;
};

/// Returns a pair of results for each question. They are computed only one time, because the computation takes long.
const std::vector<Pair>& pairs() {
  static const std::vector<Pair> all = [] {
    Optics optics = pmma();
    optics.absorption_per_mm = 0.2;  // weakens beams with long paths, so that fewer beams are above the cut-off
    const std::vector<double> cones = {0.5, 60.0};
    std::vector<Pair> result;
    for (const Question& question : questions()) {
      const auto traced = [&](Elements elements) {
        return traced_far_field(question.part, optics, question.light, {}, policy_at(1e-8), cones, elements);
      };
      result.push_back({question, traced(Elements::individual), traced(Elements::instanced)});
    }
    return result;
  }();
  return all;
}

TEST(TranslationalSymmetry, LedgersAreThoseOfEachByItself) {
  for (const auto& [question, alone, shared] : pairs()) {
    EXPECT_LT(shared.result.beams, alone.result.beams) << question.name;
    for (std::size_t cone = 0; cone < shared.result.ledgers.size(); ++cone) {
      const Ledger& own = shared.result.ledgers[cone];
      const Ledger& expected = alone.result.ledgers[cone];
      EXPECT_NEAR(own.total(), 1.0, 1e-12) << question.name;
      const double left = expected[Account::truncated] + own[Account::truncated];
      EXPECT_LT(left, 2e-2) << question.name;
      for (const Account account : {Account::retroreflected, Account::transmitted, Account::side_exit,
                                    Account::returned_elsewhere, Account::absorbed})
        EXPECT_NEAR(own[account], expected[account], 0.2 * left + 1e-9)
            << question.name << ", " << static_cast<int>(account);
    }
  }
}

std::vector<Vec3> receivers(const Illumination& light) {
  const ReturnFrame frame = frame_at(light);
  std::vector<Vec3> directions;
  for (const Vec2& at_deg : {Vec2(0.0, 0.0), Vec2(0.0, 0.2), Vec2(0.25, -0.2)})
    directions.push_back(frame.direction(EIGEN_PI / 180.0 * at_deg));
  return directions;
}

const ApertureKernel& discs() {
  static const ApertureKernel kernel({Angle::from_deg(10.0 / 60.0), Angle::from_deg(10.0 / 60.0)});
  return kernel;
}

/// The far field must be the same if each element is traced separately and if equal elements are traced only one time.
TEST(TranslationalSymmetry, FarFieldsAreThoseOfEachByItself) {
  for (const auto& [question, alone, shared] : pairs()) {
    EXPECT_NEAR(shared.field.total_power(), alone.field.total_power(), 1e-3) << question.name;
    for (const Vec3& direction : receivers(question.light)) {
      const double expected = alone.field.intensity(direction, discs()).per_sr;
      EXPECT_NEAR(shared.field.intensity(direction, discs()).per_sr, expected, 1e-3 * expected) << question.name;
    }
  }
}

/// Light that enters the first half of a period is equivalent to light that enters the second half.
TEST(TranslationalSymmetry, HalvesOfAPeriodAreAlike) {
  PartSpec quarter = infinite(RtpElement{0.5, 0.4, 90.0}, Arrangement::offset, 1.0);
  quarter.array.overlap_percent = 25.0;
  const std::vector<std::pair<PartSpec, bool>> parts = {
      {infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0), true},
      {infinite(RtpElement{0.5, 0.4, 90.0}, Arrangement::offset, 1.0), true},
      {infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::checker, 1.0), true},
      {infinite(TriangularCube{1.0}, Arrangement::triangular, 1.0), true},
      {infinite(RtpElement{0.5, 0.4, 90.0}, Arrangement::aligned, 1.0), false},
      {quarter, false}};
  const Illumination light = from(20.0, 25.0);
  for (const auto& [spec, is_alike] : parts) {
    const Part part = build_part(spec);
    ASSERT_EQ(TranslationalSymmetry::of(part, Vec2::Zero())->within_period_mm().has_value(), is_alike);
    const Seen alone = seen(part, light, policy_at(1e-6), Elements::individual);
    const Seen shared = seen(part, light, policy_at(1e-6), Elements::instanced);
    EXPECT_LT(shared.result.beams, (is_alike ? 0.6 : 1.01) * static_cast<double>(alone.result.beams));
    EXPECT_NEAR(shared.result.ledgers[0].total(), 1.0, 1e-12);
    EXPECT_NEAR(shared.field.total_power(), alone.field.total_power(), 1e-4);
    for (const Vec3& direction : receivers(light)) {
      const double expected = alone.field.intensity(direction, discs()).per_sr;
      // Both runs omit beams below the cut-off. The omitted beams of the two runs are different.
      EXPECT_NEAR(shared.field.intensity(direction, discs()).per_sr, expected, 3e-3 * expected);
    }
  }
}

/// If a resampled beam represents equal elements at several positions, its light counts at each of these positions.
TEST(TranslationalSymmetry, ResampledLightIsThatOfAllPlaces) {
  const std::vector<Question> all = questions();
  for (const Question& question :
       {all[0], all[2], all[6],
        Question{"endless", build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0)), from(20, 10)}}) {
    const Part& part = question.part;
    const double element = 1.0 / static_cast<double>(part.period_mm ? 1 : part.elements_full);
    const Seen truth = seen(part, question.light, policy_at(1e-4 * element), Elements::individual);
    BeamPolicy policy = policy_at(1e-3 * element);
    policy.population_control = PopulationControl{.seed = 1, .replicates = 16, .survivor_power_ratio = 4.0};
    const Seen own = seen(part, question.light, policy, Elements::instanced);
    EXPECT_NEAR(own.result.ledgers[0].total(), 1.0, 1e-11) << question.name;
    EXPECT_NEAR(own.result.ledgers[0][Account::truncated], 0.0, 1e-11) << question.name;
    const double left = truth.result.ledgers[0][Account::truncated];
    const double bound = student_bound(3, 16) * own.result.std_error[0];
    const double rre = truth.result.ledgers[0][Account::retroreflected];
    EXPECT_GE(own.result.ledgers[0][Account::retroreflected], rre - bound) << question.name;
    EXPECT_LE(own.result.ledgers[0][Account::retroreflected], rre + left + bound) << question.name;
    EXPECT_NEAR(own.field.total_power(),
                1.0 - own.result.ledgers[0][Account::transmitted] - own.result.ledgers[0][Account::side_exit] -
                    own.result.ledgers[0][Account::absorbed],
                1e-10)
        << question.name;
  }
}

/// The RRE of a part with zones (regions with different elements) approaches the area-weighted sum of the RRE of
/// infinite arrays as the part grows. The difference, caused by borders and by walls between zones, is inversely
/// proportional to the size of the part.
TEST(TranslationalSymmetry, PartsOfZonesComeToTheSumOfTheirZones) {
  PartSpec upright = infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0);
  PartSpec opened = infinite(HexagonalCube{0.8}, Arrangement::honeycomb, 1.0);
  opened.angle_errors.dihedral_error_arcmin = {15.0, 15.0, 15.0};
  const Illumination light = from(0.0);
  const auto rre = [&](const Part& part, double cutoff) {
    return BeamTracer(part, Elements::instanced)
        .trace(pmma(), light, {0.5}, policy_at(cutoff))
        .ledgers[0][Account::retroreflected];
  };
  const double sum = 0.5 * (rre(build_part(upright), 1e-6) + rre(build_part(opened), 1e-6));
  std::vector<double> missing;
  for (const double size_mm : {10.0, 20.0, 40.0}) {
    PartZone left{{to_polygon({{0.0, 0.0}, {0.5 * size_mm, size_mm}})}, 25.0, upright};
    PartZone right{{to_polygon({{0.5 * size_mm, 0.0}, {size_mm, size_mm}})}, 0.0, opened};
    for (PartZone* zone : {&left, &right}) zone->elements.array.extent = Extent::finite;
    missing.push_back(sum - rre(build_part(ZonedSpec{{size_mm, size_mm}, 1.0, {left, right}}), 1e-7));
  }
  EXPECT_GT(missing[0], 0.0);
  EXPECT_LT(missing[2], 0.04 * sum);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(missing[k] / missing[k + 1], 2.0, 0.3);
}

TEST(TranslationalSymmetry, AreNotThereWhereElementsDiffer) {
  PartSpec tilted = finite(RtpElement{0.5, 0.4, 90.0}, Arrangement::aligned, 4.0, 4.0, 1.0);
  tilted.random_tilts = {1.0, 1};
  const PartSpec small = finite(HexagonalCube{1.0}, Arrangement::honeycomb, 2.0, 2.0, 1.0);
  for (const Part& part :
       {build_part(tilted), build_part(small), build_part(single(HexagonalCube{1.0}, 1.0)), columns(false)}) {
    EXPECT_FALSE(TranslationalSymmetry::of(part, Vec2::Zero()));
    const BeamPolicy policy = policy_at(1e-6);
    EXPECT_EQ(BeamTracer(part, Elements::instanced).trace(pmma(), from(10.0), {0.5}, policy).beams,
              BeamTracer(part).trace(pmma(), from(10.0), {0.5}, policy).beams);
  }
}

}  // namespace
}  // namespace retrace::testing::equal_places_test
