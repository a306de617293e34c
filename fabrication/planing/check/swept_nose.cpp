#include "fabrication/planing/check/swept_nose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace retrace::fabrication {
namespace {

/// Minimum slope of line segments that are considered walls.
constexpr double kSteep = 2.0;
constexpr double kBeside = 1e-9;

/// Adds positions at the walls that the nose produces. The surface has a jump there, with a fillet below it, which the
/// other positions would not resolve.
std::vector<double> with_fillets(std::vector<double> places, const SectionLine& centres, double nose_mm) {
  constexpr int kFillet = 64;
  const double low = places.front();
  const double high = places.back();
  for (std::size_t i = 1; i < centres.size(); ++i) {
    const double dx = centres[i].x_mm - centres[i - 1].x_mm;
    const double dz = centres[i].z_mm - centres[i - 1].z_mm;
    if (!(std::abs(dz) > kSteep * dx)) continue;
    const double middle = dz > 0.0 ? centres[i - 1].x_mm : centres[i].x_mm;
    const double side = dz > 0.0 ? nose_mm : -nose_mm;
    for (int k = 1; k < kFillet; ++k) places.push_back(middle + side * std::sin(0.5 * std::numbers::pi * k / kFillet));
    // The nose is a disc. While its centre moves along the segment, it produces a line that is tangent to the discs at
    // both end points of the segment. Add positions at the two ends of this line, and at one side of each disc.
    const double from = centres[i - 1].x_mm + nose_mm * dz / std::hypot(dx, dz);
    for (const double end : {from, from + dx, centres[i - 1].x_mm + side, centres[i].x_mm + side}) {
      places.push_back(end - kBeside);
      places.push_back(end + kBeside);
    }
  }
  std::erase_if(places, [&](double x) { return x < low || x > high; });
  std::sort(places.begin(), places.end());
  return places;
}

SectionLine negated(SectionLine section) {
  for (SectionPoint& p : section) p.z_mm = -p.z_mm;
  return section;
}

double squared_distance(const SectionPoint& p, const SectionPoint& a, const SectionPoint& b) {
  const double dx = b.x_mm - a.x_mm;
  const double dz = b.z_mm - a.z_mm;
  const double length2 = dx * dx + dz * dz;
  const double along = length2 > 0.0 ? ((p.x_mm - a.x_mm) * dx + (p.z_mm - a.z_mm) * dz) / length2 : 0.0;
  const double t = std::clamp(along, 0.0, 1.0);
  const double aside = p.x_mm - a.x_mm - t * dx;
  const double above = p.z_mm - a.z_mm - t * dz;
  return aside * aside + above * above;
}

}  // namespace

SectionLine nose_envelope(const SectionLine& centres, double nose_mm, const std::vector<double>& positions_mm) {
  SectionLine left;
  for (const double x : with_fillets(positions_mm, centres, nose_mm))
    left.push_back({x, std::numeric_limits<double>::infinity()});
  const auto lower = [&](double from, double to, const auto& height) {
    auto at =
        std::lower_bound(left.begin(), left.end(), from, [](const SectionPoint& p, double x) { return p.x_mm < x; });
    for (; at != left.end() && at->x_mm <= to; ++at) at->z_mm = std::min(at->z_mm, height(at->x_mm));
  };
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const SectionPoint& c = centres[i];
    lower(c.x_mm - nose_mm, c.x_mm + nose_mm,
          [&](double x) { return c.z_mm - std::sqrt(std::max(0.0, nose_mm * nose_mm - (x - c.x_mm) * (x - c.x_mm))); });
    if (i == 0 || !(c.x_mm > centres[i - 1].x_mm)) continue;
    // Between the discs at its ends, a segment produces the line that touches both discs from below.
    const SectionPoint& before = centres[i - 1];
    const double dx = c.x_mm - before.x_mm;
    const double dz = c.z_mm - before.z_mm;
    const double length = std::hypot(dx, dz);
    const double from = before.x_mm + nose_mm * dz / length;
    const double z = before.z_mm - nose_mm * dx / length;
    lower(from, from + dx, [&](double x) { return z + (x - from) * dz / dx; });
  }
  return left;
}

SectionLine lowest_centres(const SectionLine& section, double nose_mm, const std::vector<double>& positions_mm) {
  // If the centre of the nose is above the upper envelope of circles about the points of the section, the nose does not
  // cut into the section. This upper envelope is the negative of the lower envelope of circles about the negated
  // section.
  return negated(nose_envelope(negated(section), nose_mm, positions_mm));
}

double largest_distance(const SectionLine& points, const SectionLine& line, double reach_mm) {
  double largest = 0.0;
  for (const SectionPoint& p : points) {
    double best = std::numeric_limits<double>::max();
    const auto first = std::lower_bound(line.begin(), line.end(), p.x_mm - reach_mm,
                                        [](const SectionPoint& q, double x) { return q.x_mm < x; });
    for (auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, first - line.begin()));
         i < line.size() && line[i - 1].x_mm <= p.x_mm + reach_mm; ++i)
      best = std::min(best, squared_distance(p, line[i - 1], line[i]));
    largest = std::max(largest, best);
  }
  return largest < std::numeric_limits<double>::max() ? std::sqrt(largest) : largest;
}

}  // namespace retrace::fabrication
