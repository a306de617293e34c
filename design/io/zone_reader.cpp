#include "design/io/zone_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/message_text.h"
#include "core/number_format.h"
#include "core/schema/reader.h"
#include "design/io/design_format.h"
#include "design/io/outline_reader.h"
#include "design/io/part_reader.h"
#include "design/zone_elements.h"

namespace retrace::design {
namespace {

using geometry::Polygon, geometry::Vec2, schema::Document;

constexpr std::string_view kZone = "zone";
constexpr std::array<std::string_view, 3> kRegions = {"area_fraction", "rectangles_mm", "polygon_mm"};
/// Maximum number of elements of a part with zones. The limit keeps memory small, because the back of such a part is
/// stored without using the periodicity of its arrays.
constexpr double kMaxZoneElements = 1e5;
constexpr std::size_t kMaxRegions = 1000;
constexpr std::size_t kMaxSetBytes = 4096;
/// Maximum deviation of the sum of the zones' areas from 1.
constexpr double kFractionRounding = 1e-6;
/// Relative tolerance of lengths.
constexpr double kRounding = 1e-9;

// Keys that may differ between zones. A table name with a dot stands for all keys of the table.
constexpr std::array<std::string_view, 17> kOfZones = {"element.",
                                                       "array.arrangement",
                                                       "array.partial_elements",
                                                       "array.x_gap_mm",
                                                       "array.y_gap_mm",
                                                       "array.overlap_percent",
                                                       "array.shifted_rows",
                                                       "surface.dihedral_error_arcmin",
                                                       "surface.dihedral_error_arcsec",
                                                       "surface.facet_tilt_arcmin",
                                                       "surface.angle_error_sigma_arcmin",
                                                       "surface.angle_error_seed",
                                                       "surface.root_radius_um",
                                                       "surface.root_chamfer_um",
                                                       "surface.rim_radius_um",
                                                       "surface.rim_chamfer_um",
                                                       "surface.edge_chords"};

std::string entry_of(std::size_t zone) {
  return schema::path_of_entry(kZone, zone);
}

/// Returns a text without the given characters at its beginning and end.
std::string stripped(std::string text, const char* of) {
  text.erase(text.find_last_not_of(of) + 1);
  return text.erase(0, text.find_first_not_of(of));
}

/// Returns true if a change sets a kind of element that differs from that of the design.
bool changes_kind(const ZoneChange& change, const Document& document) {
  return change.key == "element.kind" &&
         stripped(change.text.substr(change.text.find('=') + 1), " \t\"'") != document.text("element.kind");
}

/// Returns the changes of a zone.
/// \throw InputError if a change does not have the form KEY=VALUE, or if its key must have the same value in all zones
std::vector<ZoneChange> changes_of(const Document& document, std::size_t zone) {
  const std::string key = entry_of(zone) + ".set";
  std::vector<ZoneChange> changes;
  if (!document.has(key)) return changes;
  for (const std::string& change : document.texts(key)) {
    const std::size_t equals = change.find('=');
    const std::string name = equals == std::string::npos ? std::string() : stripped(change.substr(0, equals), " \t");
    if (name.empty())
      document.fail(key, fmt::format("must be a list of strings of the form KEY=VALUE, got {}", in_quotes(change)));
    if (!may_vary_between_zones(name))
      document.fail(key, fmt::format("must set only keys of [element], keys of [array] except extent, lengths, margins "
                                     "and mask, and keys of [surface] for angles and edges, got {}",
                                     in_quotes(change)));
    changes.push_back({name, change});
  }
  return changes;
}

/// Returns a design file that contains only the size and the thickness of the part. A zone with another kind of element
/// starts from this file, so that all other keys have their defaults.
std::string text_without_elements(const Document& document, const Vec2& size_mm) {
  return fmt::format("[array]\nx_length_mm = {}\ny_length_mm = {}\n[body]\nthickness_mm = {}\n", shortest(size_mm.x()),
                     shortest(size_mm.y()), shortest(document.number("body.thickness_mm")));
}

/// Returns the document of a zone: the design of the whole part with the elements of this zone everywhere.
/// \param size_mm size of the part
Document document_of_zone(const Document& document, std::size_t zone, const std::vector<ZoneChange>& changes,
                          const Vec2& size_mm) {
  const std::string key = entry_of(zone) + ".set";
  const bool is_of_another_kind =
      std::ranges::any_of(changes, [&](const ZoneChange& change) { return changes_kind(change, document); });
  std::vector<std::string> overrides;
  for (const ZoneChange& change : changes) overrides.push_back(change.text);
  try {
    Document changed = is_of_another_kind
                           ? schema::read_document(design_format(), text_without_elements(document, size_mm),
                                                   document.source(), kMaxSetBytes, overrides)
                           : schema::with(design_format(), document, overrides);
    for (std::size_t k = changed.count(kZone); k-- > 0;) changed.drop(entry_of(k));
    if (changed.has(kZone)) changed.drop(kZone);
    schema::check(changed, design_format().root, "", &changed);
    return changed;
  } catch (const InputError& error) {
    document.fail(document.has(key) ? key : entry_of(zone),
                  error.where().key.empty() ? error.text() : error.where().key + ": " + error.text());
  }
}

/// Returns the x coordinate that has a given fraction of the part's area to its left.
double end_of_stripe(const geometry::ZonedSpec& spec, double fraction) {
  const geometry::PlanRegion* const outline = spec.cutting_outline();
  if (outline == nullptr) return fraction * spec.size_mm.x();
  return geometry::coordinate_of_area_fraction(*outline, outline->box_mm, 0, fraction);
}

/// Divides the part along x into stripes, one for each zone, in the order of the zones. Each stripe contains the zone's
/// fraction of the area inside the outline.
void lay_out_stripes(const Document& document, geometry::ZonedSpec& spec) {
  double sum = 0.0;
  for (std::size_t k = 0; k < spec.zones.size(); ++k) {
    const std::string key = entry_of(k) + ".area_fraction";
    if (!document.has(key))
      document.fail(entry_of(k),
                    "must contain the key area_fraction, because other zones contain it: either all zones or no zones "
                    "may have this key");
    sum += document.number(key);
  }
  if (std::abs(sum - 1.0) > kFractionRounding)
    document.fail(
        entry_of(spec.zones.size() - 1) + ".area_fraction",
        fmt::format("the values of area_fraction of all zones must add up to 1, but their sum is {}", shortest(sum)));
  double from_mm = 0.0;
  double share = 0.0;
  for (std::size_t k = 0; k < spec.zones.size(); ++k) {
    share += document.number(entry_of(k) + ".area_fraction");
    const double to_mm = k + 1 == spec.zones.size() ? spec.size_mm.x() : end_of_stripe(spec, share / sum);
    spec.zones[k].regions = {geometry::to_polygon({{from_mm, 0.0}, {to_mm, spec.size_mm.y()}})};
    from_mm = to_mm;
  }
}

std::vector<Polygon> rectangles_of(const Document& document, const std::string& key) {
  std::vector<Polygon> regions;
  for (const std::vector<double>& r : document.rows(key)) {
    if (!(r[0] < r[2] && r[1] < r[3]))
      document.fail(key,
                    fmt::format("must be [x_from, y_from, x_to, y_to] with x_from < x_to and y_from < y_to, got [{}]",
                                fmt::join(r, ", ")));
    regions.push_back(geometry::to_polygon({{r[0], r[1]}, {r[2], r[3]}}));
  }
  return regions;
}

Polygon polygon_of(const Document& document, const std::string& key) {
  Polygon polygon;
  for (const std::vector<double>& p : document.rows(key)) polygon.emplace_back(p[0], p[1]);
  const double near_mm = kRounding * geometry::bounding_box(polygon).size().norm();
  for (std::size_t k = 0; k < polygon.size(); ++k)
    if ((polygon[k] - polygon[(k + 1) % polygon.size()]).norm() <= near_mm)
      document.fail(key, fmt::format("must contain each corner only once, got [{}, {}] twice", shortest(polygon[k].x()),
                                     shortest(polygon[k].y())));
  if (geometry::area(polygon) < 0.0) std::reverse(polygon.begin(), polygon.end());
  if (!(geometry::area(polygon) > 0.0) || !geometry::is_convex(polygon, near_mm))
    document.fail(key, "must be the corners of a convex polygon, in the order of the corners along the boundary");
  return polygon;
}

void read_regions(const Document& document, geometry::ZonedSpec& spec) {
  const auto has_share = [&](std::size_t k) { return document.has(entry_of(k) + ".area_fraction"); };
  std::size_t regions = 0;
  for (std::size_t k = 0; k < spec.zones.size(); ++k) {
    if (has_share(k)) return lay_out_stripes(document, spec);
    const std::string rectangles = entry_of(k) + ".rectangles_mm";
    spec.zones[k].regions = document.has(rectangles)
                                ? rectangles_of(document, rectangles)
                                : std::vector<Polygon>{polygon_of(document, entry_of(k) + ".polygon_mm")};
    regions += spec.zones[k].regions.size();
  }
  if (regions > kMaxRegions)
    document.fail(kZone, fmt::format("must have at most {} regions in total, got {}", kMaxRegions, regions));
}

std::vector<double> lines_of(const Document& document, const std::string& key) {
  return document.has(key) ? document.numbers(key) : std::vector<double>();
}

ElementsOfZone elements_of(const Document& document, const std::string& zone) {
  ElementsOfZone chosen;
  chosen.rows = lines_of(document, zone + ".rows");
  chosen.columns = lines_of(document, zone + ".columns");
  if (document.has(zone + ".every")) chosen.every = document.number(zone + ".every");
  if (const std::string mask = zone + ".mask"; document.has(mask))
    chosen.mask = {document.text(mask), document.file(mask), document.number(zone + ".mask_threshold")};
  chosen.is_remainder = document.has(zone + ".rest");
  if (chosen.is_remainder && !document.flag(zone + ".rest"))
    document.fail(zone + ".rest", "must be true or left out, got false");
  return chosen;
}

/// Reads zones that are elements of one array.
/// \return false if the zones are regions
bool read_elements(const Document& document, ZonedPart& part) {
  std::optional<std::size_t> rest;
  std::size_t by_cell = 0;
  for (std::size_t k = 0; k < part.spec.zones.size(); ++k) {
    const std::string zone = entry_of(k);
    const bool is_region = std::ranges::any_of(
        kRegions, [&](std::string_view key) { return document.has(fmt::format("{}.{}", zone, key)); });
    if (!is_region) ++by_cell;
    if (by_cell != 0 && by_cell != k + 1)
      document.fail(zone,
                    "must be of the same type as the previous zones: either all zones have regions (area_fraction, "
                    "rectangles_mm, polygon_mm), or all select elements (rows, columns, mask, rest)");
    part.elements.push_back(elements_of(document, zone));
    if (part.elements.back().is_remainder && rest)
      document.fail(zone + ".rest", fmt::format("only allowed for one zone, but zone {} also has it", *rest + 1));
    if (part.elements.back().is_remainder) rest = k;
  }
  if (by_cell == 0) part.elements.clear();
  return by_cell != 0;
}

void check_lines(const Document& document, const std::string& key, const std::vector<double>& numbers,
                 const std::optional<double>& every, std::size_t count) {
  const double most = every ? *every : static_cast<double>(count);
  for (const double number : numbers)
    if (number > most)
      document.fail(key,
                    fmt::format("must be at most {}, {}, got {}", shortest(most),
                                every ? "the value of the key every" : "the number of rows or columns of the array",
                                shortest(number)));
}

/// Assigns the cells of the array to the zones. part_of_design() assigns the cells of masks.
void read_cells(const Document& document, ZonedPart& part) {
  const geometry::ArrayPlan plan =
      geometry::plan_of_array(geometry::array_of_cells(part.spec, part.spec.zones.front()));
  const std::size_t rows = row_or_column_count(plan, 1);
  const std::size_t columns = row_or_column_count(plan, 0);
  for (std::size_t k = 0; k < part.elements.size(); ++k) {
    const ElementsOfZone& chosen = part.elements[k];
    check_lines(document, entry_of(k) + ".rows", chosen.rows, chosen.every, rows);
    check_lines(document, entry_of(k) + ".columns", chosen.columns, chosen.every, columns);
  }
  if (!part.has_masks()) choose_cells(part, {});
}

/// Checks that the elements of a zone fit into its regions, or into the whole part.
void check_room(const Document& document, std::size_t number, const geometry::PartZone& zone, const Vec2& part_mm) {
  const Vec2 element = geometry::bounding_box(geometry::aperture_outline(zone.elements.element)).size();
  const std::vector<Polygon> all = {geometry::to_polygon({Vec2::Zero(), part_mm})};
  for (const Polygon& region : zone.regions.empty() ? all : zone.regions) {
    const Vec2 room = geometry::bounding_box(region).size();
    // The bounding box of a region limits only elements that are not rotated.
    const bool is_narrow = geometry::width(region) < element.minCoeff() * (1.0 - kRounding);
    const bool is_turned = zone.rotation_deg != 0.0;
    if (is_narrow || (!is_turned && (room.array() < element.array() * (1.0 - kRounding)).any()))
      document.fail(entry_of(number),
                    fmt::format("the region of this zone, {} x {} mm, is too small for one element of {} x {} mm",
                                shortest(room.x()), shortest(room.y()), shortest(element.x()), shortest(element.y())));
  }
}

/// Returns the specification of a zone's elements without the outline and the margin, which belong to the whole part.
geometry::PartSpec without_outline(geometry::PartSpec elements) {
  elements.array.outline.reset();
  elements.array.x_offset_mm = elements.array.y_offset_mm = 0.0;
  return elements;
}

/// Checks that the keys of the whole part are allowed together with zones.
void check_whole(const Document& document, const geometry::PartSpec& part) {
  const auto refuse = [&](std::string_view key, std::string_view text) {
    document.fail(key, fmt::format("{} together with [[zone]]", text));
  };
  if (part.array.extent == geometry::Extent::infinite) refuse("array.extent", "\"infinite\" is not allowed");
  if (part.array.outline) return;
  if (part.array.x_offset_mm > 0.0) refuse("array.x_offset_mm", "must be 0");
  if (part.array.y_offset_mm > 0.0) refuse("array.y_offset_mm", "must be 0");
}

}  // namespace

bool has_zones(const Document& document) {
  return document.count(kZone) > 0;
}

bool may_vary_between_zones(std::string_view key) {
  return std::ranges::any_of(kOfZones,
                             [&](std::string_view of) { return of.back() == '.' ? key.starts_with(of) : key == of; });
}

ZonedPart read_zones(const Document& document) {
  ZonedPart part;
  part.base = read_part(document);
  check_whole(document, part.base);
  part.spec.size_mm = {part.base.array.x_length_mm, part.base.array.y_length_mm};
  part.spec.outline = part.base.array.outline;
  part.spec.thickness_mm = part.base.thickness_mm;
  part.outline = outline_keys(document);
  part.spec.zones.resize(document.count(kZone));
  part.spec.is_by_cell = read_elements(document, part);
  if (!part.spec.is_by_cell) read_regions(document, part.spec);
  for (std::size_t k = 0; k < part.spec.zones.size(); ++k) {
    part.changes.push_back(changes_of(document, k));
    const Document changed = document_of_zone(document, k, part.changes[k], part.spec.size_mm);
    const std::string arrangement = changed.text("array.arrangement");
    if (arrangement == "single" || arrangement == "pins" || !has_elements(changed))
      document.fail(entry_of(k),
                    "a part with zones must have an array of prisms or cube corners, and array.arrangement must be "
                    "neither \"single\" nor \"pins\"");
    part.spec.zones[k].elements = without_outline(read_part(changed));
    part.spec.zones[k].rotation_deg = document.number(entry_of(k) + ".rotation_deg");
    check_room(document, k, part.spec.zones[k], part.spec.size_mm);
  }
  if (const double elements = geometry::element_estimate(part.spec); elements > kMaxZoneElements)
    document.fail(
        kZone, fmt::format("a part with zones may have at most {:.0f} elements, but this part would have about {:.0f}",
                           kMaxZoneElements, elements));
  if (part.spec.is_by_cell) read_cells(document, part);
  if (part.has_masks()) return part;
  check_zones(part, [&](const std::string& key) { return document.where(key); });
  return part;
}

void check_zones(const Document& document) {
  if (has_zones(document)) read_zones(document);
}

}  // namespace retrace::design
