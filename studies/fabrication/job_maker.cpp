#include "studies/fabrication/job_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/message_text.h"
#include "core/named_file.h"
#include "core/number_format.h"
#include "core/schema/document.h"
#include "design/zone_elements.h"
#include "fabrication/chisel/check/verification_model.h"
#include "fabrication/chisel/check/zone_overcut.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/job/io/process_files.h"
#include "fabrication/job/v_tool.h"
#include "fabrication/machine/io/machine_files.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/io/mask_image.h"
#include "geometry/outline/plan_region.h"
#include "geometry/part/part.h"
#include "geometry/part/zones.h"
#include "requests/descriptions.h"
#include "studies/fabrication/reachable.h"

namespace retrace::studies {
namespace {

using fabrication::Job, geometry::Arrangement, geometry::PartSpec;

/// Returns the enumerator whose value is the index of `word` in `words`.
/// \pre `words` contains `word`
template <class Enumeration>
Enumeration enumerator_of(const std::string& word, std::span<const std::string_view> words) {
  return static_cast<Enumeration>(std::ranges::find(words, word) - words.begin());
}

bool is_dmc(const JobRequest& request) {
  return request.strategy == "dmc";
}

/// Returns the name of the machine. Diamond micro chiseling needs a tilting head, so "ideal" is replaced by
/// "ideal-dmc".
std::string machine_of(const JobRequest& request) {
  return is_dmc(request) && request.machine == "ideal" ? "ideal-dmc" : request.machine;
}

/// Returns the machine of a request by its name or its file.
/// \throw InputError at the field `machine` if the machine does not exist, or if the file is invalid
fabrication::Machine machine_at_field(const std::string& name_or_file) {
  return read_named(Field{"machine"}, [&] { return fabrication::load_machine(name_or_file, {}); });
}

/// Loads the process that a request names.
/// \throw InputError at the field `process` if the process does not exist, or if its file is invalid
fabrication::Process process_of(const JobRequest& request) {
  return read_named(Field{"process"}, [&] { return fabrication::load_process(request.process, {}); });
}

/// Checks that an element is not canted, because canted cube corners cannot be cut.
/// \throw InputError at `where` if it is canted
void check_upright(const geometry::Element& element, const InputLocation& where) {
  const double cant_deg = geometry::cant_of(element).deg;
  if (cant_deg != 0.0)
    throw InputError(where,
                     fmt::format("{}must be 0, because canted cube corners cannot be cut in this version, got {}",
                                 where.key == "element.cant_deg" ? "" : "element.cant_deg ", shortest(cant_deg)));
}

/// Returns the element of the design. The dihedral error of a prism is included in its apex angle.
/// \throw InputError for an element that the strategy does not cut
geometry::Element element_of(const design::Design& design, const JobRequest& request) {
  check_is_cut(design);
  if (design.part().array.extent == geometry::Extent::infinite)
    throw InputError({design.source_name(), 0, "array.extent"},
                     "must be \"finite\", because infinite arrays cannot be cut, got \"infinite\"");
  if (const auto* const rtp = std::get_if<geometry::RtpElement>(&design.part().element)) {
    if (is_dmc(request))
      throw InputError(Field{"strategy"},
                       "must be unidirectional, bidirectional or two-step for element.kind = \"rtp\", because dmc is "
                       "only for cube corners, got dmc");
    geometry::RtpElement prism = *rtp;
    prism.apex_angle_deg += design.part().angle_errors.dihedral_error_arcmin[0] / 60.0;
    return prism;
  }
  if (!is_dmc(request))
    throw InputError(Field{"strategy"},
                     fmt::format("a chisel with a straight edge reaches only {} % of the facets of this cube corner, "
                                 "and does not reach its apex: use the strategy dmc, or give {} FILE to write the "
                                 "design of the part that a chisel can cut; the given strategy is {}",
                                 fixed(100.0 * reachable_fraction(design.part().element, request.tool_width_mm), 2),
                                 reference({"reachable"}), request.strategy));
  check_upright(design.part().element, {design.source_name(), 0, "element.cant_deg"});
  return design.part().element;
}

bool is_prism(const PartSpec& part) {
  return std::holds_alternative<geometry::RtpElement>(part.element);
}

/// Returns true if the design has tilts, edges or scratches that a job cannot contain.
bool has_errors(const PartSpec& part) {
  const std::array<double, 3> none{};
  return !part.edges.is_sharp() || !part.scratches.empty() || part.random_tilts.sigma_arcmin > 0.0 ||
         (is_prism(part) && part.angle_errors.facet_tilt_arcmin != none);
}

void warn_of_errors(const PartSpec& part, const std::string& name, GeneratedJob& made) {
  if (has_errors(part))
    made.warnings.push_back(
        {"surface_errors_not_cut", fmt::format("{}: the job does not contain the {}random errors, edges and scratches "
                                               "of [surface]; the machined part will not have them",
                                               name, is_prism(part) ? "facet tilts, " : "")});
}

/// Returns the number of partial elements of the array, regardless of a mask.
std::int64_t partial_elements(const PartSpec& part) {
  if (!part.substrate && !part.array.outline && part.array.arrangement != Arrangement::offset &&
      part.array.arrangement != Arrangement::honeycomb && part.array.arrangement != Arrangement::triangular)
    return 0;
  PartSpec nominal = part;
  nominal.angle_errors = {};
  nominal.random_tilts = {};
  nominal.edges = {};
  nominal.scratches.clear();
  return geometry::build_part(nominal).elements_partial;
}

std::string cut_warning(const std::string& name, std::int64_t partial) {
  return fmt::format(
      "{}: array.partial_elements is \"cut\", but a job contains only whole elements; number of omitted elements: {}",
      name, partial);
}

void add_warnings(const design::Design& design, GeneratedJob& made) {
  const std::string name = design.source_name();
  made.partial_elements = partial_elements(design.part());
  if (made.partial_elements > 0) {
    made.job.notes.push_back(fmt::format("{} partial elements are left out", made.partial_elements));
    if (design.part().array.partial_elements == geometry::PartialElements::cut)
      made.warnings.push_back({"partial_elements_not_cut", cut_warning(name, made.partial_elements)});
  }
  warn_of_errors(design.part(), name, made);
  if (design.part().array.arrangement == Arrangement::honeycomb)
    made.job.notes.push_back("cavities are triangular: those at the border reach beyond the elements' outlines");
}

/// Checks that all zones can be cut in one job. Zones may differ in size, angles, positions and rotation of their cube
/// corners.
/// \throw InputError for zones with other differences, or for prisms
void check_zones(const design::Design& design, const JobRequest& request) {
  const std::vector<geometry::PartZone>& zones = design.zoned()->spec.zones;
  for (std::size_t z = 0; z < zones.size(); ++z) {
    const InputLocation where = design.where(schema::path_of_entry("zone", z));
    if (std::holds_alternative<geometry::RuledCells>(zones[z].elements.element))
      throw InputError(where, "ruled cells cannot be cut, because the processes of retrace do not rule grooves");
    if (is_prism(zones[z].elements))
      throw InputError(where, "only cube corners can be cut in a part with zones, got prisms");
    if (zones[z].elements.element.index() != zones.front().elements.element.index())
      throw InputError(where,
                       "must have the same kind of cube corners (hexagonal or triangular) as the preceding zones");
    check_upright(zones[z].elements.element, where);
  }
  check_cuts_zones(request);
}

/// Rounds a length to a multiple of 1e-9 mm, which is far below the increments of controls.
double rounded_mm(double mm) {
  constexpr double kStepsPerMm = 1e9;
  return std::round(mm * kStepsPerMm) / kStepsPerMm;
}

double aperture_mm(const geometry::Element& element) {
  const auto* const hexagonal = std::get_if<geometry::HexagonalCube>(&element);
  return hexagonal != nullptr ? hexagonal->aperture_mm : std::get<geometry::TriangularCube>(element).aperture_mm;
}

/// Adds the elements of each zone of the design to the job. Elements of a zone with different rotations form separate
/// zones of the job.
void add_zones(const design::Design& design, GeneratedJob& made) {
  Job& job = made.job;
  const geometry::ZonedSpec spec = design::zones_of(design);
  const PartSpec& first = spec.zones.front().elements;
  job.element = first.element;
  job.angle_errors = first.angle_errors;
  job.array.arrangement = first.array.arrangement;
  job.array.x_length_mm = spec.size_mm.x();
  job.array.y_length_mm = spec.size_mm.y();
  const std::vector<std::vector<geometry::ElementPlacement>> whole = geometry::whole_elements(spec);
  for (std::size_t z = 0; z < spec.zones.size(); ++z) {
    const PartSpec& elements = spec.zones[z].elements;
    std::map<double, fabrication::CutZone> by_turn;
    for (const geometry::ElementPlacement& at : whole[z])
      by_turn[std::remainder(at.rotation_deg, 360.0)].apexes_mm.emplace_back(rounded_mm(at.apex_mm.x()),
                                                                             rounded_mm(at.apex_mm.y()));
    if (by_turn.empty())
      made.warnings.push_back(
          {"zone_not_cut", fmt::format("zone {} has no whole element: the zone is not cut", z + 1)});
    for (auto& [turn_deg, zone] : by_turn) {
      zone.rotation_deg = turn_deg;
      if (aperture_mm(elements.element) != aperture_mm(job.element)) zone.aperture_mm = aperture_mm(elements.element);
      const auto tell = [](const std::array<double, 3>& own, const std::array<double, 3>& all, auto& told) {
        if (own != all) told = own;
      };
      tell(elements.angle_errors.dihedral_error_arcmin, job.angle_errors.dihedral_error_arcmin,
           zone.dihedral_error_arcmin);
      tell(elements.angle_errors.facet_tilt_arcmin, job.angle_errors.facet_tilt_arcmin, zone.facet_tilt_arcmin);
      job.zones.push_back(std::move(zone));
    }
    warn_of_errors(elements, fmt::format("{}, zone {}", design.source_name(), z + 1), made);
  }
  made.partial_elements = geometry::build_part(spec).elements_partial;
  if (made.partial_elements > 0)
    job.notes.push_back(fmt::format("{} elements that borders cut are left out", made.partial_elements));
  if (made.partial_elements > 0 && std::ranges::any_of(spec.zones, [](const geometry::PartZone& zone) {
        return zone.elements.array.partial_elements == geometry::PartialElements::cut;
      }))
    made.warnings.push_back({"partial_elements_not_cut", cut_warning(design.source_name(), made.partial_elements)});
}

/// Adds a warning if cavities remove parts of elements in other zones.
/// \pre the job has zones and is valid
void tell_overcut(GeneratedJob& made) {
  Job& job = made.job;
  if (!std::holds_alternative<geometry::HexagonalCube>(job.element)) return;
  job.notes.push_back("cavities are triangular: at borders of zones, they extend beyond the elements' outlines");
  const fabrication::VerificationModel workpiece =
      fabrication::verification_model_of(job, machine_at_field(job.machine));
  const fabrication::ZoneOvercut overcut =
      fabrication::zone_overcut(workpiece, std::vector<bool>(workpiece.cavities.size(), true));
  if (overcut.elements == 0) return;
  made.warnings.push_back(
      {"zones_overcut", fmt::format("cavities extend into other zones, and remove {} mm2 of the "
                                    "apertures of {} of {} elements, at most {} um deep",
                                    fixed(overcut.area_mm2, 4), overcut.elements, workpiece.cavities.size(),
                                    fixed(1e3 * overcut.deepest_mm, 1))});
}

}  // namespace

void check_job_request(const JobRequest& request) {
  requests::check(request);
  const fabrication::Machine machine = machine_at_field(machine_of(request));
  if (is_dmc(request) != (machine.tilt == fabrication::Tilt::head))
    throw InputError(Field{"machine"},
                     fmt::format("must be a machine with a tilting {} for strategy {}, got {}",
                                 is_dmc(request) ? "head" : "table", request.strategy, in_quotes(request.machine)));
  process_of(request);
}

void check_cuts_zones(const JobRequest& request) {
  if (!is_dmc(request))
    throw InputError(Field{"strategy"},
                     fmt::format("must be dmc for a part with zones, got {}", in_quotes(request.strategy)));
}

void check_element(const design::Design& design, const JobRequest& request) {
  if (design.zoned())
    check_zones(design, request);
  else
    element_of(design, request);
}

namespace {

/// Returns the requested tool.
/// \throw InputError if the tool does not fit the element
fabrication::Tool tool_of(const Job& job, const JobRequest& request) {
  fabrication::Tool tool;
  tool.width_mm = request.tool_width_mm;
  const Field at{"tool_width_mm"};
  if (!cuts_prisms(job)) {
    tool.wedge_deg = fabrication::kDmcWedgeDeg;
    for (std::size_t zone = 0; zone < fabrication::zone_count(job); ++zone)
      fabrication::check_v_tool(fabrication::blank_element(job, zone), fabrication::angle_errors_of(job, zone), tool,
                                [&](std::string_view, const std::string& text) { throw InputError(at, text); });
    return tool;
  }
  const double element_width_mm = fabrication::blank_prism(job).width_mm;
  if (request.tool_width_mm > element_width_mm + 1e-6)
    throw InputError(at, fmt::format("must be <= {}, the element's width, got {}", shortest(element_width_mm),
                                     shortest(request.tool_width_mm)));
  return tool;
}

}  // namespace

namespace {

/// Checks that a design with a base can be cut. Pins are refused, because they are ground one by one and then bundled.
/// Other elements on a substrate can only be cut in a mould.
void check_substrate(const design::Design& design, const JobRequest& request) {
  if (design.zoned() || !design.part().substrate) return;
  if (design.part().is_pin_bundle)
    throw InputError(
        {design.source_name(), 0, "array.arrangement"},
        "must be \"honeycomb\" for a job, because pins are not cut but ground one by one and bundled, got \"pins\"");
  if (std::holds_alternative<geometry::OffsetSubstrate>(design.part().substrate->shape))
    throw InputError(design.where("substrate.kind"), "must not be \"offset\" for a job");
  if (std::holds_alternative<geometry::StepFace>(design.part().substrate->shape))
    throw InputError(design.where("substrate.kind"), "must not be \"step\" for a job");
  if (request.workpiece != fabrication::kWorkpieceWords[0])
    throw InputError(Field{"workpiece"},
                     "must be mould for a design with [substrate], got " + in_quotes(request.workpiece));
}

}  // namespace

GeneratedJob make_job(const design::Design& design, const JobRequest& request) {
  requests::check(request);
  design::require_supported(design, {.what = "retrace job", .zones = true, .wet_backs = true});
  check_substrate(design, request);
  if (design.facet_planes())
    throw InputError(design.where("part.facets"),
                     "not allowed for a job: individual facet planes cannot be cut in this version");
  GeneratedJob made;
  Job& job = made.job;
  job.title = design.title;
  if (design.source != "-") made.design_file = design.source;
  job.design = made.design_file.filename().string();
  job.strategy = enumerator_of<fabrication::Strategy>(request.strategy, fabrication::kStrategyWords);
  check_element(design, request);
  check_job_request(request);
  if (design.zoned()) {
    add_zones(design, made);
  } else {
    job.element = element_of(design, request);
    job.array = design.part().array;
    if (job.array.outline && job.array.outline->is_box()) job.array.outline.reset();
    if (job.array.outline) job.outline = fabrication::job_outline(*job.array.outline);
    job.substrate = design.part().substrate;
    if (!is_prism(design.part())) job.angle_errors = design.part().angle_errors;
  }
  job.workpiece.kind = enumerator_of<fabrication::WorkpieceKind>(request.workpiece, fabrication::kWorkpieceWords);
  job.workpiece.shrinkage_percent = request.shrinkage_percent;
  job.tool = tool_of(job, request);
  job.machine = machine_of(request);
  job.process = process_of(request);
  append(made.warnings, job.process.warnings);
  if (design.mask())
    job.array.pattern = geometry::mask_pattern(design.mask()->file, design.mask()->threshold,
                                               geometry::prism_block(job.array, fabrication::prism_of(job)).counts,
                                               design.where("array.mask"));
  if (!cuts_prisms(job) && request.workpiece != fabrication::kWorkpieceWords[0])
    throw InputError(Field{"workpiece"},
                     "must be mould for cube corners, because the cavities differ from the elements, got " +
                         in_quotes(request.workpiece));
  fabrication::check_job(job, {design.source_name(), 0, ""});
  made.elements = static_cast<std::int64_t>(fabrication::cut_elements(job).size());
  design.zoned() ? tell_overcut(made) : add_warnings(design, made);
  return made;
}

}  // namespace retrace::studies
