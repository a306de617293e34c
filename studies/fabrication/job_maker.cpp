#include "studies/fabrication/job_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/message_text.h"
#include "core/number_format.h"
#include "fabrication/job/io/job_files.h"
#include "fabrication/job/io/mask_image.h"
#include "fabrication/machine/io/machine_files.h"
#include "geometry/part.h"

namespace retrace::studies {
namespace {

using fabrication::Job;
using geometry::Arrangement;
using geometry::PartSpec;

/// \throw InputError at the option if the word is none of `words`
std::size_t word_index(const std::string& option, const std::string& given, std::span<const std::string_view> words) {
  const auto found = std::find(words.begin(), words.end(), given);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  throw InputError({"", 0, option}, fmt::format("must be {}, got {}", alternatives(words), in_quotes(given)));
}

fabrication::Strategy strategy_of(const std::string& given) {
  if (given == "dmc")
    throw InputError({"", 0, "--strategy"},
                     "dmc (cube corners by diamond micro chiseling) is not available in this version");
  return static_cast<fabrication::Strategy>(word_index("--strategy", given, fabrication::kStrategyWords));
}

const geometry::RtpElement& element_of(const Design& design) {
  design.require_elements("retrace job");
  const auto* const rtp = std::get_if<geometry::RtpElement>(&design.part.element);
  if (rtp == nullptr)
    throw InputError({design.source_name(), 0, "element.kind"},
                     "must be \"rtp\": other elements cannot be cut in this version");
  if (design.part.extent == geometry::Extent::infinite)
    throw InputError({design.source_name(), 0, "array.extent"}, "must be \"finite\" to be cut, got \"infinite\"");
  return *rtp;
}

fabrication::Array array_of(const Design& design) {
  const PartSpec& part = design.part;
  fabrication::Array array;
  array.arrangement = part.arrangement;
  array.shifted_rows = part.shifted_rows;
  array.overlap_percent = part.overlap_percent;
  array.x_length_mm = part.x_length_mm;
  array.y_length_mm = part.y_length_mm;
  array.x_gap_mm = part.x_gap_mm;
  array.y_gap_mm = part.y_gap_mm;
  array.x_offset_mm = part.x_offset_mm;
  array.y_offset_mm = part.y_offset_mm;
  return array;
}

/// Whether the design has tilts or edges that a job does not know.
bool has_errors(const PartSpec& part) {
  const std::array<double, 3> none{};
  return !part.edges.is_sharp() || part.angle_errors.facet_tilt_arcmin != none || part.random_tilts.sigma_arcmin > 0.0;
}

/// Partial elements of the array, whether or not a mask is to leave out others.
std::int64_t partial_elements(const PartSpec& part) {
  if (part.arrangement != Arrangement::offset) return 0;
  PartSpec nominal = part;
  nominal.angle_errors = {};
  nominal.random_tilts = {};
  nominal.edges = {};
  return geometry::build_part(nominal).elements_partial;
}

void add_warnings(const Design& design, MadeJob& made) {
  const std::string name = design.source_name();
  made.partial_elements = partial_elements(design.part);
  if (made.partial_elements > 0) {
    made.job.notes.push_back(fmt::format("{} partial elements are left out", made.partial_elements));
    if (design.part.partial_elements == geometry::PartialElements::cut)
      made.warnings.push_back(
          fmt::format("{}: array.partial_elements is \"cut\", but a job leaves partial elements out: {}", name,
                      made.partial_elements));
  }
  if (has_errors(design.part))
    made.warnings.push_back(fmt::format("{}: facet tilts, random errors and edges of [surface] are not cut", name));
}

}  // namespace

void check_making(const JobRequest& request) {
  strategy_of(request.strategy);
  word_index("--workpiece", request.workpiece, fabrication::kWorkpieceWords);
  if (!(request.shrinkage_percent >= 0.0 && request.shrinkage_percent <= 10.0))
    throw InputError({"", 0, "--shrinkage-percent"},
                     "must be >= 0 and <= 10, got " + shortest(request.shrinkage_percent));
  if (!(request.tool_width_mm >= 0.1 && request.tool_width_mm <= 2.0))
    throw InputError({"", 0, "--tool-width-mm"}, "must be >= 0.1 and <= 2, got " + shortest(request.tool_width_mm));
  fabrication::load_machine(request.machine, {"", 0, "--machine"});
  fabrication::load_process(request.process, {"", 0, "--process"});
}

MadeJob make_job(const Design& design, const JobRequest& request) {
  if (design.facet_planes)
    throw InputError(design.facet_planes->location, "planes of single facets are traced, not cut, in this version");
  MadeJob made;
  Job& job = made.job;
  job.title = design.title;
  job.design = design.source == "-" ? "" : std::filesystem::path(design.source).filename().string();
  job.element = element_of(design);
  prism_of(job).apex_angle_deg += design.part.angle_errors.dihedral_error_arcmin[0] / 60.0;
  job.array = array_of(design);
  check_making(request);
  job.strategy = strategy_of(request.strategy);
  job.workpiece.kind = static_cast<fabrication::WorkpieceKind>(
      word_index("--workpiece", request.workpiece, fabrication::kWorkpieceWords));
  job.workpiece.shrinkage_percent = request.shrinkage_percent;
  job.tool.width_mm = request.tool_width_mm;
  const double element_width_mm = fabrication::blank_prism(job).width_mm;
  if (request.tool_width_mm > element_width_mm + 1e-6)
    throw InputError({"", 0, "--tool-width-mm"},
                     fmt::format("must be <= {}, the element's width, got {}", shortest(element_width_mm),
                                 shortest(request.tool_width_mm)));
  job.machine = request.machine;
  job.process = fabrication::load_process(request.process, {"", 0, "--process"});
  if (design.mask)
    job.array.pattern =
        fabrication::mask_pattern(design.mask->file, design.mask->threshold,
                                  fabrication::cell_counts(job.array, prism_of(job)), design.mask->location);
  fabrication::check_job(job, {design.source_name(), 0, ""});
  made.elements = static_cast<std::int64_t>(fabrication::cut_elements(job).size());
  add_warnings(design, made);
  return made;
}

}  // namespace retrace::studies
