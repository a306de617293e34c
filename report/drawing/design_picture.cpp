#include "report/drawing/design_picture.h"

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "report/canvas.h"
#include "report/drawing/shaded_view.h"
#include "report/style.h"

namespace retrace::report {
namespace {

using geometry::Vec3;

constexpr double kWidth = 860.0, kHeight = 560.0, kHead = 66.0;
constexpr double kScale = 2.0;
constexpr double kAxisLength = 34.0;
constexpr Font kRemarkFont{11.5, false};

/// Returns a view direction from the side of the light.
ViewDirection from_above() {
  return {Vec3(-0.48, -0.62, 0.55).normalized(), Vec3::UnitZ()};
}

/// Returns a view direction from below, so that the elements are in front. The y axis of the part points to the right
/// and away from the viewer.
ViewDirection from_below() {
  return {Vec3(-0.48, -0.62, -0.72).normalized(), -Vec3::UnitZ()};
}

void draw_axes(Canvas& canvas, const ViewDirection& direction, Point origin) {
  const Vec3 right = direction.up.cross(direction.from).normalized();
  const Vec3 up = direction.from.cross(right);
  const std::array<std::pair<Vec3, const char*>, 3> axes = {
      {{Vec3::UnitX(), "x"}, {Vec3::UnitY(), "y"}, {Vec3::UnitZ(), "z"}}};
  for (const auto& [axis, name] : axes) {
    const Point step{axis.dot(right), -axis.dot(up)};
    const Point end{origin.x + kAxisLength * step.x, origin.y + kAxisLength * step.y};
    canvas.line({origin, end}, {kAxis, 1.4, {}});
    canvas.text({origin.x + (kAxisLength + 9.0) * step.x, origin.y + (kAxisLength + 9.0) * step.y + 4.0}, name,
                kRemarkFont, kText, Align::centre);
  }
}

}  // namespace

std::string view_png(const studies::DesignView& view) {
  struct Aspect {
    ViewDirection direction;
    const char* text;
  };
  std::vector<Aspect> aspects;
  if (view.has_curved_entrance) aspects.push_back({from_above(), "above: seen from the light"});
  aspects.push_back({from_below(), view.has_curved_entrance ? "below: seen from behind"
                                                            : "seen from behind, where the elements are"});
  const double head = kHead + added_title_height(view.title, kWidth);
  const Size size{kWidth, head + kHeight * static_cast<double>(aspects.size())};
  Canvas canvas(Canvas::Format::png, size, kScale);
  double top = head;
  std::string remarks;
  for (const Aspect& aspect : aspects) {
    const ShadedView picture =
        shaded_view(view.mesh, view.edges, aspect.direction, static_cast<std::size_t>(kScale * kWidth),
                    static_cast<std::size_t>(kScale * kHeight));
    if (top == head) canvas.fill_rectangle({0.0, 0.0}, size, picture.colours.front());
    canvas.image({0.0, top}, {kWidth, kHeight}, picture.columns, picture.colours);
    draw_axes(canvas, aspect.direction, {kMargin + 40.0, top + kHeight - 56.0});
    top += kHeight;
    remarks += (remarks.empty() ? "" : "; ") + std::string(aspect.text);
  }
  draw_title(canvas, kWidth, view.title, {kMargin, kMargin + kTitleFont.size}, Align::left);
  for (const std::string& remark : view.remarks) remarks += "; " + remark;
  const double y = kMargin + kTitleFont.size + added_title_height(view.title, kWidth) + kRemarkFont.size + 7.0;
  for (const std::string& line : canvas.fitted(remarks, kRemarkFont, kWidth - 2.0 * kMargin, 1, Ellipsis::end))
    canvas.text({kMargin, y}, line, kRemarkFont, kFaint, Align::left);
  return canvas.finish();
}

}  // namespace retrace::report
