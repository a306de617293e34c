#include "geometry/io/gltf_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/error.h"
#include "core/version.h"
#include "geometry/io/face_groups.h"

namespace retrace::geometry {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the format (glTF 2.0, 3.6.2 and 4.4.3).
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
                  // Of a closed mesh any thickness above 0 says that light is bent at its faces.
                  {"KHR_materials_volume", {{"thicknessFactor", 1.0}}}}}};
  // White light falls to the attenuation colour, here 1 / e, over the attenuation distance, in metres.
  constexpr double kMetresPerMm = 1e-3;
  constexpr double kOneOverE = 0.36787944117144233;
  if (absorption_per_mm > 0.0)
    clear["extensions"]["KHR_materials_volume"].update({{"attenuationDistance", kMetresPerMm / absorption_per_mm},
                                                        {"attenuationColor", {kOneOverE, kOneOverE, kOneOverE}}});
  return clear;
}

}  // namespace

std::string gltf_text(const BoundaryMesh& mesh, std::string_view title, std::optional<double> refractive_index,
                      double absorption_per_mm) {
  // The head and what describes the mesh take far less than this.
  constexpr std::size_t kHead = 16384;
  const std::size_t bytes = 12 * (mesh.vertices.size() + mesh.triangles.size());
  if (bytes + kHead > kMostGltfBytes)
    throw InputError("the mesh is too large for glTF, which ends at 4 GiB; OBJ takes it");

  Json json = {{"asset", {{"version", "2.0"}, {"generator", "retrace " + std::string(kVersion)}}}, {"scene", 0}};
  json["scenes"] = {{{"name", title}, {"nodes", {0}}}};
  // A quarter turn about x, as a quaternion x y z w.
  constexpr double kHalfRoot = 0.70710678118654752;
  json["nodes"] = {{{"name", "part"},
                    {"rotation", {-kHalfRoot, 0.0, 0.0, kHalfRoot}},
                    {"scale", {1e-3, 1e-3, 1e-3}},
                    {"children", Json::array()}}};
  json["materials"] = {material(refractive_index, absorption_per_mm)};
  if (refractive_index)
    json["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_ior", "KHR_materials_volume"};

  std::string binary;
  binary.reserve(bytes);
  Eigen::Vector3f lower = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
  Eigen::Vector3f upper = -lower;
  for (const Vec3& vertex : mesh.vertices) {
    const Eigen::Vector3f place = vertex.cast<float>();
    lower = lower.cwiseMin(place);
    upper = upper.cwiseMax(place);
    for (const float value : place) append(binary, std::bit_cast<std::uint32_t>(value));
  }
  json["accessors"] = {{{"bufferView", 0},
                        {"componentType", kFloat},
                        {"count", mesh.vertices.size()},
                        {"type", "VEC3"},
                        {"min", vector_json(lower)},
                        {"max", vector_json(upper)}}};
  json["bufferViews"] = {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", binary.size()}, {"target", kArrayBuffer}}};
  json["meshes"] = Json::array();
  for (const auto& [role, name] : kFaceGroups) {
    const std::size_t begin = binary.size();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (mesh.roles[t] == role)
        for (const std::uint32_t vertex : mesh.triangles[t]) append(binary, vertex);
    if (binary.size() == begin) continue;
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", binary.size() - begin}, {"target", kElementArrayBuffer}});
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", kUnsignedInt},
                                 {"count", (binary.size() - begin) / 4},
                                 {"type", "SCALAR"}});
    json["meshes"].push_back(
        {{"name", name},
         {"primitives",
          {{{"attributes", {{"POSITION", 0}}}, {"indices", json["accessors"].size() - 1}, {"material", 0}}}}});
    json["nodes"][0]["children"].push_back(json["nodes"].size());
    json["nodes"].push_back({{"name", name}, {"mesh", json["meshes"].size() - 1}});
  }
  json["buffers"] = {{{"byteLength", binary.size()}}};

  std::string head = json.dump();
  head.append((4 - head.size() % 4) % 4, ' ');
  std::string text;
  append(text, kMagic);
  append(text, 2);
  append(text, static_cast<std::uint32_t>(12 + 8 + head.size() + 8 + binary.size()));
  append(text, static_cast<std::uint32_t>(head.size()));
  append(text, kJsonChunk);
  text += head;
  append(text, static_cast<std::uint32_t>(binary.size()));
  append(text, kBinaryChunk);
  return text + binary;
}

}  // namespace retrace::geometry
