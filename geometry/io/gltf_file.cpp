#include "geometry/io/gltf_file.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/version.h"
#include "geometry/io/face_groups.h"

namespace retrace::geometry {
namespace {

using Json = nlohmann::ordered_json;

// Constants of the format (glTF 2.0, 3.6.2 and 4.4.3).
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr std::uint32_t kMagic = 0x46546c67;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;
constexpr std::uint32_t kBinaryChunk = 0x004e4942;

void append(std::string& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(word >> shift & 0xffU);
}

Json vector_json(const Eigen::Vector3f& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Json material(std::optional<double> refractive_index, double absorption_per_mm) {
  if (!refractive_index)
    return {{"name", "metal"},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {0.8, 0.8, 0.78, 1.0}}, {"metallicFactor", 1.0}, {"roughnessFactor", 0.1}}}};
  Json clear = {{"name", "clear"},
                {"pbrMetallicRoughness",
                 {{"baseColorFactor", {1.0, 1.0, 1.0, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.0}}},
                {"extensions",
                 {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}},
                  {"KHR_materials_ior", {{"ior", *refractive_index}}},
                  // For a closed mesh, any thickness above 0 means that light is refracted at its faces.
                  {"KHR_materials_volume", {{"thicknessFactor", 1.0}}}}}};
  // White light is attenuated to the attenuation colour, here 1 / e, over the attenuation distance in metres.
  constexpr double kMetresPerMm = 1e-3;
  constexpr double kOneOverE = 0.36787944117144233;
  if (absorption_per_mm > 0.0)
    clear["extensions"]["KHR_materials_volume"].update({{"attenuationDistance", kMetresPerMm / absorption_per_mm},
                                                        {"attenuationColor", {kOneOverE, kOneOverE, kOneOverE}}});
  return clear;
}

/// JSON description and binary data of a file, which are built together.
class GltfFile {
 public:
  GltfFile(std::string_view title, std::optional<double> refractive_index, double absorption_per_mm) {
    json_ = {{"asset", {{"version", "2.0"}, {"generator", "retrace " + std::string(kVersion)}}}, {"scene", 0}};
    json_["scenes"] = {{{"name", title}, {"nodes", {0}}}};
    // Rotation by 90 degrees about x, as a quaternion (x, y, z, w).
    constexpr double kHalfRoot = 0.70710678118654752;
    json_["nodes"] = {{{"name", "part"},
                       {"rotation", {-kHalfRoot, 0.0, 0.0, kHalfRoot}},
                       {"scale", {1e-3, 1e-3, 1e-3}},
                       {"children", Json::array()}}};
    json_["materials"] = Json::array({material(refractive_index, absorption_per_mm)});
    if (refractive_index)
      json_["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_ior", "KHR_materials_volume"};
    for (const char* const list : {"accessors", "bufferViews", "meshes"}) json_[list] = Json::array();
  }

  /// Adds the vertices as the first accessor. All faces refer to them.
  void add_vertices(const std::vector<Vec3>& vertices) {
    Eigen::Vector3f lower = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
    Eigen::Vector3f upper = -lower;
    for (const Vec3& vertex : vertices) {
      const Eigen::Vector3f place = vertex.cast<float>();
      lower = lower.cwiseMin(place);
      upper = upper.cwiseMax(place);
      for (const float value : place) append(binary_, std::bit_cast<std::uint32_t>(value));
    }
    add_accessor(0, kArrayBuffer,
                 {{"componentType", kFloat},
                  {"count", vertices.size()},
                  {"type", "VEC3"},
                  {"min", vector_json(lower)},
                  {"max", vector_json(upper)}});
  }

  /// Adds a mesh of all faces with the given role, and its node. Nothing is added if there are no such faces.
  void add_faces(const BoundaryMesh& mesh, FacetRole role, std::string_view name) {
    const std::size_t begin = binary_.size();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (mesh.roles[t] == role)
        for (const std::uint32_t vertex : mesh.triangles[t]) append(binary_, vertex);
    if (binary_.size() == begin) return;
    const std::size_t indices =
        add_accessor(begin, kElementArrayBuffer,
                     {{"componentType", kUnsignedInt}, {"count", (binary_.size() - begin) / 4}, {"type", "SCALAR"}});
    json_["meshes"].push_back(
        {{"name", name}, {"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", indices}, {"material", 0}}}}});
    json_["nodes"][0]["children"].push_back(json_["nodes"].size());
    json_["nodes"].push_back({{"name", name}, {"mesh", json_["meshes"].size() - 1}});
  }

  /// Returns the file: header, description, binary data.
  std::string text() {
    json_["buffers"] = {{{"byteLength", binary_.size()}}};
    std::string description = json_.dump();
    description.append((4 - description.size() % 4) % 4, ' ');
    std::string text;
    append(text, kMagic);
    append(text, 2);
    append(text, static_cast<std::uint32_t>(12 + 8 + description.size() + 8 + binary_.size()));
    append(text, static_cast<std::uint32_t>(description.size()));
    append(text, kJsonChunk);
    text += description;
    append(text, static_cast<std::uint32_t>(binary_.size()));
    append(text, kBinaryChunk);
    return text + binary_;
  }

 private:
  /// Adds an accessor for the binary data from `begin` on.
  /// \return index of the accessor
  std::size_t add_accessor(std::size_t begin, int target, Json accessor) {
    accessor["bufferView"] = json_["bufferViews"].size();
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", binary_.size() - begin}, {"target", target}});
    json_["accessors"].push_back(std::move(accessor));
    return json_["accessors"].size() - 1;
  }

  Json json_;
  std::string binary_;
};

}  // namespace

std::string gltf_text(const BoundaryMesh& mesh, std::string_view title, std::optional<double> refractive_index,
                      double absorption_per_mm) {
  // Upper bound of the size of the header and the description.
  constexpr std::size_t kHead = 16384;
  if (12 * (mesh.vertices.size() + mesh.triangles.size()) + kHead > kMaxGltfBytes)
    throw InputError("the mesh is too large for glTF, whose files have at most 4 GiB; write OBJ instead");
  GltfFile file(title, refractive_index, absorption_per_mm);
  file.add_vertices(mesh.vertices);
  for (const auto& [role, name] : kFaceGroups) file.add_faces(mesh, role, name);
  return file.text();
}

}  // namespace retrace::geometry
