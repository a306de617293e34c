// Tests of the rules that determine which engine can trace a model, and of the seeds of wavelengths.
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <vector>

#include "core/error.h"
#include "raytrace/engines/engine.h"
#include "raytrace/engines/wavelengths.h"

namespace retrace::testing::engines_test {
namespace {

using namespace retrace::raytrace;

constexpr Engine kEngines[] = {Engine::automatic,  Engine::exact, Engine::stochastic,
                               Engine::montecarlo, Engine::cell,  Engine::embree};

using Flag = bool EngineFacts::*;

EngineFacts facts_with(std::initializer_list<Flag> flags) {
  EngineFacts facts;
  for (const Flag flag : flags) facts.*flag = true;
  return facts;
}

/// Returns the engines that cannot trace a model because of `obstacle`. The test fails if an engine reports another
/// obstacle.
std::set<Engine> refused(const EngineFacts& facts, Obstacle obstacle) {
  std::set<Engine> engines;
  for (const Engine engine : kEngines)
    if (const auto found = obstacle_for(engine, facts)) {
      EXPECT_EQ(*found, obstacle) << engine_name(engine);
      engines.insert(engine);
    }
  return engines;
}

TEST(Engines, HaveNames) {
  for (const Engine engine : kEngines) EXPECT_EQ(engine_from_name(engine_name(engine)), engine);
  EXPECT_THROW(engine_from_name("rays"), InputError);
}

TEST(Engines, EachOfThemTracesASmoothPlanePart) {
  for (const Engine engine : kEngines) EXPECT_FALSE(obstacle_for(engine, {})) << engine_name(engine);
}

TEST(Engines, RefuseWhatTheyCannotTrace) {
  using F = EngineFacts;
  using enum Engine;
  const std::set<Engine> beams = {exact, stochastic};
  const std::set<Engine> all_but_embree = {exact, stochastic, cell};
  EXPECT_EQ(refused(facts_with({&F::has_balls}), Obstacle::balls), std::set({exact, stochastic, cell, embree}));
  EXPECT_EQ(refused(facts_with({&F::has_curved_entrance}), Obstacle::curved_entrance), all_but_embree);
  EXPECT_EQ(refused(facts_with({&F::has_deflecting_shells}), Obstacle::deflecting_shells), all_but_embree);
  EXPECT_EQ(refused(facts_with({&F::has_unequal_backs}), Obstacle::unequal_backs), all_but_embree);
  EXPECT_EQ(refused(facts_with({&F::needs_plain_sampling}), Obstacle::plain_sampling), all_but_embree);
  EXPECT_EQ(refused(facts_with({&F::has_unequal_cells}), Obstacle::unequal_cells), std::set({cell}));
  EXPECT_EQ(refused(facts_with({&F::has_form}), Obstacle::form), beams);
  EXPECT_EQ(refused(facts_with({&F::has_texture}), Obstacle::texture), beams);
  EXPECT_EQ(refused(facts_with({&F::has_texture, &F::texture_keeps_specular_light}), Obstacle::texture),
            std::set({exact}));
  EXPECT_EQ(refused(facts_with({&F::entrance_scatters}), Obstacle::scattering_entrance), beams);
}

TEST(Engines, BallsAreNotTracedWithPlainSampling) {
  const EngineFacts facts = facts_with({&EngineFacts::has_balls, &EngineFacts::needs_plain_sampling});
  EXPECT_EQ(obstacle_for(Engine::montecarlo, facts), Obstacle::plain_sampling);
  EXPECT_EQ(obstacle_for(Engine::embree, facts), Obstacle::balls);
}

TEST(Engines, PhasesAreFollowedThroughFormsOrTexturesButNotBoth) {
  using F = EngineFacts;
  const auto why = [](std::initializer_list<Flag> flags) {
    EngineFacts facts = facts_with(flags);
    facts.needs_phases = true;
    return obstacle_for(Engine::exact, facts);
  };
  EXPECT_EQ(why({&F::has_form}), std::nullopt);
  EXPECT_EQ(why({&F::has_texture, &F::texture_has_phases}), std::nullopt);
  EXPECT_EQ(why({&F::has_texture}), Obstacle::texture_without_phases);
  EXPECT_EQ(why({&F::has_form, &F::has_texture, &F::texture_has_phases}), Obstacle::form_and_texture);
  EXPECT_EQ(why({&F::entrance_scatters}), Obstacle::scattering_entrance);
}

TEST(Engines, FactsFollowFromTheOptics) {
  const EngineFacts smooth = facts_of(Optics());
  EXPECT_FALSE(smooth.has_texture || smooth.has_form || smooth.has_unequal_backs || smooth.entrance_scatters);
  Optics optics;
  optics.facet_scatter = surface_models::HarveyShack(surface_models::Roughness{5.0, 2.0});
  const EngineFacts rough = facts_of(optics);
  EXPECT_TRUE(rough.has_texture && rough.texture_keeps_specular_light && rough.texture_has_phases);
  optics.facet_scatter = surface_models::Abg(1e-3, 1e-4, 1.5);
  const EngineFacts abg = facts_of(optics);
  EXPECT_TRUE(abg.has_texture && !abg.texture_keeps_specular_light && !abg.texture_has_phases);
  optics.wet = std::make_shared<const WetBack>();
  EXPECT_TRUE(facts_of(optics).has_unequal_backs);
}

TEST(Engines, AreChosenForARequest) {
  using F = EngineFacts;
  for (const Engine requested : kEngines)
    EXPECT_EQ(is_exact(requested, {}), requested == Engine::automatic || requested == Engine::exact);
  EXPECT_FALSE(is_exact(Engine::automatic, facts_with({&F::has_texture})));
  EXPECT_EQ(ray_engine(Engine::automatic, {}), Engine::cell);
  EXPECT_EQ(ray_engine(Engine::embree, {}), Engine::embree);
  EXPECT_EQ(ray_engine(Engine::montecarlo, facts_with({&F::has_unequal_cells})), Engine::embree);
}

TEST(Engines, WavelengthsShareTheRaysAndTheTargetError) {
  Sampling all;
  all.seed = 7;
  all.rays = 1000;
  all.target_error = 1e-3;
  EXPECT_EQ(sampling_at(all, 0.25, 0).seed, all.seed);
  EXPECT_EQ(sampling_at(all, 0.25, 3).rays, 250U);
  EXPECT_EQ(sampling_at(all, 1e-9, 3).rays, 1U);
  EXPECT_DOUBLE_EQ(sampling_at(all, 0.25, 3).target_error, 2e-3);
  std::set<std::uint32_t> seeds;
  for (std::size_t k = 0; k < 100; ++k) seeds.insert(seed_at(all.seed, k));
  EXPECT_EQ(seeds.size(), 100U);
}

TEST(Engines, TraceEachDirectionAtEachWavelength) {
  for (const bool in_parallel : {false, true}) {
    TaskProgress progress(nullptr, 6);
    std::vector<int> count(6);
    EXPECT_TRUE(trace_wavelengths(2, 3, in_parallel, progress, [&](std::size_t direction, std::size_t k, Progress&) {
      ++count[3 * direction + k];
      return true;
    }));
    EXPECT_EQ(count, std::vector<int>(6, 1));
    EXPECT_FALSE(
        trace_wavelengths(2, 3, in_parallel, progress, [&](std::size_t, std::size_t k, Progress&) { return k != 1; }));
  }
}

}  // namespace
}  // namespace retrace::testing::engines_test
