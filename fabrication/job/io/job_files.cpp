#include "fabrication/job/io/job_files.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "core/angle.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/schema/access.h"
#include "core/schema/conditions.h"
#include "core/schema/reader.h"
#include "core/schema/writer.h"
#include "fabrication/job/io/given_access.h"
#include "fabrication/job/io/job_outline.h"
#include "fabrication/job/io/process_files.h"
#include "fabrication/job/substrate_cells.h"
#include "fabrication/job/tool_limits.h"
#include "fabrication/job/v_tool.h"
#include "fabrication/job/zone_cells.h"
#include "geometry/elements/substrate_checks.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/io/element_keys.h"
#include "geometry/io/substrate_rows.h"
#include "geometry/outline/plan_region.h"

namespace retrace::fabrication {
namespace fs = std::filesystem;
namespace {

using namespace schema;
using geometry::AngleErrors;
using geometry::Arrangement;
using geometry::ArrayLayout;
using geometry::RtpElement;

/// Range of sizes in mm: 0.1 micrometre to 10 metres. Positions in nanometres then fit into 64-bit integers.
constexpr Kind kSize = Number{{.low = 1e-4, .high = 1e4}};
constexpr geometry::SizeKeys kSizeKeys(kSize, Number{{.low = 0.0, .high = 1e4}});
constexpr Kind kThreeErrors = Numbers{3, {.low = -300.0, .high = 300.0}};
constexpr Kind kWedge = Number{{.low = 10.0, .high = kMaxWedgeDeg}};
/// Maximum number of elements. It limits the memory of a plan, which needs about 1 KiB per element.
constexpr double kMaxElements = 2e6;
constexpr std::size_t kMaxZoneElements = 2'000'000;
constexpr std::size_t kMaxChips = 100;
/// Minimum angle, in degrees, between the rake face and the facet that is not being cut. The chip leaves through the
/// gap between them. The value is an assumption: if the angle between the facets is 90, the wedge angle 50 and the
/// clearance angle 15 degrees, the gap is 25 degrees. Half of this gap is required.
constexpr double kChipRoomDeg = 12.5;

// Conversions between members of Job and values in files.

Value get_prism(const Job&) {
  return 0.0;
}
void set_prism(Job& job, const Value&) {
  job.element = RtpElement();
}
Value get_cube(const Job& job) {
  return std::holds_alternative<geometry::HexagonalCube>(job.element) ? 0.0 : 1.0;
}
void set_cube(Job& job, const Value& value) {
  job.element = std::get<double>(value) == 0.0 ? geometry::Element(geometry::HexagonalCube())
                                               : geometry::Element(geometry::TriangularCube());
}

Value get_aperture(const Job& job) {
  const auto* const hexagon = std::get_if<geometry::HexagonalCube>(&job.element);
  return hexagon != nullptr ? hexagon->aperture_mm : std::get<geometry::TriangularCube>(job.element).aperture_mm;
}
void set_aperture(Job& job, const Value& value) {
  auto* const hexagon = std::get_if<geometry::HexagonalCube>(&job.element);
  double& aperture_mm =
      hexagon != nullptr ? hexagon->aperture_mm : std::get<geometry::TriangularCube>(job.element).aperture_mm;
  aperture_mm = std::get<double>(value);
}

Value get_tiled(const ArrayLayout& array) {
  return array.arrangement == Arrangement::single ? 0.0 : 1.0;
}
template <Arrangement tiled>
void set_tiled(ArrayLayout& array, const Value& value) {
  array.arrangement = std::get<double>(value) == 0.0 ? Arrangement::single : tiled;
}

// Conversions of angle errors. Files contain angle errors only if they are not 0.

using Three = std::array<double, 3>;

Value three_numbers(const Three& numbers) {
  return std::vector<double>(numbers.begin(), numbers.end());
}
Three three_of(const Value& value) {
  const auto& numbers = std::get<std::vector<double>>(value);
  return {numbers[0], numbers[1], numbers[2]};
}
template <auto member>
Value get_errors(const Job& job) {
  return job.angle_errors.*member == Three{} ? Value() : three_numbers(job.angle_errors.*member);
}
template <auto member>
void set_errors(Job& job, const Value& value) {
  job.angle_errors.*member = three_of(value);
}
template <auto member>
Value get_own_errors(const CutZone& zone) {
  return zone.*member ? three_numbers(*(zone.*member)) : Value();
}
template <auto member>
void set_own_errors(CutZone& zone, const Value& value) {
  zone.*member = three_of(value);
}

Value get_apexes(const CutZone& zone) {
  std::vector<std::vector<double>> apexes;
  for (const geometry::Vec2& apex : zone.apexes_mm) apexes.push_back({apex.x(), apex.y()});
  return apexes;
}
void set_apexes(CutZone& zone, const Value& value) {
  zone.apexes_mm.clear();
  for (const auto& apex : std::get<std::vector<std::vector<double>>>(value))
    zone.apexes_mm.emplace_back(apex[0], apex[1]);
}

bool has_edge_life(const Tool& tool) {
  return tool.edge_life_mm.has_value();
}

constexpr std::string_view kElementKind = "element.kind";
constexpr Condition kOfPrisms[] = {is(kElementKind, only(geometry::kElementKinds, "rtp"))};
constexpr Condition kOfCubes[] = {is(kElementKind, geometry::kCubeKinds)};
constexpr Condition kOfHexagons[] = {is(kElementKind, only(geometry::kElementKinds, "hexagonal_icc"))};
constexpr Condition kOfTriangles[] = {is(kElementKind, only(geometry::kElementKinds, "triangular_icc"))};
constexpr Condition kOfArrays[] = {is_not("arrangement", only(geometry::kArrangementWords, "single"))};
constexpr Condition kOfChisels[] = {is_not("strategy", only(kStrategyWords, "dmc"))};
constexpr Condition kOfVTools[] = {is("strategy", only(kStrategyWords, "dmc"))};

constexpr Row kJobRows[] = {
    {"title", Text{}, kNone, "Title of the job. It appears in the header of programs and on the set-up sheet.",
     access<&Job::title>},
    {"design", Text{}, kNone,
     "Design file from which the job was made, relative to the folder of the job file. `retrace verify --as-machined` "
     "takes the thickness and the material of the plate, and the keys of its outline, from this design.",
     access<&Job::design>},
    {"notes", Texts{}, kNone,
     "Notes for the reader of the job, for example about omitted elements. They have no effect.", access<&Job::notes>},
    {"machine", Text{}, kRequired,
     "Name of a shipped machine (`\"ideal\"`, `\"paper\"`, `\"thesis\"` or `\"ideal-dmc\"`), or a [machine "
     "file](machine_file.md), relative to the folder of the job file. A name with an extension is a file.",
     access<&Job::machine>},
    {"strategy", Word{kStrategyWords}, kRequired,
     "Cutting strategy. `\"dmc\"` (diamond micro chiseling) is for cube corners, on a machine with a tilting head. The "
     "other strategies are for prisms.",
     access<&Job::strategy>}};
constexpr Row kWorkpieceRows[] = {
    {"kind", Word{kWorkpieceWords}, "mould",
     "Kind of workpiece. `\"mould\"`: the mould of the part's back, in the frame of the part. `\"direct\"`: the "
     "optical part itself (prisms only). It is rotated by 180 degrees about y, so that the array is mirrored in x.",
     access<&Workpiece::kind>},
    {"shrinkage_percent", Number{{.low = 0.0, .high = 10.0}}, 0.0,
     "Shrinkage of the moulded part. All sizes on the blank are the sizes of the part, multiplied by 1 + "
     "shrinkage_percent / 100.",
     access<&Workpiece::shrinkage_percent>}};
constexpr Row kElementRows[] = {
    {"kind", Word{only(geometry::kElementKinds, "rtp")}, kRequired, "Kind of the elements: prisms.",
     access_by<get_prism, set_prism>, kOfChisels},
    {"kind", Word{geometry::kCubeKinds}, kRequired, "Kind of the elements: cube corners.",
     access_by<get_cube, set_cube>, kOfVTools},
    with(kSizeKeys.base_mm, access_in<&Job::element, &RtpElement::base_mm>, kOfPrisms),
    with(kSizeKeys.width_mm, access_in<&Job::element, &RtpElement::width_mm>, kOfPrisms),
    with(geometry::kApexAngleKey, access_in<&Job::element, &RtpElement::apex_angle_deg>, kOfPrisms),
    with(kSizeKeys.aperture_mm, access_by<get_aperture, set_aperture>, kOfCubes),
    {"dihedral_error_arcmin", kThreeErrors, kNone,
     "Intended errors of the three dihedral angles. An error is positive if the angle is larger than 90 degrees. The "
     "key has the same meaning in a [design](design_file.md).",
     access_by<get_errors<&AngleErrors::dihedral_error_arcmin>, set_errors<&AngleErrors::dihedral_error_arcmin>>,
     kOfCubes},
    {"facet_tilt_arcmin", kThreeErrors, kNone,
     "Additional intended tilts of the three facets. The key has the same meaning in a [design](design_file.md).",
     access_by<get_errors<&AngleErrors::facet_tilt_arcmin>, set_errors<&AngleErrors::facet_tilt_arcmin>>, kOfCubes}};
constexpr Row kZoneRows[] = {
    {"aperture_mm", kSize, kNone,
     "Aperture of the elements of this zone. If this key is missing, the value of `[element]` is used.",
     access_given<&CutZone::aperture_mm>},
    {"dihedral_error_arcmin", kThreeErrors, kNone,
     "Errors of the dihedral angles in this zone. If this key is missing, the values of `[element]` are used.",
     access_by<get_own_errors<&CutZone::dihedral_error_arcmin>, set_own_errors<&CutZone::dihedral_error_arcmin>>},
    {"facet_tilt_arcmin", kThreeErrors, kNone,
     "Tilts of the facets in this zone. If this key is missing, the values of `[element]` are used.",
     access_by<get_own_errors<&CutZone::facet_tilt_arcmin>, set_own_errors<&CutZone::facet_tilt_arcmin>>},
    {"rotation_deg", Number{{.low = -360.0, .high = 360.0}}, 0.0,
     "Rotation of each element about its axis, counter-clockwise as seen from the light.",
     access<&CutZone::rotation_deg>},
    {"apexes_mm", NumberRows{2, {.low = 0.0, .high = 1e4}, 1, kMaxZoneElements, "points"}, kRequired,
     "`[[x, y], ...]`: positions of the apexes of the zone's elements, in x and y of the part. The origin is the "
     "corner of the part with the smallest x and y.",
     access_by<get_apexes, set_apexes>}};
constexpr Row kArrayRows[] = {
    {"arrangement", Word{geometry::kPrismArrangements}, kRequired, geometry::kArrangementMeaning,
     access<&ArrayLayout::arrangement>, kOfPrisms},
    {"arrangement", Word{only(geometry::kHexagonalArrangements, "single", "honeycomb")}, kRequired,
     geometry::kArrangementMeaning, access_by<get_tiled, set_tiled<Arrangement::honeycomb>>, kOfHexagons},
    {"arrangement", Word{geometry::kTriangularArrangements}, kRequired, geometry::kArrangementMeaning,
     access_by<get_tiled, set_tiled<Arrangement::triangular>>, kOfTriangles},
    with(geometry::kShiftedRowsKey, access<&ArrayLayout::shifted_rows>, kOfPrisms),
    with(geometry::kOverlapKey, access<&ArrayLayout::overlap_percent>, kOfPrisms),
    with(kSizeKeys.x_length_mm, access<&ArrayLayout::x_length_mm>, kOfArrays),
    with(kSizeKeys.y_length_mm, access<&ArrayLayout::y_length_mm>, kOfArrays),
    with(kSizeKeys.x_gap_mm, access<&ArrayLayout::x_gap_mm>, kOfPrisms),
    with(kSizeKeys.y_gap_mm, access<&ArrayLayout::y_gap_mm>, kOfPrisms),
    with(kSizeKeys.x_offset_mm, access<&ArrayLayout::x_offset_mm>),
    with(kSizeKeys.y_offset_mm, access<&ArrayLayout::y_offset_mm>),
    {"pattern", Texts{}, kNone,
     "Elements that are cut: one text for each row, beginning with the row of largest y. Each character is an element: "
     "`#` if it is cut, `-` if it is not cut. The last element of a shifted row of prisms extends beyond the border "
     "and is never cut. A row of cube corners contains the elements with equal y that are completely inside the "
     "margins.",
     access<&ArrayLayout::pattern>, kOfArrays}};
constexpr Row kChipRows[] = {
    {"position_um", Number{}, kRequired,
     "Position of the chip's centre along the edge, measured from the centre of the edge towards +X of the machine.",
     access<&EdgeChip::position_um>},
    {"width_um", Number{{.low = 0.01, .high = 100.0}}, kRequired, "Width of the chip along the edge.",
     access<&EdgeChip::width_um>},
    {"depth_um", Number{}, kRequired,
     "Depth of the chip, normal to the clearance face. It is above 0 and at most half of the width.",
     access<&EdgeChip::depth_um>}};
constexpr Row kToolRows[] = {
    {"width_mm", Number{{.low = kMinToolWidthMm, .high = kMaxToolWidthMm}}, kRequired,
     "Length of the chisel's cutting edge, at most the width of the element.", access<&Tool::width_mm>, kOfChisels},
    {"width_mm", Number{{.low = 0.01, .high = 10.0}}, kRequired,
     "Distance between the outer ends of the two cutting edges of the V-shaped tool. The cutting edges must reach from "
     "the apex to the face of the blank.",
     access<&Tool::width_mm>, kOfVTools},
    {"wedge_deg", kWedge, 50.0,
     "Wedge angle of the chisel, between its clearance face and its rake face. The sum of the wedge angle and the "
     "clearance angle is at most the apex angle of the element minus 12.5 degrees, which leaves room for chips.",
     access<&Tool::wedge_deg>, kOfChisels},
    {"wedge_deg", kWedge, kDmcWedgeDeg,
     "Wedge angle behind each cutting edge of the V-shaped tool. A wedge angle of 65 and a clearance angle of 3 give a "
     "rake angle of 22. The wedge angle must be small enough that no flank touches a neighbouring facet, and large "
     "enough that no fin (thin ridge) remains along the dihedral edges.",
     access<&Tool::wedge_deg>, kOfVTools},
    {"clearance_deg", Number{{.low = 2.0, .high = 15.0}}, 3.0,
     "Clearance angle of the mounted tool: angle between its clearance face and the facet that is cut.",
     access<&Tool::clearance_deg>},
    {"edge_radius_um", Number{{.low = 0.0, .high = 50.0}}, 0.0,
     "Radius of the chisel's cutting edge, or nose radius of the V-shaped tool. The nose radius is at most a tenth of "
     "the aperture.",
     access<&Tool::edge_radius_um>},
    {"nose_angle_deg", Number{{.low = 10.0, .high = 120.0}}, 50.0,
     "Angle between the two cutting edges of the V-shaped tool. It is less than 90 degrees, the angle between the two "
     "dihedral edges of a facet.",
     access<&Tool::nose_angle_deg>, kOfVTools},
    {"side_clearance_deg", Number{{.low = 0.0, .low_included = false, .high = 20.0}}, 2.0,
     "Clearance angle of the chisel's side walls, by which the diamond narrows towards its shank. It must be small "
     "enough that the diamond does not end in a point within the depth of the element.",
     access<&Tool::side_clearance_deg>, kOfChisels},
    {"edge_life_mm", Number{{.low = 0.0, .low_included = false, .high = kMaxEdgeLifeMm}}, kNone,
     "Tool life of a cutting edge: maximum length of the tip's path below the face of the blank, along plunges and "
     "ploughs. For a V-shaped tool, the path goes down and up the dihedral edges.",
     access_given<&Tool::edge_life_mm>},
    {"next_edge", Word{kNextEdgeWords}, "stop",
     "Action when the cutting edge has reached its tool life. `\"stop\"`: the program stops. At every stop, the edge "
     "is inspected, and it is replaced or touched off again. The length of cut is then counted from 0. `\"program\"`: "
     "a new program begins with a new edge. The edge is not changed at stops.",
     access_where<&Tool::next_edge, has_edge_life>}};
constexpr Table kToolTables[] = {
    {.name = "edge_chips",
     .meaning = "Edge chip: notch in the chisel's cutting edge where diamond has broken off. At most 100 chips are "
                "allowed, and they must not overlap. The cuts are planned for an undamaged edge. The as-machined part "
                "shows the chips as scratches.",
     .rows = kChipRows,
     .child = children<&Tool::edge_chips>,
     .presence = Presence::list,
     .when = kOfChisels}};

/// Access for a table whose values are members of the job itself.
constexpr Child kItself = {[](const void*) -> std::size_t { return 1; },
                           [](const void* job, std::size_t) { return job; }, [](void* job) { return job; }};
constexpr Child kBase = {
    [](const void* job) -> std::size_t { return static_cast<const Job*>(job)->substrate ? 1 : 0; },
    [](const void* job, std::size_t) -> const void* { return &*static_cast<const Job*>(job)->substrate; },
    [](void* job) -> void* { return &static_cast<Job*>(job)->substrate.emplace(); }};

const Table kJobTables[] = {
    {.name = "workpiece",
     .meaning = "Workpiece that is cut.",
     .rows = kWorkpieceRows,
     .child = child<&Job::workpiece>,
     .presence = Presence::implied},
    {.name = "element", .meaning = "Kind and dimensions of one element.", .rows = kElementRows, .child = kItself},
    {.name = "array",
     .meaning = "Arrangement of the elements. At most 2,000,000 elements are allowed.",
     .rows = kArrayRows,
     .child = child<&Job::array>},
    outline_table(),
    {.name = "zone",
     .meaning = "Zone: equal cube corners at given positions. If there are zones, they are cut instead of the array, "
                "and only the lengths of `[array]` are used.",
     .rows = kZoneRows,
     .child = children<&Job::zones>,
     .presence = Presence::list,
     .when = kOfVTools},
    {.name = "substrate",
     .meaning = "Surface on which the elements are placed, instead of the plane z = 0.",
     .rows = geometry::substrate_rows().first(geometry::substrate_rows().size() - 1),
     .child = kBase,
     .presence = Presence::optional,
     .former = "base"},
    {.name = "tool", .meaning = "Diamond tool.", .rows = kToolRows, .tables = kToolTables, .child = child<&Job::tool>},
    process_table("process", child<&Job::process>)};
// Checks that involve several keys.

void check_chips(const Job& job, const Refuse& refuse) {
  const auto& chips = job.tool.edge_chips;
  if (chips.size() > kMaxChips)
    refuse("tool.edge_chips", fmt::format("must have at most {} chips, got {}", kMaxChips, chips.size()));
  for (std::size_t i = 0; i < chips.size(); ++i) {
    const std::string path = path_of_entry("tool.edge_chips", i);
    const auto check = [&](std::string_view key, double value, const NumberRange& range) {
      if (!range.contains(value))
        refuse(path_in(path, key), fmt::format("must be {}, got {}", range.text(), shortest(value)));
    };
    const auto& [position_um, width_um, depth_um] = chips[i];
    const double reach_um = 0.5 * (1e3 * job.tool.width_mm - width_um);
    check("position_um", position_um, {.low = -reach_um, .high = reach_um});
    check("depth_um", depth_um, {.low = 0.0, .low_included = false, .high = 0.5 * width_um});
    for (std::size_t k = 0; k < i; ++k)
      if (std::abs(chips[k].position_um - position_um) < 0.5 * (chips[k].width_um + width_um) * (1.0 - 1e-9))
        refuse(path_in(path, "position_um"), "must not overlap another chip, got " + shortest(position_um));
  }
}

void check_chisel(const Job& job, const Refuse& refuse) {
  const double width_mm = blank_prism(job).width_mm;
  if (job.tool.width_mm > width_mm + kFitToleranceMm)
    refuse("tool.width_mm", fmt::format("must be <= {}, the element's width, got {}",
                                        fixed_apart(width_mm, job.tool.width_mm, 6), shortest(job.tool.width_mm)));
  const double apex_deg = prism_of(job).apex_angle_deg;
  const double taken_deg = job.tool.wedge_deg + job.tool.clearance_deg;
  if (taken_deg >= apex_deg)
    refuse("tool.wedge_deg", fmt::format("the sum of wedge_deg and clearance_deg must be < {}, the element's apex "
                                         "angle, so that the tool fits the root, got {}",
                                         shortest(apex_deg), fixed_apart(taken_deg, apex_deg, 3)));
  if (apex_deg - taken_deg < kChipRoomDeg)
    refuse("tool.wedge_deg", fmt::format("the sum of wedge_deg and clearance_deg must be <= {}, so that chips can "
                                         "leave between the rake face and the facet, got {}",
                                         fixed_apart(apex_deg - kChipRoomDeg, taken_deg, 3),
                                         fixed_apart(taken_deg, apex_deg - kChipRoomDeg, 3)));
  // If both facets are cut by plunging, the rake faces of both cuts must intersect above the root. Otherwise, a fin
  // remains.
  if (job.strategy != Strategy::unidirectional && 2.0 * taken_deg < apex_deg)
    refuse("tool.wedge_deg",
           fmt::format("the sum of wedge_deg and clearance_deg must be >= {}, half the apex angle, otherwise a fin of "
                       "{} degrees remains between the plunges of both facets, got {}",
                       shortest(0.5 * apex_deg), fixed_visible(apex_deg - 2.0 * taken_deg, 3),
                       fixed_apart(taken_deg, 0.5 * apex_deg, 3)));
  // The diamond becomes narrower towards its shank. Its width must still be positive at the height of the element's
  // rims (upper edges).
  const double half_apex_rad = 0.5 * Angle::from_deg(apex_deg).rad();
  const double facet_mm = 0.5 * blank_prism(job).base_mm / std::sin(half_apex_rad);
  const double side_limit_deg = Angle::from_rad(std::atan(0.5 * job.tool.width_mm / facet_mm)).deg();
  if (job.tool.side_clearance_deg >= side_limit_deg)
    refuse("tool.side_clearance_deg",
           fmt::format("must be < {}, otherwise the diamond ends in a point within the depth of the element, got {}",
                       fixed_apart(side_limit_deg, job.tool.side_clearance_deg, 3),
                       shortest(job.tool.side_clearance_deg)));
}

void check_zones(const Job& job, const Refuse& refuse) {
  if (job.zones.empty()) return;
  const ArrayLayout& array = job.array;
  if (array.arrangement == Arrangement::single)
    refuse("array.arrangement", "must not be \"single\" together with [[zone]], got \"single\"");
  for (const auto& [key, is_given] : {std::pair("array.x_offset_mm", array.x_offset_mm != 0.0),
                                      {"array.y_offset_mm", array.y_offset_mm != 0.0},
                                      {"array.pattern", !array.pattern.empty()},
                                      {"outline", job.outline.has_value()},
                                      {"substrate.kind", job.substrate.has_value()}})
    if (is_given) refuse(key, "not allowed together with [[zone]]");
  std::size_t elements = 0;
  for (const CutZone& zone : job.zones) elements += zone.apexes_mm.size();
  if (elements > kMaxZoneElements)
    refuse("zone", fmt::format("must have at most {} elements in total, got {}", kMaxZoneElements, elements));
  if (const std::optional<ZoneError> misfit = first_zone_error(job))
    refuse(path_in(path_of_entry("zone", misfit->zone), "apexes_mm"), misfit->text);
}

void check_row(const std::string& row, std::size_t k, std::int64_t columns, const Refuse& refuse) {
  if (static_cast<std::int64_t>(row.size()) != columns)
    refuse("array.pattern", fmt::format("must have {} characters in every row, because the array has this number of "
                                        "cells in a row, got {} in row {}",
                                        columns, row.size(), k));
  const std::size_t wrong = row.find_first_not_of("#-");
  if (wrong != std::string::npos)
    refuse("array.pattern", fmt::format("must contain only # and -, got {} in row {}",
                                        in_quotes(std::string_view(row).substr(wrong, 1)), k));
}

void check_pattern(const Job& job, const Refuse& refuse) {
  const std::vector<std::string>& pattern = job.array.pattern;
  if (pattern.empty()) return;
  const std::vector<std::int64_t> lengths = geometry::row_lengths(job.array, job.element);
  if (pattern.size() != lengths.size())
    refuse("array.pattern", fmt::format("must have {} rows, because the array has this number of rows, got {}",
                                        lengths.size(), pattern.size()));
  for (std::size_t k = 0; k < pattern.size(); ++k) check_row(pattern[k], k, lengths[lengths.size() - 1 - k], refuse);
  if (cut_elements(job).empty()) refuse("array.pattern", "must mark at least one element with #");
}

void check_room(const Job& job, const Refuse& refuse) {
  const ArrayLayout& array = job.array;
  if (array.arrangement == Arrangement::single || !job.zones.empty()) return;
  if (const double elements = geometry::element_estimate(array, job.element); elements > kMaxElements)
    refuse("array.x_length_mm",
           fmt::format("the array would have {:.6g} elements, but at most {:.0f} are allowed", elements, kMaxElements));
  if (cuts_prisms(job)) {
    const geometry::CellCounts counts = geometry::prism_block(array, prism_of(job)).counts;
    for (const auto& [count, key, length_mm] : {std::tuple(counts.columns, "array.x_length_mm", array.x_length_mm),
                                                {counts.rows, "array.y_length_mm", array.y_length_mm}})
      if (count < 1)
        refuse(key, "must be large enough for one element between the margins, got " + shortest(length_mm));
  } else if (geometry::row_lengths(array, job.element).empty()) {
    refuse("array.x_length_mm", fmt::format("x_length_mm and y_length_mm must be large enough for one whole element at "
                                            "the centre of the array, got {} and {}",
                                            shortest(array.x_length_mm), shortest(array.y_length_mm)));
  }
}

void check_square(const Job& job, const Refuse& refuse) {
  if (job.array.arrangement != Arrangement::checker) return;
  const RtpElement& prism = prism_of(job);
  if (std::abs(prism.base_mm - prism.width_mm) > 1e-9 * prism.base_mm)
    refuse("element.width_mm", fmt::format("must equal base_mm ({}) for array.arrangement = \"checker\", got {}",
                                           shortest(prism.base_mm), shortest(prism.width_mm)));
}

/// Checks that a job with a substrate makes a mould, and that its array has neither margins nor a pattern.
void check_array_on_substrate(const Job& job, const Refuse& refuse) {
  if (!job.substrate) return;
  const std::string_view key = geometry::substrate_shape_key(*job.substrate);
  const ArrayLayout& array = job.array;
  if (job.workpiece.kind == WorkpieceKind::direct)
    refuse(key, "workpiece.kind must be \"mould\" for elements on a substrate, got \"direct\"");
  if (array.arrangement == Arrangement::single) refuse(key, "not allowed for array.arrangement = \"single\"");
  if (array.x_offset_mm != 0.0 || array.y_offset_mm != 0.0)
    refuse(key, "not allowed together with array.x_offset_mm and y_offset_mm");
  if (!array.pattern.empty()) refuse(key, "not allowed together with array.pattern");
}

/// Checks that the elements fit on the substrate, and that the tool can move out of the cuts.
void check_substrate(const Job& job, const Refuse& refuse) {
  if (!job.substrate) return;
  try {
    geometry::check_substrate(part_on_substrate(job));
    const std::vector<CutElement> elements = cut_elements(job);
    if (elements.empty()) throw InputError("must be large enough for at least one whole element within the part");
    stock_mm(job, elements, job.process.clearance_mm);
  } catch (const InputError& error) {
    refuse(geometry::substrate_shape_key(*job.substrate), error.what());
  }
}

void check_machine(const Job& job, const Refuse& refuse) {
  // The operating system would truncate the name at a zero byte.
  if (job.machine.empty() || job.machine.find('\0') != std::string::npos)
    refuse("machine", "must be the name of a machine or of a file, got " + in_quotes(job.machine));
}

void check_workpiece(const Job& job, const Refuse& refuse) {
  if (!cuts_prisms(job) && job.workpiece.kind == WorkpieceKind::direct)
    refuse("workpiece.kind",
           "must be \"mould\" for cube corners, because the cavities differ from the elements, got \"direct\"");
}

void check_tool(const Job& job, const Refuse& refuse) {
  if (cuts_prisms(job))
    check_chisel(job, refuse);
  else
    for (std::size_t zone = 0; zone < zone_count(job); ++zone)
      check_v_tool(blank_element(job, zone), angle_errors_of(job, zone), job.tool, refuse);
}

void check_stops(const Job& job, const Refuse& refuse) {
  if (job.process.stop_before_finishing && !has_finishing_cuts(job))
    refuse("process.stop_before_finishing",
           fmt::format("must be false unless strategy is \"two-step\" or \"dmc\", because other strategies have no "
                       "finishing cuts, got strategy {}",
                       in_quotes(kStrategyWords[static_cast<std::size_t>(job.strategy)])));
}

constexpr Words kMachineKeys = {"machine"};
constexpr Words kWorkpieceKeys = {"workpiece.kind", "element.kind"};
constexpr Words kChipKeys = {"tool.edge_chips", "tool.width_mm"};
constexpr Words kArrayOnSubstrateKeys = {"substrate.kind",    "workpiece.kind",    "array.arrangement",
                                         "array.x_offset_mm", "array.y_offset_mm", "array.pattern"};
constexpr Words kArrayKeys = {"array.x_length_mm", "array.y_length_mm"};
constexpr Words kPatternKeys = {"array.pattern"};
constexpr Words kZoneKeys = {"zone", "array.arrangement", "array.x_offset_mm", "array.y_offset_mm", "array.pattern"};
constexpr Words kOutlineKeys = {"outline",           "outline.tolerance_mm", "array.x_length_mm", "array.y_length_mm",
                                "array.x_offset_mm", "array.y_offset_mm",    "array.pattern"};
constexpr Words kSquareKeys = {"element.base_mm", "element.width_mm"};
constexpr Words kToolKeys = {"tool.width_mm", "tool.wedge_deg", "tool.clearance_deg", "tool.side_clearance_deg"};
constexpr Words kSubstrateKeys = {"substrate.kind"};
constexpr Words kStopKeys = {"process.stop_before_finishing", "strategy"};
constexpr Rule kJobRules[] = {
    Check{kMachineKeys, "The name of the machine must not be empty.", check_by<check_machine>},
    Check{kWorkpieceKeys, "Cube corners can be cut only as moulds.", check_by<check_workpiece>},
    Check{kChipKeys, "At most 100 chips are allowed. They must be within the edge and must not overlap.",
          check_by<check_chips>},
    Check{kArrayOnSubstrateKeys,
          "A `[substrate]` is allowed only for moulds, and only for arrays without margins and pattern. It is not "
          "allowed for the arrangement `single`.",
          check_by<check_array_on_substrate>},
    Check{kZoneKeys,
          "With zones, margins, a pattern, an outline, a substrate and the arrangement `single` are not allowed. The "
          "elements of all "
          "zones, at most 2,000,000 in total, must be within the lengths of the array and must not overlap.",
          check_by<check_zones>},
    Check{kArrayKeys, "At least one element must fit between the margins, and at most 2,000,000 elements are allowed.",
          check_by<check_room>},
    Check{kSquareKeys, "In the arrangement `checker`, `base_mm` and `width_mm` must be equal.", check_by<check_square>},
    Check{kPatternKeys, "The pattern must have a mark for each cell, and at least one element must be cut.",
          check_by<check_pattern>},
    Check{
        kToolKeys,
        "The tool must fit the element. The cutting edge of a chisel must not be longer than the width of the element, "
        "and its wedge must leave room for chips. A V-shaped tool must reach the apex and every point of the facets.",
        check_by<check_tool>},
    Check{kStopKeys, "`stop_before_finishing` needs a strategy with finishing cuts: `two-step` or `dmc`.",
          check_by<check_stops>},
    Check{kSubstrateKeys,
          "At least one whole element must fit on the substrate, and the tool must be able to move out of the cuts.",
          check_by<check_substrate>},
    Check{kOutlineKeys,
          "The borders of an outline must not cross or touch themselves or each other, and holes must be inside the "
          "outer "
          "border. The lengths of the array are the size of the outline, and both offsets are equal. At least one "
          "whole element must be inside. A pattern is allowed only for prisms.",
          check_by<check_outline>}};

const Format kJobFormat = {"job",
                           "retrace.job/1",
                           "Fabrication job",
                           {"", "Fabrication job: the workpiece, the elements, the tool, the machine and the process.",
                            kJobRows, kJobTables, kJobRules}};

}  // namespace

const Format& job_format() {
  return kJobFormat;
}

void check_job(const Job& job, const InputLocation& where) {
  schema::check(kJobFormat.root, &job, [&](std::string_view key, const std::string& text) {
    throw InputError({where.file, where.line, std::string(key)}, text);
  });
}

Job parse_job(std::string_view text, const std::string& source_name) {
  Job job;
  job.document = std::make_shared<const Document>(read_object(kJobFormat, text, source_name, &job));
  job.warnings = schema::renamed_keys(*job.document);
  job.source = source_name;
  if (job.outline) {
    std::optional<geometry::OutlineFault> fault;  // remains empty, because check_outline() has found no fault
    job.array.outline = std::make_shared<const geometry::PlanRegion>(plan_of_outline(job, fault));
  }
  return job;
}

Job read_job(const fs::path& file, const FileTexts& texts) {
  Job job = parse_job(text_of_file(file.string(), texts), file.string());
  // A name without an extension is the name of a shipped machine. Other relative paths start at the folder of the job.
  const fs::path machine = job.machine;
  if (machine.has_extension() && machine.is_relative()) job.machine = (file.parent_path() / machine).string();
  return job;
}

std::string job_text(const Job& job) {
  return "# A fabrication job for retrace. Lengths in mm, angles in degrees; depths of cut in um.\n" +
         object_text(kJobFormat, &job);
}

}  // namespace retrace::fabrication
