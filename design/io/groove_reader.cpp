#include "design/io/groove_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/length_units.h"
#include "core/number_format.h"
#include "design/io/groove_rows.h"
#include "design/io/outline_reader.h"
#include "design/io/part_reader.h"
#include "geometry/elements/ruled_pattern.h"

namespace retrace::design {
namespace {

using geometry::GrooveSet, geometry::RuledPattern, schema::Document, schema::Value;
using HalfAngles = std::vector<std::array<double, 2>>;

constexpr std::string_view kGrooves = "grooves";
constexpr std::string_view kBaseAngleKey = "grooves.base_angles_deg";
constexpr std::string_view kBottomFlat = "grooves.bottom_flat_um";
constexpr std::string_view kBottomRadius = "grooves.bottom_radius_um";
constexpr double kDegPerArcmin = 1.0 / 60.0;

std::string path_of_set(std::size_t number) {
  return schema::path_in(kGrooves, kGrooveSets[number]);
}

/// Returns pairs of angles from one number or from rows of two numbers.
HalfAngles pairs_of(const Value& value) {
  if (const double* const both = std::get_if<double>(&value)) return {{*both, *both}};
  HalfAngles pairs;
  for (const std::vector<double>& row : std::get<std::vector<std::vector<double>>>(value))
    pairs.push_back({row[0], row[1]});
  return pairs;
}

std::array<double, 3> base_angles_of(const Document& document) {
  const std::string form = document.text("grooves.form");
  if (form == "equilateral") return {60.0, 60.0, 60.0};
  if (form == "canted") {
    const double sign = document.text("grooves.cant_direction") == "face_more_parallel" ? 1.0 : -1.0;
    return geometry::base_angles_of_cant(sign * document.number("grooves.cant_deg"));
  }
  constexpr double kRounding = 1e-9;
  const std::vector<double> given = document.numbers(kBaseAngleKey);
  const double sum = given[0] + given[1] + given[2];
  if (std::abs(sum - 180.0) > kRounding * 180.0)
    document.fail(kBaseAngleKey, fmt::format("the sum of the angles must be 180 degrees, got {}", shortest(sum)));
  return {given[0], given[1], given[2]};
}

GrooveSet custom_set(const Document& document, const std::string& table) {
  GrooveSet set;
  set.azimuth_deg = document.number(schema::path_in(table, "azimuth_deg"));
  set.spacing_mm = document.numbers(schema::path_in(table, "spacing_mm"));
  set.half_angles_deg = pairs_of(document.value(schema::path_in(table, "half_angle_deg")));
  return set;
}

/// Returns the number of custom sets: the tables a, b, ... without a gap.
std::size_t count_of_sets(const Document& document) {
  std::size_t count = 0;
  while (count < std::size(kGrooveSets) && document.has(path_of_set(count))) ++count;
  for (std::size_t k = count; k < std::size(kGrooveSets); ++k)
    if (document.has(path_of_set(k)))
      document.fail(path_of_set(k), fmt::format("only allowed together with [{}]", path_of_set(count)));
  if (count < 2)
    document.fail(kGrooves, fmt::format("must contain tables of two to four groove sets, [grooves.a], [grooves.b] and "
                                        "so on, or another form than \"custom\"; got {}",
                                        count));
  return count;
}

/// Adds the errors of a set to its half-angles and spacings.
void add_errors(const Document& document, const std::string& table, GrooveSet& set) {
  constexpr double kSteepest = 2.0;
  const HalfAngles errors = pairs_of(document.value(schema::path_in(table, "half_angle_error_arcmin")));
  const std::size_t grooves = std::lcm(set.half_angles_deg.size(), errors.size());
  HalfAngles angles;
  for (std::size_t m = 0; m < grooves; ++m) {
    std::array<double, 2> pair = set.half_angles_deg[m % set.half_angles_deg.size()];
    for (std::size_t side = 0; side < 2; ++side) {
      pair[side] += kDegPerArcmin * errors[m % errors.size()][side];
      const NumberRange range{.low = kSteepest, .high = 90.0 - kSteepest};
      if (!range.contains(pair[side]))
        document.fail(schema::path_in(table, "half_angle_error_arcmin"),
                      fmt::format("the half-angle with its error must be {} degrees, got {}", range.text(),
                                  shortest(pair[side])));
    }
    angles.push_back(pair);
  }
  set.half_angles_deg = std::move(angles);
  const std::string key = schema::path_in(table, "spacing_error_um");
  const double more_mm = kMmPerUm * document.number(key);
  for (double& spacing_mm : set.spacing_mm) {
    spacing_mm += more_mm;
    if (!(spacing_mm >= 1e-6))
      document.fail(key, fmt::format("the spacing with its error must be >= 1e-06 mm, got {}", shortest(spacing_mm)));
  }
}

/// Returns the groove sets of a document with their errors.
std::vector<GrooveSet> sets_of(const Document& document) {
  if (!document.has(kGrooves)) document.fail(kGrooves, "is missing: element.kind = \"ruled\" requires this table");
  const bool is_custom = document.text("grooves.form") == "custom";
  std::vector<GrooveSet> sets;
  if (is_custom) {
    const std::size_t count = count_of_sets(document);
    for (std::size_t k = 0; k < count; ++k) sets.push_back(custom_set(document, path_of_set(k)));
  } else {
    sets = geometry::perpendicular_groove_sets(base_angles_of(document), document.number("grooves.spacing_mm"));
    if (document.has(path_of_set(sets.size())))
      document.fail(path_of_set(sets.size()), "only allowed for grooves.form = \"custom\"");
  }
  double deepest_mm = -INFINITY;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    GrooveSet& set = sets[k];
    set.bottom_flat_mm = kMmPerUm * document.number(kBottomFlat);
    set.bottom_radius_mm = kMmPerUm * document.number(kBottomRadius);
    set.bottom_chords = static_cast<int>(document.number("surface.edge_chords"));
    if (document.has(path_of_set(k))) {
      set.offset_mm += document.number(schema::path_in(path_of_set(k), "offset_mm"));
      set.rise_mm = kMmPerUm * document.number(schema::path_in(path_of_set(k), "depth_error_um"));
      add_errors(document, path_of_set(k), set);
    }
    deepest_mm = std::max(deepest_mm, set.rise_mm);
  }
  for (GrooveSet& set : sets) set.rise_mm -= deepest_mm;
  return sets;
}

/// Returns the key that a message about the pattern names.
std::string blamed_groove_key(const Document& document, const InputError& error) {
  const std::string& key = error.where().key;
  if (key.empty()) return std::string(kGrooves);
  return key == kBottomFlat && document.number(kBottomRadius) > 0.0 ? std::string(kBottomRadius) : key;
}

}  // namespace

geometry::RuledCells read_grooves(const Document& document) {
  // Many rules read the part. The last pattern is kept, because large patterns take long to compute.
  thread_local std::shared_ptr<const RuledPattern> last;
  std::vector<GrooveSet> sets = sets_of(document);
  const std::optional<double> depth_mm = document.number_if("grooves.depth_mm");
  if (!last || last->sets != sets || last->depth_mm != depth_mm) {
    try {
      last = std::make_shared<const RuledPattern>(geometry::ruled_pattern(std::move(sets), depth_mm));
    } catch (const InputError& error) {
      document.fail(blamed_groove_key(document, error), error.text());
    }
  }
  return {last};
}

void set_grooves(Document& document, const geometry::RuledCells& ruled) {
  const RuledPattern& pattern = *ruled.pattern;
  document.set(std::string(kGrooves), {});
  const auto set = [&](const std::string& table, std::string_view key, Value value) {
    document.set(schema::path_in(table, key), std::move(value));
  };
  const std::string root(kGrooves);
  if (pattern.depth_mm) set(root, "depth_mm", *pattern.depth_mm);
  set(root, "bottom_flat_um", kUmPerMm * pattern.sets.front().bottom_flat_mm);
  set(root, "bottom_radius_um", kUmPerMm * pattern.sets.front().bottom_radius_mm);
  for (std::size_t k = 0; k < pattern.sets.size(); ++k) {
    const GrooveSet& grooves = pattern.sets[k];
    const std::string table = path_of_set(k);
    document.set(table, {});
    set(table, "azimuth_deg", grooves.azimuth_deg);
    if (grooves.spacing_mm.size() == 1)
      set(table, "spacing_mm", grooves.spacing_mm.front());
    else
      set(table, "spacing_mm", grooves.spacing_mm);
    const std::array<double, 2>& first = grooves.half_angles_deg.front();
    if (grooves.half_angles_deg.size() == 1 && first[0] == first[1]) {
      set(table, "half_angle_deg", first[0]);
    } else {
      std::vector<std::vector<double>> rows;
      for (const std::array<double, 2>& pair : grooves.half_angles_deg) rows.push_back({pair[0], pair[1]});
      set(table, "half_angle_deg", std::move(rows));
    }
    set(table, "offset_mm", grooves.offset_mm);
    set(table, "depth_error_um", kUmPerMm * grooves.rise_mm);
  }
}

void check_grooves(const Document& document) {
  const bool is_ruled = has_elements(document) && document.text("element.kind") == "ruled";
  if (!is_ruled) return;
  if (document.number(kBottomFlat) > 0.0 && document.number(kBottomRadius) > 0.0)
    document.fail(kBottomRadius, fmt::format("must be 0 if bottom_flat_um is given, got {}",
                                             shortest(document.number(kBottomRadius))));
  const geometry::RuledCells ruled = read_grooves(document);
  if (document.text("array.extent") != "infinite") return;
  try {
    geometry::ArrayLayout array;
    array.extent = geometry::Extent::infinite;
    geometry::ruled_lattice(*ruled.pattern, array);
  } catch (const InputError& error) {
    document.fail("array.extent", error.text());
  }
}

void check_ruled_part(const Document& document, const geometry::PartSpec& part) {
  const auto* const ruled = std::get_if<geometry::RuledCells>(&part.element);
  if (ruled == nullptr) return;
  constexpr std::string_view kUseGrooves =
      "must be 0 for element.kind = \"ruled\": give half_angle_error_arcmin in the tables of [grooves]";
  if (part.angle_errors.dihedral_error_arcmin != std::array<double, 3>{})
    document.fail(kDihedralErrorArcmin, kUseGrooves);
  if (part.angle_errors.facet_tilt_arcmin != std::array<double, 3>{})
    document.fail("surface.facet_tilt_arcmin", kUseGrooves);
  if (part.random_tilts.sigma_arcmin > 0.0)
    document.fail("surface.angle_error_sigma_arcmin",
                  "must be 0 for element.kind = \"ruled\", because neighbouring cells share their grooves");
  for (const std::string_view key : {"surface.rim_radius_um", "surface.rim_chamfer_um"})
    if (document.number(key) > 0.0)
      document.fail(key,
                    "must be 0 for element.kind = \"ruled\": give bottom_radius_um or bottom_flat_um in [grooves]");
  const auto is_cube = [](const geometry::Cell& cell) { return cell.facets.size() == 3; };
  if (part.edges.rounds_roots() && !std::all_of(ruled->pattern->cells.begin(), ruled->pattern->cells.end(), is_cube))
    document.fail(part.edges.root_radius_mm > 0.0 ? "surface.root_radius_um" : "surface.root_chamfer_um",
                  "must be 0 for element.kind = \"ruled\", unless every cell has three faces and nothing else");
  if (part.array.partial_elements == geometry::PartialElements::omit)
    document.fail("array.partial_elements", "must be \"cut\" for element.kind = \"ruled\", got \"omit\"");
  for (const std::string_view key : {"part.facets", "substrate", "form"})
    if (document.has(key)) document.fail(key, "not allowed for element.kind = \"ruled\"");
}

}  // namespace retrace::design
