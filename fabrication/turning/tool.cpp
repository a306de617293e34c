#include "fabrication/turning/tool.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/number_format.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::Vec3;

Vec3 normal_of(const SlopeSample& s) {
  return Vec3(-s.radial, -s.along, 1.0).normalized();
}

bool clears(const TurningTool& tool, const std::vector<SlopeSample>& samples) {
  const ToolFrame frame = tool_frame(tool);
  return std::all_of(samples.begin(), samples.end(), [&](const SlopeSample& s) {
    const Contact contact = contact_of(frame, normal_of(s));
    return contact.clearance_needed_deg <= tool.clearance_deg &&
           2.0 * std::abs(contact.window_angle_deg) <= tool.window_deg;
  });
}

}  // namespace

Warnings tool_warnings(const TurningTool& tool) {
  Warnings warnings;
  if (tool.rake_deg < kMinTestedRakeDeg || tool.rake_deg > kMaxTestedRakeDeg)
    warnings.push_back(
        {"untried_rake",
         fmt::format("a rake of {} degrees is outside of -45 to 18 degrees, the range with proven good surface finish",
                     shortest(tool.rake_deg))});
  if (std::abs(tool.skew_deg) > kTestedSkewDeg)
    warnings.push_back(
        {"untried_skew",
         fmt::format("a skew of {} degrees is outside of -60 to 60 degrees, the range with proven good surface finish",
                     shortest(tool.skew_deg))});
  return warnings;
}

ToolFrame tool_frame(const TurningTool& tool) {
  const double skew = tool.skew_deg * kRadPerDeg;
  const double rake = tool.rake_deg * kRadPerDeg;
  const Vec3 cut(std::sin(skew), std::cos(skew), 0.0);
  ToolFrame frame;
  frame.across = {std::cos(skew), -std::sin(skew), 0.0};
  frame.rake_normal = std::cos(rake) * cut + std::sin(rake) * Vec3::UnitZ();
  frame.up = std::cos(rake) * Vec3::UnitZ() - std::sin(rake) * cut;
  return frame;
}

Contact contact_of(const ToolFrame& frame, const Vec3& normal) {
  const double along = std::clamp(normal.dot(frame.rake_normal), -1.0, 1.0);
  // At the point of contact, the direction from the centre of the nose is opposite to the component of the normal in
  // the rake face.
  const double angle = std::atan2(-normal.dot(frame.across), normal.dot(frame.up));
  return {std::asin(along) / kRadPerDeg, angle / kRadPerDeg};
}

Angle clearance_along_cut(Angle clearance, Angle skew) {
  return Angle::from_rad(std::asin(std::sin(clearance.rad()) / std::cos(skew.rad())));
}

std::vector<SlopeSample> slopes_along(const geometry::FreeformSurface& surface, const PathOptions& options) {
  std::vector<SlopeSample> samples;
  const auto add = [&](double x, double y, const geometry::Vec2& outward, const geometry::Vec2& cut) {
    const jets::Gradient z = surface.gradient(x, y);
    samples.push_back({{x, y}, z.x * outward.x() + z.y * outward.y(), z.x * cut.x() + z.y * cut.y()});
  };
  constexpr int kAcross = 200;
  constexpr int kAlong = 720;
  if (options.strategy == Strategy::raster) {
    for (int i = 0; i <= kAcross; ++i)
      for (int k = 0; k <= kAlong; ++k)
        add(options.height_mm * (static_cast<double>(i) / kAcross - 0.5),
            options.width_mm * (static_cast<double>(k) / kAlong - 0.5), geometry::Vec2::UnitX(),
            -geometry::Vec2::UnitY());
    return samples;
  }
  for (int i = 1; i <= kAcross; ++i)
    for (int k = 0; k < kAlong; ++k) {
      const double r = options.radius_mm * i / kAcross;
      const double theta = kTwoPi * k / kAlong;
      const geometry::Vec2 outward(std::cos(theta), std::sin(theta));
      add(r * outward.x(), r * outward.y(), outward, geometry::Vec2(outward.y(), -outward.x()));
    }
  return samples;
}

ClearanceFigures clearance_figures(const TurningTool& tool, const std::vector<SlopeSample>& samples) {
  const ToolFrame frame = tool_frame(tool);
  ClearanceFigures figures;
  for (const SlopeSample& s : samples) {
    const Contact contact = contact_of(frame, normal_of(s));
    if (contact.clearance_needed_deg > figures.clearance_needed_deg) {
      figures.clearance_needed_deg = contact.clearance_needed_deg;
      figures.clearance_at_mm = s.at_mm;
    }
    if (2.0 * std::abs(contact.window_angle_deg) > figures.window_needed_deg) {
      figures.window_needed_deg = 2.0 * std::abs(contact.window_angle_deg);
      figures.window_at_mm = s.at_mm;
    }
  }
  return figures;
}

std::optional<double> min_skew_deg(TurningTool tool, const std::vector<SlopeSample>& samples, double max_deg) {
  constexpr double kCoarse = 0.25;
  const auto clears_at = [&](double skew) {
    tool.skew_deg = skew;
    return clears(tool, samples);
  };
  if (clears_at(0.0)) return 0.0;
  for (int i = 1; kCoarse * i <= max_deg + 1e-9; ++i)
    for (const double sign : {1.0, -1.0}) {
      if (!clears_at(sign * kCoarse * i)) continue;
      double failing = kCoarse * (i - 1);
      double clearing = kCoarse * i;
      while (clearing - failing > 0.005) {
        const double middle = 0.5 * (failing + clearing);
        (clears_at(sign * middle) ? clearing : failing) = middle;
      }
      return sign * std::min(max_deg, std::ceil(clearing * 100.0) / 100.0);
    }
  return std::nullopt;
}

}  // namespace retrace::fabrication::turning
