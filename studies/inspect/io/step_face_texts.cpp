#include "studies/inspect/io/step_face_texts.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/message_text.h"
#include "core/number_format.h"
#include "geometry/surface/step_surface.h"

namespace retrace::studies {
namespace {

constexpr double kNmPerMm = 1e6;

const geometry::StepFace* entrance_of_step(const design::Design& design) {
  const design::EntranceForm* const form = design.entrance ? design.entrance->form() : nullptr;
  return form != nullptr ? std::get_if<geometry::StepFace>(&form->shape) : nullptr;
}

const geometry::StepFace* substrate_of_step(const design::Design& design) {
  return design.elements() != nullptr && design.part().substrate
             ? std::get_if<geometry::StepFace>(&design.part().substrate->shape)
             : nullptr;
}

std::string face_text(std::string_view label, const geometry::StepFace& face) {
  const geometry::StepSurface& surface = *face.surface;
  const std::size_t count = surface.patches.face_count();
  std::string text =
      fmt::format("  {:<20}{}, {} face{}, {}; within {} nm and {} arcsec of the file\n", label, printable(face.name),
                  count, count == 1 ? "" : "s", printable(surface.unit),
                  fixed_visible(kNmPerMm * surface.deviation_mm, 4), fixed_visible(surface.deviation_arcsec, 4));
  if (surface.gap_mm > 0.0)
    text += fmt::format("  {:<20}gaps of up to {} mm between faces were closed\n", "", fixed(surface.gap_mm, 6));
  constexpr std::size_t kMaxLines = 10;
  for (std::size_t k = 0; k < surface.breaks.size() && k < kMaxLines; ++k) {
    const auto& [angle_deg, at_mm] = surface.breaks[k];
    text += fmt::format("  {:<20}tangent break of {} degrees at ({}, {}, {}) mm of the file\n", "",
                        fixed_visible(angle_deg, 2), fixed(at_mm.x(), 3), fixed(at_mm.y(), 3), fixed(at_mm.z(), 3));
  }
  if (surface.breaks.size() > kMaxLines)
    text += fmt::format("  {:<20}{} smaller tangent breaks\n", "", surface.breaks.size() - kMaxLines);
  return text;
}

nlohmann::ordered_json face_json(const geometry::StepSurface& surface) {
  nlohmann::ordered_json breaks = nlohmann::ordered_json::array();
  for (const auto& [angle_deg, at_mm] : surface.breaks)
    breaks.push_back({{"angle_deg", angle_deg}, {"at_mm", {at_mm.x(), at_mm.y(), at_mm.z()}}});
  return {{"unit", surface.unit},
          {"faces", surface.patches.face_count()},
          {"polynomials", surface.patches.patch_count()},
          {"origin_mm", {surface.origin_mm.x(), surface.origin_mm.y(), surface.origin_mm.z()}},
          {"deviation_nm", kNmPerMm * surface.deviation_mm},
          {"deviation_arcsec", surface.deviation_arcsec},
          {"gap_mm", surface.gap_mm},
          {"tangent_breaks", breaks}};
}

}  // namespace

std::string step_faces_text(const design::Design& design) {
  std::string text;
  if (const geometry::StepFace* const face = entrance_of_step(design)) text += face_text("entrance file", *face);
  if (const geometry::StepFace* const face = substrate_of_step(design)) text += face_text("substrate file", *face);
  return text;
}

void add_step_faces(const design::Design& design, nlohmann::ordered_json& json) {
  if (const geometry::StepFace* const face = entrance_of_step(design))
    json["entrance_surface"]["step"] = face_json(*face->surface);
  if (const geometry::StepFace* const face = substrate_of_step(design))
    json["substrate"]["step"] = face_json(*face->surface);
}

}  // namespace retrace::studies
