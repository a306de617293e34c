// Tests of scratches along the facets of prisms: closed forms of ineffective widths and volumes, closed boundaries, and
// agreement of the engines.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "geometry/part/closed_boundary.h"
#include "raytrace/exact/beam_tracer.h"
#include "tests/support/designs.h"
#include "tests/support/engines.h"

namespace retrace::testing::scratches_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kBase = 0.5;
constexpr double kWidth = 0.4;

PartSpec scratched(PartSpec spec, std::vector<Scratch> scratches) {
  spec.scratches = std::move(scratches);
  return spec;
}

double exact_rre(const PartSpec& spec, const Optics& optics) {
  BeamPolicy policy;
  policy.truncated_goal = 1e-9;
  return BeamTracer(build_part(spec)).trace(optics, from(0.0), {0.5}, policy).ledgers[0][Account::retroreflected];
}

double volume_mm3(const PartSpec& spec) {
  const BoundaryMesh mesh = closed_boundary(build_part(spec));
  double six = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) six += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c]));
  return six / 6.0;
}

// At normal incidence, light hits both facets at the same position along the roof edge. A scratch of either facet
// therefore makes a strip of its width ineffective, across the whole prism. Deflected light may return after it meets a
// second scratch, which is an effect of second order.
TEST(Scratches, TakeTheirWidthOfAPrism) {
  const PartSpec smooth = infinite(RtpElement{kBase, kWidth, 90.0}, Arrangement::aligned, 1.0);
  Optics lossless = pmma();
  lossless.lossless_entrance = true;
  EXPECT_NEAR(exact_rre(smooth, lossless), 1.0, 1e-9);
  const double w = 0.003;
  const auto expect_taken = [&](const std::vector<Scratch>& scratches, double taken) {
    const double kept = exact_rre(scratched(smooth, scratches), lossless) - (1.0 - taken);
    EXPECT_GT(kept, -1e-8) << taken;
    EXPECT_LT(kept, 0.02 * taken * taken) << taken;
  };
  for (const double depth : {5e-4, -5e-4}) {
    expect_taken({{0, 0.05, w, depth}}, w / kWidth);
    expect_taken({{1, -0.1, w, depth}}, w / kWidth);
    expect_taken({{0, 0.05, w, depth}, {1, -0.1, w, depth}}, 2.0 * w / kWidth);
    expect_taken({{0, 0.05, w, depth}, {1, 0.05, 2.0 * w, depth}}, 2.0 * w / kWidth);
  }
  EXPECT_NEAR(exact_rre(scratched(smooth, {{0, 0.05, w, 0.0}}), lossless), 1.0, 1e-9);
}

// A V-shaped scratch of depth d, normal to the facet, removes a cross-section of half its width times d along the
// facet.
TEST(Scratches, TakeTheirVolume) {
  for (const double apex_deg : {90.0, 70.0}) {
    const PartSpec smooth = single(RtpElement{kBase, kWidth, apex_deg}, 0.5);
    const double facet_mm = 0.5 * kBase / std::sin(0.5 * apex_deg * std::acos(-1.0) / 180.0);
    for (const double depth : {2e-3, -2e-3}) {
      const PartSpec worn = scratched(smooth, {{0, 0.05, 0.01, depth}, {1, -0.02, 0.02, depth}});
      EXPECT_NEAR(volume_mm3(smooth) - volume_mm3(worn), 0.5 * depth * (0.01 + 0.02) * facet_mm, 1e-12) << apex_deg;
    }
  }
}

std::vector<PartSpec> all_arrangements(const std::vector<Scratch>& scratches) {
  PartSpec apart = finite(RtpElement{kBase, kBase, 90.0}, Arrangement::aligned, 1.5, 1.3, 0.5);
  apart.array.x_gap_mm = 0.06;
  PartSpec worn = single(RtpElement{kBase, kBase, 88.0}, 0.5);
  worn.edges.root_radius_mm = 0.01;
  worn.edges.chords = 4;
  return {scratched(infinite(RtpElement{kBase, kBase, 90.0}, Arrangement::offset, 0.5), scratches),
          scratched(finite(RtpElement{kBase, kBase, 90.0}, Arrangement::offset, 1.5, 1.5, 0.5), scratches),
          scratched(finite(RtpElement{kBase, kBase, 84.0}, Arrangement::checker, 1.5, 1.5, 0.5), scratches),
          scratched(apart, scratches), scratched(worn, scratches)};
}

const std::vector<Scratch> kTwo = {{0, 0.08, 0.03, 0.006}, {1, -0.1, 0.02, -0.004}};

TEST(Scratches, PartsStayClosed) {
  for (const PartSpec& spec : all_arrangements(kTwo)) {
    if (spec.array.extent == Extent::finite) expect_closed_part(spec);
  }
}

TEST(Scratches, EnginesAgree) {
  for (const PartSpec& spec : all_arrangements(kTwo)) expect_engines_agree(spec, 0.03);
}

// If a prism is rotated by 180 degrees, its facets are swapped and the direction along its roof edge is reversed.
TEST(Scratches, TurnWithThePrism) {
  const auto rre = [](const std::vector<Scratch>& scratches, double azimuth_deg) {
    const PartSpec spec = scratched(single(RtpElement{kBase, kWidth, 90.0}, 0.5), scratches);
    BeamPolicy policy;
    policy.cutoff = 1e-6;
    return BeamTracer(build_part(spec)).trace(pmma(), from(8.0, azimuth_deg), {0.5}, policy).ledgers[0];
  };
  const Ledger one = rre({{0, 0.08, 0.03, 0.006}}, 40.0);
  const Ledger other = rre({{1, -0.08, 0.03, 0.006}}, 220.0);
  EXPECT_NEAR(one[Account::retroreflected], other[Account::retroreflected],
              one[Account::truncated] + other[Account::truncated] + 1e-12);
  EXPECT_NEAR(one[Account::transmitted], other[Account::transmitted], 1e-4);
}

}  // namespace
}  // namespace retrace::testing::scratches_test
