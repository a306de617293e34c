#include "design/io/entrance_reader.h"

#include <array>
#include <string>
#include <vector>

namespace retrace::design {
namespace {

using schema::Document;

std::string key_in_surface(std::string_view name) {
  return schema::path_in("entrance_surface", name);
}

std::array<double, 2> pair_in_surface(const Document& document, std::string_view name) {
  const std::vector<double> given = document.numbers(key_in_surface(name));
  return {given[0], given[1]};
}

/// Reads the shape of the surface.
/// \pre the key `kind` is given
geometry::EntranceShape read_entrance_shape(const Document& document) {
  const std::string kind = document.text(key_in_surface("kind"));
  const auto number = [&](std::string_view name) { return document.number(key_in_surface(name)); };
  if (kind == "cylinder") return geometry::CylinderEntrance{number("radius_mm"), number("conic")};
  if (kind == "sphere") return geometry::SphereEntrance{number("radius_mm"), number("conic")};
  if (kind == "biconic")
    return geometry::BiconicEntrance{pair_in_surface(document, "radii_mm"), pair_in_surface(document, "conics")};
  if (kind == "formula")
    return geometry::parse_entrance_formula(document.text(key_in_surface("formula")),
                                            document.where(key_in_surface("formula")));
  return geometry::PlaneEntrance{};
}

EntranceFile read_entrance_file(const Document& document) {
  EntranceFile entrance;
  entrance.is_mesh = document.has(key_in_surface("mesh"));
  const std::string key = key_in_surface(entrance.is_mesh ? "mesh" : "turned_part");
  entrance.file = document.file(key);
  entrance.name = document.text(key);
  entrance.mesh_bottom = entrance.is_mesh && document.text(key_in_surface("mesh_side")) == "bottom";
  return entrance;
}

}  // namespace

std::optional<CurvedEntrance> read_entrance(const Document& document) {
  if (!document.has("entrance_surface")) return std::nullopt;
  CurvedEntrance entrance;
  if (document.has(key_in_surface("kind")))
    entrance.surface = EntranceForm{read_entrance_shape(document), document.number(key_in_surface("rotation_deg"))};
  else
    entrance.surface = read_entrance_file(document);
  if (document.has(key_in_surface("centre_mm"))) entrance.centre_mm = pair_in_surface(document, "centre_mm");
  return entrance;
}

}  // namespace retrace::design
