#include "studies/solids/io/solid_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/text.h"
#include "core/version.h"
#include "design/io/design_json.h"
#include "design/optical_model.h"
#include "geometry/io/gltf_file.h"
#include "geometry/io/obj_file.h"
#include "geometry/io/step_file.h"
#include "geometry/io/stl_file.h"
#include "geometry/part/faceted_solid.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the title as one line of ASCII characters. It contains no line breaks, because they end a comment in OBJ. It
/// contains no apostrophes, because they end a text in STEP.
std::string title_of(const Solid& solid) {
  std::string title = printable(design::short_name(solid.design), 60) + ", " + name_of(solid.what);
  std::replace(title.begin(), title.end(), '\'', ' ');
  // STEP and STL support only ASCII.
  std::replace_if(
      title.begin(), title.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return title;
}

/// Returns the solid as glTF. A part has the transmittance of its material at the wavelength of its light. A mould is
/// metallic.
std::string gltf_text(const Solid& solid) {
  if (solid.what == SolidKind::mould) return geometry::gltf_text(solid.mesh, title_of(solid), std::nullopt, 0.0);
  design::Design body = solid.design;
  body.surface = {};
  body.wet_back.reset();
  const raytrace::Optics optics = design::make_light_model(body, materials::MaterialLibrary::shipped()).optics;
  return geometry::gltf_text(solid.mesh, title_of(solid), optics.index, optics.absorption_per_mm);
}

Json vector_json(const geometry::Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

/// Returns the solid that is written as STEP.
/// \pre solid.is_manifold
geometry::ExactSolid step_solid(const Solid& solid) {
  return solid.exact ? *solid.exact : geometry::ExactSolid{geometry::faceted_solid(solid.mesh), {}};
}

/// Returns the name of the surface of an exact entrance face.
std::string_view surface_name(const geometry::FaceSurface& surface) {
  constexpr std::array<std::string_view, 4> kNames = {"plane", "cylinder", "sphere", "B-spline"};
  return kNames.at(surface.index());
}

}  // namespace

SolidFormat solid_format(const std::string& file) {
  const std::string ending = ending_of(file);
  if (ending == ".stl") return SolidFormat::stl;
  if (ending == ".obj") return SolidFormat::obj;
  if (ending == ".glb") return SolidFormat::gltf;
  if (ending == ".step" || ending == ".stp") return SolidFormat::step;
  throw InputError(
      Field{"out"},
      fmt::format(
          "must end in .stl, .obj, .glb, .step or .stp for a solid, or in .json, .xml or .glsl for a material, got {}",
          in_quotes(file)));
}

std::string solid_text(const Solid& solid, SolidFormat format) {
  switch (format) {
    case SolidFormat::stl:
      return geometry::stl_text(solid.mesh, "retrace " + std::string(kVersion) + ", mm: " + title_of(solid));
    case SolidFormat::obj:
      return geometry::obj_text(solid.mesh, "retrace " + std::string(kVersion) + ": " + title_of(solid));
    case SolidFormat::gltf: return gltf_text(solid);
    case SolidFormat::step: break;
  }
  if (!solid.is_manifold)
    throw InputError(
        {solid.design.source_name(), 0, ""},
        "the part touches itself along edges, which is not allowed for a STEP solid: export it as STL or OBJ");
  return geometry::step_text(step_solid(solid), title_of(solid));
}

std::string step_notice(const Solid& solid) {
  // Costs below which the user need not be told.
  constexpr double kFewMegabytes = 20.0, kFewSeconds = 5.0;
  if (!solid.is_manifold) return {};
  const geometry::ExactSolid exact = step_solid(solid);
  const geometry::StepCost cost = geometry::predicted_step_cost(exact);
  if (cost.megabytes < kFewMegabytes && cost.seconds < kFewSeconds) return {};
  return fmt::format("the STEP file has {} faces; it takes about {:.0f} MB and {:.0f} s", exact.faces.faces.size(),
                     cost.megabytes, cost.seconds);
}

std::string solid_json(const Solid& solid, const std::string& file) {
  Json json = {{"design", design::to_json(solid.design)}, {"what", name_of(solid.what)}};
  if (!file.empty()) json["file"] = file;
  if (solid.what == SolidKind::mould) json["block_mm"] = solid.block_mm;
  if (solid.surface_error_mm) json["surface_error_mm"] = *solid.surface_error_mm;
  json.update({{"elements_full", solid.elements_full},
               {"elements_partial", solid.elements_partial},
               {"volume_mm3", solid.volume_mm3},
               {"area_mm2", solid.area_mm2},
               {"lower_mm", vector_json(solid.lower_mm)},
               {"upper_mm", vector_json(solid.upper_mm)}});
  if (solid.exact) {
    json["faces"] = solid.exact->faces.faces.size();
    json["entrance_face"] = surface_name(solid.exact->entrance->surface);
  } else {
    json["triangles"] = solid.mesh.triangles.size();
  }
  json["is_manifold"] = solid.is_manifold;
  return result_text("retrace.export/2", json, solid.warnings);
}

std::string solid_table(const Solid& solid) {
  const auto size = solid.upper_mm - solid.lower_mm;
  std::string text = fmt::format("{} of {}\n", name_of(solid.what), printable(design::short_name(solid.design)));
  if (solid.what == SolidKind::mould) text += fmt::format("  block below the deepest point  {} mm\n", solid.block_mm);
  text += fmt::format("  elements   {} whole, {} cut\n", solid.elements_full, solid.elements_partial);
  text += fmt::format("  size       {} x {} x {} mm\n", fixed(size.x(), 4), fixed(size.y(), 4), fixed(size.z(), 4));
  text += fmt::format("  volume     {} mm3\n", fixed(solid.volume_mm3, 6));
  text += fmt::format("  surface    {} mm2\n", fixed(solid.area_mm2, 6));
  if (solid.exact) {
    text += fmt::format("  faces      {}\n", solid.exact->faces.faces.size());
    text += fmt::format("  entrance   {}", surface_name(solid.exact->entrance->surface));
    if (*solid.surface_error_mm > 0.0)
      text += fmt::format(" within {:.2g} mm of the exact surface", *solid.surface_error_mm);
    return text + "\n";
  }
  text += fmt::format("  triangles  {}\n", solid.mesh.triangles.size());
  if (solid.surface_error_mm)
    text +=
        fmt::format("  entrance   triangles within {} mm of the exact surface\n", fixed(*solid.surface_error_mm, 6));
  return text;
}

}  // namespace retrace::studies
