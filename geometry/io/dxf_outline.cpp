#include "geometry/io/dxf_outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/leading_number.h"
#include "core/message_text.h"
#include "core/text.h"
#include "geometry/direction.h"

namespace retrace::geometry {
namespace {

/// Maximum distance between ends of entities that are joined, as a fraction of the size of the outline.
constexpr double kJoinedFraction = 1e-5;
constexpr std::size_t kMaxSides = 20'000;
constexpr double kMaxCoordinate = 1e9;
/// Name of the layer that contains all entities for which the file specifies no layer.
constexpr std::string_view kDefaultLayer = "0";
/// Length in mm of each unit of length, indexed by the value of $INSUNITS. 0: the unit is not allowed.
constexpr std::array<double, 15> kUnitLengthsMm = {1.0,     25.4,   304.8, 0.0,  1.0,  10.0, 1000.0, 0.0,
                                                   2.54e-5, 0.0254, 914.4, 1e-7, 1e-6, 1e-3, 100.0};

/// Pair of a group code and its value.
struct Group {
  int code = 0;
  std::string_view value;
  int line = 0;  ///< line of the group code
};

/// Side of a loop, and the line of the file at which the entity that describes this side begins.
struct EntitySide {
  OutlineSide side;
  int line = 0;
};

class DxfReader {
 public:
  DxfReader(std::string_view text, const std::string& name, const DxfSelection& selection)
      : remainder_(text), name_(name), selection_(selection) {}

  std::vector<OutlineLoop> read() {
    if (remainder_.starts_with("AutoCAD Binary DXF")) fail(0, "must be an ASCII DXF file, got a binary one");
    Group group = next();
    while (!is(group, 0, "EOF")) {
      if (!is(group, 0, "SECTION")) {
        group = next();
        continue;
      }
      const Group section = next();
      if (is(section, 2, "HEADER"))
        group = read_header();
      else if (is(section, 2, "ENTITIES"))
        group = read_entities();
      else
        group = next();
    }
    if (!has_entities_) fail(0, "must have a section ENTITIES");
    convert_to_mm();
    return joined();
  }

 private:
  [[noreturn]] void fail(int line, const std::string& text) const { throw InputError({name_, line, ""}, text); }

  static bool is(const Group& group, int code, std::string_view value) {
    return group.code == code && group.value == value;
  }

  /// Returns the next group. After the end of the text, returns the group "0, EOF", which ends a DXF file.
  Group next() {
    if (remainder_.empty()) return {0, "EOF", line_};
    Group group;
    group.line = line_ + 1;
    const std::string_view code = next_line();
    const auto number = leading_number(code);
    if (!number || number->length != code.size() || !(std::abs(number->value) < 2000.0) ||
        number->value != std::floor(number->value))
      fail(group.line, fmt::format("must be a group code (an integer), got {}", in_quotes(code)));
    group.code = static_cast<int>(number->value);
    group.value = next_line();
    return group;
  }

  std::string_view next_line() {
    const std::size_t end = std::min(remainder_.find('\n'), remainder_.size());
    const std::string_view line = trimmed(remainder_.substr(0, end));
    remainder_.remove_prefix(std::min(end + 1, remainder_.size()));
    ++line_;
    return line;
  }

  double number_of(const Group& group) const {
    const auto number = leading_number(group.value);
    if (!number || number->length != group.value.size() || !(std::abs(number->value) <= kMaxCoordinate))
      fail(group.line + 1,
           fmt::format("must be a number of magnitude up to {:g}, got {}", kMaxCoordinate, in_quotes(group.value)));
    return number->value;
  }

  Group read_header() {
    Group group = next();
    bool is_unit = false;
    while (group.code != 0) {
      if (group.code == 9) is_unit = group.value == "$INSUNITS";
      if (group.code == 70 && is_unit) {
        const double unit = number_of(group);
        const bool is_known =
            unit >= 0.0 && unit < static_cast<double>(kUnitLengthsMm.size()) && unit == std::floor(unit);
        unit_mm_ = is_known ? kUnitLengthsMm[static_cast<std::size_t>(unit)] : 0.0;
        unit_line_ = group.line + 1;
      }
      group = next();
    }
    return group;
  }

  Group read_entities() {
    has_entities_ = true;
    Group group = next();
    while (!is(group, 0, "ENDSEC") && !is(group, 0, "EOF"))
      group = group.code != 0 ? next() : is_next_selected() ? read_entity(group) : skip_entity();
    return group;
  }

  /// Values of an entity, indexed by group code. If a code occurs several times, the last value is stored.
  struct Entity {
    std::array<double, 60> values{};
    std::array<bool, 60> is_given{};
    int flags = 0;
    Vec3 extrusion = Vec3::UnitZ();
    std::vector<Vec2> corners;
    std::vector<double> bulges;
  };

  /// Returns true if the next entity in the text is on the selected layer. Leaves the reading position unchanged.
  bool is_next_selected() {
    if (selection_.layer.empty()) return true;
    const std::string_view remainder = remainder_;
    const int line = line_;
    std::string_view layer = kDefaultLayer;
    for (Group group = next(); group.code != 0; group = next())
      if (group.code == 8) layer = group.value;
    remainder_ = remainder;
    line_ = line;
    return layer == selection_.layer;
  }

  /// Skips the groups of an entity and returns the group that follows it.
  Group skip_entity() {
    Group group = next();
    while (group.code != 0) group = next();
    return group;
  }

  /// Reads an entity of the selected layer and returns the group that follows it.
  Group read_entity(const Group& start) {
    Entity entity;
    Group group = next();
    for (; group.code != 0; group = next()) {
      if (group.code == 70) entity.flags = static_cast<int>(std::clamp(number_of(group), 0.0, 1e6));
      if (group.code == 210 || group.code == 220 || group.code == 230)
        entity.extrusion[(group.code - 210) / 10] = number_of(group);
      if (group.code < 10 || group.code >= 60) continue;
      const auto code = static_cast<std::size_t>(group.code);
      entity.values[code] = number_of(group);
      entity.is_given[code] = true;
      if (group.code == 10) {
        entity.corners.emplace_back(entity.values[10], 0.0);
        entity.bulges.push_back(0.0);
      }
      if (!entity.corners.empty() && group.code == 20) entity.corners.back().y() = entity.values[20];
      if (!entity.bulges.empty() && group.code == 42) entity.bulges.back() = entity.values[42];
      if (entity.corners.size() > kMaxSides) fail(group.line, fmt::format("must have at most {} corners", kMaxSides));
    }
    add(start, entity);
    return group;
  }

  void add(const Group& start, const Entity& entity) {
    const std::string_view kind = start.value;
    const int line = start.line + 1;
    if (kind != "LINE" && kind != "ARC" && kind != "CIRCLE" && kind != "LWPOLYLINE")
      fail(line, fmt::format("must be LINE, ARC, CIRCLE or LWPOLYLINE, got {}; other entities of the file must be on "
                             "other layers than the outline (dxf_layer)",
                             in_quotes(kind)));
    if ((entity.extrusion - Vec3::UnitZ()).norm() > 1e-9)
      fail(line, "must be seen from +z, but the entity has another extrusion direction");
    const auto require = [&](std::initializer_list<std::size_t> codes) {
      for (const std::size_t code : codes)
        if (!entity.is_given[code]) fail(line, fmt::format("{} must have the group code {}", kind, code));
    };
    const auto& v = entity.values;
    if (kind == "LINE") {
      require({10, 20, 11, 21});
      add_side({{v[10], v[20]}, {v[11], v[21]}, 0.0}, line);
    } else if (kind == "LWPOLYLINE") {
      add_polyline(entity, line);
    } else {
      require({10, 20, 40});
      if (!(v[40] > 0.0)) fail(line, fmt::format("{} must have a radius > 0, got {:g}", kind, v[40]));
      if (kind == "ARC") require({50, 51});
      add_arc({v[10], v[20]}, v[40], kind == "ARC" ? v[50] : 0.0, kind == "ARC" ? v[51] : 360.0, line);
    }
  }

  /// Adds an arc as two half arcs, because the bulge of a single arc becomes infinite for a full circle.
  void add_arc(const Vec2& centre, double radius, double from_deg, double to_deg, int line) {
    double sweep_deg = std::fmod(to_deg - from_deg, 360.0);
    if (sweep_deg <= 0.0) sweep_deg += 360.0;
    const auto at = [&](double deg) { return Vec2(centre + radius * direction_at(Angle::from_deg(deg))); };
    const double bulge = std::tan(sweep_deg / 8.0 * std::numbers::pi / 180.0);
    const Vec2 from = at(from_deg);
    const Vec2 middle = at(from_deg + 0.5 * sweep_deg);
    const Vec2 to = sweep_deg == 360.0 ? from : at(from_deg + sweep_deg);
    add_side({from, middle, bulge}, line);
    add_side({middle, to, bulge}, line);
  }

  void add_polyline(const Entity& entity, int line) {
    const std::size_t count = entity.corners.size();
    if (count < 2) fail(line, fmt::format("LWPOLYLINE must have at least two corners, got {}", count));
    const bool is_closed = (entity.flags & 1) != 0;
    for (std::size_t k = 0; k + (is_closed ? 0 : 1) < count; ++k) {
      const Vec2& from = entity.corners[k];
      const Vec2& to = entity.corners[(k + 1) % count];
      if (from != to) add_side({from, to, entity.bulges[k]}, line);
    }
  }

  void add_side(const OutlineSide& side, int line) {
    if (sides_.size() >= kMaxSides) fail(line, fmt::format("must have at most {} sides in total", kMaxSides));
    if (std::abs(side.bulge) > 100.0) fail(line, "must not have arcs of almost a full circle between two corners");
    sides_.push_back({side, line});
  }

  void convert_to_mm() {
    if (sides_.empty())
      fail(0, selection_.layer.empty()
                  ? std::string("must have at least one LINE, ARC, CIRCLE or LWPOLYLINE")
                  : fmt::format("must have entities on the layer {}", in_quotes(selection_.layer)));
    if (!selection_.scale && unit_mm_ == 0.0)
      fail(unit_line_, "must be a unit of length up to 1 m ($INSUNITS), or the design must contain dxf_scale");
    const double scale = selection_.scale.value_or(unit_mm_);
    for (EntitySide& entity : sides_) {
      entity.side.from_mm *= scale;
      entity.side.to_mm *= scale;
    }
  }

  /// Returns the diagonal of the bounding box of the end points of all sides.
  double size_mm() const {
    std::vector<Vec2> ends;
    for (const EntitySide& entity : sides_) ends.insert(ends.end(), {entity.side.from_mm, entity.side.to_mm});
    return bounding_box(ends).size().norm();
  }

  /// Joins the sides and returns the closed loops that they form.
  std::vector<OutlineLoop> joined() {
    const double near_mm = kJoinedFraction * size_mm();
    std::erase_if(sides_, [&](const EntitySide& entity) { return entity.side.chord_mm() <= near_mm; });
    std::vector<OutlineLoop> loops;
    std::vector<bool> is_used(sides_.size(), false);
    for (std::size_t first = 0; first < sides_.size(); ++first) {
      if (is_used[first]) continue;
      is_used[first] = true;
      OutlineLoop loop = {sides_[first].side};
      int line = sides_[first].line;
      while ((loop.back().to_mm - loop.front().from_mm).norm() > near_mm) {
        const auto [at, is_reversed] = successor(loop.back().to_mm, is_used, near_mm, line);
        is_used[at] = true;
        line = sides_[at].line;
        OutlineSide side = is_reversed ? sides_[at].side.reversed() : sides_[at].side;
        side.from_mm = loop.back().to_mm;
        loop.push_back(side);
      }
      loop.back().to_mm = loop.front().from_mm;
      loops.push_back(std::move(loop));
    }
    if (loops.empty()) fail(0, "must enclose an area");
    return loops;
  }

  /// Returns the index of the unused side that begins or ends at a point, and true if this side ends there.
  /// \param line line of the file that the error message names if there is no such side
  std::pair<std::size_t, bool> successor(const Vec2& end, const std::vector<bool>& is_used, double near_mm,
                                         int line) const {
    std::optional<std::pair<std::size_t, bool>> found;
    double nearest = INFINITY;
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      if (is_used[k]) continue;
      for (const bool is_reversed : {false, true}) {
        const double away = ((is_reversed ? sides_[k].side.to_mm : sides_[k].side.from_mm) - end).norm();
        nearest = std::min(nearest, away);
        if (away > near_mm) continue;
        if (found)
          fail(sides_[k].line,
               fmt::format("must join only two entities at x = {:.6g}, y = {:.6g} mm, got more", end.x(), end.y()));
        found = {k, is_reversed};
      }
    }
    if (!found)
      fail(line,
           fmt::format("must continue at x = {:.6g}, y = {:.6g} mm, but the outline is open there{}", end.x(), end.y(),
                       std::isfinite(nearest) ? fmt::format(": the nearest end is {:.6g} mm away", nearest) : ""));
    return *found;
  }

  std::string_view remainder_;
  const std::string& name_;
  const DxfSelection& selection_;
  int line_ = 0;
  bool has_entities_ = false;
  double unit_mm_ = 1.0;
  int unit_line_ = 0;
  std::vector<EntitySide> sides_;
};

}  // namespace

std::vector<OutlineLoop> parse_dxf_outline(std::string_view text, const std::string& name,
                                           const DxfSelection& selection) {
  return DxfReader(text, name, selection).read();
}

}  // namespace retrace::geometry
