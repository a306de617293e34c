// Tests of the engine that `auto` selects, and of the accuracy of exact values if some power is truncated.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/threads.h"
#include "design/io/design_reader.h"
#include "studies/rre/io/rre_files.h"
#include "studies/rre/rre.h"
#include "tests/support/sample_size.h"

namespace retrace::testing::engine_choice_test {
namespace {

using namespace retrace::studies;
using raytrace::Account;

const std::string kHoneycomb = R"(
[element]
kind = "hexagonal_icc"
aperture_mm = 2.5
[array]
extent = "infinite"
[body]
thickness_mm = 2
refractive_index = 1.49
)";

std::string prisms(const std::string& array) {
  return "[element]\nkind = \"rtp\"\nbase_mm = 0.45\nwidth_mm = 0.45\n[array]\n" + array +
         "\n[body]\nthickness_mm = 2\nrefractive_index = 1.4917\n";
}
const std::string kSingle = prisms("arrangement = \"single\"");
const std::string kBricks = prisms("arrangement = \"offset\"\nextent = \"infinite\"");

RreResult run(const std::string& text, const std::vector<std::string>& overrides, RreSettings request,
              unsigned threads = 0) {
  RreResult result;
  const RreStudy study({design::parse_design(text, "design", overrides)}, std::move(request));
  run_with_threads(threads, [&] { result = study.run(); });
  return result;
}

RreSettings at(std::vector<double> incidence_deg, raytrace::Engine engine, std::optional<double> target_error) {
  RreSettings request;
  request.incidence_deg = std::move(incidence_deg);
  request.azimuth_deg = {17.0};
  request.engine = engine;
  request.target_error = target_error;
  return request;
}

TEST(EngineChoice, WhatIsTruncatedBoundsTheExactValue) {
  const double left = test::sample_size(1e-4, 3e-5);
  std::vector<double> goals = {1e-2, 1e-3};
  if (test::is_long_run()) goals.push_back(1e-4);
  for (const std::string& text : {kHoneycomb, kBricks}) {
    const RreResult fine = run(text, {}, at({0.0, 12.0}, raytrace::Engine::exact, left));
    for (const double goal : goals) {
      const RreResult rough = run(text, {}, at({0.0, 12.0}, raytrace::Engine::exact, goal));
      for (std::size_t k = 0; k < rough.points.size(); ++k) {
        const RrePoint& p = rough.points[k];
        EXPECT_LE(p.ledger[Account::truncated], goal);
        EXPECT_LE(p.rre, fine.points[k].rre + left);
        EXPECT_GE(p.rre + p.ledger[Account::truncated], fine.points[k].rre - 1e-9);
        EXPECT_NEAR(p.ledger.total(), 1.0, 1e-9);
        EXPECT_EQ(p.std_error, 0.0);
      }
    }
  }
}

TEST(EngineChoice, ExactByNameLeavesNothingThatShows) {
  for (const RrePoint& p : run(kSingle, {}, at({0.0, 5.0}, raytrace::Engine::exact, std::nullopt)).points)
    EXPECT_LE(p.ledger[Account::truncated], 1e-10);
}

TEST(EngineChoice, OneHardDirectionLeavesTheOthersExact) {
  const RreResult found = run(kHoneycomb, {}, at({0.0, 20.0}, raytrace::Engine::automatic, 1e-3));
  EXPECT_EQ(found.points[0].engine, "exact");
  EXPECT_EQ(found.points[1].engine, "stochastic");
  EXPECT_EQ(found.engine, kMixedEngines);
  EXPECT_EQ(found.points[0].std_error, 0.0);
  EXPECT_LE(found.points[1].std_error, 1e-3);
}

TEST(EngineChoice, AgreesWithTheExactEngineWithinWhatItSays) {
  constexpr double left = 1e-4;
  for (const std::string& text : {kHoneycomb, kBricks}) {
    const RreResult chosen = run(text, {}, at({3.0, 12.0, 30.0}, raytrace::Engine::automatic, 1e-3));
    const RreResult fine = run(text, {}, at({3.0, 12.0, 30.0}, raytrace::Engine::exact, left));
    for (std::size_t k = 0; k < chosen.points.size(); ++k) {
      const RrePoint& p = chosen.points[k];
      EXPECT_GE(fine.points[k].rre + left, p.rre - 4.0 * p.std_error) << p.incidence_deg << p.engine;
      EXPECT_LE(fine.points[k].rre, p.rre + p.ledger[Account::truncated] + 4.0 * p.std_error)
          << p.incidence_deg << p.engine;
    }
  }
}

TEST(EngineChoice, IsTheSameAtAnyNumberOfThreads) {
  const std::vector<std::string> white = {"light.spectrum=A"};
  const auto text = [&](unsigned threads) {
    RreResult found = run(kHoneycomb, white, at({0.0, 10.0, 25.0}, raytrace::Engine::automatic, 1e-3), threads);
    found.elapsed_s = 0.0;
    return rre_json(found);
  };
  const std::string alone = text(1);
  EXPECT_EQ(text(2), alone);
  EXPECT_EQ(text(5), alone);
}

// Trapped light travels almost parallel to the entrance face. In an infinite part, it may travel thousands of
// kilometres, so that an unlimited search for its next hit would not end.
TEST(EngineChoice, AWetBackAtNormalIncidenceEnds) {
  for (const char* index : {"body.back_index=1.2", "body.back_index=1.333", "body.back_index=1.45"}) {
    RreSettings beams = at({0.0}, raytrace::Engine::exact, std::nullopt);
    beams.azimuth_deg = {0.0};
    beams.cutoff = 3e-5;
    const RrePoint exact = run(kBricks, {index}, beams).points.front();
    RreSettings rays = beams;
    rays.engine = raytrace::Engine::montecarlo;
    rays.cutoff = std::nullopt;
    rays.target_error = 1e-4;
    const RrePoint sampled = run(kBricks, {index}, rays).points.front();
    EXPECT_NEAR(exact.ledger.total(), 1.0, 1e-9) << index;
    EXPECT_LT(exact.ledger[Account::truncated], 0.05) << index;
    EXPECT_LE(exact.rre, sampled.rre + 4.0 * sampled.std_error) << index;
    EXPECT_GE(exact.rre + exact.ledger[Account::truncated], sampled.rre - 4.0 * sampled.std_error) << index;
  }
}

}  // namespace
}  // namespace retrace::testing::engine_choice_test
