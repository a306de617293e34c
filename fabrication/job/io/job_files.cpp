#include "fabrication/job/io/job_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/angle.h"
#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/schema/reader.h"
#include "core/schema/writer.h"
#include "core/toml_file.h"
#include "fabrication/job/cube_cells.h"
#include "fabrication/job/io/base_keys.h"
#include "fabrication/job/io/process_files.h"
#include "fabrication/job/v_tool.h"

namespace retrace::fabrication {
namespace fs = std::filesystem;
namespace {

using geometry::Arrangement;
using geometry::RowParity;

constexpr std::string_view kSchema = "retrace.job/1";
/// Arrangements of an element in the order of their words.
struct ArrangementWords {
  std::vector<std::string_view> words;
  std::vector<Arrangement> arrangements;
};
const ArrangementWords kPrismArrangements = {
    {"single", "aligned", "offset", "checker"},
    {Arrangement::single, Arrangement::aligned, Arrangement::offset, Arrangement::checker}};
const ArrangementWords kHexagonalArrangements = {{"single", "honeycomb"},
                                                 {Arrangement::single, Arrangement::honeycomb}};
const ArrangementWords kTriangularArrangements = {{"single", "triangular"},
                                                  {Arrangement::single, Arrangement::triangular}};
constexpr std::array<std::string_view, 2> kRowWords = {"even", "odd"};
/// In the order of the alternatives of geometry::Element.
constexpr std::array<std::string_view, 3> kElementWords = {"rtp", "hexagonal_icc", "triangular_icc"};

/// From a tenth of a micrometre to ten metres, in which nanometres still are whole numbers of 64 bits.
constexpr NumberRange kSize{.low = 1e-4, .high = 1e4};
constexpr NumberRange kGap{.low = 0.0, .high = 1e4};
constexpr NumberRange kApexAngle{.low = 60.0, .high = 120.0};
constexpr NumberRange kOverlap{.low = 0.0, .high = 100.0, .high_included = false};
constexpr NumberRange kShrinkage{.low = 0.0, .high = 10.0};
constexpr NumberRange kToolWidth{.low = 0.1, .high = 2.0};
constexpr NumberRange kDmcToolWidth{.low = 0.01, .high = 10.0};
constexpr NumberRange kNoseAngle{.low = 10.0, .high = 120.0};
constexpr NumberRange kWedge{.low = 10.0, .high = 80.0};
constexpr NumberRange kToolClearance{.low = 2.0, .high = 15.0};
constexpr NumberRange kEdgeRadius{.low = 0.0, .high = 50.0};
constexpr NumberRange kSideClearance{.low = 0.0, .low_included = false, .high = 20.0};
/// Keeps the memory of a plan within reason: about 1 KiB an element.
constexpr double kMostElements = 2e6;
/// A tool this much wider than the element fits it all the same.
constexpr double kFitToleranceMm = 1e-6;
constexpr NumberRange kChipWidth{.low = 0.01, .high = 100.0};
constexpr std::size_t kMostChips = 100;
/// The chip needs this much between the rake face and the other facet (assumed: half of what wedge 50 and clearance 15
/// leave of a right angle).
constexpr double kChipRoomDeg = 12.5;

template <std::size_t size>
std::span<const std::string_view> words(const std::array<std::string_view, size>& all) {
  return all;
}

Workpiece read_workpiece(TomlTable table) {
  Workpiece workpiece;
  if (const auto kind = table.choice("kind", kWorkpieceWords)) workpiece.kind = static_cast<WorkpieceKind>(*kind);
  workpiece.shrinkage_percent = table.number("shrinkage_percent", kShrinkage).value_or(0.0);
  return workpiece;
}

bool is_prism(const Job& job) {
  return std::holds_alternative<geometry::RtpElement>(job.element);
}

const ArrangementWords& arrangements_of(const geometry::Element& element) {
  if (std::holds_alternative<geometry::RtpElement>(element)) return kPrismArrangements;
  return std::holds_alternative<geometry::HexagonalCube>(element) ? kHexagonalArrangements : kTriangularArrangements;
}

geometry::Element read_element(TomlTable table) {
  const std::size_t kind = table.required_choice("kind", words(kElementWords));
  if (kind == 1) return geometry::HexagonalCube{table.required_number("aperture_mm", kSize), {}};
  if (kind == 2) return geometry::TriangularCube{table.required_number("aperture_mm", kSize), {}};
  geometry::RtpElement element;
  element.base_mm = table.required_number("base_mm", kSize);
  element.width_mm = table.required_number("width_mm", kSize);
  element.apex_angle_deg = table.number("apex_angle_deg", kApexAngle).value_or(90.0);
  return element;
}

Array read_array(TomlTable table, const geometry::Element& element) {
  Array array;
  const ArrangementWords& known = arrangements_of(element);
  array.arrangement = known.arrangements[table.required_choice("arrangement", known.words)];
  if (array.arrangement != Arrangement::single) {
    array.x_length_mm = table.required_number("x_length_mm", kSize);
    array.y_length_mm = table.required_number("y_length_mm", kSize);
  }
  if (std::holds_alternative<geometry::RtpElement>(element)) {
    if (const auto rows = table.choice("shifted_rows", words(kRowWords)))
      array.shifted_rows = *rows == 0 ? RowParity::even : RowParity::odd;
    array.overlap_percent = table.number("overlap_percent", kOverlap).value_or(50.0);
    array.x_gap_mm = table.number("x_gap_mm", kGap).value_or(0.0);
    array.y_gap_mm = table.number("y_gap_mm", kGap).value_or(0.0);
  }
  array.x_offset_mm = table.number("x_offset_mm", kGap).value_or(0.0);
  array.y_offset_mm = table.number("y_offset_mm", kGap).value_or(0.0);
  array.pattern = table.texts("pattern").value_or(std::vector<std::string>{});
  return array;
}

/// The chips of an edge, each with its own table.
std::vector<EdgeChip> read_edge_chips(TomlTable& tool, double tool_width_mm) {
  std::vector<EdgeChip> chips;
  for (TomlTable table : tool.tables("edge_chips")) {
    EdgeChip chip;
    chip.width_um = table.required_number("width_um", kChipWidth);
    const double reach_um = 0.5 * (1e3 * tool_width_mm - chip.width_um);
    chip.position_um = table.required_number("position_um", {.low = -reach_um, .high = reach_um});
    chip.depth_um = table.required_number("depth_um", {.low = 0.0, .low_included = false, .high = 0.5 * chip.width_um});
    for (const EdgeChip& other : chips)
      if (std::abs(other.position_um - chip.position_um) < 0.5 * (other.width_um + chip.width_um) * (1.0 - 1e-9))
        table.fail("position_um", "must keep clear of the other chips, got " + shortest(chip.position_um));
    chips.push_back(chip);
  }
  if (chips.size() > kMostChips)
    tool.fail("edge_chips", fmt::format("must be at most {}, got {}", kMostChips, chips.size()));
  return chips;
}

Tool read_tool(TomlTable table, Strategy strategy) {
  Tool tool;
  const bool is_v = strategy == Strategy::dmc;
  tool.width_mm = table.required_number("width_mm", is_v ? kDmcToolWidth : kToolWidth);
  tool.wedge_deg = table.number("wedge_deg", kWedge).value_or(is_v ? kDmcWedgeDeg : tool.wedge_deg);
  tool.clearance_deg = table.number("clearance_deg", kToolClearance).value_or(tool.clearance_deg);
  tool.edge_radius_um = table.number("edge_radius_um", kEdgeRadius).value_or(tool.edge_radius_um);
  if (is_v) {
    tool.nose_angle_deg = table.number("nose_angle_deg", kNoseAngle).value_or(tool.nose_angle_deg);
  } else {
    tool.side_clearance_deg = table.number("side_clearance_deg", kSideClearance).value_or(tool.side_clearance_deg);
    tool.edge_chips = read_edge_chips(table, tool.width_mm);
  }
  return tool;
}

/// Where the values that belong together were given.
struct Places {
  InputLocation strategy;
  InputLocation workpiece;
  InputLocation element_width;
  InputLocation tool_width;
  InputLocation tool_wedge;
  InputLocation tool_side;
  InputLocation tool_nose;
  InputLocation tool_radius;
  InputLocation x_length;
  InputLocation y_length;
  InputLocation pattern;
  InputLocation base;
};

void check_chisel(const Job& job, const Places& at) {
  const double width_mm = blank_prism(job).width_mm;
  if (job.tool.width_mm > width_mm + kFitToleranceMm)
    throw InputError(at.tool_width, fmt::format("must be <= {}, the element's width, got {}", shortest(width_mm),
                                                shortest(job.tool.width_mm)));
  const double apex_deg = prism_of(job).apex_angle_deg;
  const double taken_deg = job.tool.wedge_deg + job.tool.clearance_deg;
  if (taken_deg >= apex_deg)
    throw InputError(at.tool_wedge,
                     fmt::format("with clearance_deg must be < {}, the element's apex angle, for the tool "
                                 "to fit the root, got {}",
                                 shortest(apex_deg), shortest(taken_deg)));
  if (apex_deg - taken_deg < kChipRoomDeg)
    throw InputError(at.tool_wedge, fmt::format("with clearance_deg must be <= {} for chips to leave between rake face "
                                                "and facet, got {}",
                                                shortest(apex_deg - kChipRoomDeg), shortest(taken_deg)));
  // The diamond narrows towards its shank and must still be there where it leaves the element.
  const double half_apex_rad = 0.5 * Angle::from_deg(apex_deg).rad();
  const double facet_mm = 0.5 * blank_prism(job).base_mm / std::sin(half_apex_rad);
  const double side_limit_deg = Angle::from_rad(std::atan(0.5 * job.tool.width_mm / facet_mm)).deg();
  if (job.tool.side_clearance_deg >= side_limit_deg)
    throw InputError(at.tool_side,
                     fmt::format("must be < {}, or the diamond ends in a point within its element, got {}",
                                 fixed(side_limit_deg, 3), shortest(job.tool.side_clearance_deg)));
}

void check_row(const std::string& row, std::size_t k, std::int64_t columns, const Places& at) {
  if (static_cast<std::int64_t>(row.size()) != columns)
    throw InputError(at.pattern, fmt::format("must have {} cells in every row, as many as the array, got {} in row {}",
                                             columns, row.size(), k));
  const std::size_t wrong = row.find_first_not_of("#-");
  if (wrong != std::string::npos)
    throw InputError(at.pattern, fmt::format("must hold # and - only, got {} in row {}",
                                             in_quotes(std::string_view(row).substr(wrong, 1)), k));
}

/// \param lengths cells of each row, from that of least y
void check_pattern(const Job& job, const std::vector<std::int64_t>& lengths, const Places& at) {
  const std::vector<std::string>& pattern = job.array.pattern;
  if (pattern.empty()) return;
  if (pattern.size() != lengths.size())
    throw InputError(at.pattern,
                     fmt::format("must have {} rows, as many as the array, got {}", lengths.size(), pattern.size()));
  for (std::size_t k = 0; k < pattern.size(); ++k) check_row(pattern[k], k, lengths[lengths.size() - 1 - k], at);
  if (cut_elements(job).empty()) throw InputError(at.pattern, "leaves no element to cut");
}

void refuse_too_many(double elements, const Places& at) {
  if (elements > kMostElements)
    throw InputError(at.x_length, fmt::format("the array would have {:.6g} elements, at most {:.0f} are allowed",
                                              elements, kMostElements));
}

void check_prism_array(const Job& job, const Places& at) {
  const geometry::RtpElement& prism = prism_of(job);
  const double columns = (job.array.x_length_mm + job.array.x_gap_mm) / (prism.base_mm + job.array.x_gap_mm);
  const double rows = (job.array.y_length_mm + job.array.y_gap_mm) / (prism.width_mm + job.array.y_gap_mm);
  refuse_too_many(columns * rows, at);
  const CellCounts counts = cell_counts(job.array, prism);
  if (counts.columns < 1)
    throw InputError(at.x_length, "must hold one element between the margins, got " + shortest(job.array.x_length_mm));
  if (counts.rows < 1)
    throw InputError(at.y_length, "must hold one element between the margins, got " + shortest(job.array.y_length_mm));
  if (job.array.arrangement == Arrangement::checker && std::abs(prism.base_mm - prism.width_mm) > 1e-9 * prism.base_mm)
    throw InputError(at.element_width, fmt::format("must equal base_mm ({}) for arrangement = \"checker\", got {}",
                                                   shortest(prism.base_mm), shortest(prism.width_mm)));
  // Without a pattern the first unshifted row has elements.
  check_pattern(job, std::vector<std::int64_t>(static_cast<std::size_t>(counts.rows), counts.columns), at);
}

void check_cube_array(const Job& job, const Places& at) {
  refuse_too_many(cube_cell_estimate(job.array, job.element), at);
  const std::vector<std::int64_t> lengths = cube_row_lengths(job.array, job.element);
  if (lengths.empty())
    throw InputError(at.x_length,
                     fmt::format("with y_length_mm must hold one whole element round the middle, got {} and {}",
                                 shortest(job.array.x_length_mm), shortest(job.array.y_length_mm)));
  check_pattern(job, lengths, at);
}

void check_array(const Job& job, const Places& at) {
  if (job.array.arrangement == Arrangement::single) {
    if (!job.array.pattern.empty()) throw InputError(at.pattern, "not allowed for arrangement = \"single\"");
    return;
  }
  is_prism(job) ? check_prism_array(job, at) : check_cube_array(job, at);
}

/// Prisms are cut by a chisel, cube corners by a V.
void check_strategy(const Job& job, const InputLocation& at_strategy, const InputLocation& at_workpiece) {
  const bool is_dmc = job.strategy == Strategy::dmc;
  const std::string_view kind = kElementWords[job.element.index()];
  if (is_dmc && is_prism(job))
    throw InputError(at_strategy,
                     R"(must be "unidirectional", "bidirectional" or "two-step" for element.kind = "rtp", got "dmc")");
  if (!is_dmc && !is_prism(job))
    throw InputError(at_strategy, fmt::format("must be \"dmc\" for element.kind = {}, got {}", in_quotes(kind),
                                              in_quotes(kStrategyWords[static_cast<std::size_t>(job.strategy)])));
  if (is_dmc && job.workpiece.kind == WorkpieceKind::direct)
    throw InputError(at_workpiece,
                     "must be \"mould\" for cube corners, whose cavities are not their elements, got "
                     "\"direct\"");
}

void check_together(const Job& job, const Places& at) {
  check_strategy(job, at.strategy, at.workpiece);
  if (job.base) check_array_on_base(job, at.base);
  check_array(job, at);
  if (is_prism(job))
    check_chisel(job, at);
  else
    check_v_tool(blank_element(job), job.tool, {at.tool_width, at.tool_nose, at.tool_wedge, at.tool_radius});
  if (job.base) check_base_of(job, at.base);
}

std::string rows_text(const std::vector<std::string>& pattern) {
  std::string text = "pattern = [\n";
  for (const std::string& row : pattern) text += "  " + toml_text(row) + ",\n";
  return text + "]\n";
}

class TextWriter {
 public:
  void head(std::string_view name) { text_ += fmt::format("\n[{}]\n", name); }
  void number(std::string_view key, double value) { text_ += fmt::format("{} = {}\n", key, shortest(value)); }
  void text(std::string_view key, std::string_view value) { text_ += fmt::format("{} = {}\n", key, toml_text(value)); }
  void raw(std::string_view line) { text_ += line; }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

void write_element(TextWriter& out, const geometry::Element& element) {
  out.head("element");
  out.text("kind", kElementWords[element.index()]);
  if (const auto* const prism = std::get_if<geometry::RtpElement>(&element)) {
    out.number("base_mm", prism->base_mm);
    out.number("width_mm", prism->width_mm);
    out.number("apex_angle_deg", prism->apex_angle_deg);
  } else if (const auto* const hexagonal = std::get_if<geometry::HexagonalCube>(&element)) {
    out.number("aperture_mm", hexagonal->aperture_mm);
  } else {
    out.number("aperture_mm", std::get<geometry::TriangularCube>(element).aperture_mm);
  }
}

void write_array(TextWriter& out, const Array& array, const geometry::Element& element) {
  const ArrangementWords& known = arrangements_of(element);
  const bool is_of_prisms = std::holds_alternative<geometry::RtpElement>(element);
  out.head("array");
  const auto index =
      std::find(known.arrangements.begin(), known.arrangements.end(), array.arrangement) - known.arrangements.begin();
  out.text("arrangement", known.words[static_cast<std::size_t>(index)]);
  if (is_of_prisms) {
    out.text("shifted_rows", array.shifted_rows == RowParity::even ? "even" : "odd");
    out.number("overlap_percent", array.overlap_percent);
  }
  if (array.arrangement != Arrangement::single) {
    out.number("x_length_mm", array.x_length_mm);
    out.number("y_length_mm", array.y_length_mm);
  }
  if (is_of_prisms) {
    out.number("x_gap_mm", array.x_gap_mm);
    out.number("y_gap_mm", array.y_gap_mm);
  }
  out.number("x_offset_mm", array.x_offset_mm);
  out.number("y_offset_mm", array.y_offset_mm);
  if (!array.pattern.empty()) out.raw(rows_text(array.pattern));
}

}  // namespace

void check_job(const Job& job, const InputLocation& where) {
  const auto at = [&](std::string key) { return InputLocation{where.file, where.line, std::move(key)}; };
  check_together(
      job, {at("strategy"), at("workpiece.kind"), at("element.width_mm"), at("tool.width_mm"), at("tool.wedge_deg"),
            at("tool.side_clearance_deg"), at("tool.nose_angle_deg"), at("tool.edge_radius_um"),
            at("array.x_length_mm"), at("array.y_length_mm"), at("array.pattern"), at("base")});
}

Job parse_job(std::string_view text, const std::string& source_name) {
  TomlTable root = parse_toml(text, source_name);
  const std::string schema = root.required_text("schema");
  if (schema != kSchema) root.fail("schema", fmt::format("must be {}, got {}", in_quotes(kSchema), in_quotes(schema)));
  Job job;
  job.source = source_name;
  job.title = root.text("title").value_or("");
  job.design = root.text("design").value_or("");
  job.notes = root.texts("notes").value_or(std::vector<std::string>{});
  job.strategy = static_cast<Strategy>(root.required_choice("strategy", kStrategyWords));
  job.machine = root.required_text("machine");
  if (job.machine.empty()) root.fail("machine", "must name a machine or a file, got \"\"");
  TomlTable element = root.required_table("element");
  TomlTable array = root.required_table("array");
  TomlTable tool = root.required_table("tool");
  TomlTable process = root.required_table("process");
  TomlTable workpiece = root.table("workpiece");
  job.workpiece = read_workpiece(workpiece);
  job.element = read_element(element);
  check_strategy(job, root.where("strategy"), workpiece.where("kind"));
  job.array = read_array(array, job.element);
  InputLocation base_at;
  if (root.has("base")) job.base = read_base(root.required_table("base"), base_at);
  job.tool = read_tool(tool, job.strategy);
  schema::read_table(process_format().root, process, &job.process);
  root.finish();
  check_together(job, {root.where("strategy"), workpiece.where("kind"), element.where("width_mm"),
                       tool.where("width_mm"), tool.where("wedge_deg"), tool.where("side_clearance_deg"),
                       tool.where("nose_angle_deg"), tool.where("edge_radius_um"), array.where("x_length_mm"),
                       array.where("y_length_mm"), array.where("pattern"), base_at});
  return job;
}

Job read_job(const fs::path& file) {
  Job job = parse_job(read_file(file), file.string());
  // A name without a folder or an ending is one of the shipped machines.
  const fs::path machine = job.machine;
  if (machine.has_extension() && machine.is_relative()) job.machine = (file.parent_path() / machine).string();
  return job;
}

std::string job_text(const Job& job) {
  TextWriter out;
  out.raw("# A fabrication job for retrace. Lengths in mm, angles in degrees; depths of cut in um.\n");
  out.text("schema", kSchema);
  if (!job.title.empty()) out.text("title", job.title);
  if (!job.design.empty()) out.text("design", job.design);
  if (!job.notes.empty()) {
    out.raw("notes = [\n");
    for (const std::string& note : job.notes) out.raw("  " + toml_text(note) + ",\n");
    out.raw("]\n");
  }
  out.text("machine", job.machine);
  out.text("strategy", kStrategyWords[static_cast<std::size_t>(job.strategy)]);
  out.head("workpiece");
  out.text("kind", kWorkpieceWords[static_cast<std::size_t>(job.workpiece.kind)]);
  out.number("shrinkage_percent", job.workpiece.shrinkage_percent);
  write_element(out, job.element);
  write_array(out, job.array, job.element);
  if (job.base) {
    out.head("base");
    out.raw(base_text(*job.base));
  }
  out.head("tool");
  out.number("width_mm", job.tool.width_mm);
  out.number("wedge_deg", job.tool.wedge_deg);
  out.number("clearance_deg", job.tool.clearance_deg);
  out.number("edge_radius_um", job.tool.edge_radius_um);
  if (job.strategy == Strategy::dmc)
    out.number("nose_angle_deg", job.tool.nose_angle_deg);
  else
    out.number("side_clearance_deg", job.tool.side_clearance_deg);
  for (const EdgeChip& chip : job.tool.edge_chips) {
    out.raw("\n[[tool.edge_chips]]\n");
    out.number("position_um", chip.position_um);
    out.number("width_um", chip.width_um);
    out.number("depth_um", chip.depth_um);
  }
  out.raw(schema::table_text(process_table("process"), &job.process));
  return out.take();
}

}  // namespace retrace::fabrication
