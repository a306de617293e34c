#include <fmt/format.h>

#include <filesystem>
#include <numbers>
#include <utility>

#include "core/number_format.h"
#include "fabrication/job/v_tool.h"
#include "geometry/elements/element_cells.h"
#include "report/results/result_plots.h"
#include "studies/fabrication/fabricate.h"

namespace retrace::report {
namespace {

using geometry::Polygon, geometry::Vec2;

/// Maximum number of prisms that are drawn one by one. In larger arrays, adjacent prisms of a row are drawn as one
/// rectangle.
constexpr std::size_t kMaxDrawnElements = 4000;

std::string name_of(const studies::FabricationResult& result) {
  return std::filesystem::path(result.job.source).filename().string();
}

Polygon rectangle(const Vec2& low, const Vec2& high) {
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

/// Returns the size of the section in which the tool path is drawn: half of its width, and its full height. The width
/// is measured at the face of the blank.
std::pair<double, double> section_of(const fabrication::Job& job) {
  if (cuts_prisms(job)) {
    const geometry::RtpElement prism = fabrication::blank_prism(job);
    return {0.5 * prism.base_mm, fabrication::root_depth_mm(prism)};
  }
  // A dihedral edge of a cube corner with length sqrt(3) rises by 1. It is at 45 degrees to the line of steepest slope
  // of the facet.
  const double edge_mm = fabrication::cavity_edge_mm(fabrication::blank_element(job));
  const double up_mm = edge_mm / std::numbers::sqrt2;
  return {up_mm, up_mm};
}

/// Returns the outline of an element in plan.
/// \param centre center of the element in the drawing
Polygon outline_of(const fabrication::Job& job, const fabrication::CutElement& cut, const Vec2& centre) {
  const geometry::Element element = fabrication::blank_element(job, cut.zone);
  if (const auto* const prism = std::get_if<geometry::RtpElement>(&element)) {
    const Vec2 half =
        cut.rotated ? 0.5 * Vec2(prism->width_mm, prism->base_mm) : 0.5 * Vec2(prism->base_mm, prism->width_mm);
    return rectangle(centre - half, centre + half);
  }
  // In a job with zones, the outline is rotated about z like the element. Elements on a curved substrate are drawn
  // without their tilt, as on the unrolled sheet.
  const Eigen::Matrix2d turn = job.zones.empty() ? Eigen::Matrix2d::Identity()
                                                 : Eigen::Matrix2d(cut.workpiece_from_element.topLeftCorner<2, 2>());
  Polygon outline = geometry::element_cell(element).outline;
  for (Vec2& p : outline) p = cut.rotated ? Vec2(centre - p) : Vec2(centre + turn * p);
  return outline;
}

std::string sizes_of(const fabrication::Job& job) {
  if (!job.zones.empty()) return fmt::format("cube corners of {} zones", job.zones.size());
  const geometry::Element element = fabrication::blank_element(job);
  if (const auto* const prism = std::get_if<geometry::RtpElement>(&element))
    return fmt::format("base {} mm, width {} mm", shortest(prism->base_mm), shortest(prism->width_mm));
  const Vec2 size = geometry::bounding_box(geometry::element_cell(element).outline).size();
  return fmt::format("cube corners of {} x {} mm", fixed(size.x(), 3), fixed(size.y(), 3));
}

}  // namespace

PathPlot tool_path_plot(const studies::FabricationResult& result, bool roughing) {
  const auto [half_mm, depth_mm] = section_of(result.job);
  PathPlot plot = tool_path_plot({.job = name_of(result),
                                  .machine = result.machine.name,
                                  .elements = result.plan.elements.size(),
                                  .is_roughing = roughing,
                                  .is_layered = result.job.strategy == fabrication::Strategy::bidirectional,
                                  .is_cube_corner = !cuts_prisms(result.job)});
  plot.material = {{-2.0 * half_mm, -0.25 * depth_mm},
                   {2.0 * half_mm, -0.25 * depth_mm},
                   {2.0 * half_mm, depth_mm},
                   {half_mm, depth_mm},
                   {0.0, 0.0},
                   {-half_mm, depth_mm},
                   {-2.0 * half_mm, depth_mm},
                   {-2.0 * half_mm, -0.25 * depth_mm}};
  for (const studies::SectionMove& move : studies::section_moves(result, roughing))
    plot.kinds[static_cast<std::size_t>(move.motion)].moves.push_back(
        {{move.from_u_mm, move.from_z_mm}, {move.to_u_mm, move.to_z_mm}});
  return plot;
}

namespace {

/// Adjacent elements of a row that are drawn as one outline.
struct DrawnElements {
  Polygon outline;
  std::size_t count = 1;  ///< number of elements
  /// Sum of the elements' positions in the cutting sequence. It is used to compute their mean position.
  std::int64_t places = 0;
};

/// Returns the outline of the element `first`. If there are more than kMaxDrawnElements elements, returns the outline
/// of a group of adjacent prisms that begins with `first`.
/// \param places position of each element in the cutting sequence
/// \param in_plan function that converts coordinates of the workpiece to coordinates of the drawing
template <class InPlan>
DrawnElements drawn_from(std::size_t first, const std::vector<fabrication::CutElement>& elements,
                         const std::vector<std::int64_t>& places, const fabrication::Job& job, const InPlan& in_plan) {
  const auto outline_at = [&](std::size_t k) { return outline_of(job, elements[k], in_plan(elements[k].centre_mm)); };
  DrawnElements drawn{outline_at(first), 1, places[first]};
  if (!cuts_prisms(job) || elements.size() <= kMaxDrawnElements) return drawn;
  for (std::size_t next = first + 1; next < elements.size() && elements[next].row == elements[first].row &&
                                     elements[next].column == elements[next - 1].column + 1;
       ++next) {
    const geometry::Rectangle box = geometry::bounding_box(drawn.outline);
    const geometry::Rectangle more = geometry::bounding_box(outline_at(next));
    drawn.outline = rectangle(box.lower.cwiseMin(more.lower), box.upper.cwiseMax(more.upper));
    drawn.places += places[next];
    ++drawn.count;
  }
  return drawn;
}

}  // namespace

MapPlot arrangement_plot(const studies::FabricationResult& result) {
  const std::vector<fabrication::CutElement>& elements = result.plan.elements;
  const std::vector<std::int64_t> places = studies::cutting_order_numbers(result);
  const Vec2 extent(fabrication::blank_extent_mm(result.job).y(), fabrication::blank_extent_mm(result.job).x());
  MapPlot plot;
  plot.title = fmt::format("{}: {} elements", name_of(result), elements.size());
  plot.axis_unit = "mm";
  plot.value_label = "Position in the order of cutting (%)";
  plot.hatched_label = "not cut";
  plot.full_value = 100.0;
  MapPanel panel;
  panel.title = sizes_of(result.job);
  panel.remarks = {"the blank seen from the tool, in the frame of the part that is moulded in it"};
  if (result.job.workpiece.kind == fabrication::WorkpieceKind::direct)
    panel.remarks = {"the back of the part seen from the tool: mirrored relative to the design"};
  panel.outline = rectangle(Vec2::Zero(), extent);
  // Converts workpiece coordinates to coordinates of the part (x_part = -y_w, y_part = x_w). The origin is moved to a
  // corner of the array.
  const auto in_plan = [&](const Vec2& w) -> Vec2 { return Vec2(-w.y(), w.x()) + 0.5 * extent; };
  for (std::size_t k = 0; k < elements.size();) {
    const Vec2 centre = in_plan(elements[k].centre_mm);
    const DrawnElements drawn = drawn_from(k, elements, places, result.job, in_plan);
    const double mean = static_cast<double>(drawn.places) / static_cast<double>(drawn.count);
    const Vec2 half = 0.5 * geometry::bounding_box(drawn.outline).size();
    panel.regions.push_back({drawn.outline, 100.0 * mean / static_cast<double>(elements.size())});
    if (drawn.count == 1 && cuts_prisms(result.job)) {
      const Vec2 along = elements[k].rotated ? Vec2(half.x(), 0.0) : Vec2(0.0, half.y());
      panel.fine_lines.push_back({centre - along, centre + along});
    }
    k += drawn.count;
  }
  plot.panels.push_back(std::move(panel));
  return plot;
}

}  // namespace retrace::report
