#include "studies/setup/setup_light.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "fabrication/chisel/check/cavity.h"
#include "fabrication/chisel/plan/edge_cuts.h"
#include "fabrication/machine/setup.h"
#include "geometry/elements/element_cells.h"
#include "studies/closed_loop/part_planes.h"
#include "studies/photometry/photometer.h"
#include "studies/rre/rre.h"

namespace retrace::studies {
namespace {

using namespace fabrication;
using geometry::Vec3;

/// Number of traced elements along each axis of the array.
constexpr double kElementsAcross = 2.0;
/// Displacement of a facet, in mm, above which the resulting change of the light is computed. Smaller displacements are
/// treated as no change.
constexpr double kStillMm = 1e-12;

/// Minimum power of traced beams, as a fraction of the power on the part (for R_A: on an element). The results are then
/// accurate to SetupLight::kMinRreChange and kMinRaChange. Without this minimum, tilted facets would split
/// beams into ever smaller ones without end.
constexpr double kCutoff = 1e-6;

/// Returns the job for a small patch: an array of a few whole elements from the center of the job's array.
Job patch_of(Job job) {
  if (job.array.arrangement == geometry::Arrangement::single) return job;
  geometry::ArrayLayout& array = job.array;
  array.pattern.clear();
  array.outline = nullptr;
  job.outline.reset();
  array.x_offset_mm = array.y_offset_mm = 0.0;
  const geometry::Vec2 size = geometry::bounding_box(geometry::aperture_outline(job.element)).size();
  // Offset rows are shifted against each other, and cube corners interlock. Therefore, a slightly larger area is needed
  // for the same number of elements.
  const double more = cuts_prisms(job) && array.arrangement != geometry::Arrangement::offset ? 0.0 : 1.01;
  array.x_length_mm = std::min(array.x_length_mm, (kElementsAcross + more) * (size.x() + array.x_gap_mm));
  array.y_length_mm = std::min(array.y_length_mm, (kElementsAcross + more) * (size.y() + array.y_gap_mm));
  array.partial_elements = geometry::PartialElements::omit;
  return job;
}

/// Finds the last cut of each facet. If a facet needs several parallel passes side by side, the last cut is that of the
/// pass closest to the center of the facet.
class LastCuts {
 public:
  LastCuts(const Job& job, const Machine& machine) : grooves_(designed_cavities(job)) {
    cuts_.resize(grooves_.size());
    const Plan plan = make_plan(job, machine);
    for (std::size_t i = 0; i < grooves_.size(); ++i) cuts_[i].resize(common(grooves_[i]).facets.size());
    for (const FacetEdgeCut& cut : facet_edge_cuts(job, plan))
      if (cut.ends_at_root || cut.is_ploughed) take(machine, cut);
  }

  std::vector<ElementCutPlanes> planes_on(const Machine& machine) const {
    std::vector<ElementCutPlanes> elements(cuts_.size());
    for (std::size_t i = 0; i < cuts_.size(); ++i)
      for (std::size_t f = 0; f < cuts_[i].size(); ++f)
        elements[i].push_back(cut_plane(machine, cuts_[i][f]->cut, common(grooves_[i]).facets[f].normal));
    return elements;
  }
  std::size_t size() const { return cuts_.size(); }

 private:
  void take(const Machine& machine, const FacetEdgeCut& cut) {
    std::optional<FacetEdgeCut>& known = cuts_[cut.element][cut.facet];
    const DesignElement& design = common(grooves_[cut.element]);
    const auto off_middle = [&](const FacetEdgeCut& c) {
      return std::abs(design.facets[cut.facet].along.dot(forward(machine, c.cut.at).reference_mm - design.root_mm));
    };
    if (!known || cut.stage != known->stage || off_middle(cut) < off_middle(*known)) known = cut;
  }

  std::vector<Cavity> grooves_;
  std::vector<std::vector<std::optional<FacetEdgeCut>>> cuts_;
};

/// Returns the design of a part moulded from the patch, without its facet planes. It is smooth and clean, and it has
/// the illumination of the job's design.
design::Design patch_design(const Job& patch, const std::filesystem::path& job_file, Warnings& warnings) {
  design::Design design;
  design::ElementArray array{machined_elements(patch, true), {}, {}};
  if (const std::optional<design::Design> given = design_of_job(patch, job_file)) {
    design.substance = given->substance;
    design.surface.coating = given->surface.coating;
    design.light = given->light;
    design.detector = given->detector;
    design.idealisation = given->idealisation;
    array.part.thickness_mm = given->thickness_mm();
  } else {
    const MachinedBody body = machined_body(patch, job_file, warnings);
    design.substance = body.substance();
    array.part.thickness_mm = body.thickness_mm;
  }
  design.shape = std::move(array);
  return design;
}

PhotometrySettings photometry_of_patch() {
  PhotometrySettings request;
  request.engine = raytrace::Engine::exact;
  request.cutoff = kCutoff;
  request.apertures = {Angle::from_deg(SetupLight::kApertureArcmin / 60.0),
                       Angle::from_deg(SetupLight::kApertureArcmin / 60.0)};
  return request;
}

PartLight light_of(design::Design design, geometry::FacetPlanes planes) {
  auto& array = std::get<design::ElementArray>(design.shape);
  array.facet_planes =
      design::FacetPlanesFile{{}, {}, std::make_shared<const geometry::FacetPlanes>(std::move(planes))};
  RreSettings request;
  request.engine = raytrace::Engine::exact;
  request.cutoff = kCutoff;
  PartLight light;
  for (const RrePoint& point : RreStudy({design}, request).run().points) light.rre.push_back(point.rre);
  const Photometer photometer(design, photometry_of_patch(), 1);
  PhotometerSetting setting;
  setting.h_deg = SetupLight::kEntranceDeg;
  setting.observation_deg = {SetupLight::kObservationDeg};
  light.r_a = photometer.measure({setting}, nullptr, nullptr)->front().r_a.front();
  return light;
}

bool is_still(const std::vector<ElementCutPlanes>& before, const std::vector<ElementCutPlanes>& after) {
  for (std::size_t i = 0; i < before.size(); ++i)
    for (std::size_t f = 0; f < before[i].size(); ++f) {
      const CutPlane& plane = before[i][f];
      const Vec3 off = after[i][f].point_mm - plane.point_mm;
      if (std::abs(plane.normal.dot(off)) > kStillMm || (plane.normal - after[i][f].normal).norm() > kStillMm)
        return false;
    }
  return true;
}

}  // namespace

std::string why_no_setup_light(const Job& job) {
  if (job.workpiece.kind == WorkpieceKind::direct) return "the light of parts that are cut directly is not computed";
  if (job.substrate) return "the light of elements on a substrate is not computed";
  if (!job.zones.empty()) return "the light of parts with zones is not computed";
  return {};
}

SetupLight setup_light(const Job& job, const std::filesystem::path& job_file, const Machine& machine,
                       Warnings& warnings) {
  const Job patch = patch_of(job);
  const LastCuts cuts(patch, machine);
  const design::Design design = patch_design(patch, job_file, warnings);
  const std::vector<ElementCutPlanes> nominal = cuts.planes_on(machine);
  SetupLight light;
  light.elements = cuts.size();
  light.cones_deg = design.detector.acceptance_half_angle_deg;
  light.nominal = light_of(design, part_planes(patch, nominal));
  for (const SetupQuantity& quantity : setup_quantities(machine.tilt)) {
    const std::vector<ElementCutPlanes> planes = cuts.planes_on(with_error(machine, quantity, 1.0));
    PartLight change{std::vector<double>(light.nominal.rre.size(), 0.0), 0.0};
    if (!is_still(nominal, planes)) {
      change = light_of(design, part_planes(patch, planes));
      for (std::size_t k = 0; k < change.rre.size(); ++k) change.rre[k] -= light.nominal.rre[k];
      change.r_a -= light.nominal.r_a;
    }
    light.changes.push_back(std::move(change));
  }
  return light;
}

}  // namespace retrace::studies
