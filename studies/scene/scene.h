#pragma once

// Part with light paths for the three-dimensional view on the page of `retrace report`.

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "studies/scene/piece.h"

namespace retrace::studies {

/// Design for display.
struct DesignScene {
  geometry::BoundaryMesh mesh;
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< edges between faces
  std::vector<ScenePath> paths;
  std::vector<std::string> remarks;  ///< differences from the design
};

/// Returns a still picture of a Piece, with up to three kinds of paths for each direction.
/// \throw InputError as make_model()
DesignScene make_scene(const Design& design, const std::vector<SceneLight>& lights);

/// Returns the design from the JSON of a result (to_json()) for a picture. Texture, spectrum and polarisation are left
/// out.
/// \throw InputError if the JSON is no design
Design design_of_json(const nlohmann::ordered_json& json);

}  // namespace retrace::studies
