#include "geometry/io/facet_planes_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/angle.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/number_format.h"
#include "geometry/direction.h"

namespace retrace::geometry {
namespace {

constexpr std::array<std::string_view, 6> kColumns = {"x_mm", "y_mm", "facet", "height_mm", "x_slope", "y_slope"};
constexpr NumberRange kValue{.low = -1e6, .high = 1e6};
/// First facet number of flares. Facets 0 to 2 belong to an element. Flares 3 to 5 replace a missing hexagonal element:
/// the cavities of its neighbours extend over its corners.
constexpr std::size_t kFlares = 3;
/// First facet number of caps. A cap is the surface that a chisel with a straight edge leaves over the apex of an
/// element.
constexpr std::size_t kCaps = 6;
constexpr double kMaxTiltDeg = 5.0;
constexpr double kMaxHeightDeviationFraction = 0.1;

/// Row of the table of facet planes.
struct FacetRow {
  Vec2 centre_mm = Vec2::Zero();
  std::size_t facet = 0;
  HeightPlane plane;
  int line = 0;
};

class Reader {
 public:
  Reader(const std::string& file, const geometry::PartSpec& spec) : file_(file), spec_(spec) {
    for (const geometry::CellFacet& facet : geometry::element_cell(spec.element).facets)
      nominal_slopes_.push_back(facet.plane.slope);
    depth_mm_ = geometry::element_depth_mm(spec.element);
    const Vec2 size = geometry::bounding_box(geometry::aperture_outline(spec.element)).size();
    spacing_mm_ = is_prism() ? size.minCoeff() : geometry::cube_spacing_mm(spec.element);
  }

  geometry::FacetPlanes read(std::string_view text) {
    CsvReader table(text, file_, kMaxFacetPlanesBytes, kColumns);
    while (table.next()) take(row_of(table));
    if (!pending_.empty())
      fail(pending_.back().line, "",
           fmt::format("the next lines must contain the other {} of this element", is_prism() ? "facet" : "facets"));
    if (!has_element_)
      fail(0, "", fmt::format("the file must have {} lines for each element", is_prism() ? "two" : "three"));
    try {
      return {std::move(elements_), spacing_mm_};
    } catch (const InputError& error) {
      throw InputError({file_, 0, ""}, error.what());
    }
  }

 private:
  [[noreturn]] void fail(int line, std::string_view column, const std::string& text) const {
    throw InputError({file_, line, std::string(column)}, text);
  }

  FacetRow row_of(const CsvReader& table) const {
    std::array<double, kColumns.size()> values{};
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = table.number(k, kValue);
    if (!is_facet(values[2]))
      table.fail(2, fmt::format("must be {}, got {}",
                                is_prism()       ? "1 or 2"
                                : is_hexagonal() ? "1 to 9"
                                                 : "1 to 3 or 7 to 9",
                                shortest(values[2])));
    FacetRow row;
    row.centre_mm = {values[0], values[1]};
    row.facet = static_cast<std::size_t>(values[2]) - 1;
    row.plane = {values[3], {values[4], values[5]}};
    row.line = table.line();
    check(row);
    return row;
  }

  bool is_facet(double number) const {
    if (!(number >= 1.0 && number <= 9.0) || number != std::floor(number)) return false;
    if (number <= static_cast<double>(nominal_slopes_.size())) return true;
    return !is_prism() && (is_hexagonal() || number > static_cast<double>(kCaps));
  }
  bool is_prism() const { return std::holds_alternative<geometry::RtpElement>(spec_.element); }
  bool is_hexagonal() const { return std::holds_alternative<geometry::HexagonalCube>(spec_.element); }

  /// Returns true if a plane is similar to the nominal plane. For a facet, this is the plane of the nominal facet. A
  /// flare has the slope of the facet that is opposite to the flare's corner.
  /// \param rotated true: compare with the rotated element, which is rotated by 90 degrees in a checker array and by
  /// 180 degrees in a triangular array
  bool resembles(const FacetRow& row, bool rotated) const {
    const std::size_t facet = row.facet < kFlares ? row.facet : (row.facet - kFlares + 1) % 3;
    Vec2 slope = nominal_slopes_[facet];
    if (rotated) slope = is_prism() ? Vec2(slope.y(), slope.x()) : Vec2(-slope);
    const geometry::Vec3 nominal = geometry::Vec3(slope.x(), slope.y(), -1.0).normalized();
    const geometry::Vec3 own = geometry::Vec3(row.plane.slope.x(), row.plane.slope.y(), -1.0).normalized();
    return own.dot(nominal) >= std::cos(Angle::from_deg(kMaxTiltDeg).rad());
  }

  /// Returns the nominal height of a plane. For a facet it is the height at the root or apex. For a flare it is the
  /// height at the centre of the missing hexagon. It is extrapolated from the corner, which is half as deep as the
  /// apex.
  double nominal_height_mm(const FacetRow& row) const {
    if (row.facet < kFlares) return -depth_mm_;
    const Angle angle = Angle::from_deg(120.0 * static_cast<double>(row.facet - kFlares));
    const double radius_mm = 0.5 * std::get<geometry::HexagonalCube>(spec_.element).aperture_mm;
    const Vec2 corner = radius_mm * geometry::direction_at(angle);
    return -0.5 * depth_mm_ - nominal_slopes_[(row.facet - kFlares + 1) % 3].dot(corner);
  }

  /// Checks the plane of a cap. It may have any tilt, but it must be above the apex and below the rim.
  void check_cap(const FacetRow& row) const {
    if (!(row.plane.height_mm > -depth_mm_ && row.plane.height_mm < 0.0))
      fail(row.line, "height_mm",
           fmt::format("must be > {} (the apex) and < 0 (the rim), got {}",
                       fixed_apart(-depth_mm_, row.plane.height_mm, 6), shortest(row.plane.height_mm)));
  }

  void check(const FacetRow& row) const {
    if (row.facet >= kCaps) return check_cap(row);
    const bool may_be_turned = spec_.array.arrangement == geometry::Arrangement::checker ||
                               spec_.array.arrangement == geometry::Arrangement::triangular;
    if (!resembles(row, false) && !(may_be_turned && resembles(row, true)))
      fail(row.line, "x_slope",
           fmt::format(
               "the angle between this plane and facet {1} of the element in the design must be at most {0} degrees",
               shortest(kMaxTiltDeg), row.facet + 1));
    const double nominal_mm = nominal_height_mm(row);
    if (std::abs(row.plane.height_mm - nominal_mm) > kMaxHeightDeviationFraction * depth_mm_)
      fail(row.line, "height_mm",
           fmt::format("must be from {} to {} mm, near the root of the element in the design, got {}",
                       fixed_apart(nominal_mm - kMaxHeightDeviationFraction * depth_mm_, row.plane.height_mm, 6),
                       fixed_apart(nominal_mm + kMaxHeightDeviationFraction * depth_mm_, row.plane.height_mm, 6),
                       shortest(row.plane.height_mm)));
  }

  void take(const FacetRow& row) {
    if (row.facet >= kCaps && pending_.empty()) return take_cap(row);
    if (row.facet >= kFlares && pending_.empty()) return take_flare(row);
    for (const FacetRow& other : pending_)
      if (other.centre_mm != row.centre_mm || other.facet == row.facet || row.facet >= kFlares)
        fail(row.line, "",
             fmt::format("this line must contain {} facet of the element in the previous line",
                         is_prism() ? "the other" : "another"));
    pending_.push_back(row);
    if (pending_.size() < nominal_slopes_.size()) return;
    ElementPlanes element;
    element.centre_mm = row.centre_mm;
    element.planes.resize(pending_.size());
    for (const FacetRow& known : pending_) element.planes[known.facet] = known.plane;
    elements_.push_back(std::move(element));
    has_element_ = true;
    pending_.clear();
  }

  /// Adds a cap to its element. Caps must follow the facets of their element, in the order of the facets.
  void take_cap(const FacetRow& row) {
    if (elements_.empty() || elements_.back().planes.empty() || elements_.back().centre_mm != row.centre_mm)
      fail(row.line, "facet", "must come after the rows of the three facets of its element");
    auto& caps = elements_.back().caps;
    const std::size_t k = row.facet - kCaps;
    if (caps[k] || (k > 0 && !caps[k - 1])) fail(row.line, "facet", "must be in the order 7, 8, 9");
    caps[k] = row.plane;
  }

  /// Adds a flare. The lines of all flares at one position must be consecutive.
  void take_flare(const FacetRow& row) {
    const bool is_same =
        !elements_.empty() && elements_.back().planes.empty() && elements_.back().centre_mm == row.centre_mm;
    if (!is_same) {
      elements_.emplace_back();
      elements_.back().centre_mm = row.centre_mm;
      elements_.back().planes.clear();
    }
    auto& flare = elements_.back().flares[row.facet - kFlares];
    if (flare) fail(row.line, "facet", "the facet must not occur twice at one position");
    flare = row.plane;
  }

  const std::string& file_;
  const geometry::PartSpec& spec_;
  std::vector<Vec2> nominal_slopes_;
  double depth_mm_ = 0.0;
  double spacing_mm_ = 0.0;
  std::vector<ElementPlanes> elements_;
  std::vector<FacetRow> pending_;
  bool has_element_ = false;
};

}  // namespace

geometry::FacetPlanes parse_facet_planes(std::string_view text, const std::string& file,
                                         const geometry::PartSpec& spec) {
  return Reader(file, spec).read(text);
}

std::string facet_planes_text(const geometry::FacetPlanes& planes) {
  CsvWriter csv("x_mm,y_mm,facet,height_mm,x_slope,y_slope");
  for (const ElementPlanes& element : planes.elements()) {
    const auto put = [&](std::size_t facet, const HeightPlane& plane) {
      csv.row(element.centre_mm.x(), element.centre_mm.y(), facet, plane.height_mm, plane.slope.x(), plane.slope.y());
    };
    for (std::size_t k = 0; k < element.planes.size(); ++k) put(k + 1, element.planes[k]);
    for (std::size_t k = 0; k < element.flares.size(); ++k)
      if (element.flares[k]) put(kFlares + k + 1, *element.flares[k]);
    for (std::size_t k = 0; k < element.caps.size(); ++k)
      if (element.caps[k]) put(kCaps + k + 1, *element.caps[k]);
  }
  return csv.text();
}

}  // namespace retrace::geometry
