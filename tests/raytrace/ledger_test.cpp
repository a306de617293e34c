// Tests that all power ends in exactly one account, for every kind of design.
#include "raytrace/light/ledger.h"

#include <gtest/gtest.h>

#include "tests/support/designs.h"

namespace retrace::testing::ledger_test {
namespace {

using namespace geometry;
using namespace raytrace;

/// Returns designs with every kind of element, arrangement and border.
std::vector<NamedPart> all_designs() {
  const RtpElement prism{0.5, 0.5, 90.0};
  const HexagonalCube hexagon{1.0};
  const TriangularCube triangle{1.0};
  std::vector<NamedPart> designs = {
      {"rtp single", single(prism, 0.3)},
      {"hexagonal single", single(hexagon, 0.3)},
      {"triangular single", single(triangle, 0.3)},
      {"rtp aligned", finite(prism, Arrangement::aligned, 2.1, 2.3, 0.4)},
      {"rtp offset", finite(prism, Arrangement::offset, 2.5, 2.5, 0.4)},
      {"rtp checker", finite(prism, Arrangement::checker, 2.5, 2.0, 0.4)},
      {"honeycomb", finite(hexagon, Arrangement::honeycomb, 4.3, 3.9, 0.4)},
      {"triangular", finite(triangle, Arrangement::triangular, 4.3, 3.9, 0.4)},
      {"rtp aligned infinite", infinite(prism, Arrangement::aligned, 0.4)},
      {"rtp offset infinite", infinite(prism, Arrangement::offset, 0.4)},
      {"rtp checker infinite", infinite(prism, Arrangement::checker, 0.4)},
      {"honeycomb infinite", infinite(hexagon, Arrangement::honeycomb, 0.4)},
      {"triangular infinite", infinite(triangle, Arrangement::triangular, 0.4)},
  };
  const auto vary = [&](std::string name, PartSpec spec, const std::function<void(PartSpec&)>& change) {
    change(spec);
    designs.push_back({std::move(name), spec});
  };
  vary("rtp offset omit", designs[4].spec, [](PartSpec& s) { s.array.partial_elements = PartialElements::omit; });
  vary("rtp offset odd gaps margins", designs[4].spec, [](PartSpec& s) {
    s.array.shifted_rows = RowParity::odd;
    s.array.x_gap_mm = 0.05;
    s.array.y_gap_mm = 0.08;
    s.array.x_offset_mm = s.array.y_offset_mm = 0.15;
    s.array.overlap_percent = 30.0;
  });
  vary("honeycomb omit margins", designs[6].spec, [](PartSpec& s) {
    s.array.partial_elements = PartialElements::omit;
    s.array.x_offset_mm = 0.2;
  });
  vary("triangular omit", designs[7].spec, [](PartSpec& s) { s.array.partial_elements = PartialElements::omit; });
  vary("rtp checker infinite gaps", designs[10].spec, [](PartSpec& s) { s.array.x_gap_mm = s.array.y_gap_mm = 0.1; });
  vary("rtp wide apex", designs[4].spec, [](PartSpec& s) { s.element = RtpElement{0.5, 0.5, 118.0}; });
  vary("rtp narrow apex", designs[9].spec, [](PartSpec& s) { s.element = RtpElement{0.5, 0.5, 61.0}; });
  return designs;
}

class LedgerOf : public ::testing::TestWithParam<std::size_t> {};

TEST_P(LedgerOf, AddsUpToOne) {
  const NamedPart design = all_designs()[GetParam()];
  const Part part = build_part(design.spec);
  const MonteCarlo tracer(part);
  Optics absorbing = pmma();
  absorbing.absorption_per_mm = 0.05;
  for (const Optics& optics : {pmma(), absorbing, ideal()})
    for (const double t : {0.0, 3.0, 21.0, 45.0, 75.0, 89.0})
      for (const double p : {0.0, 30.0, 90.0, 211.0}) {
        const MonteCarloResult result = tracer.trace(optics, from(t, p), {0.5}, rays(t < 80.0 ? 4096 : 256), {});
        const Ledger& ledger = result.cones[0].ledger;
        const std::string what = design.name + " at " + std::to_string(t) + ", " + std::to_string(p);
        EXPECT_NEAR(ledger.total(), 1.0, 1e-9) << what;
        EXPECT_EQ(ledger[Account::lost], 0.0) << what;
        EXPECT_EQ(result.misses, 0U) << what;
        EXPECT_LE(ledger[Account::truncated], 1e-7) << what;
        for (const double power : ledger.power) EXPECT_GE(power, 0.0) << what;
        if (part.period_mm) {
          EXPECT_EQ(ledger[Account::side_exit], 0.0) << what;
        }
      }
}

INSTANTIATE_TEST_SUITE_P(Designs, LedgerOf, ::testing::Range(std::size_t{0}, all_designs().size()));

// Power below the cut-off is added to the account `truncated`, and the accounts still add up to 1.
TEST(Ledger, CutoffIsBookedAsTruncated) {
  const Part part = build_part(single(HexagonalCube{1.0}, 0.5));
  Optics optics = pmma();
  optics.absorption_per_mm = 2.0;
  PathPolicy coarse;
  coarse.cutoff = 1e-2;
  const Ledger ledger = MonteCarlo(part).trace(optics, from(20.0, 10.0), {0.5}, rays(1U << 14), coarse).cones[0].ledger;
  EXPECT_GT(ledger[Account::truncated], 1e-5);
  EXPECT_NEAR(ledger.total(), 1.0, 1e-9);
}

}  // namespace
}  // namespace retrace::testing::ledger_test
