#pragma once

// A part with paths of light through it, to be shown in three dimensions on the page of `retrace report`.

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "studies/scene/piece.h"

namespace retrace::studies {

/// A design to look at.
struct DesignScene {
  geometry::BoundaryMesh mesh;
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< where faces meet
  std::vector<ScenePath> paths;
  std::vector<std::string> remarks;  ///< in what it differs from the design
};

/// A still picture of a Piece, with up to three kinds of path from each direction. \throw InputError as make_model()
DesignScene make_scene(const Design& design, const std::vector<SceneLight>& lights);

/// The design that a result quotes (to_json()), as far as it matters to a picture: texture, spectrum and polarisation
/// are left out. \throw InputError if it is none
Design design_of_json(const nlohmann::ordered_json& json);

}  // namespace retrace::studies
