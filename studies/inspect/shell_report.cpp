#include "studies/inspect/shell_report.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "raytrace/light/light_setup.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;

// Number of intervals into which each line of the section is divided.
constexpr int kPointsOfLine = 200;

/// Returns the fraction of power that shell `k` transmits at its middle, for light along the normal of its outer
/// surface.
double transmittance_of(const design::OpticalModel& model, std::size_t k) {
  double mean = 0.0;
  for (const design::SpectralOptics& at : model.spectral) {
    raytrace::Shell plate = at.optics.shells[k];
    plate.outer.curvature_per_mm = plate.inner.curvature_per_mm = 0.0;
    plate.inner.normal = plate.outer.normal;
    raytrace::Light light;
    pass_plates(raytrace::Shells{plate}, raytrace::ShellPassage::to_part, -plate.outer.normal, light);
    mean += at.weight * light.power();
  }
  return mean;
}

/// Returns true if shells or their surfaces are rotated about x, but none about y. These rotations are visible only in
/// the section along y.
bool is_turned_about_x(const design::Design& design) {
  const auto any = [&](std::size_t axis) {
    return std::ranges::any_of(design.shells, [axis](const design::OuterShell& shell) {
      return shell.wedge_deg[axis] != 0.0 || shell.tilt_deg[axis] != 0.0;
    });
  };
  return any(0) && !any(1);
}

/// Makes the lines of a section. All lines extend over the same range of x or y.
class SectionLines {
 public:
  SectionLines(const design::OpticalModel& model, Eigen::Index axis)
      : axis_(axis), heights_(model), shells_(model.optics.shells) {
    const geometry::Part& part = model.part;
    const geometry::Rectangle box =
        part.period_mm ? geometry::Rectangle{Vec2::Zero(), *part.period_mm} : geometry::bounding_box(part.outline);
    centre_ = box.centre();
    half_mm_ = 0.5 * box.size()[axis];
    // The section of an infinite part is wider than a period if a period is much smaller than the shells.
    if (part.period_mm) half_mm_ = std::max(half_mm_, 0.5 * shells_.front().outer.vertex_mm.z());
  }

  std::vector<Vec2> around(const raytrace::Shell& shell) const {
    std::vector<Vec2> line;
    add(line, shell.outer, false);
    add(line, shell.inner, true);
    line.push_back(line.front());
    return line;
  }

  std::vector<Vec2> around_part() const {
    std::vector<Vec2> line;
    for (int k = 0; k <= kPointsOfLine; ++k) {
      const Vec2 at = point(k);
      line.emplace_back(at[axis_], heights_.at(at));
    }
    line.emplace_back(line.back().x(), 0.0);
    line.emplace_back(line.front().x(), 0.0);
    line.push_back(line.front());
    return line;
  }

 private:
  /// Returns heights of the entrance surface in the part frame.
  struct Heights {
    explicit Heights(const design::OpticalModel& model)
        : entrance(model.entrance ? &*model.entrance : nullptr), thickness_mm(model.part.thickness_mm) {}
    double at(const Vec2& point) const {
      return entrance != nullptr ? geometry::height_mm(*entrance, point) : thickness_mm;
    }
    const geometry::Entrance* entrance;
    double thickness_mm;
  };

  Vec2 point(int k) const {
    Vec2 at = centre_;
    at[axis_] += (2.0 * k / kPointsOfLine - 1.0) * half_mm_ * (1.0 - 1e-9);
    return at;
  }

  void add(std::vector<Vec2>& line, const raytrace::ShellSurface& surface, bool reversed) const {
    const double middle_mm = heights_.at(centre_);
    for (int k = 0; k <= kPointsOfLine; ++k) {
      const Vec2 at = point(reversed ? kPointsOfLine - k : k);
      line.emplace_back(at[axis_], middle_mm + raytrace::height_mm(surface, at - centre_));
    }
  }

  Eigen::Index axis_;
  Heights heights_;
  const raytrace::Shells& shells_;
  Vec2 centre_ = Vec2::Zero();
  double half_mm_ = 0.0;
};

}  // namespace

ShellsReport report_shells(const design::Design& design, const design::OpticalModel& model) {
  const raytrace::Shells& shells = model.optics.shells;
  const std::vector<design::ShellClearance> clearances =
      design::clearances_of_shells(design, shells, model.part, model.entrance);
  ShellsReport report;
  report.section.is_along_y = is_turned_about_x(design);
  const SectionLines lines(model, report.section.is_along_y ? 1 : 0);
  for (std::size_t k = 0; k < shells.size(); ++k) {
    report.shells.push_back({shells[k].index, transmittance_of(model, k), clearances[k]});
    report.section.shells.push_back(lines.around(shells[k]));
  }
  report.section.part = lines.around_part();
  return report;
}

}  // namespace retrace::studies
