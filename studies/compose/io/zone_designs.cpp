#include "studies/compose/io/zone_designs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>

#include "core/message_text.h"
#include "core/number_format.h"
#include "design/io/design_document.h"
#include "design/io/design_reader.h"
#include "design/io/zone_reader.h"
#include "geometry/outline/plan_region.h"
#include "studies/quantity/io/study_reader.h"

namespace retrace::studies {
namespace {

using geometry::Rectangle, geometry::Vec2;

constexpr std::string_view kTurn = "analysis.rotation_deg";
/// Minimum height of a row of a zone, in elements. With this height, most elements in the row are whole.
constexpr double kElementsOfRow = 8.0;
/// Maximum number of rows of all zones together. It limits the number of regions in a design file.
constexpr double kMaxRows = 120.0;

/// Returns the coordinate that divides the part's area within a rectangle. A given fraction of this area has smaller
/// coordinates.
/// \param outline outline of the part, or null for a rectangular part
/// \param axis 0: coordinate x; 1: coordinate y
double coordinate_in(const geometry::PlanRegion* outline, const Rectangle& room, Eigen::Index axis, double fraction) {
  if (outline == nullptr) return room.lower[axis] + fraction * room.size()[axis];
  return geometry::coordinate_of_area_fraction(*outline, room, axis, fraction);
}

/// Divides a rectangle into blocks for the zones from `first` to `end`. The zones are split into two groups of about
/// the same area. The rectangle is split across its longer side, and each half is divided in the same manner.
/// \param shares fractions of the area of all zones
/// \param outline outline of the part, or null for a rectangular part
void add_blocks(const std::vector<double>& shares, std::size_t first, std::size_t end, const Rectangle& room,
                const geometry::PlanRegion* outline, std::vector<std::vector<Rectangle>>& regions) {
  if (end - first == 1) {
    regions[first] = {room};
    return;
  }
  double all = 0.0;
  for (std::size_t k = first; k < end; ++k) all += shares[k];
  std::size_t middle = first + 1;
  double before = shares[first];
  while (middle + 1 < end && before + 0.5 * shares[middle] < 0.5 * all) before += shares[middle++];
  const Eigen::Index axis = room.size().x() >= room.size().y() ? 0 : 1;
  Rectangle lower = room;
  Rectangle upper = room;
  lower.upper[axis] = upper.lower[axis] = coordinate_in(outline, room, axis, before / all);
  add_blocks(shares, first, middle, lower, outline, regions);
  add_blocks(shares, middle, end, upper, outline, regions);
}

std::vector<std::vector<Rectangle>> blocks_of(const std::vector<double>& shares, const Vec2& size_mm,
                                              const geometry::PlanRegion* outline) {
  std::vector<std::vector<Rectangle>> regions(shares.size());
  add_blocks(shares, 0, shares.size(), {Vec2::Zero(), size_mm}, outline, regions);
  return regions;
}

/// Divides the part into rows and assigns them to the zones in turn.
/// \param element_mm maximum extent of an element along y
/// \param outline outline of the part, or null for a rectangular part
std::vector<std::vector<Rectangle>> rows_of(const std::vector<double>& shares, const Vec2& size_mm, double element_mm,
                                            const geometry::PlanRegion* outline) {
  const double least = *std::ranges::min_element(shares);
  const double most = std::floor(kMaxRows / static_cast<double>(shares.size()));
  const double bands = std::clamp(std::floor(least * size_mm.y() / (kElementsOfRow * element_mm)), 1.0, most);
  std::vector<std::vector<Rectangle>> regions(shares.size());
  const auto y_of = [&](double fraction) {
    if (fraction >= 1.0) return size_mm.y();
    return fraction > 0.0 ? coordinate_in(outline, {Vec2::Zero(), size_mm}, 1, fraction) : 0.0;
  };
  double from = 0.0;
  for (double band = 0.0; band < bands; band += 1.0) {
    double share = 0.0;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      share += shares[k];
      const double to = k + 1 == shares.size() ? (band + 1.0) / bands : (band + share) / bands;
      regions[k].push_back({{0.0, y_of(from)}, {size_mm.x(), y_of(to)}});
      from = to;
    }
  }
  return regions;
}

std::string regions_text(const std::vector<Rectangle>& regions) {
  std::string text;
  for (const Rectangle& r : regions)
    text += fmt::format("  [{}, {}, {}, {}],\n", shortest(r.lower.x()), shortest(r.lower.y()), shortest(r.upper.x()),
                        shortest(r.upper.y()));
  return fmt::format("rectangles_mm = [\n{}]\n", text);
}

/// Returns the `set` key of a zone, with the parameter values that may differ between zones.
std::string changes_text(const Study& study, const PointValues& values) {
  std::string text;
  for (std::size_t k = 0; k < study.parameters.size(); ++k)
    for (const std::string& key : study.parameters[k].keys)
      if (design::may_vary_between_zones(key))
        text += fmt::format("{}'{}={}'", text.empty() ? "" : ", ", key, values[k].toml);
  return text.empty() ? text : fmt::format("set = [{}]\n", text);
}

/// Returns the field of a ZonedDesignRequest that determines the given key of the design of the whole part.
Field field_of(std::string_view key) {
  if (key == "array.x_length_mm") return {"x_length_mm"};
  return {key == "array.y_length_mm" ? "y_length_mm" : "design"};
}

/// Returns the design of the whole part, with elements that have the given parameter values everywhere. The part is
/// finite and has the size of the request.
design::Design whole_design(const Study& study, const PointValues& values, const ZonedDesignRequest& request) {
  const design::Design design = make_candidate(study, values).design();
  if (!request.size_mm) return design;
  try {
    return design::with(design,
                        std::vector<std::string>{"array.extent=\"finite\"",
                                                 fmt::format("array.x_length_mm={}", shortest(request.size_mm->x())),
                                                 fmt::format("array.y_length_mm={}", shortest(request.size_mm->y()))});
  } catch (const InputError& error) {
    const Field field = field_of(error.where().key);
    throw InputError(field, field.name == "design" ? error.where().key + ": " + error.text() : error.text());
  }
}

double height_of(const Study& study, const Zone& zone) {
  const geometry::PartSpec part = make_candidate(study, zone.cell.values).design().part();
  return geometry::bounding_box(geometry::aperture_outline(part.element)).size().y();
}

}  // namespace

std::size_t max_zone_designs(const ComposeRequest& request) {
  return std::min<std::size_t>(100, request.max_zones.value_or(100));
}

std::string zone_design_text(const Study& study, const std::vector<Zone>& zones, std::size_t zone) {
  const Candidate candidate = make_candidate(study, zones[zone].cell.values);
  std::string comment = fmt::format("# Zone {} of {} of {}: {} of the area", zone + 1, zones.size(),
                                    printable(std::filesystem::path(study.source).filename().string()),
                                    shortest(zones[zone].area_fraction));
  if (const double turn_deg = candidate.analysis().rotation_deg; turn_deg != 0.0)
    comment += fmt::format(", rotated by {} degrees (use this value as the rotation of retrace photometry)",
                           shortest(turn_deg));
  return design::design_text(candidate.design(), comment + "\n");
}

ZoneLayout read_zone_layout(const std::string& word) {
  const auto* const found = std::ranges::find(kZoneLayouts, word);
  if (found == std::end(kZoneLayouts))
    throw InputError(Field{"layout"}, fmt::format("must be {}, got {}", alternatives(kZoneLayouts), in_quotes(word)));
  return static_cast<ZoneLayout>(found - std::begin(kZoneLayouts));
}

void check_zoned_design(const Study& study, const ZonedDesignRequest& request) {
  for (const Parameter& parameter : study.parameters)
    for (const std::string& key : parameter.keys)
      if (key != kTurn && !design::may_vary_between_zones(key))
        throw InputError(parameter.location,
                         fmt::format("{}: all zones of a part must have the same {}", reference({"design"}), key));
  const design::Design design = whole_design(study, example_values(study), request);
  if (design.is_infinite())
    throw InputError(Field{"x_length_mm"},
                     "is required, because a part with zones is finite, but the design of the study is infinite");
  if (design.part().array.arrangement == geometry::Arrangement::single)
    throw InputError(Field{"design"},
                     "the design of the study must be an array, because a single element cannot be divided into zones");
}

std::string zoned_design_text(const Study& study, const std::vector<Zone>& zones, const ZonedDesignRequest& request) {
  const design::Design whole = whole_design(study, zones.front().cell.values, request);
  const Vec2 size_mm(whole.part().array.x_length_mm, whole.part().array.y_length_mm);
  const geometry::PlanRegion* outline = whole.part().array.outline.get();
  if (outline != nullptr && outline->is_box()) outline = nullptr;
  std::vector<double> shares;
  double element_mm = 0.0;
  for (const Zone& zone : zones) {
    shares.push_back(zone.area_fraction);
    element_mm = std::max(element_mm, height_of(study, zone));
  }
  std::vector<std::vector<Rectangle>> regions;
  if (request.layout == ZoneLayout::blocks) regions = blocks_of(shares, size_mm, outline);
  if (request.layout == ZoneLayout::rows) regions = rows_of(shares, size_mm, element_mm, outline);
  std::string text =
      design::design_text(whole, fmt::format("# The {} zones of {} in {}.\n", zones.size(),
                                             printable(std::filesystem::path(study.source).filename().string()),
                                             kZoneLayouts[static_cast<std::size_t>(request.layout)]));
  for (std::size_t k = 0; k < zones.size(); ++k) {
    const PointValues& values = zones[k].cell.values;
    text += "\n[[zone]]\n";
    text += regions.empty() ? fmt::format("area_fraction = {}\n", shortest(shares[k])) : regions_text(regions[k]);
    const double turn_deg = make_candidate(study, values).analysis().rotation_deg;
    if (turn_deg != 0.0) text += fmt::format("rotation_deg = {}\n", shortest(turn_deg));
    text += changes_text(study, values);
  }
  design::parse_design(text, "the design of zones");  // throws InputError if a zone is too small for its elements
  return text;
}

}  // namespace retrace::studies
