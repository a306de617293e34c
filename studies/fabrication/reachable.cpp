#include "studies/fabrication/reachable.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/named_file.h"
#include "core/number_format.h"
#include "design/io/design_document.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/facet_planes.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/io/facet_planes_reader.h"
#include "geometry/outline/plan_region.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;

/// Returns the plane through a point that is given relative to the apex.
/// \param depth_mm depth of the apex below the rims
/// \param rotated true: the plane is rotated by 180 degrees, like its cell
geometry::HeightPlane height_plane(const Vec3& normal, const Vec3& point_mm, double depth_mm, bool rotated) {
  geometry::HeightPlane plane;
  plane.slope = (rotated ? 1.0 : -1.0) * normal.head<2>() / normal.z();
  plane.height_mm = -depth_mm + normal.dot(point_mm) / normal.z();
  return plane;
}

geometry::ElementPlanes element_at(const geometry::Element& element, const fabrication::ChiselReach& reach,
                                   const Vec2& centre_mm, bool rotated) {
  const double depth_mm = geometry::element_depth_mm(element);
  geometry::ElementPlanes planes;
  planes.centre_mm = centre_mm;
  planes.planes.clear();
  for (const geometry::CellFacet& facet : geometry::element_cell(element).facets)
    planes.planes.push_back({-depth_mm, rotated ? Vec2(-facet.plane.slope) : facet.plane.slope});
  for (std::size_t k = 0; k < 3; ++k)
    planes.caps[k] = height_plane(reach.caps[k].normal, reach.caps[k].point_mm, depth_mm, rotated);
  return planes;
}

/// Returns the centre of the array in the part frame.
Vec2 middle_of(const geometry::PartSpec& part) {
  if (part.array.arrangement != geometry::Arrangement::single)
    return 0.5 * Vec2(part.array.x_length_mm, part.array.y_length_mm);
  return 0.5 * geometry::bounding_box(geometry::aperture_outline(part.element)).size();
}

/// Returns a design that contains only what a chisel can cut: whole elements of the same material, with facet planes
/// from a table.
design::Design reached(const design::Design& design, const std::string& facets_file) {
  const geometry::PartSpec& part = design.part();
  design::Design reached;
  reached.title = (design.title.empty() ? "Part" : design.title) + ", as far as a chisel with a straight edge reaches";
  design::ElementArray array;
  array.part.element = part.element;
  array.part.array.arrangement = part.array.arrangement;
  array.part.array.partial_elements = geometry::PartialElements::omit;
  array.part.array.x_length_mm = part.array.x_length_mm;
  array.part.array.y_length_mm = part.array.y_length_mm;
  if (part.array.outline) {
    // Machined cavities extend into the margin. The design with the table of planes therefore has no margin.
    array.part.array.outline =
        std::make_shared<const geometry::PlanRegion>(geometry::without_margin(*part.array.outline));
    array.outline = design::with_absolute_path(design.elements()->outline);
  }
  array.part.thickness_mm = part.thickness_mm;
  array.facet_planes = design::FacetPlanesFile{facets_file, facets_file};
  reached.shape = std::move(array);
  reached.substance.material = design.substance.material;
  reached.substance.catalogue = design::with_absolute_path(design.substance.catalogue);
  reached.substance.refractive_index = design.substance.refractive_index;
  reached.substance.temperature_c = design.substance.temperature_c;
  reached.substance.absorption_per_mm = design.substance.absorption_per_mm;
  return reached;
}

}  // namespace

void check_is_cut(const design::Design& design) {
  if (std::holds_alternative<geometry::RoundCube>(design.part().element))
    throw InputError(
        design.where("element.kind"),
        "must be \"rtp\", \"hexagonal_icc\" or \"triangular_icc\" for a job, because the processes of retrace "
        "do not cut single round cube corners, got \"round_icc\"");
  if (std::holds_alternative<geometry::RuledCells>(design.part().element))
    throw InputError(design.where("element.kind"),
                     "must be \"rtp\", \"hexagonal_icc\" or \"triangular_icc\" for a job, because the processes of "
                     "retrace do not rule grooves, got \"ruled\"");
}

namespace {

void check_design(const design::Design& design, const JobRequest& request) {
  design::require_supported(design, {.what = "retrace job --reachable", .wet_backs = true});
  const geometry::PartSpec& part = design.part();
  check_is_cut(design);
  if (std::holds_alternative<geometry::RtpElement>(part.element))
    throw InputError(Field{"reachable"},
                     "only allowed for cube corners, because a chisel reaches every point of a prism");
  if (request.strategy == "dmc")
    throw InputError(Field{"reachable"},
                     "not allowed for the strategy dmc, because dmc reaches every point of a cube corner");
  if (part.array.extent == geometry::Extent::infinite)
    throw InputError({design.source_name(), 0, "array.extent"},
                     "must be \"finite\", because infinite arrays cannot be cut, got \"infinite\"");
  if (geometry::cant_of(part.element).deg != 0.0)
    throw InputError({design.source_name(), 0, "element.cant_deg"},
                     "must be 0, because canted cube corners cannot be cut in this version, got " +
                         shortest(geometry::cant_of(part.element).deg));
  if (request.shrinkage_percent != 0.0)
    throw InputError(Field{"shrinkage_percent"}, fmt::format("must be 0 with {}, got {}", reference({"reachable"}),
                                                             shortest(request.shrinkage_percent)));
}

}  // namespace

double reachable_fraction(const geometry::Element& element, double tool_width_mm) {
  return std::max(0.0, 1.0 - 0.25 * tool_width_mm * tool_width_mm / fabrication::facet_area_mm2(element));
}

ReachablePart reachable_part(const design::Design& design, const JobRequest& request, const std::string& facets_file) {
  check_design(design, request);
  check_job_request(request);
  const geometry::PartSpec& part = design.part();
  fabrication::Tool tool;
  tool.width_mm = request.tool_width_mm;
  read_named(Field{"tool_width_mm"}, [&] { fabrication::check_chisel_reach(part.element, tool, {}, {}); });
  ReachablePart result;
  result.reach = fabrication::chisel_reach(part.element, tool);
  std::vector<geometry::ElementPlanes> planes;
  for (const geometry::WholeElement& whole : geometry::whole_elements(part.array, part.element))
    planes.push_back(element_at(part.element, result.reach, middle_of(part) + whole.centre_mm, whole.is_rotated));
  if (planes.empty())
    throw InputError(
        part.array.outline ? design.where("outline") : InputLocation{design.source_name(), 0, "array.x_length_mm"},
        "the array must be large enough for at least one whole element");
  result.elements = static_cast<std::int64_t>(planes.size());
  const auto* const hexagonal = std::get_if<geometry::HexagonalCube>(&part.element);
  if (hexagonal != nullptr && part.array.arrangement != geometry::Arrangement::single)
    geometry::add_flares(planes, 0.5 * hexagonal->aperture_mm);
  result.facets = geometry::facet_planes_text({std::move(planes), geometry::cube_spacing_mm(part.element)});
  result.design = design::design_text(reached(design, facets_file));
  return result;
}

std::string reach_json(const ReachablePart& part, const JobRequest& request) {
  const fabrication::ChiselReach& r = part.reach;
  const nlohmann::ordered_json json = {{"elements", part.elements},
                                       {"strategy", request.strategy},
                                       {"tool_width_mm", request.tool_width_mm},
                                       {"facet_area_mm2", r.facet_area_mm2},
                                       {"reached_fraction", r.fraction},
                                       {"reached_fraction_cut", r.cut_fraction},
                                       {"core_mm", r.core_mm},
                                       {"core_mm_cut", r.cut_core_mm}};
  return result_text("retrace.reach/2", json, {});
}

std::string reach_table(const ReachablePart& part) {
  const fabrication::ChiselReach& r = part.reach;
  std::string text = fmt::format("  elements            {}\n", part.elements);
  text += fmt::format("  facets reached      {} % of their area, {} % in simulated cuts\n",
                      fixed(100.0 * r.fraction, 2), fixed(100.0 * r.cut_fraction, 2));
  text += fmt::format("  uncut above apex    {} mm high, {} mm in simulated cuts\n", fixed(r.core_mm, 6),
                      fixed(r.cut_core_mm, 6));
  return text;
}

}  // namespace retrace::studies
