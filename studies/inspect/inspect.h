#pragma once

// Properties of a design before tracing: sizes, areas, counts, angles, and limits of total reflection. `retrace
// inspect` runs this study.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "design/design.h"
#include "design/form_of_design.h"
#include "design/optical_model.h"
#include "design/total_reflection.h"
#include "geometry/elements/substrate_checks.h"
#include "materials/io/material_library.h"
#include "requests/inspect.h"
#include "studies/inspect/coating_report.h"
#include "studies/inspect/entrance_report.h"
#include "studies/inspect/entrance_state_report.h"
#include "studies/inspect/ruled_report.h"
#include "studies/inspect/shell_report.h"
#include "studies/inspect/tool_report.h"
#include "studies/inspect/zone_report.h"

namespace retrace::studies {

/// Properties of a layer of balls, or of a single ball, for light along its axis. They are computed in closed form
/// (docs/theory/beads.md).
struct BallFigures {
  double packing_fraction = 0.0;  ///< fraction of the plan that balls cover
  /// Derivative of the return error with respect to h / radius at h = 0, in rad. h is the distance of the light from
  /// the axis of the ball. If the derivative is 0, light near the axis returns parallel to it.
  double paraxial_error = 0.0;
  /// Mirror offset for which the paraxial error is 0. None if no offset has this effect.
  std::optional<double> focal_offset_mm;
  double largest_return_error_deg = 0.0;  ///< maximum return error over the aperture, due to spherical aberration
  /// Fraction of the aperture whose light returns within the narrowest acceptance cone of the detector. It follows from
  /// geometry only, without Fresnel losses.
  double fraction_within_acceptance = 0.0;
  double mirror_half_angle_deg = 0.0;
};

/// Measures of a base under the elements.
struct SubstrateReport {
  geometry::SubstrateMeasures measures;
  /// Width of an element. The minimum radius of curvature of the base must be at least as large.
  double element_mm = 0.0;
  geometry::InnerWalls walls;  ///< walls between neighbours, seen along the normal at the centre of the base
};

/// Elements with another medium behind them.
struct WetReport {
  std::int64_t elements = 0;  ///< number of elements with another medium behind them, including partial elements
  std::int64_t of_all = 0;
  /// Limit of total reflection for elements with this medium behind them, defined like Inspection::tir_limit_deg.
  std::optional<double> tir_limit_deg;
};

/// Properties of a design before tracing. Areas and counts of an infinite array are those of one period.
struct Inspection {
  design::Design design;
  std::int64_t elements_full = 0;
  std::int64_t elements_partial = 0;
  double element_depth_mm = 0.0;
  double facet_area_mm2 = 0.0;  ///< area of all retro facets, including partial elements
  double entrance_area_mm2 = 0.0;
  double thickness_mm = 0.0;
  double full_element_area_fraction = 0.0;    ///< fraction of the entrance area
  double wavelength_nm = 0.0;                 ///< wavelength of the light; for a spectrum, its centroid
  double refractive_index = 1.0;              ///< refractive index; for a spectrum, its mean
  std::vector<design::SpectralOptics> light;  ///< traced wavelengths of a spectrum, or the only wavelength
  /// Maximum incidence up to which every facet reflects the retroreflected light totally: across the roof edge for
  /// prisms, at every azimuth for cube corners. For a spectrum, it is that of the wavelength with the smallest index.
  /// None if there is no total reflection even at normal incidence. Also none if facets are mirrors or have an opaque
  /// layer.
  std::optional<double> tir_limit_deg;
  /// Azimuth of the light for which total reflection ends at the smallest incidence; 0 to below 360. It is the smallest
  /// of equivalent azimuths and applies to elements that are not rotated. None if total reflection is not needed.
  std::optional<double> tir_limit_azimuth_deg;
  /// Base under the elements. If there is one, limits of total reflection are not computed.
  std::optional<SubstrateReport> substrate;
  /// Curved entrance face. Limits of total reflection are nevertheless those of light that enters through a plane.
  std::optional<EntranceReport> entrance;
  std::optional<ShellsReport> shells;  ///< shells in front of the part; empty if there are none
  std::optional<WetReport> wet_back;
  std::optional<RuledReport> ruled;        ///< cells of a ruled array; empty for other kinds of elements
  std::optional<ZonesReport> zones;        ///< zones of the part; empty if it has none
  std::optional<design::FormReport> form;  ///< form of the facets; empty for plane facets
  CoatingReports coating;
  std::optional<EntranceStateReport> entrance_state;  ///< state of a face that is not clean
  double dead_zone_fraction = 0.0;  ///< fraction of an element's plan that rounded and chamfered edges occupy
  /// Properties for kind = "ball". If they are set, only this member, the light, the counts and the areas are valid.
  std::optional<BallFigures> balls;
  std::optional<ToolReport> tool;  ///< properties for the toolmaker; empty for infinite arrays and for balls
  std::string boundary;            ///< result of the boundary check
  Warnings warnings;
};

/// Returns the properties of a design.
/// \throw InputError under the same conditions as make_model(), and if the request is invalid
Inspection inspect(const design::Design& design, const materials::MaterialLibrary& library,
                   const InspectRequest& request = {});

}  // namespace retrace::studies
