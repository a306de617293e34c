#pragma once

// Part with light paths for the three-dimensional view on the page of `retrace report`.

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "studies/scene/design_excerpt.h"

namespace retrace::studies {

/// Design as it is displayed.
struct DesignScene {
  geometry::BoundaryMesh mesh;
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< edges between faces that are not in one plane
  std::vector<ScenePath> paths;
  std::vector<std::string> remarks;  ///< differences from the design, as texts for the user
};

/// Returns a still picture of a few elements of a design (DesignExcerpt), with up to three kinds of paths for each
/// direction.
/// \throw InputError in the same cases as make_model()
DesignScene make_scene(const design::Design& design, const std::vector<SceneLight>& lights);

/// Returns the design from the JSON of a result (to_json()) for a picture. Texture, spectrum and polarisation are
/// omitted.
/// \throw InputError if the JSON does not describe a design
design::Design design_of_json(const nlohmann::ordered_json& json);

}  // namespace retrace::studies
