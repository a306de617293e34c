#include "studies/scene/scene.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "core/schema/json.h"
#include "design/io/design_format.h"
#include "design/io/design_reader.h"

namespace retrace::studies {

design::Design design_of_json(const nlohmann::ordered_json& json) {
  const bool has_source = json.is_object() && json.contains("source") && json["source"].is_string();
  return design::parse_design(schema::toml_of_json(design::design_format(), json),
                              has_source ? json["source"].get<std::string>() : std::string("result"));
}

DesignScene make_scene(const design::Design& design, const std::vector<SceneLight>& lights) {
  const DesignExcerpt piece(design, materials::MaterialLibrary::shipped(), kSceneElements);
  DesignScene scene{piece.mesh(), piece.edges(), {}, piece.remarks()};
  for (const SceneLight& light : lights)
    for (ScenePath& path : piece.typical_paths(light)) scene.paths.push_back(std::move(path));
  return scene;
}

}  // namespace retrace::studies
