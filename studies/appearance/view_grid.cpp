#include "studies/appearance/view_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/random.h"
#include "geometry/direction.h"
#include "raytrace/light/aperture_kernel.h"
#include "studies/appearance/table_errors.h"

namespace retrace::studies {
namespace {

using geometry::Vec2, geometry::Vec3;

// Initial resolution of a grid of view directions: number of grid steps across the radius of the aperture kernel. The
// kernel averages R_A over the discs of source and receiver. Its radius is measured in the plane of incidence at the
// maximum entrance angle, where the kernel is narrowest. The error of cubic interpolation grows with the fourth power
// of the grid step (docs/theory/appearance.md).
constexpr double kStepsPerReach = 4.0;
// Maximum initial number of grid points along a side.
constexpr std::size_t kMaxColumns = 161;
// Maximum interpolation error of a grid of view directions, as a fraction of the requested error.
constexpr double kGridErrorFraction = 0.5;
// Factor by which the number of grid points along each side grows if the interpolation error is too large.
constexpr double kFinerGrid = 1.5;
// Number of grid points along a side above which a grid is not refined further.
constexpr std::size_t kMaxColumnsToRefine = 121;
constexpr RandomKey kGridKey{.seed = kAppearanceSeed, .stream = 3};

/// Deviations of random views, and R_A of these views for the eye's response.
struct TestViews {
  std::vector<Vec2> deviations;
  std::vector<double> r_a;
};

TestViews random_views(const ReflectionTable& table, const Vec3& to_source, const ColourFields& fields,
                       const raytrace::ApertureKernel& kernel) {
  TestViews views;
  for (std::uint32_t k = 0; k < kProbes; ++k) {
    const auto random = philox(kGridKey, k, 0);
    const Vec2 deviation = random_deviation(table, random[0], random[1]);
    const auto view = view_at(table, to_source, deviation);
    if (!view) continue;
    views.deviations.push_back(deviation);
    Rgb sum{};
    for (const raytrace::BandedField& one : fields.weighted) {
      const double per_sr = one.field->intensity(view->to_observer, kernel).per_sr;
      for (std::size_t band = 0; band < sum.size(); ++band) sum[band] += one.weights[band] * per_sr;
    }
    views.r_a.push_back(luminous(sum));
  }
  return views;
}

/// Returns the error of values that are interpolated between the points of a grid.
double interpolation_error(const ReflectionTable& table, const std::vector<Rgb>& grid, const TestViews& views) {
  double most = 0.0;
  for (const Rgb& value : grid) most = std::max(most, luminous(value));
  std::vector<double> errors;
  for (std::size_t k = 0; k < views.r_a.size(); ++k)
    errors.push_back(error_of(luminous(table.between(grid, views.deviations[k])), views.r_a[k], most));
  return percentile_95_of(errors);
}

}  // namespace

std::size_t first_columns(const MaterialRequest& request, const ReflectionTable& table) {
  const double narrowest =
      raytrace::ApertureKernel(apertures_of(request)).reach_rad() * std::cos(table.max_entrance.rad());
  const double steps = 2.0 * table.half_width * kStepsPerReach / narrowest;
  return std::clamp(static_cast<std::size_t>(std::ceil(steps)) + 1, kDirectionsPerSide, kMaxColumns);
}

std::vector<Rgb> grid_of(const ReflectionTable& table, const Vec3& to_source, const ColourFields& fields,
                         const raytrace::ApertureKernel& kernel, const Cancellation* cancel) {
  return raytrace::disc_means(fields.weighted, {table.central_direction(to_source), table.half_width, table.columns},
                              kernel, cancel);
}

bool refine_grid(const ColourPhotometer& photometer, double error, ReflectionTable& table, const Cancellation* cancel) {
  const std::array<Angle, 2> range = table.azimuths();
  const Vec3 to_source = geometry::direction_at(Angle::from_rad(0.5 * table.max_entrance.rad()),
                                                Angle::from_rad(0.5 * (range[0].rad() + range[1].rad())));
  const std::optional<ColourFields> fields = photometer.fields(to_source, cancel);
  if (!fields) return false;
  const raytrace::ApertureKernel& kernel = photometer.eye().kernel();
  const TestViews views = random_views(table, to_source, *fields, kernel);
  for (;;) {
    const std::vector<Rgb> grid = grid_of(table, to_source, *fields, kernel, cancel);
    if (is_cancelled(cancel)) return false;
    const auto finer = static_cast<std::size_t>(std::ceil(kFinerGrid * static_cast<double>(table.columns)));
    if (interpolation_error(table, grid, views) <= kGridErrorFraction * error || finer > kMaxColumnsToRefine)
      return true;
    table.columns = finer;
  }
}

}  // namespace retrace::studies
