#include "design/zone_elements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/schema/document.h"
#include "geometry/io/mask_image.h"

namespace retrace::design {
namespace {

using geometry::ArrayCell, geometry::ArrayPlan, geometry::Vec2;

/// Elements are in one row or column if their centres agree within this tolerance, which is a fraction of an element's
/// size.
constexpr double kSameLine = 1e-6;

/// Positions of the rows or columns of elements.
class Lines {
 public:
  Lines(const ArrayPlan& plan, Eigen::Index axis) : axis_(axis) {
    std::vector<double> middles_mm;
    double size_mm = 0.0;
    for (const ArrayCell& cell : plan.cells) {
      if (!cell.is_element) continue;
      const geometry::Rectangle box = geometry::bounding_box(cell.outline);
      middles_mm.push_back(box.centre()[axis]);
      size_mm = box.size()[axis];
    }
    near_mm_ = kSameLine * size_mm;
    std::sort(middles_mm.begin(), middles_mm.end());
    for (const double middle_mm : middles_mm)
      if (at_mm_.empty() || middle_mm > at_mm_.back() + near_mm_) at_mm_.push_back(middle_mm);
  }

  std::size_t size() const { return at_mm_.size(); }
  /// Returns the number of the row or column of an element, counted from 1.
  double number_of(const ArrayCell& cell) const {
    const double middle_mm = geometry::bounding_box(cell.outline).centre()[axis_];
    const auto after = std::upper_bound(at_mm_.begin(), at_mm_.end(), middle_mm + near_mm_);
    return static_cast<double>(after - at_mm_.begin());
  }

 private:
  Eigen::Index axis_;
  double near_mm_ = 0.0;
  std::vector<double> at_mm_;
};

bool has(const std::vector<double>& numbers, const std::optional<double>& every, double line) {
  const double number = every ? std::fmod(line - 1.0, *every) + 1.0 : line;
  return std::ranges::find(numbers, number) != numbers.end();
}

/// Returns true if the pixel of the mask at a position is dark.
/// \param dark mask that covers the whole part
bool is_dark_at(const std::vector<std::string>& dark, const Vec2& place_mm, const Vec2& size_mm) {
  const auto pixel = [](double share, std::size_t count) {
    const double at = std::floor(share * static_cast<double>(count));
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(count - 1)));
  };
  const Vec2 share = place_mm.cwiseQuotient(size_mm);
  return dark[pixel(1.0 - share.y(), dark.size())][pixel(share.x(), dark.front().size())] == '#';
}

}  // namespace

std::size_t row_or_column_count(const ArrayPlan& plan, Eigen::Index axis) {
  return Lines(plan, axis).size();
}

void choose_cells(ZonedPart& part, const std::function<std::vector<std::string>(std::size_t zone)>& dark) {
  geometry::ZonedSpec& spec = part.spec;
  const ArrayPlan plan = geometry::plan_of_array(geometry::array_of_cells(spec, spec.zones.front()));
  const Lines rows(plan, 1);
  const Lines columns(plan, 0);
  std::vector<std::vector<std::string>> masks(spec.zones.size());
  std::optional<std::size_t> rest;
  for (std::size_t z = 0; z < spec.zones.size(); ++z) {
    spec.zones[z].cells.clear();
    if (part.elements[z].mask) masks[z] = dark(z);
    if (part.elements[z].is_remainder) rest = z;
  }
  for (const ArrayCell& cell : plan.cells) {
    if (!cell.is_element) {
      spec.zones.front().cells.push_back(cell.number);
      continue;
    }
    const double row = rows.number_of(cell);
    const double column = columns.number_of(cell);
    const Vec2 middle_mm = geometry::centroid(cell.outline);
    bool is_held = false;
    for (std::size_t z = 0; z < spec.zones.size(); ++z) {
      const ElementsOfZone& chosen = part.elements[z];
      const bool is_own = chosen.mask
                              ? is_dark_at(masks[z], middle_mm, spec.size_mm)
                              : has(chosen.rows, chosen.every, row) || has(chosen.columns, chosen.every, column);
      if (!is_own) continue;
      spec.zones[z].cells.push_back(cell.number);
      is_held = true;
    }
    if (!is_held && rest) spec.zones[*rest].cells.push_back(cell.number);
  }
}

geometry::ZonedSpec zones_of(const Design& design) {
  const ZonedPart& read = *design.zoned();
  if (!read.has_masks()) return read.spec;
  ZonedPart part = read;
  choose_cells(part, [&](std::size_t zone) {
    const ArrayMask& mask = *part.elements[zone].mask;
    return geometry::mask_pattern(mask.file, mask.threshold, std::nullopt,
                                  design.where(schema::path_of_entry("zone", zone) + ".mask"));
  });
  check_zones(part, [&](const std::string& key) { return design.where(key); });
  return part.spec;
}

void check_zones(const ZonedPart& part, const std::function<InputLocation(const std::string& key)>& where) {
  using Of = geometry::ZoneFault::Subject;
  const auto fault = geometry::fault_of_zones(part.spec);
  if (!fault) return;
  const std::string zone = schema::path_of_entry("zone", fault->zone);
  if (fault->subject != Of::elements)
    throw InputError(where(fault->subject == Of::rotation ? zone + ".rotation_deg" : zone), fault->text);
  if (!part.changes[fault->zone].empty()) throw InputError(where(zone + ".set"), fault->text);
  // The elements of this zone differ from those of zone 1, but this zone has no changes. The changes of zone 1
  // therefore cause the difference, and the message names the key `set` of zone 1.
  throw InputError(
      where(schema::path_of_entry("zone", 0) + ".set"),
      fmt::format("must not change the outlines and positions of the elements, which must be the same as in zone {}",
                  fault->zone + 1));
}

}  // namespace retrace::design
