#pragma once

// A part with paths of light through it, to be shown in three dimensions on the page of `retrace report`.

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "geometry/part/closed_boundary.h"
#include "raytrace/paths/light_path.h"
#include "studies/design/optical_model.h"

namespace retrace::studies {

/// A path and what share of the light that falls on one element goes such a way.
struct ScenePath {
  raytrace::LightPath path;
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
  double share = 0.0;
};

/// A design to look at.
struct DesignScene {
  geometry::BoundaryMesh mesh;
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< where faces meet
  std::vector<ScenePath> paths;
  std::vector<std::string> remarks;  ///< in what it differs from the design
};

/// Where the light comes from.
struct SceneLight {
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
};

/// At most `kSceneElements` elements along a side of an array, on a plate no thicker than they are wide; up to three
/// kinds of path from each direction, the most frequent ones. Rough facets are shown smooth.
/// \throw InputError as make_model()
DesignScene make_scene(const Design& design, const std::vector<SceneLight>& lights);

inline constexpr double kSceneElements = 4.0;

/// The design that a result quotes (to_json()), as far as it matters to a picture: texture, spectrum and polarisation
/// are left out. \throw InputError if it is none
Design design_of_json(const nlohmann::ordered_json& json);

}  // namespace retrace::studies
