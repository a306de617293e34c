#include "design/engine_facts.h"

namespace retrace::design {

raytrace::EngineFacts engine_facts(const Design& design, const raytrace::Optics* optics) {
  raytrace::EngineFacts facts;
  if (optics != nullptr) facts = raytrace::facts_of(*optics);
  facts.has_balls = design.balls() != nullptr;
  facts.has_curved_entrance = design.entrance.has_value();
  facts.has_deflecting_shells = design.has_deflecting_shells();
  return facts;
}

InputLocation position_of(const Design& design, raytrace::Obstacle obstacle) {
  using enum raytrace::Obstacle;
  switch (obstacle) {
    case balls: return design.where("element.kind");
    case curved_entrance: return design.where(design.entrance_key());
    case deflecting_shells: return design.where_shell_deflects();
    case unequal_backs: return design.where("wet_back.index");
    case form_and_texture:
    case texture:
    case texture_without_phases:
    case form: return design.where_facets();
    case scattering_entrance: return design.where_entrance_scatters();
    case plain_sampling:
    case unequal_cells: break;  // several keys together are the cause, or a key of the request
  }
  return {design.source_name(), 0, ""};
}

}  // namespace retrace::design
