#include "studies/closed_loop/as_machined.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/error.h"
#include "core/length_units.h"
#include "core/number_format.h"
#include "design/io/design_document.h"
#include "studies/closed_loop/machined_zones.h"

namespace retrace::studies {
namespace {

namespace fs = std::filesystem;
using namespace fabrication;

constexpr double kArcminPerRad = 180.0 * 60.0 / std::numbers::pi;

// Ratios of the Sa of roughness and of waviness to the published Sa. Five facets that were finished by plunging have a
// mean Sa of 48.9 nm. After separation at a cut-off wavelength of 80 um, their roughness has a mean Sa of 19.7 nm, and
// their waviness has 29.9 nm (Milliken 2017, Table 3.4). Other motions are assumed to have the same ratios.
constexpr double kRoughnessSaRatio = 19.7 / 48.9;
constexpr double kWavinessSaRatio = 29.9 / 48.9;
// Temporal frequency of feed marks. They have 42.4 periods per mm at a feed of 10 mm/min (Milliken, 3.3.5).
constexpr double kFeedMarksHz = 7.07;
constexpr double kCorrelationLengthUm = 5.0;  // assumed; smaller than the resolution of the profilometer
/// Minimum angle, in arcmin, that is reported.
constexpr double kShownArcmin = 0.05;
const double kSqPerSa = std::sqrt(0.5 * std::numbers::pi);  // ratio for Gaussian heights

/// Returns Sa of the facets after the last cuts. If one of two facets is ploughed, returns the quadratic mean of both.
double sa_of(const Job& job) {
  const Process& p = job.process;
  switch (job.strategy) {
    case Strategy::unidirectional:
      return std::sqrt(0.5 * (p.plough_sa_nm * p.plough_sa_nm + p.roughing_plunge_sa_nm * p.roughing_plunge_sa_nm));
    case Strategy::bidirectional: return p.roughing_plunge_sa_nm;
    case Strategy::two_step:
    case Strategy::dmc: return p.finishing_plunge_sa_nm;
  }
  return 0.0;
}

}  // namespace

PredictedTexture predicted_texture(const Job& job) {
  PredictedTexture texture;
  texture.sa_nm = sa_of(job);
  texture.roughness_sq_nm = kRoughnessSaRatio * texture.sa_nm * kSqPerSa;
  texture.waviness_sq_nm = kWavinessSaRatio * texture.sa_nm * kSqPerSa;
  texture.correlation_length_um = kCorrelationLengthUm;
  const double feed_mm_per_min =
      has_finishing_cuts(job) ? job.process.finishing_feed_mm_per_min : job.process.roughing_feed_mm_per_min;
  texture.waviness_length_um = 1e3 * feed_mm_per_min / 60.0 / kFeedMarksHz;
  return texture;
}

namespace {

/// Returns the scratches that chips of the tool's edge leave on the facets of the part. The edge is parallel to the
/// roof edge. For facet 2, the tool is rotated by 180 degrees if the facet is plunged. If the facet is ploughed, the
/// tool keeps the orientation of facet 1.
std::vector<geometry::Scratch> scratches_of(const Job& job) {
  const bool is_direct = job.workpiece.kind == WorkpieceKind::direct;
  const double scale = 1.0 / blank_scale(job.workpiece);
  std::vector<geometry::Scratch> scratches;
  for (const std::size_t facet : {0U, 1U}) {
    const double sense = facet == 1 && job.strategy != Strategy::unidirectional ? -1.0 : 1.0;
    for (const EdgeChip& chip : job.tool.edge_chips) {
      geometry::Scratch scratch;
      scratch.facet = is_direct ? 1 - facet : facet;
      scratch.position_mm = 1e-3 * sense * scale * chip.position_um;
      scratch.width_mm = 1e-3 * scale * chip.width_um;
      // A ridge in a mould becomes a groove in the part. A part that is cut directly keeps the ridge.
      scratch.depth_mm = 1e-3 * scale * (is_direct ? -chip.depth_um : chip.depth_um);
      scratches.push_back(scratch);
    }
  }
  return scratches;
}

/// Returns the tilts of an element's facets, in arcmin. A positive tilt opens the element.
std::vector<double> tilts_of(const ElementResult& element) {
  std::vector<double> tilt(element.figures.facets.size());
  // If the height of a facet above the design increases up its slope, the facet leans into the groove. This closes the
  // element, so that the tilt is negative.
  for (std::size_t f = 0; f < tilt.size(); ++f)
    tilt[f] = -std::atan(element.figures.facets[f].slope_up) * kArcminPerRad;
  return tilt;
}

/// Differences between the machined elements and a design in which all elements are equal.
struct ElementDifferences {
  double along_arcmin = 0.0;   ///< maximum rotation of a facet by which one end of its root rises
  double spread_arcmin = 0.0;  ///< maximum deviation of a tilt from the mean
  std::int64_t missing = 0;
};

ElementDifferences unlikeness_of(const VerificationRun& run, const std::vector<double>& mean_arcmin) {
  ElementDifferences unlike;
  const geometry::Arrangement arrangement = run.job.array.arrangement;
  const bool is_whole = arrangement == geometry::Arrangement::single || run.job.array.pattern.empty();
  if (!is_whole) ++unlike.missing;
  for (const ElementResult& element : run.result.elements) {
    if (!element.figures.is_cut) {
      ++unlike.missing;
      continue;
    }
    const std::vector<double> tilt = tilts_of(element);
    for (std::size_t f = 0; f < tilt.size(); ++f) {
      const double along = std::abs(std::atan(element.figures.facets[f].slope_along)) * kArcminPerRad;
      unlike.along_arcmin = std::max(unlike.along_arcmin, along);
      unlike.spread_arcmin = std::max(unlike.spread_arcmin, std::abs(tilt[f] - mean_arcmin[f]));
    }
  }
  return unlike;
}

/// Returns the planes that verification fitted to an element's facets.
ElementCutPlanes fitted_planes(const DesignElement& groove, const ElementFigures& figures) {
  ElementCutPlanes planes;
  for (std::size_t f = 0; f < figures.facets.size(); ++f) {
    const FacetFigures& facet = figures.facets[f];
    const DesignFacet& design = groove.facets[f];
    CutPlane plane;
    plane.point_mm = groove.root_mm + facet.mean_up_mm * design.up_slope + facet.mean_along_mm * design.along +
                     1e-6 * facet.mean_nm * design.normal;
    plane.normal = (design.normal - facet.slope_up * design.up_slope - facet.slope_along * design.along).normalized();
    planes.push_back(plane);
  }
  return planes;
}

geometry::FacetPlanes facet_planes_of(const VerificationRun& run) {
  const std::vector<Cavity> grooves = designed_cavities(run.job);
  std::vector<ElementCutPlanes> planes(grooves.size());
  for (std::size_t i = 0; i < grooves.size(); ++i)
    if (run.result.elements[i].figures.is_cut)
      planes[i] = fitted_planes(common(grooves[i]), run.result.elements[i].figures);
  return part_planes(run.job, planes);
}

/// Adds warnings about differences between the elements. A design with equal elements cannot represent them.
/// \param where description of the part in the warning, such as "on a substrate"
void warn_of(const ElementDifferences& unlike, AsMachined& part, const char* where) {
  if (unlike.along_arcmin > kShownArcmin)
    part.warnings.push_back(
        {"rotation_along_root_omitted",
         fmt::format(
             "facets of a part {} are rotated by up to {} arcmin along the root: the as-machined design omits this",
             where, fixed(unlike.along_arcmin, 2))});
  if (unlike.spread_arcmin > kShownArcmin)
    part.warnings.push_back(
        {"facets_differ_from_mean", fmt::format("facets of individual elements differ from the mean by up to {} "
                                                "arcmin: the as-machined design contains the mean",
                                                fixed(unlike.spread_arcmin, 2))});
  if (unlike.missing > 0)
    part.warnings.push_back({"uncut_elements_included",
                             "the as-machined design of a part that is cut directly contains all elements, even "
                             "elements that are not cut"});
}

}  // namespace

namespace {

/// Returns true if cavities extend beyond the outlines of hexagonal elements at the border of the array. A part with a
/// single element has no material there, because it ends with the aperture.
bool has_flares(const VerificationRun& run) {
  return run.result.border_overcut_mm3 > 0.0 && run.job.array.arrangement != geometry::Arrangement::single;
}

/// Checks the as-machined part of a job on a substrate. The design describes such a part by equal elements and not by a
/// table of planes. Adds warnings about the differences between the elements.
/// \throw InputError if an element is not cut
void check_on_substrate(const VerificationRun& run, const ElementDifferences& unlike, AsMachined& part) {
  if (unlike.missing > 0)
    throw InputError(Field{"as_machined"}, fmt::format("all elements on a [substrate] must be cut for an as-machined "
                                                       "design; number of elements that are not cut: {}",
                                                       unlike.missing));
  warn_of(unlike, part, "on a substrate");
  if (run.result.rim_overcut_um_max > 0.0)
    part.warnings.push_back(
        {"rim_overcut", fmt::format("cuts of neighbouring elements with rims at other heights remove up to {} um below "
                                    "the rims of an element, but the as-machined design has walls there",
                                    fixed(run.result.rim_overcut_um_max, 3))});
  if (has_flares(run))
    part.warnings.push_back({"border_cavities_omitted",
                             "cavities of hexagons extend beyond the elements' outlines at the border: the as-machined "
                             "design omits this for elements on a substrate"});
}

design::ZonedPart zones_of_run(const VerificationRun& run, AsMachined& part) {
  std::vector<ElementTilts> elements;
  for (const ElementResult& element : run.result.elements) {
    ElementTilts& tilts = elements.emplace_back();
    if (!element.figures.is_cut) continue;
    const std::vector<double> three = tilts_of(element);
    tilts = {three[0], three[1], three[2]};
  }
  if (run.result.border_overcut_mm3 > 0.0)
    part.warnings.push_back(
        {"zone_border_cavities_omitted",
         run.result.elements_overcut == 0
             ? "cavities of hexagons extend into the flat land at borders of zones: the as-machined design omits this"
             : fmt::format(
                   "cavities of hexagons extend beyond the elements' outlines at borders of zones, and remove {} "
                   "mm2 of the apertures of other elements: the as-machined design omits this",
                   fixed(run.result.zone_overcut_mm2, 4))});
  return machined_zones(run.job, run.request.job, elements, part.warnings);
}

}  // namespace

AsMachined as_machined(const VerificationRun& run) {
  AsMachined part;
  std::int64_t cut = 0;
  for (const ElementResult& element : run.result.elements) {
    if (!element.figures.is_cut) continue;
    ++cut;
    const std::vector<double> tilt = tilts_of(element);
    part.facet_tilt_arcmin.resize(tilt.size());
    for (std::size_t f = 0; f < tilt.size(); ++f) part.facet_tilt_arcmin[f] += tilt[f];
  }
  if (cut == 0) throw InputError(Field{"as_machined"}, "the programs cut no element of the job");
  for (double& tilt : part.facet_tilt_arcmin) tilt /= static_cast<double>(cut);
  const ElementDifferences unlike = unlikeness_of(run, part.facet_tilt_arcmin);
  const bool is_direct = run.job.workpiece.kind == WorkpieceKind::direct;
  // Facet 1 faces -x in a moulded part. A part that is cut directly is rotated about y, which exchanges its facets.
  if (is_direct) std::swap(part.facet_tilt_arcmin[0], part.facet_tilt_arcmin[1]);
  if (is_direct)
    warn_of(unlike, part, "that is cut directly");
  else if (!run.job.zones.empty())
    part.zones = zones_of_run(run, part);
  else if (run.job.substrate)
    check_on_substrate(run, unlike, part);
  else if (has_flares(run) || unlike.along_arcmin > kShownArcmin || unlike.spread_arcmin > kShownArcmin ||
           unlike.missing > 0)
    part.planes = facet_planes_of(run);
  if (run.job.strategy == Strategy::unidirectional &&
      run.job.process.plough_sa_nm != run.job.process.roughing_plunge_sa_nm)
    part.warnings.push_back(
        {"facet_roughness_averaged",
         fmt::format("plunged and ploughed facets differ in roughness (Sa {} and {} nm), but a design has only one "
                     "roughness: it contains their root mean square",
                     shortest(run.job.process.roughing_plunge_sa_nm), shortest(run.job.process.plough_sa_nm))});
  part.root_radius_um = run.result.root_radius_um;
  part.root_chamfer_um = run.result.root_chamfer_um;
  if (run.result.root_ridge_um > 0.0)
    part.warnings.push_back({"root_ridges_as_flats",
                             fmt::format("the nose of the tool leaves ridges of a height of {} um in the dihedral "
                                         "edges: the as-machined design has flats with a width of {} um instead",
                                         fixed(run.result.root_ridge_um, 2), fixed(run.result.root_chamfer_um, 2))});
  part.texture = predicted_texture(run.job);
  part.scratches = scratches_of(run.job);
  if (run.job.substrate && !part.scratches.empty()) {
    part.warnings.push_back(
        {"scratches_omitted", "scratches of a chipped edge are omitted for elements on a substrate"});
    part.scratches.clear();
  }
  part.body = machined_body(run.job, run.request.job, part.warnings);
  if (run.job.outline) part.outline = outline_of_job(run.job, run.request.job);
  return part;
}

namespace {

/// Returns the intended angle errors plus the facet tilts that the programs cause.
geometry::AngleErrors machined_errors(geometry::AngleErrors errors, const std::vector<double>& tilt_arcmin) {
  for (std::size_t f = 0; f < tilt_arcmin.size(); ++f)
    if (std::abs(tilt_arcmin[f]) >= 1e-6) errors.facet_tilt_arcmin[f] += tilt_arcmin[f];
  return errors;
}

void add_edges(geometry::PartSpec& spec, const AsMachined& part) {
  spec.edges.root_chamfer_mm = part.root_chamfer_um / kUmPerMm;
  spec.edges.root_radius_mm = part.root_radius_um / kUmPerMm;
  spec.thickness_mm = part.body.thickness_mm;
}

design::ElementArray array_shape(const VerificationRun& run, const AsMachined& part, const std::string& facets_file) {
  design::ElementArray array{machined_elements(run.job, part.planes.has_value()), {}, {}, part.outline};
  if (part.planes)
    array.facet_planes = design::FacetPlanesFile{facets_file, facets_file};
  else
    array.part.angle_errors = machined_errors(run.job.angle_errors, part.facet_tilt_arcmin);
  add_edges(array.part, part);
  array.part.scratches = part.scratches;
  return array;
}

design::ZonedPart zoned_shape(const AsMachined& part) {
  design::ZonedPart zones = *part.zones;
  add_edges(zones.base, part);
  zones.spec.thickness_mm = part.body.thickness_mm;
  return zones;
}

}  // namespace

std::string as_machined_toml(const VerificationRun& run, const AsMachined& part, const std::string& facets_file) {
  const auto rounded = [](double value) { return std::round(1e3 * value) / 1e3; };
  design::Design design;
  design.title = (run.job.title.empty() ? "Part" : run.job.title) + ", as machined";
  design.shape = part.zones ? design::Shape(zoned_shape(part)) : design::Shape(array_shape(run, part, facets_file));
  design.substance = part.body.substance();
  design.surface.texture =
      design::HarveyShackTexture{rounded(part.texture.roughness_sq_nm), part.texture.correlation_length_um,
                                 rounded(part.texture.waviness_sq_nm), rounded(part.texture.waviness_length_um)};
  design.detector.acceptance_half_angle_deg = {0.05, 0.5};
  return design::design_text(design,
                             fmt::format("# Facets as the programs cut them: {}. Sa {} nm is a published value for\n"
                                         "# facets that were cut by such motions; feed marks at 7.07 Hz.\n",
                                         part.planes  ? "one plane for each facet"
                                         : part.zones ? "the mean over the elements of each zone"
                                                      : "the mean over the elements",
                                         fixed(part.texture.sa_nm, 1)));
}

}  // namespace retrace::studies
