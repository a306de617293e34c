#include "studies/design/facet_planes_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/angle.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"

namespace retrace::studies {
namespace {

using geometry::ElementPlanes;
using geometry::HeightPlane;
using geometry::Vec2;

constexpr std::string_view kHeader = "x_mm,y_mm,facet,height_mm,x_slope,y_slope";
constexpr std::array<std::string_view, 6> kColumns = {"x_mm", "y_mm", "facet", "height_mm", "x_slope", "y_slope"};
constexpr std::size_t kMostBytes = std::size_t{512} << 20;
constexpr double kMost = 1e6;
constexpr double kMostTurnDeg = 5.0;
constexpr double kMostHeightShare = 0.1;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// One line of the table.
struct Row {
  Vec2 centre_mm = Vec2::Zero();
  std::size_t facet = 0;
  HeightPlane plane;
  int line = 0;
};

class Reader {
 public:
  Reader(const std::string& file, const geometry::PartSpec& spec)
      : file_(file), spec_(spec), nominal_(std::get<geometry::RtpElement>(spec.element)) {
    half_apex_rad_ = 0.5 * Angle::from_deg(nominal_.apex_angle_deg).rad();
    depth_mm_ = geometry::element_depth_mm(spec.element);
  }

  geometry::FacetPlanes read(std::string_view text) {
    if (text.size() > kMostBytes) fail(0, "", fmt::format("must have at most {} bytes", kMostBytes));
    int line = 0;
    bool has_header = false;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      const std::string_view content = trimmed(text.substr(begin, end - begin));
      ++line;
      begin = end + 1;
      if (content.empty() || content.starts_with('#')) continue;
      if (!has_header && content != kHeader) fail(line, "", fmt::format("must be the header {}", kHeader));
      if (has_header) take(row_of(content, line));
      has_header = true;
    }
    if (pending_) fail(pending_->line, "", "must be followed by the other facet of its element");
    if (elements_.empty()) fail(0, "", fmt::format("must have the header {} and two lines for each element", kHeader));
    try {
      return {std::move(elements_), std::min(nominal_.base_mm, nominal_.width_mm)};
    } catch (const InputError& error) {
      throw InputError({file_, 0, ""}, error.what());
    }
  }

 private:
  [[noreturn]] void fail(int line, std::string_view column, const std::string& text) const {
    throw InputError({file_, line, std::string(column)}, text);
  }

  double number(std::string_view text, std::size_t column, int line) const {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !(std::abs(value) <= kMost))
      fail(line, kColumns[column],
           fmt::format("must be a number from -{0} to {0}, got {1}", shortest(kMost), in_quotes(text)));
    return value;
  }

  Row row_of(std::string_view content, int line) const {
    std::array<double, kColumns.size()> values{};
    std::size_t column = 0;
    for (std::size_t begin = 0; begin <= content.size(); ++column) {
      const std::size_t comma = std::min(content.find(',', begin), content.size());
      if (column < values.size()) values[column] = number(trimmed(content.substr(begin, comma - begin)), column, line);
      begin = comma + 1;
    }
    if (column != values.size())
      fail(line, "", fmt::format("must have the {} fields of the heading, got {}", values.size(), column));
    if (values[2] != 1.0 && values[2] != 2.0) fail(line, "facet", "must be 1 or 2, got " + shortest(values[2]));
    Row row;
    row.centre_mm = {values[0], values[1]};
    row.facet = static_cast<std::size_t>(values[2]) - 1;
    row.plane = {values[3], {values[4], values[5]}};
    row.line = line;
    check(row);
    return row;
  }

  /// The nominal slope of a facet; in a checker every second element is turned.
  bool resembles(const Row& row, bool turned) const {
    const double side = row.facet == 0 ? -1.0 : 1.0;
    Vec2 slope(side / std::tan(half_apex_rad_), 0.0);
    if (turned) std::swap(slope.x(), slope.y());
    const geometry::Vec3 nominal = geometry::Vec3(slope.x(), slope.y(), -1.0).normalized();
    const geometry::Vec3 own = geometry::Vec3(row.plane.slope.x(), row.plane.slope.y(), -1.0).normalized();
    return own.dot(nominal) >= std::cos(Angle::from_deg(kMostTurnDeg).rad());
  }

  void check(const Row& row) const {
    const bool may_be_turned = spec_.arrangement == geometry::Arrangement::checker;
    if (!resembles(row, false) && !(may_be_turned && resembles(row, true)))
      fail(row.line, "x_slope",
           fmt::format("the plane must lie within {} degrees of facet {} of the design's element",
                       shortest(kMostTurnDeg), row.facet + 1));
    if (std::abs(row.plane.height_mm + depth_mm_) > kMostHeightShare * depth_mm_)
      fail(row.line, "height_mm",
           fmt::format("must be {} to {}, near the root of the design's element, got {}",
                       fixed(-(1.0 + kMostHeightShare) * depth_mm_, 6), fixed(-(1.0 - kMostHeightShare) * depth_mm_, 6),
                       shortest(row.plane.height_mm)));
  }

  void take(const Row& row) {
    if (!pending_) {
      pending_ = row;
      return;
    }
    if (pending_->centre_mm != row.centre_mm || pending_->facet == row.facet)
      fail(row.line, "", "must be the other facet of the element of the line before");
    ElementPlanes element;
    element.centre_mm = row.centre_mm;
    element.planes[pending_->facet] = pending_->plane;
    element.planes[row.facet] = row.plane;
    elements_.push_back(element);
    pending_.reset();
  }

  const std::string& file_;
  const geometry::PartSpec& spec_;
  const geometry::RtpElement& nominal_;
  double half_apex_rad_ = 0.0;
  double depth_mm_ = 0.0;
  std::vector<ElementPlanes> elements_;
  std::optional<Row> pending_;
};

}  // namespace

geometry::FacetPlanes parse_facet_planes(std::string_view text, const std::string& file,
                                         const geometry::PartSpec& spec) {
  return Reader(file, spec).read(text);
}

std::string facet_planes_text(const geometry::FacetPlanes& planes) {
  std::string text = std::string(kHeader) + "\n";
  for (const ElementPlanes& element : planes.elements())
    for (const std::size_t k : {0U, 1U}) {
      const HeightPlane& plane = element.planes[k];
      text += fmt::format("{},{},{},{},{},{}\n", shortest(element.centre_mm.x()), shortest(element.centre_mm.y()),
                          k + 1, shortest(plane.height_mm), shortest(plane.slope.x()), shortest(plane.slope.y()));
    }
  return text;
}

}  // namespace retrace::studies
