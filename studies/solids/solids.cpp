#include "studies/solids/solids.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.h"
#include "design/design_part.h"
#include "design/entrance_of_design.h"
#include "design/part_of_design.h"
#include "geometry/entrance/curved_boundary.h"
#include "geometry/entrance/exact_boundary.h"
#include "geometry/part/faceted_solid.h"
#include "geometry/part/mesh_part.h"
#include "geometry/part/mould_boundary.h"
#include "geometry/part/welded_part.h"
#include "requests/descriptions.h"

namespace retrace::studies {
namespace {

constexpr std::array<std::string_view, 3> kKinds = {"element", "array", "mould"};

/// Returns the kind of solid that has the given name.
/// \pre `word` is in kKinds
SolidKind kind_of(const std::string& word) {
  return static_cast<SolidKind>(std::ranges::find(kKinds, word) - kKinds.begin());
}

/// Estimates the number of elements of a finite array before it is built.
double estimated_elements(const geometry::PartSpec& spec) {
  if (spec.array.arrangement == geometry::Arrangement::single) return 1.0;
  const double cell_mm2 = geometry::area(geometry::aperture_outline(spec.element));
  const auto* const rtp = std::get_if<geometry::RtpElement>(&spec.element);
  const double with_gaps_mm2 =
      rtp != nullptr ? (rtp->base_mm + spec.array.x_gap_mm) * (rtp->width_mm + spec.array.y_gap_mm) : cell_mm2;
  return spec.array.x_length_mm * spec.array.y_length_mm / with_gaps_mm2;
}

geometry::PartSpec spec_of(const design::Design& design, SolidKind what) {
  geometry::PartSpec spec = design.part();
  if (what == SolidKind::element) {
    spec.array.arrangement = geometry::Arrangement::single;
    spec.array.extent = geometry::Extent::finite;
    return spec;
  }
  if (spec.array.extent == geometry::Extent::infinite)
    throw InputError({design.source_name(), 0, "array.extent"},
                     fmt::format("must be \"finite\" for {0} {1}, got \"infinite\"; {0} element has one element",
                                 reference({"what"}), name_of(what)));
  const double elements = estimated_elements(spec);
  if (elements > static_cast<double>(kMaxSolidElements))
    throw InputError({design.source_name(), 0, "array.x_length_mm"},
                     fmt::format("the solid would have about {:.0f} elements, but at most {} can be exported", elements,
                                 kMaxSolidElements));
  return spec;
}

/// Measures the mesh of a solid. The measures of an exact solid are already set.
void measure(Solid& solid) {
  if (solid.exact) return;
  solid.volume_mm3 = geometry::volume_mm3(solid.mesh);
  solid.area_mm2 = geometry::area_mm2(solid.mesh);
  solid.lower_mm.setConstant(INFINITY);
  solid.upper_mm.setConstant(-INFINITY);
  for (const auto& t : solid.mesh.triangles)
    for (const std::uint32_t v : t) {
      solid.lower_mm = solid.lower_mm.cwiseMin(solid.mesh.vertices[v]);
      solid.upper_mm = solid.upper_mm.cwiseMax(solid.mesh.vertices[v]);
    }
  solid.is_manifold = geometry::is_closed_manifold(solid.mesh);
}

/// Checks that the options of the request are allowed for the entrance face of the design.
void check_entrance(const design::Design& design, SolidKind what, const SolidRequest& request) {
  if (!design.entrance) {
    if (request.surface_error_mm)
      throw InputError(Field{"surface_error_mm"}, "only allowed for a design with an [entrance_surface]");
    return;
  }
  if (what == SolidKind::element)
    throw InputError(design.where(design.entrance_key()),
                     reference({"what"}) +
                         " element is not available with an [entrance_surface], which covers the "
                         "whole part: export the array");
}

void add_warnings(Solid& solid) {
  const std::string name = solid.design.source_name();
  if (solid.design.substance.is_hollow)
    solid.warnings.push_back(
        {"solid_of_air",
         name + ": the design is a hollow cube corner, so that the solid is the air in front of its mirrors"});
  if (!solid.is_manifold)
    solid.warnings.push_back(
        {"touching_edges", name + ": the part touches itself along edges; some programs treat it as an open surface"});
  if (!solid.design.surface.is_smooth())
    solid.warnings.push_back(
        {"texture_omitted",
         name + ": the texture of the facets is not exported, because the facets of solids are plane"});
  if (!solid.design.surface.form.is_plane())
    solid.warnings.push_back(
        {"form_omitted", name + ": the form of the facets is not exported, because the facets of solids are plane"});
}

geometry::Part part_to_write(const design::Design& design, SolidKind what) {
  const geometry::PartSpec spec = spec_of(design, what);
  if (what == SolidKind::element && !design.facet_planes()) return geometry::build_welded_part(spec);
  if (!design.facet_planes() && !design.mask()) return geometry::build_welded_part(spec);
  if (what == SolidKind::element)
    throw InputError(
        design.where("part.facets"),
        reference({"what"}) + " element is not available for planes of individual facets: export the array");
  geometry::Part part = design::part_of(design);
  if (part.placements.size() != 1)
    throw InputError(design.where(design.mask() ? "array.mask" : "part.facets"),
                     "arrays with such elements can be exported only up to about 2000 elements");
  return part;
}

/// Sets the exact boundary and the measures of a solid.
void set_exact_boundary(Solid& solid, geometry::ExactBoundary boundary) {
  solid.surface_error_mm = boundary.entrance_error_mm;
  solid.volume_mm3 = boundary.volume_mm3;
  solid.area_mm2 = boundary.area_mm2;
  solid.lower_mm = solid.upper_mm = boundary.solid.faces.vertices.front();
  for (const geometry::Vec3& p : boundary.solid.faces.vertices) {
    solid.lower_mm = solid.lower_mm.cwiseMin(p);
    solid.upper_mm = solid.upper_mm.cwiseMax(p);
  }
  solid.upper_mm.z() = boundary.highest_mm;
  solid.exact = std::move(boundary.solid);
}

/// Sets the boundary of a solid to that of a part, including the curved entrance face of the design if it has one.
void set_boundary(Solid& solid, const geometry::Part& part, const SolidRequest& request, SolidEntrance model) {
  solid.elements_full = part.elements_full;
  solid.elements_partial = part.elements_partial;
  if (!solid.design.entrance) {
    solid.mesh = geometry::closed_boundary(part);
    return;
  }
  const geometry::Entrance entrance = design::entrance_of_design(solid.design, part);
  try {
    const auto* const surface = std::get_if<std::shared_ptr<const geometry::EntranceSurface>>(&entrance);
    if (model == SolidEntrance::exact && surface != nullptr) {
      set_exact_boundary(solid,
                         geometry::exact_boundary(part, **surface, design::closed_form_of_entrance(solid.design, part),
                                                  request.surface_error_mm.value_or(kSplineErrorMm)));
      return;
    }
    geometry::CurvedBoundary boundary =
        geometry::curved_boundary(part, entrance, request.surface_error_mm.value_or(kSurfaceErrorMm));
    solid.mesh = std::move(boundary.mesh);
    solid.surface_error_mm = boundary.entrance_error_mm;
    if (!geometry::open_edges(solid.mesh).empty())
      throw InputError("cannot be joined to the sides of the mesh of the part without gaps");
  } catch (const InputError& error) {
    throw InputError(solid.design.where(solid.design.entrance_key()), error.what());
  }
}

/// Returns the solid with its mesh, for a design that is read from a mesh file or consists of zones. Repairs of the
/// mesh are reported in the warnings.
Solid solid_of_mesh(Solid solid, const SolidRequest& request, SolidEntrance model) {
  if (solid.what != SolidKind::array)
    design::require_supported(
        solid.design, {.what = fmt::format("{} {}", reference({"what"}), name_of(solid.what)), .wet_backs = true});
  if (solid.design.zoned() || solid.design.entrance) {
    set_boundary(solid, design::part_of_design(solid.design, &solid.warnings), request, model);
  } else {
    solid.mesh = geometry::boundary_of(design::mesh_of_design(solid.design, &solid.warnings));
  }
  measure(solid);
  add_warnings(solid);
  return solid;
}

}  // namespace

std::string name_of(SolidKind kind) {
  return std::string(kKinds[static_cast<std::size_t>(kind)]);
}

Solid make_solid(const design::Design& design, const SolidRequest& request, SolidEntrance model) {
  requests::check(request);
  design::require_supported(design, {.what = "retrace export", .solids = true, .entrances = true, .wet_backs = true});
  Solid solid;
  solid.design = design;
  solid.what = kind_of(request.what);
  check_entrance(design, solid.what, request);
  if (!design.elements()) return solid_of_mesh(std::move(solid), request, model);
  const geometry::Part part = part_to_write(design, solid.what);
  if (solid.what == SolidKind::mould) {
    solid.elements_full = part.elements_full;
    solid.elements_partial = part.elements_partial;
    solid.block_mm = request.block_mm.value_or(part.thickness_mm);
    solid.mesh = geometry::mould_boundary(part, solid.block_mm);
  } else {
    set_boundary(solid, part, request, model);
  }
  measure(solid);
  add_warnings(solid);
  return solid;
}

}  // namespace retrace::studies
