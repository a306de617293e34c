#include "studies/inspect/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/number_format.h"
#include "design/design_part.h"
#include "design/optical_model.h"
#include "geometry/check/boundary_check.h"
#include "geometry/elements/edges.h"
#include "geometry/elements/lattice.h"
#include "geometry/entrance/curved_boundary.h"
#include "raytrace/balls/ball_forms.h"
#include "requests/descriptions.h"

namespace retrace::studies {
namespace {

// Maximum number of elements whose boundary is checked completely. For more elements, a smaller part of the same kind
// is checked, because CGAL would need many seconds.
constexpr double kElementsToCheck = 1000.0;
// Maximum distance between a curved entrance face and the triangles of the boundary to be checked, as a fraction of the
// size of the part.
constexpr double kCheckedError = 1e-3;

/// Returns a finite part with the same elements, which is small enough for a quick check with CGAL. If the design is
/// small, returns the design itself.
/// \param is_whole receives true if the part is the design itself
geometry::PartSpec part_to_check(const geometry::PartSpec& spec, double element_mm, bool& is_whole) {
  geometry::PartSpec small = spec;
  is_whole = spec.array.arrangement == geometry::Arrangement::single;
  if (is_whole) return small;
  if (spec.array.extent == geometry::Extent::finite &&
      spec.array.x_length_mm * spec.array.y_length_mm < kElementsToCheck * element_mm * element_mm) {
    is_whole = true;
    return small;
  }
  const double gap = std::max(spec.array.x_gap_mm, spec.array.y_gap_mm);
  double side = 0.0;
  if (const auto* rtp = std::get_if<geometry::RtpElement>(&spec.element))
    side = std::max(rtp->base_mm, rtp->width_mm);
  else
    side = 2.0 * element_mm;
  small.array.extent = geometry::Extent::finite;
  small.array.outline.reset();
  small.array.x_length_mm = 6.0 * (side + gap) + 2.0 * spec.array.x_offset_mm;
  small.array.y_length_mm = 6.0 * (side + gap) + 2.0 * spec.array.y_offset_mm;
  return small;
}

std::string finding_of(const geometry::BoundaryMesh& boundary) {
  const geometry::BoundaryReport report = geometry::check_boundary(boundary);
  // With angle errors or cant, neighbouring elements may differ in height. The part may then touch itself where more
  // than three cells meet.
  return report.ok()           ? "closed, free of self-intersections"
         : !report.is_closed   ? "not closed"
         : !report.is_manifold ? "closed, touches itself along edges"
                               : "crosses itself";
}

/// Returns the closed boundary of a part. The entrance face is the curved face of the model, or plane if there is none.
geometry::BoundaryMesh boundary_to_check(const geometry::Part& part, const design::OpticalModel& model) {
  if (!model.entrance) return geometry::closed_boundary(part);
  const double size_mm = geometry::bounding_box(part.outline).size().maxCoeff();
  return geometry::curved_boundary(part, *model.entrance, kCheckedError * size_mm).mesh;
}

std::string boundary_finding(const design::Design& design, const design::OpticalModel& model) {
  bool is_whole = design.facet_planes() != nullptr || design.mask() != nullptr;
  const geometry::Part part = is_whole
                                  ? design::part_of(design)
                                  : geometry::build_part(part_to_check(design.part(), model.part.size_mm, is_whole));
  if (part.placements.size() != 1) return "not checked: the elements are too small compared with the array";
  const std::string finding = finding_of(is_whole ? boundary_to_check(part, model) : geometry::closed_boundary(part));
  return is_whole ? finding : finding + " (checked on a smaller array of the same elements)";
}

double min_refractive_index(const std::vector<design::SpectralOptics>& light) {
  const auto smaller = [](const design::SpectralOptics& a, const design::SpectralOptics& b) {
    return a.optics.index < b.optics.index;
  };
  return std::min_element(light.begin(), light.end(), smaller)->optics.index;
}

/// Returns the refractive index of the medium behind the elements, or behind the dry elements if some are wet.
double back_index(const Inspection& result) {
  return result.light.front().optics.back_index;
}

double mean_index(const std::vector<design::SpectralOptics>& light) {
  double mean = 0.0;
  for (const design::SpectralOptics& at : light) mean += at.weight * at.optics.index;
  return mean;
}

/// Returns the properties of the elements that reduce the range of total reflection. Empty if there are none.
std::string circumstances(const Inspection& result) {
  std::string text;
  if (back_index(result) > 1.0) text += fmt::format(", index {} behind the facets", shortest(back_index(result)));
  const geometry::Cant cant = geometry::cant_of(result.design.part().element);
  if (cant.deg > 0.0) text += fmt::format(", canted by {} degrees", shortest(cant.deg));
  return text;
}

/// Returns a text about light from the azimuth opposite to that of the limit of total reflection. The text contains the
/// incidence at which total reflection begins for this light. Empty if it never begins.
std::string where_it_begins(const Inspection& result) {
  const geometry::PartSpec& part = result.design.part();
  if (std::holds_alternative<geometry::RtpElement>(part.element)) return {};
  const double away_deg = std::fmod(*result.tir_limit_azimuth_deg + 180.0, 360.0);
  const auto from_deg = design::total_reflection_from_deg(part, min_refractive_index(result.light), back_index(result),
                                                          Angle::from_deg(away_deg));
  if (!from_deg) return {};
  return fmt::format("; total reflection begins at an incidence of {:.2f} degrees and an azimuth of {:.1f} degrees",
                     *from_deg, away_deg);
}

std::string of_turned_elements(const geometry::PartSpec& part) {
  return part.array.arrangement == geometry::Arrangement::triangular
             ? "; for rotated elements, add 180 degrees to the azimuth"
             : "";
}

/// Adds a warning about the limit of total reflection, for cube corners that are canted or have a medium other than air
/// behind them.
void tell_early_end(Inspection& result) {
  const geometry::PartSpec& part = result.design.part();
  if (std::holds_alternative<geometry::RtpElement>(part.element) || circumstances(result).empty()) return;
  result.warnings.push_back(
      {"total_reflection_limit",
       fmt::format("{}: total reflection at the facets ends at an incidence of {} degrees and an azimuth of {:.1f} "
                   "degrees (n = {:.4f}{}){}",
                   result.design.source_name(), fixed_visible(*result.tir_limit_deg, 2), *result.tir_limit_azimuth_deg,
                   min_refractive_index(result.light), circumstances(result), of_turned_elements(part))});
}

/// Adds a warning if light at normal incidence is not totally reflected at some wavelengths.
void warn_of_lost_reflection(Inspection& result) {
  if (!result.design.needs_total_reflection() || result.design.has_deflecting_shells()) return;
  if (result.coating.facets && result.coating.facets->stack.absorbs()) return;  // the facets reflect by their coating
  if (result.tir_limit_deg) return tell_early_end(result);
  const std::string lost =
      fmt::format("{}: the facets have no total reflection at normal incidence", result.design.source_name());
  double share = 0.0;
  double from_nm = 0.0;  // range of the wavelengths without total reflection
  double to_nm = 0.0;
  for (const design::SpectralOptics& at : result.light) {
    if (design::tir_limit_deg(result.design.part(), at.optics.index, at.optics.back_index)) continue;
    if (share == 0.0) from_nm = at.wavelength_nm;
    to_nm = at.wavelength_nm;
    share += at.weight;
  }
  const std::string begins = where_it_begins(result);
  const std::string ends = begins.empty() ? begins : begins + of_turned_elements(result.design.part());
  if (result.light.size() == 1)
    result.warnings.push_back({"no_total_reflection", fmt::format("{} (n = {:.4f}{}){}", lost, result.refractive_index,
                                                                  circumstances(result), ends)});
  else
    result.warnings.push_back(
        {"no_total_reflection",
         fmt::format("{} for {:.0f} % of the light, {:.0f} to {:.0f} nm (n from {:.4f}{}){}", lost, 100.0 * share,
                     from_nm, to_nm, min_refractive_index(result.light), circumstances(result), ends)});
}

/// Adds the report on the base. The depth of an element is measured along its own axis; the depth of the part includes
/// that of the base.
void add_base(Inspection& result, const geometry::Part& part) {
  const geometry::PartSpec& spec = part.spec;
  SubstrateReport report;
  report.measures = geometry::check_substrate(spec);
  report.element_mm = geometry::width_across_mm(spec.element);
  report.walls = geometry::inner_walls(part, geometry::substrate_surface_of(spec).normal_at(geometry::Vec2::Zero()));
  result.substrate = report;
  result.element_depth_mm = geometry::element_depth_mm(spec.element, spec.angle_errors);
  if (spec.substrate->element_axes == geometry::ElementAxes::normal)
    result.full_element_area_fraction *= part.entrance_area_mm2 / report.measures.area_mm2;
}

void add_warnings(Inspection& result, const geometry::Part& part) {
  if (!part.spec.substrate) warn_of_lost_reflection(result);
  if (part.elements_partial > 0 && part.spec.array.partial_elements == geometry::PartialElements::cut)
    result.warnings.push_back(
        {"partial_elements", fmt::format("{}: {} elements are cut by the border; most of the light that falls on these "
                                         "elements is lost through the walls on the border",
                                         result.design.source_name(), part.elements_partial)});
}

/// Returns a result with the design, the properties of the light, the coatings and the warnings.
Inspection report_light(const design::Design& design, const design::OpticalModel& model) {
  Inspection result;
  result.design = design;
  result.warnings = model.warnings;
  result.coating = report_coating(design, model);
  result.light = model.spectral;
  result.refractive_index = mean_index(model.spectral);
  result.wavelength_nm = model.wavelength_nm;
  return result;
}

Inspection inspect_balls(const design::Design& design, const materials::MaterialLibrary& library) {
  const raytrace::BallLayer& layer = *design.balls();
  const design::OpticalModel model = design::make_light_model(design, library);
  Inspection result = report_light(design, model);
  result.elements_full = layer.pitch_mm ? 2 : 1;
  result.element_depth_mm = layer.mirror_radius_mm();
  const double ball_mm2 = std::numbers::pi * layer.radius_mm() * layer.radius_mm();
  const double cosine = std::cos(Angle::from_deg(layer.mirror_half_angle_deg).rad());
  result.facet_area_mm2 = static_cast<double>(result.elements_full) * 2.0 * std::numbers::pi *
                          std::pow(layer.mirror_radius_mm(), 2.0) * (1.0 - cosine);
  BallFigures figures;
  figures.packing_fraction = raytrace::packing_fraction(layer);
  result.full_element_area_fraction = figures.packing_fraction;
  result.entrance_area_mm2 = static_cast<double>(result.elements_full) * ball_mm2 / figures.packing_fraction;
  const double index = result.refractive_index;
  const double spacer = layer.mirror_offset_mm > 0.0 ? model.optics.back_index : 1.0;
  const double rho = layer.mirror_radius_mm() / layer.radius_mm();
  figures.paraxial_error = raytrace::paraxial_error(index, spacer, rho);
  if (const auto offset = raytrace::focal_offset_over_radius(index, model.optics.back_index))
    figures.focal_offset_mm = *offset * layer.radius_mm();
  figures.largest_return_error_deg = Angle::from_rad(raytrace::largest_return_error_rad(index, spacer, rho)).deg();
  const double acceptance_rad = Angle::from_deg(design.detector.acceptance_half_angle_deg.front()).rad();
  figures.fraction_within_acceptance = raytrace::fraction_within(acceptance_rad, index, spacer, rho);
  figures.mirror_half_angle_deg = layer.mirror_half_angle_deg;
  result.balls = figures;
  return result;
}

}  // namespace

namespace {

void add_zones(Inspection& result, const design::OpticalModel& model) {
  const geometry::Part& part = model.part;
  result.zones = report_zones(result.design, model);
  result.boundary = static_cast<double>(part.elements_full + part.elements_partial) <= kElementsToCheck
                        ? finding_of(boundary_to_check(part, model))
                        : "not checked: more than 1000 elements";
}

/// Returns the report on the elements that have another medium behind them.
/// \pre model.wet_elements
WetReport report_wet_back(const design::Design& design, const design::OpticalModel& model) {
  WetReport wet{model.wet_elements->count(), model.wet_elements->of_all(), {}};
  if (!design.entrance && !design.has_deflecting_shells())
    wet.tir_limit_deg =
        design::tir_limit_deg(design.part(), min_refractive_index(model.spectral), design.wet_back->index);
  return wet;
}

}  // namespace

Inspection inspect(const design::Design& design, const materials::MaterialLibrary& library,
                   const InspectRequest& request) {
  requests::check(request);
  if (design.balls()) return inspect_balls(design, library);
  const design::OpticalModel model = design::make_model(design, library);
  const geometry::Part& part = model.part;
  Inspection result = report_light(design, model);
  result.elements_full = part.elements_full;
  result.elements_partial = part.elements_partial;
  result.element_depth_mm = part.element_depth_mm;
  result.thickness_mm = part.thickness_mm;
  result.entrance_state = report_entrance_state(design, model);
  result.facet_area_mm2 = part.retro_facet_area_mm2;
  result.entrance_area_mm2 = part.entrance_area_mm2;
  if (model.entrance) result.entrance = report_entrance(*model.entrance, part);
  if (!part.period_mm) result.tool = report_tool(part, model.entrance, request);
  if (!design.shells.empty()) result.shells = report_shells(design, model);
  if (design.zoned()) {
    add_zones(result, model);
    return result;
  }
  if (!design.elements()) {
    // The mesh was repaired if the model has more warnings than the design: make_model() adds a warning for each
    // repair.
    const bool is_mended = result.warnings.size() > design.warnings().size();
    result.boundary = is_mended ? "see warnings" : "closed, free of self-intersections";
    return result;
  }
  if (!model.optics.facet_form.is_plane()) result.form = design::report_form(design, model.optics.facet_form);
  const auto* const ruled = std::get_if<geometry::RuledCells>(&design.part().element);
  const double aperture = ruled != nullptr ? ruled->pattern->mean_cell_mm2
                                           : geometry::area(geometry::aperture_outline(design.part().element));
  if (ruled != nullptr) result.ruled = report_ruled(*ruled->pattern);
  result.full_element_area_fraction = static_cast<double>(part.elements_full) * aperture / part.entrance_area_mm2;
  if (design.part().substrate) {
    add_base(result, part);
  } else if (!design.entrance && !design.has_deflecting_shells()) {
    result.tir_limit_deg =
        design::tir_limit_deg(design.part(), min_refractive_index(model.spectral), model.optics.back_index);
    if (design.needs_total_reflection()) result.tir_limit_azimuth_deg = design::tir_limit_azimuth_deg(design.part());
  }
  if (model.wet_elements) result.wet_back = report_wet_back(design, model);
  result.dead_zone_fraction = geometry::edge_fraction(geometry::finished_cell(
      geometry::element_cell(design.part().element, design.part().angle_errors), design.part()));
  if (result.ruled && design.part().edges.is_sharp()) result.dead_zone_fraction = result.ruled->dead_fraction;
  result.boundary = boundary_finding(design, model);
  add_warnings(result, part);
  return result;
}

}  // namespace retrace::studies
