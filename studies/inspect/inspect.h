#pragma once

// What a design is like before it is traced: sizes, areas, counts, angles, and where total reflection ends. The study
// behind `retrace inspect`.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/part/substrate_part.h"
#include "materials/io/material_library.h"
#include "studies/design/design.h"
#include "studies/design/form_of_design.h"
#include "studies/design/optical_model.h"
#include "studies/design/total_reflection.h"
#include "studies/inspect/coating_report.h"
#include "studies/inspect/entrance_report.h"
#include "studies/inspect/entrance_state_report.h"
#include "studies/inspect/zone_report.h"

namespace retrace::studies {

/// What a layer of balls, or a single one, is to light along its axis: closed forms (docs/theory/beads.md).
struct BallFigures {
  double packing_share = 0.0;             ///< of the plan that balls cover
  double paraxial_error = 0.0;            ///< return error over height near the axis, rad; 0: parallel
  std::optional<double> focal_offset_mm;  ///< mirror offset for which that is 0; none if there is none
  double largest_return_error_deg = 0.0;  ///< over the whole aperture: spherical aberration
  double share_within_acceptance = 0.0;   ///< of the aperture, narrowest cone; geometry alone, no Fresnel
  double mirror_half_angle_deg = 0.0;
};

/// What a base is like under its elements.
struct SubstrateReport {
  geometry::SubstrateMeasures measures;
  double element_mm = 0.0;     ///< circle round an element, which the least radius is to exceed
  geometry::InnerWalls walls;  ///< what stands open between neighbours, seen along the base's normal at its middle
};

/// Elements that have another medium behind them.
struct WetReport {
  std::int64_t elements = 0;  ///< whole and partial ones that have
  std::int64_t of_all = 0;
  /// As Inspection::tir_limit_deg, of these elements.
  std::optional<double> tir_limit_deg;
};

/// What a design is, before any light is traced. Areas and counts of an infinite array are those of one period.
struct Inspection {
  Design design;
  std::int64_t elements_full = 0;
  std::int64_t elements_partial = 0;
  double element_depth_mm = 0.0;
  double facet_area_mm2 = 0.0;  ///< of all retro facets, partial elements included
  double entrance_area_mm2 = 0.0;
  double thickness_mm = 0.0;
  double full_element_share = 0.0;    ///< of the entrance area
  double wavelength_nm = 0.0;         ///< of the light; of a spectrum, its centroid
  double refractive_index = 1.0;      ///< of a spectrum: its mean
  std::vector<SpectralOptics> light;  ///< the wavelengths that stand for a spectrum, or the one there is
  /// Largest incidence up to which the retroreflected light is totally reflected at every facet: across the roof edge
  /// for an RTP, at every azimuth for cube corners. None if there is no total reflection even at normal incidence, or
  /// none is needed: facets are mirrors or have an opaque layer. Of a spectrum, that of the wavelength with the least
  /// index.
  std::optional<double> tir_limit_deg;
  /// From where light meets a facet most squarely, so that its total reflection ends first; 0 to below 360, the least
  /// of equal ones, of an unturned element. None where none is needed.
  std::optional<double> tir_limit_azimuth_deg;
  std::optional<SubstrateReport>
      substrate;  ///< of elements that stand on one; there are no limits of total reflection then
  std::optional<EntranceReport> entrance;  ///< of a part with one; limits of total reflection are those of light that
                                           ///< enters through a plane
  std::optional<WetReport> wet_back;
  std::optional<ZonesReport> zones;  ///< of a part of zones
  std::optional<FormReport> form;    ///< of facets that have one
  CoatingReports coating;
  std::optional<EntranceStateReport> entrance_state;  ///< of a face that is not clean
  double dead_zone_share = 0.0;                       ///< of an element's plan that rounded and chamfered edges take
  std::optional<BallFigures> balls;  ///< kind = "ball": then only these, the light, and counts and areas mean something
  std::string boundary;              ///< what the check of the boundary found
  std::vector<std::string> warnings;
};

/// \throw InputError as make_model()
Inspection inspect(const Design& design, const materials::MaterialLibrary& library);

}  // namespace retrace::studies
