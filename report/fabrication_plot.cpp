#include "report/fabrication_plot.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "core/number_format.h"

namespace retrace::report {
namespace {

using geometry::Polygon;
using geometry::Vec2;

/// Of more elements neighbours in a row are drawn as one.
constexpr std::size_t kMostElementsDrawn = 4000;

std::string name_of(const studies::FabricationResult& result) {
  return std::filesystem::path(result.job.source).filename().string();
}

Polygon rectangle(const Vec2& low, const Vec2& high) {
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

}  // namespace

PathPlot tool_path_plot(const studies::FabricationResult& result, bool roughing) {
  const geometry::RtpElement element = fabrication::blank_prism(result.job);
  const double half_mm = 0.5 * element.base_mm;
  const double depth_mm = fabrication::root_depth_mm(element);
  PathPlot plot;
  plot.title = fmt::format("{}: {}", name_of(result),
                           roughing                                                      ? "roughing"
                           : result.job.strategy == fabrication::Strategy::bidirectional ? "layers"
                                                                                         : "finishing");
  plot.remarks = {fmt::format("one element of {}, in the section across its root; machine {}",
                              result.plan.elements.size(), result.machine.name)};
  plot.x_label = "across the root (mm)";
  plot.y_label = "above the root (mm)";
  plot.material = {{-2.0 * half_mm, -0.25 * depth_mm},
                   {2.0 * half_mm, -0.25 * depth_mm},
                   {2.0 * half_mm, depth_mm},
                   {half_mm, depth_mm},
                   {0.0, 0.0},
                   {-half_mm, depth_mm},
                   {-2.0 * half_mm, depth_mm},
                   {-2.0 * half_mm, -0.25 * depth_mm}};
  plot.kinds = {{"plunge", false, {}}, {"plough", false, {}}, {"retract", false, {}}, {"to the next cut", true, {}}};
  for (const studies::SectionMove& move : studies::section_moves(result, roughing))
    plot.kinds[static_cast<std::size_t>(move.motion)].moves.push_back(
        {{move.from_u_mm, move.from_z_mm}, {move.to_u_mm, move.to_z_mm}});
  return plot;
}

MapPlot arrangement_plot(const studies::FabricationResult& result) {
  const std::vector<fabrication::CutElement>& elements = result.plan.elements;
  const geometry::RtpElement element = fabrication::blank_prism(result.job);
  const std::vector<std::int64_t> places = studies::cutting_places(result);
  const Vec2 extent(fabrication::blank_extent_mm(result.job).y(), fabrication::blank_extent_mm(result.job).x());
  MapPlot plot;
  plot.title = fmt::format("{}: {} elements", name_of(result), elements.size());
  plot.axis_unit = "mm";
  plot.value_label = "Place in the order of cutting (%)";
  plot.rest_label = "not cut";
  plot.full_value = 100.0;
  MapPanel panel;
  panel.title = fmt::format("base {} mm, width {} mm", shortest(element.base_mm), shortest(element.width_mm));
  panel.remarks = {"the blank seen from the tool, in the frame of the part that is moulded in it"};
  if (result.job.workpiece.kind == fabrication::WorkpieceKind::direct)
    panel.remarks = {"the optic's back seen from the tool: mirrored against the design"};
  panel.outline = rectangle(Vec2::Zero(), extent);
  // x_part = -y_w and y_part = x_w, from a corner of the extent.
  const auto in_plan = [&](const Vec2& w) -> Vec2 { return Vec2(-w.y(), w.x()) + 0.5 * extent; };
  for (std::size_t k = 0; k < elements.size();) {
    const Vec2 half = elements[k].turned ? 0.5 * Vec2(element.width_mm, element.base_mm)
                                         : 0.5 * Vec2(element.base_mm, element.width_mm);
    Vec2 low = in_plan(elements[k].centre_mm) - half;
    Vec2 high = low + 2.0 * half;
    std::int64_t sum = places[k];
    std::int64_t count = 1;
    std::size_t next = k + 1;
    while (elements.size() > kMostElementsDrawn && next < elements.size() && elements[next].row == elements[k].row &&
           elements[next].column == elements[next - 1].column + 1) {
      low = low.cwiseMin(in_plan(elements[next].centre_mm) - half);
      high = high.cwiseMax(in_plan(elements[next].centre_mm) + half);
      sum += places[next];
      ++count;
      ++next;
    }
    const double mean = static_cast<double>(sum) / static_cast<double>(count);
    panel.regions.push_back({rectangle(low, high), 100.0 * mean / static_cast<double>(elements.size())});
    if (count == 1) {
      const Vec2 along = elements[k].turned ? Vec2(half.x(), 0.0) : Vec2(0.0, half.y());
      const Vec2 centre = in_plan(elements[k].centre_mm);
      panel.fine_lines.push_back({centre - along, centre + along});
    }
    k = next;
  }
  plot.panels.push_back(std::move(panel));
  return plot;
}

}  // namespace retrace::report
