#pragma once

// The engines that trace light, and the rules that determine which of them can trace a model.

#include <optional>
#include <string>
#include <string_view>

#include "raytrace/light/optics.h"

namespace retrace::raytrace {

/// Tracing method of a request. `automatic` selects for each direction and wavelength the method that is expected to
/// reach the target error first: `exact`, `stochastic` or `montecarlo`. `montecarlo` uses `cell` if this engine can
/// trace the model, and otherwise `embree`.
enum class Engine { automatic, exact, stochastic, montecarlo, cell, embree };

/// Names of the engines, in the order of the enumerators.
inline constexpr std::string_view kEngineNames[] = {"auto", "exact", "stochastic", "montecarlo", "cell", "embree"};
/// Returns the engine with this name.
/// \throw InputError that lists all engines if the name is unknown
Engine engine_from_name(std::string_view name);
std::string_view engine_name(Engine engine);

/// Returns true if a request for this engine permits the engine `exact`.
constexpr bool may_be_exact(Engine requested) {
  return requested == Engine::exact || requested == Engine::automatic;
}

/// Properties of a model and of the requested result that determine which engines can be used. Every engine can be used
/// if all properties are false.
struct EngineFacts {
  bool has_balls = false;  ///< true: the model consists of balls; false: it is a part with an entrance face
  bool has_curved_entrance = false;
  bool has_deflecting_shells = false;         ///< shells in front of the part change the direction of light
  bool has_unequal_backs = false;             ///< the medium behind the elements is not the same for all of them
  bool has_unequal_cells = false;             ///< MonteCarlo::cell_supports() is false for the part
  bool has_form = false;                      ///< retro facets deviate from planes
  bool has_texture = false;                   ///< retro facets scatter
  bool texture_keeps_specular_light = false;  ///< enough light remains in the specular direction to trace it as a beam
  bool texture_has_phases = false;            ///< see surface_models::has_phases()
  bool entrance_scatters = false;
  bool needs_phases = false;          ///< the requested result needs the phases of the light, to compute diffraction
  bool needs_plain_sampling = false;  ///< the request uses Sampling::Kind::plain
};

/// Returns the facts that can be derived from optical properties. All other facts are false.
EngineFacts facts_of(const Optics& optics);

/// Reason why an engine cannot be used: a property of the model or of the requested result.
enum class Obstacle {
  balls,
  curved_entrance,
  deflecting_shells,
  unequal_backs,
  plain_sampling,
  unequal_cells,
  form_and_texture,  ///< facets have both a form and a texture, and phases are needed
  texture,
  form,
  scattering_entrance,
  texture_without_phases  ///< the texture does not determine the phases of the light, and phases are needed
};

/// Returns the reason why an engine cannot trace a model, or nothing if the engine can trace it. If there are several
/// reasons, the first in the order of Obstacle is returned. Requests for `automatic` or `montecarlo` can trace balls:
/// both then use BallTracer.
std::optional<Obstacle> obstacle_for(Engine engine, const EngineFacts& facts);

/// Returns an obstacle as the subject of a sentence, such as "rough facets".
std::string_view subject_of(Obstacle obstacle);
/// Returns a clause for messages, such as "rough facets are traced by rays".
/// \param tracer noun phrase, such as "rays"
std::string traced_by(Obstacle obstacle, std::string_view tracer);

/// Returns true if the engine `exact` can trace a model and the request permits this engine, see may_be_exact().
bool is_exact(Engine requested, const EngineFacts& facts);
/// Returns the engine for a request that is traced with rays instead of beams. This is `embree` if it is requested or
/// if `cell` cannot trace the model, and otherwise `cell`.
Engine ray_engine(Engine requested, const EngineFacts& facts);

}  // namespace retrace::raytrace
