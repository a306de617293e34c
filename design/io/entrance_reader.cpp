#include "design/io/entrance_reader.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/angle.h"
#include "design/io/step_choice_reader.h"
#include "design/light_and_index.h"

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

/// Reads the shape of the entrance surface.
/// \pre the document has the key `entrance_surface.kind`
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
  if (kind == "step") return read_step_face(document, "entrance_surface");
  return geometry::PlaneEntrance{};
}

EntranceForm read_entrance_form(const Document& document) {
  EntranceForm form;
  form.shape = read_entrance_shape(document);
  if (!std::holds_alternative<geometry::StepFace>(form.shape))
    form.rotation_deg = document.number(key_in_surface("rotation_deg"));
  form.inclination.incidence_deg = document.number(key_in_surface("incidence_deg"));
  form.inclination.azimuth_deg = document.number(key_in_surface("azimuth_deg"));
  const std::optional<double> pin_angle_deg = document.number_if(key_in_surface("pin_angle_deg"));
  form.has_pin_angle = pin_angle_deg.has_value();
  form.inclination.pin_angle_deg = pin_angle_deg.value_or(0.0);
  return form;
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
    entrance.surface = read_entrance_form(document);
  else
    entrance.surface = read_entrance_file(document);
  if (document.has(key_in_surface("centre_mm"))) entrance.centre_mm = pair_in_surface(document, "centre_mm");
  return entrance;
}

void find_pin_angle(Design& design) {
  EntranceForm* const form = design.entrance ? std::get_if<EntranceForm>(&design.entrance->surface) : nullptr;
  if (form == nullptr || form->has_pin_angle || form->inclination.incidence_deg == 0.0) return;
  const double sine = std::sin(Angle::from_deg(form->inclination.incidence_deg).rad());
  form->inclination.pin_angle_deg = Angle::from_rad(std::asin(sine / index_at_centroid(design))).deg();
}

}  // namespace retrace::design
