#include "studies/fabrication/job_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/message_text.h"
#include "core/number_format.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/job/io/process_files.h"
#include "fabrication/job/v_tool.h"
#include "fabrication/machine/io/machine_files.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/io/mask_image.h"
#include "geometry/part/part.h"
#include "studies/fabrication/reachable.h"

namespace retrace::studies {
namespace {

using fabrication::Job, geometry::Arrangement, geometry::PartSpec;

/// \throw InputError at the option if the word is none of `words`
std::size_t word_index(const std::string& option, const std::string& given, std::span<const std::string_view> words) {
  const auto found = std::find(words.begin(), words.end(), given);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  throw InputError({"", 0, option}, fmt::format("must be {}, got {}", alternatives(words), in_quotes(given)));
}

fabrication::Strategy strategy_of(const std::string& given) {
  return static_cast<fabrication::Strategy>(word_index("--strategy", given, fabrication::kStrategyWords));
}

bool is_dmc(const JobRequest& request) {
  return strategy_of(request.strategy) == fabrication::Strategy::dmc;
}

/// Diamond micro chiseling needs a head that tilts: the ideal machine is another one.
std::string machine_of(const JobRequest& request) {
  return is_dmc(request) && request.machine == "ideal" ? "ideal-dmc" : request.machine;
}

template <class Cube>
geometry::Element upright(const Cube& cube, const Design& design) {
  if (cube.cant.deg != 0.0)
    throw InputError({design.source_name(), 0, "element.cant_deg"},
                     "must be 0 to be cut in this version, got " + shortest(cube.cant.deg));
  return Cube{cube.aperture_mm, {}};
}

/// The element of the design, its dihedral error included if it is a prism.
/// \throw InputError for one that the strategy does not cut
geometry::Element element_of(const Design& design, const JobRequest& request) {
  if (design.part().array.extent == geometry::Extent::infinite)
    throw InputError({design.source_name(), 0, "array.extent"}, "must be \"finite\" to be cut, got \"infinite\"");
  if (const auto* const rtp = std::get_if<geometry::RtpElement>(&design.part().element)) {
    if (is_dmc(request))
      throw InputError({"", 0, "--strategy"},
                       "dmc cuts cube corners: must be unidirectional, bidirectional or two-step "
                       "for element.kind = \"rtp\", got dmc");
    geometry::RtpElement prism = *rtp;
    prism.apex_angle_deg += design.part().angle_errors.dihedral_error_arcmin[0] / 60.0;
    return prism;
  }
  if (!is_dmc(request))
    throw InputError(
        {"", 0, "--strategy"},
        fmt::format("a chisel with a straight edge reaches {} % of the facets of this cube corner, and not "
                    "its apex: must be dmc, or --reachable FILE for the part that it can make, got {}",
                    fixed(100.0 * reachable_share(design.part().element, request.tool_width_mm), 2), request.strategy));
  if (const auto* const hexagonal = std::get_if<geometry::HexagonalCube>(&design.part().element))
    return upright(*hexagonal, design);
  return upright(std::get<geometry::TriangularCube>(design.part().element), design);
}

/// Whether the design has tilts or edges that a job does not know.
bool has_errors(const PartSpec& part) {
  const std::array<double, 3> none{};
  const bool is_prism = std::holds_alternative<geometry::RtpElement>(part.element);
  if (!is_prism && part.angle_errors.dihedral_error_arcmin != none) return true;
  return !part.edges.is_sharp() || !part.scratches.empty() || part.angle_errors.facet_tilt_arcmin != none ||
         part.random_tilts.sigma_arcmin > 0.0;
}

/// Partial elements of the array, whether or not a mask is to leave out others.
std::int64_t partial_elements(const PartSpec& part) {
  if (!part.substrate && part.array.arrangement != Arrangement::offset &&
      part.array.arrangement != Arrangement::honeycomb && part.array.arrangement != Arrangement::triangular)
    return 0;
  PartSpec nominal = part;
  nominal.angle_errors = {};
  nominal.random_tilts = {};
  nominal.edges = {};
  nominal.scratches.clear();
  return geometry::build_part(nominal).elements_partial;
}

void add_warnings(const Design& design, MadeJob& made) {
  const std::string name = design.source_name();
  made.partial_elements = partial_elements(design.part());
  if (made.partial_elements > 0) {
    made.job.notes.push_back(fmt::format("{} partial elements are left out", made.partial_elements));
    if (design.part().array.partial_elements == geometry::PartialElements::cut)
      made.warnings.push_back(
          fmt::format("{}: array.partial_elements is \"cut\", but a job leaves partial elements out: {}", name,
                      made.partial_elements));
  }
  if (has_errors(design.part()))
    made.warnings.push_back(
        fmt::format("{}: {}facet tilts, random errors, edges and scratches of [surface] are not cut", name,
                    std::holds_alternative<geometry::RtpElement>(design.part().element) ? "" : "dihedral errors, "));
  if (design.part().array.arrangement == Arrangement::honeycomb)
    made.job.notes.push_back("cavities are triangular: those at the border reach beyond the elements' outlines");
}

}  // namespace

void check_making(const JobRequest& request) {
  strategy_of(request.strategy);
  word_index("--workpiece", request.workpiece, fabrication::kWorkpieceWords);
  if (!(request.shrinkage_percent >= 0.0 && request.shrinkage_percent <= 10.0))
    throw InputError({"", 0, "--shrinkage-percent"},
                     "must be >= 0 and <= 10, got " + shortest(request.shrinkage_percent));
  const double least_mm = is_dmc(request) ? 0.01 : 0.1;
  const double most_mm = is_dmc(request) ? 10.0 : 2.0;
  if (!(request.tool_width_mm >= least_mm && request.tool_width_mm <= most_mm))
    throw InputError({"", 0, "--tool-width-mm"}, fmt::format("must be >= {} and <= {}, got {}", shortest(least_mm),
                                                             shortest(most_mm), shortest(request.tool_width_mm)));
  const fabrication::Machine machine = fabrication::load_machine(machine_of(request), {"", 0, "--machine"});
  if (is_dmc(request) != (machine.tilt == fabrication::Tilt::head))
    throw InputError({"", 0, "--machine"},
                     fmt::format("must be a machine whose {} tilts for strategy {}, got {}",
                                 is_dmc(request) ? "head" : "table", request.strategy, in_quotes(request.machine)));
  fabrication::load_process(request.process, {"", 0, "--process"});
}

void check_element(const Design& design, const JobRequest& request) {
  element_of(design, request);
}

namespace {

/// The tool as it was requested. \throw InputError if it does not fit the element
fabrication::Tool tool_of(const Job& job, const JobRequest& request) {
  fabrication::Tool tool;
  tool.width_mm = request.tool_width_mm;
  const InputLocation at{"", 0, "--tool-width-mm"};
  if (job.strategy == fabrication::Strategy::dmc) {
    tool.wedge_deg = fabrication::kDmcWedgeDeg;
    fabrication::check_v_tool(fabrication::blank_element(job), tool,
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

/// Pins are ground one by one and bundled; elements that are cut into a base are cut into a mould.
void check_substrate(const Design& design, const JobRequest& request) {
  if (!design.part().substrate) return;
  if (design.part().is_pin_bundle)
    throw InputError({design.source_name(), 0, "array.arrangement"},
                     "pins are ground one by one and bundled, not cut: must be \"honeycomb\" for a job, got \"pins\"");
  if (request.workpiece != fabrication::kWorkpieceWords[0])
    throw InputError({"", 0, "--workpiece"},
                     "must be mould for a design with [base], got " + in_quotes(request.workpiece));
}

}  // namespace

MadeJob make_job(const Design& design, const JobRequest& request) {
  check_taken(design, {.what = "retrace job", .wet_backs = true});
  check_substrate(design, request);
  if (design.facet_planes())
    throw InputError(design.where("part.facets"), "planes of single facets are traced, not cut, in this version");
  MadeJob made;
  Job& job = made.job;
  job.title = design.title;
  if (design.source != "-") made.design_file = design.source;
  job.design = made.design_file.filename().string();
  job.strategy = strategy_of(request.strategy);
  job.element = element_of(design, request);
  job.array = design.part().array;
  job.substrate = design.part().substrate;
  check_making(request);
  job.workpiece.kind = static_cast<fabrication::WorkpieceKind>(
      word_index("--workpiece", request.workpiece, fabrication::kWorkpieceWords));
  job.workpiece.shrinkage_percent = request.shrinkage_percent;
  job.tool = tool_of(job, request);
  job.machine = machine_of(request);
  job.process = fabrication::load_process(request.process, {"", 0, "--process"});
  if (design.mask())
    job.array.pattern = geometry::mask_pattern(design.mask()->file, design.mask()->threshold,
                                               geometry::prism_block(job.array, fabrication::prism_of(job)).counts,
                                               design.where("array.mask"));
  fabrication::check_job(job, {design.source_name(), 0, ""});
  made.elements = static_cast<std::int64_t>(fabrication::cut_elements(job).size());
  add_warnings(design, made);
  return made;
}

}  // namespace retrace::studies
