// Tests of single rays from any position: comparison with an engine that uses only the closed boundary, and with beams.
#include "raytrace/paths/ray_tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "core/error.h"
#include "core/threads.h"
#include "raytrace/light/light_setup.h"
#include "tests/support/designs.h"
#include "tests/support/outlined_parts.h"
#include "tests/support/reference_tracer.h"

namespace retrace::testing::ray_tracer_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kCone = 2.0;

PathPolicy every_branch() {
  PathPolicy policy;
  policy.cutoff = 1e-12;
  policy.split_power = 1e-8;
  return policy;
}

/// Returns a policy with which each incident ray gives at most one leaving ray.
PathPolicy one_branch() {
  PathPolicy policy;
  policy.split_power = 1.0;
  return policy;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator_); }
  Vec3 direction() {
    std::normal_distribution<double> normal;
    return Vec3(normal(generator_), normal(generator_), normal(generator_)).normalized();
  }
  /// Returns partly polarised light of power 1.
  Light light(const Vec3& along) {
    const Vec3 state = between(0.0, 1.0) * direction();
    return {{1.0, state.x(), state.y(), state.z()}, along.cross(direction()).normalized()};
  }
  Vec3 within(const Rectangle& box, double low, double high) {
    return {between(box.lower.x(), box.upper.x()), between(box.lower.y(), box.upper.y()), between(low, high)};
  }

 private:
  std::mt19937_64 generator_;
};

/// Expects that both ledgers agree, and that for every ray of the reference with a power of at least 1e-3 there is an
/// equal traced ray.
void expect_same(const TracedRays& found, const ReferenceRay& known, const std::string& what) {
  constexpr double kNoise = 2e-3;   // power that the reference truncates
  constexpr double kChance = 1e-7;  // effect of a branch that is too weak to be traced
  ASSERT_EQ(found.missed.empty(), known.meets) << what;
  for (std::size_t k = 0; k < kAccountCount; ++k)
    EXPECT_NEAR(found.ledger.ledger.power[k], known.ledger.power[k], kNoise) << what << ": " << kAccountNames[k];
  double strong = 0.0;
  for (const ReferenceExit& exit : known.exits) {
    if (exit.power() < 1e-3) continue;
    strong += exit.power();
    const auto same = std::find_if(found.leaving.begin(), found.leaving.end(), [&](const LeavingRay& ray) {
      return (ray.direction - exit.direction).norm() < 1e-9 && (ray.position_mm - exit.position_mm).norm() < 1e-8 &&
             std::abs(ray.light.power() - exit.power()) < kChance;
    });
    ASSERT_NE(same, found.leaving.end()) << what << ": power " << exit.power();
    EXPECT_EQ(same->account, exit.account) << what;
    const std::array<double, 4> stokes = exit.stokes(same->light.s_axis);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(same->light.stokes.values()[k], stokes[k], kChance) << what << k;
  }
  // The compared rays contain most of the light.
  EXPECT_NEAR(strong + known.ledger[Account::absorbed], known.meets ? 1.0 : 0.0, 0.06) << what;
}

std::vector<NamedPart> parts() {
  const RtpElement prism{0.5, 0.5, 90.0};
  PartSpec margins = finite(prism, Arrangement::offset, 2.5, 2.5, 0.4);
  margins.array.x_gap_mm = 0.05;
  margins.array.x_offset_mm = margins.array.y_offset_mm = 0.15;
  return {{"prism", single(prism, 0.3)},
          {"cube corner", single(HexagonalCube{1.0}, 0.3)},
          {"checker", finite(prism, Arrangement::checker, 1.6, 1.1, 0.4)},
          {"margins", margins},
          {"honeycomb", finite(HexagonalCube{1.0}, Arrangement::honeycomb, 2.3, 1.9, 0.4)},
          {"parallelogram", with_outline(finite(prism, Arrangement::offset, 0.0, 0.0, 0.4), oblique_outline())},
          {"notch", with_outline(finite(prism, Arrangement::offset, 0.0, 0.0, 0.4), angle_outline(), 0.05)},
          {"hole", with_outline(finite(HexagonalCube{0.5}, Arrangement::honeycomb, 0.0, 0.0, 0.4), holed_outline())}};
}

/// Fixture with rays towards points of a box around a part. The ray tracer and the reference engine trace these rays.
class RayByRay : public ::testing::TestWithParam<std::size_t> {
 protected:
  void compare(const Vec3& origin, const Vec3& direction, bool inside, const Optics& optics, const std::string& what) {
    const Light light = random.light(direction);
    RayTracer tracer(part, nullptr, kCone, every_branch(), 1);
    tracer.add(optics);
    const IncidentRay ray{origin, direction, light, 0};
    expect_same(tracer.trace({&ray, 1}, 0, nullptr),
                reference_ray(part, optics, origin, direction, light, inside, kCone), named.name + ", " + what);
  }

  /// Returns a random point in the plate that is not in a notch or a hole.
  Vec3 point_in_plate() {
    while (true) {
      const Vec3 p = random.within(box, 0.02, part.thickness_mm - 0.02);
      if (!contains(part.outline, p.head<2>(), -1e-6)) continue;
      if (part.entrance_pieces.empty() || std::ranges::any_of(part.entrance_pieces, [&](const Polygon& piece) {
            return contains(piece, p.head<2>(), -1e-6);
          }))
        return p;
    }
  }

  NamedPart named = parts()[GetParam()];
  Part part = build_part(named.spec);
  Rectangle box = bounding_box(part.outline);
  Random random{GetParam() + 1};
};

TEST_P(RayByRay, FromAllAroundIsThatOfTheReference) {
  Optics optics = pmma();
  optics.absorption_per_mm = 0.1;
  for (int k = 0; k < 60; ++k) {
    const Vec3 at = random.within(box, -part.element_depth_mm, part.thickness_mm);
    const Vec3 direction = random.direction();
    compare(at - 5.0 * direction, direction, false, k % 2 == 0 ? optics : pmma(), "ray " + std::to_string(k));
  }
}

// The material absorbs light. In a transparent part, some light would be trapped.
TEST_P(RayByRay, FromInsideIsThatOfTheReference) {
  Optics dark = pmma();
  dark.absorption_per_mm = 1.0;
  for (int k = 0; k < 20; ++k) compare(point_in_plate(), random.direction(), true, dark, "ray " + std::to_string(k));
}

TEST_P(RayByRay, WithAnotherMediumBehindIsThatOfTheReference) {
  Optics wet = pmma();
  wet.back_index = 1.2;
  // The rays hit the entrance face from the front, because rays from behind would start in the medium behind the part.
  for (int k = 0; k < 20; ++k) {
    Vec3 direction = random.direction();
    direction.z() = -std::abs(direction.z()) - 0.3;
    direction.normalize();
    const Vec3 at = random.within(box, part.thickness_mm, part.thickness_mm);
    compare(at - 5.0 * direction, direction, false, wet, "ray " + std::to_string(k));
  }
}

INSTANTIATE_TEST_SUITE_P(Parts, RayByRay, ::testing::Range(std::size_t{0}, parts().size()));

/// Returns parallel rays from far above that cover a rectangle with a uniform random distribution.
std::vector<IncidentRay> beam(const Rectangle& over, double z, const Illumination& light, std::size_t count) {
  Random random(7);
  const Vec3 to_source = direction_to_source(light);
  std::vector<IncidentRay> rays;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 at = random.within(over, z, z);
    rays.push_back({at + 20.0 * to_source, -to_source, light_of_beam(light.stokes, to_source), 0});
  }
  return rays;
}

/// Expects that the accounts of rays, as fractions of the rays that hit the part, equal those of the beam within four
/// standard errors.
void expect_same_accounts(const RayLedger& rays, const Ledger& beam) {
  for (std::size_t k = 0; k < kAccountCount; ++k) {
    const double share = rays.ledger.power[k] / (rays.incident - rays.missed);
    const double error = std::sqrt(beam.power[k] * (1.0 - beam.power[k]) / static_cast<double>(rays.rays));
    EXPECT_NEAR(share, beam.power[k], 4.0 * error + 2e-4) << kAccountNames[k];
  }
  EXPECT_NEAR(rays.ledger.total(), rays.incident - rays.missed, 1e-9 * rays.incident);
}

TEST(RayTracer, ManyRaysAreABeamOnAnEndlessPart) {
  const PartSpec specs[] = {infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 0.4),
                            infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.4)};
  Optics absorbing = pmma();
  absorbing.absorption_per_mm = 0.05;
  for (const PartSpec& spec : specs) {
    const Part part = build_part(spec);
    const Illumination light = from(25.0, 40.0);
    RayTracer tracer(part, nullptr, 0.5, one_branch(), 3);
    tracer.add(absorbing);
    const TracedRays traced =
        tracer.trace(beam({Vec2(3.0, -40.0), Vec2(97.0, 50.0)}, part.thickness_mm, light, 40000), 0, nullptr);
    EXPECT_EQ(traced.ledger.rays_missed, 0U);
    EXPECT_LE(traced.leaving.size(), 40000U);
    const MonteCarloResult known = MonteCarlo(part).trace(absorbing, light, {0.5}, rays(65536), {});
    expect_same_accounts(traced.ledger, known.cones[0].ledger);
    // The standard error is that of a binomial fraction, slightly reduced by absorption.
    const double rre = known.cones[0].rre;
    EXPECT_NEAR(traced.ledger.std_error() / std::sqrt(rre * (1.0 - rre) / 40000.0), 0.95, 0.08);
  }
}

TEST(RayTracer, WhereTheyLeaveAnEndlessPartIsWhereTheyCame) {
  const Part part = build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.4));
  RayTracer tracer(part, nullptr, 0.5, every_branch(), 1);
  tracer.add(pmma());
  Random random(5);
  const Vec2 far = Vec2(300.0, -200.0).cwiseProduct(*part.period_mm);
  for (int k = 0; k < 40; ++k) {
    const Vec3 direction = random.direction();
    const Vec3 at = random.within({Vec2(-2.0, -2.0), Vec2(2.0, 2.0)}, -0.5, 0.0) - 4.0 * direction;
    const IncidentRay here{at, direction, random.light(direction), 0};
    IncidentRay there = here;
    there.position_mm.head<2>() += far;
    const TracedRays a = tracer.trace({&here, 1}, 0, nullptr);
    const TracedRays b = tracer.trace({&there, 1}, 0, nullptr);
    ASSERT_EQ(a.leaving.size(), b.leaving.size());
    for (std::size_t i = 0; i < a.leaving.size(); ++i) {
      EXPECT_LT((b.leaving[i].position_mm - a.leaving[i].position_mm - Vec3(far.x(), far.y(), 0.0)).norm(), 1e-9);
      EXPECT_EQ(a.leaving[i].account, b.leaving[i].account);
    }
    // Light must leave near its point of entry. The bound is larger for oblique light, which moves farther sideways
    // within the part.
    const double scale = 10.0 / std::max(0.05, std::abs(direction.z()));
    for (const LeavingRay& ray : a.leaving) EXPECT_LT((ray.position_mm - at).norm() * ray.light.power(), scale);
  }
}

TEST(RayTracer, ManyRaysAreABeamOnASoiledFace) {
  const Part part = build_part(finite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 5.0, 4.0, 0.4));
  Optics soiled = pmma();
  soiled.entrance.haze = {0.1, 0.1};
  soiled.entrance.dust = {0.1, 0.5, 0.5};
  const Illumination light = from(20.0, 70.0);
  RayTracer tracer(part, nullptr, 0.5, one_branch(), 3);
  tracer.add(soiled);
  const TracedRays traced = tracer.trace(beam(bounding_box(part.outline), part.thickness_mm, light, 40000), 0, nullptr);
  const MonteCarloResult known = MonteCarlo(part).trace(soiled, light, {0.5}, rays(65536), {});
  expect_same_accounts(traced.ledger, known.cones[0].ledger);
}

TEST(RayTracer, ManyRaysAreABeamOnAPartWithNotches) {
  for (const Outline& outline : {bent_outline(), ring_outline()}) {
    const Part part =
        build_part(with_outline(finite(HexagonalCube{0.5}, Arrangement::honeycomb, 0.0, 0.0, 0.5), outline));
    // The light is parallel to the walls, so that it enters only through the entrance face.
    const Illumination light = from(0.0);
    RayTracer tracer(part, nullptr, 0.5, one_branch(), 3);
    tracer.add(pmma());
    const Rectangle box = bounding_box(part.outline);
    const TracedRays traced = tracer.trace(beam(box, part.thickness_mm, light, 40000), 0, nullptr);
    const double missed = 1.0 - part.entrance_area_mm2 / box.size().prod();
    EXPECT_NEAR(traced.ledger.missed / traced.ledger.incident, missed, 0.012);
    const MonteCarloResult known = MonteCarlo(part).trace(pmma(), light, {0.5}, rays(65536), {});
    expect_same_accounts(traced.ledger, known.cones[0].ledger);
  }
}

TEST(RayTracer, WhatLeavesAddsUpToTheLedger) {
  const Part part = build_part(finite(HexagonalCube{1.0}, Arrangement::honeycomb, 3.0, 3.0, 0.4));
  for (const double split : {1.0, 0.01}) {
    PathPolicy policy;
    policy.split_power = split;
    RayTracer tracer(part, nullptr, 0.5, policy, 3);
    tracer.add(pmma());
    std::vector<IncidentRay> incident = beam(bounding_box(part.outline), part.thickness_mm, from(10.0), 4000);
    for (std::size_t k = 0; k < incident.size(); ++k) incident[k].light.scale(1.0 + static_cast<double>(k % 5));
    const TracedRays traced = tracer.trace(incident, 0, nullptr);
    Ledger leaving;
    for (const LeavingRay& ray : traced.leaving) leaving[ray.account] += ray.light.power();
    for (const Account account : {Account::retroreflected, Account::front_specular, Account::returned_elsewhere,
                                  Account::side_exit, Account::transmitted})
      EXPECT_NEAR(leaving[account], traced.ledger.ledger[account], 1e-9 * traced.ledger.incident);
    EXPECT_TRUE(std::is_sorted(traced.leaving.begin(), traced.leaving.end(),
                               [](const LeavingRay& a, const LeavingRay& b) { return a.incident < b.incident; }));
  }
}

TEST(RayTracer, NeitherThreadsNorPiecesMatter) {
  const Part part = build_part(finite(HexagonalCube{1.0}, Arrangement::honeycomb, 3.0, 3.0, 0.4));
  RayTracer tracer(part, nullptr, 0.5, one_branch(), 3);
  tracer.add(pmma());
  const std::vector<IncidentRay> all = beam(bounding_box(part.outline), part.thickness_mm, from(10.0), 6000);
  TracedRays one;
  TracedRays three;
  run_with_threads(1, [&] { one = tracer.trace(all, 0, nullptr); });
  run_with_threads(3, [&] { three = tracer.trace(all, 0, nullptr); });
  const TracedRays tail = tracer.trace(std::span(all).subspan(4096), 4096, nullptr);
  ASSERT_EQ(one.leaving.size(), three.leaving.size());
  EXPECT_EQ(one.ledger.ledger.power, three.ledger.ledger.power);
  for (std::size_t k = 0; k < one.leaving.size(); ++k)
    EXPECT_EQ(one.leaving[k].position_mm, three.leaving[k].position_mm);
  for (std::size_t k = 1; k <= tail.leaving.size(); ++k)
    EXPECT_EQ(one.leaving[one.leaving.size() - k].position_mm, tail.leaving[tail.leaving.size() - k].position_mm);
}

// Files contain positions in single precision. A ray that starts on a face, within rounding errors, must hit this face
// one time.
TEST(RayTracer, RaysThatBeginOnAFaceMeetItOnce) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.3));
  RayTracer tracer(part, nullptr, 0.5, every_branch(), 1);
  tracer.add(pmma());
  const auto front = [&](double z, double towards) {
    const IncidentRay ray{{0.1, 0.2, z}, {0.0, 0.0, towards}, {}, 0};
    return tracer.trace({&ray, 1}, 0, nullptr);
  };
  const double reflected = std::pow((kPmma - 1.0) / (kPmma + 1.0), 2.0);
  for (const double off : {-1e-8, 0.0, 1e-8}) {
    const TracedRays down = front(0.3 + off, -1.0);
    ASSERT_FALSE(down.leaving.empty());
    EXPECT_NEAR(down.leaving.front().light.power(), reflected, 1e-12) << off;
    EXPECT_EQ(front(0.3 + off, 1.0).missed.size(), 1U) << off;
  }
  // The ray starts on a facet of the prism. Its roof edge is along y at x = 0.25 and z = -0.25.
  for (const double off : {-1e-8, 0.0, 1e-8}) {
    const IncidentRay up{{0.1, 0.2, -0.1 + off}, {0.0, 0.0, 1.0}, {}, 0};
    const TracedRays entering = tracer.trace({&up, 1}, 0, nullptr);
    EXPECT_GT(entering.ledger.ledger[Account::transmitted], 0.01) << off;
    EXPECT_LT(entering.ledger.ledger[Account::transmitted], 0.3) << off;
    const IncidentRay down{{0.1, 0.2, -0.1 + off}, {0.0, 0.0, -1.0}, {}, 0};
    EXPECT_EQ(tracer.trace({&down, 1}, 0, nullptr).missed.size(), 1U) << off;
  }
}

TEST(RayTracer, RaysThatPassThePartAreMissed) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.3));
  RayTracer tracer(part, nullptr, 0.5, one_branch(), 1);
  tracer.add(pmma());
  const std::vector<IncidentRay> passing = {{{5.0, 0.2, 1.0}, {0.0, 0.0, -1.0}, {}, 0},
                                            {{0.1, 0.2, 1.0}, {0.0, 0.0, 1.0}, {}, 0},
                                            {{0.1, 0.2, -1.0}, {0.0, 0.0, -1.0}, {}, 0},
                                            {{-2.0, 0.2, 0.31}, {1.0, 0.0, 0.0}, {}, 0},
                                            {{-2.0, 0.2, -0.3}, {1.0, 0.0, 0.0}, {}, 0}};
  const TracedRays traced = tracer.trace(passing, 0, nullptr);
  EXPECT_EQ(traced.missed.size(), passing.size());
  EXPECT_EQ(traced.ledger.missed, static_cast<double>(passing.size()));
  EXPECT_TRUE(traced.leaving.empty());
}

// Every face of this prism reflects the ray totally: the cosine of each angle of incidence is at most 0.702, and the
// critical angle has a cosine of 0.742. The path therefore never leaves the part. It must end at the maximum number of
// events, and its power must be added to `truncated`.
TEST(RayTracer, ATrappedPathEndsAsTruncated) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.3));
  PathPolicy policy;
  policy.cutoff = 0.0;
  policy.split_power = 0.0;
  policy.max_events = 1'000;
  RayTracer tracer(part, nullptr, 0.5, policy, 1);
  tracer.add(pmma());
  const double in_plane = 22.5 * std::numbers::pi / 180.0;
  const Vec3 direction(0.76 * std::sin(in_plane), 0.65, 0.76 * std::cos(in_plane));
  const IncidentRay ray{{0.1, 0.2, 0.1}, direction.normalized(), {}, 0};
  const TracedRays traced = tracer.trace({&ray, 1}, 0, nullptr);
  EXPECT_NEAR(traced.ledger.ledger[Account::truncated], 1.0, 1e-9);
  EXPECT_TRUE(traced.leaving.empty());
}

TEST(RayTracer, ARayWithTooManySegmentsIsRefused) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.3));
  const IncidentRay ray{{0.1, 0.2, 1.0}, {0.0, 0.0, -1.0}, {}, 0};
  const auto trace = [&](std::uint64_t max_segments) {
    PathPolicy policy = every_branch();
    policy.max_segments = max_segments;
    RayTracer tracer(part, nullptr, 0.5, policy, 1);
    tracer.add(pmma());
    return tracer.trace({&ray, 1}, 0, nullptr);
  };
  EXPECT_NEAR(trace(1'000).ledger.ledger.total(), 1.0, 1e-9);
  EXPECT_THROW(trace(4), BudgetError);
}

}  // namespace
}  // namespace retrace::testing::ray_tracer_test
