#include "raytrace/engines/engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

#include "core/error.h"
#include "core/message_text.h"

namespace retrace::raytrace {

Engine engine_from_name(std::string_view name) {
  const auto* const found = std::ranges::find(kEngineNames, name);
  if (found != std::end(kEngineNames)) return static_cast<Engine>(found - std::begin(kEngineNames));
  throw InputError(Field{"engine"},
                   fmt::format("must be auto, exact, stochastic, montecarlo, cell or embree, got {}", printable(name)));
}

std::string_view engine_name(Engine engine) {
  return kEngineNames[static_cast<std::size_t>(engine)];
}

EngineFacts facts_of(const Optics& optics) {
  const auto* const rough = std::get_if<surface_models::HarveyShack>(&optics.facet_scatter);
  EngineFacts facts;
  facts.has_deflecting_shells = deflect(optics.shells);
  facts.has_unequal_backs = !optics.has_uniform_backing();
  facts.has_form = !optics.facet_form.is_plane();
  facts.has_texture = !optics.is_smooth();
  facts.texture_keeps_specular_light = rough != nullptr && rough->roughness().waviness_sq_nm == 0.0;
  facts.texture_has_phases = surface_models::has_phases(optics.facet_scatter);
  facts.entrance_scatters = optics.entrance.scatters();
  return facts;
}

std::optional<Obstacle> obstacle_for(Engine engine, const EngineFacts& facts) {
  const bool chooses = engine == Engine::automatic || engine == Engine::montecarlo;
  const bool stochastic = engine == Engine::stochastic;
  const bool cell = engine == Engine::cell;
  const bool with_phases = engine == Engine::exact && facts.needs_phases;
  const bool without_phases = engine == Engine::exact && !facts.needs_phases;
  const bool beams = engine == Engine::exact || stochastic;
  const std::pair<Obstacle, bool> rules[] = {
      {Obstacle::balls, facts.has_balls && !chooses},
      {Obstacle::curved_entrance, facts.has_curved_entrance && (beams || cell)},
      {Obstacle::deflecting_shells, facts.has_deflecting_shells && (beams || cell)},
      {Obstacle::unequal_backs, facts.has_unequal_backs && (beams || cell)},
      {Obstacle::plain_sampling, facts.needs_plain_sampling && (beams || cell || facts.has_balls)},
      {Obstacle::unequal_cells, facts.has_unequal_cells && cell},
      {Obstacle::form_and_texture, facts.has_form && facts.has_texture && with_phases},
      {Obstacle::texture, facts.has_texture && (without_phases || (stochastic && !facts.texture_keeps_specular_light))},
      {Obstacle::form, facts.has_form && (without_phases || stochastic)},
      {Obstacle::scattering_entrance, facts.entrance_scatters && beams},
      {Obstacle::texture_without_phases, facts.has_texture && !facts.texture_has_phases && with_phases}};
  for (const auto& [obstacle, applies] : rules)
    if (applies) return obstacle;
  return std::nullopt;
}

std::string_view subject_of(Obstacle obstacle) {
  switch (obstacle) {
    case Obstacle::balls: return "balls";
    case Obstacle::curved_entrance: return "curved entrance surfaces";
    case Obstacle::deflecting_shells: return "shells that change the direction of light";
    case Obstacle::unequal_backs: return "parts whose elements have different media behind them";
    case Obstacle::plain_sampling: return "plain sampling points";
    case Obstacle::unequal_cells: return "parts without an inner region of identical elements";
    case Obstacle::form_and_texture: return "facets with both a form and a texture";
    case Obstacle::texture: return "rough facets";
    case Obstacle::form: return "facets with a form";
    case Obstacle::scattering_entrance: return "an entrance face that scatters";
    case Obstacle::texture_without_phases:
      return "textures without phase information (abg, microfacet, height_map, roughness with a lay)";
  }
  return "";
}

std::string traced_by(Obstacle obstacle, std::string_view tracer) {
  const std::string_view verb = obstacle == Obstacle::scattering_entrance ? "is" : "are";
  return fmt::format("{} {} traced by {}", subject_of(obstacle), verb, tracer);
}

bool is_exact(Engine requested, const EngineFacts& facts) {
  return may_be_exact(requested) && !obstacle_for(Engine::exact, facts);
}

Engine ray_engine(Engine requested, const EngineFacts& facts) {
  return requested == Engine::embree || obstacle_for(Engine::cell, facts) ? Engine::embree : Engine::cell;
}

}  // namespace retrace::raytrace
