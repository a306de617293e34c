// Validation rows for balls with mirrors on their backs.

#include <cmath>
#include <numbers>
#include <utility>

#include "raytrace/balls/ball_forms.h"
#include "raytrace/balls/ball_tracer.h"
#include "studies/validation/rows.h"

namespace retrace::studies {
namespace {

using raytrace::BallLayer, raytrace::return_error_rad;

constexpr const char* kBeads = "docs/theory/beads.md";

/// Returns the result for ideal balls and light along the axis. The balls have mirrors on their backs, and their
/// entrance faces have no Fresnel losses.
raytrace::ConeResult traced(const BallLayer& layer, double index, const Cancellation* cancel) {
  raytrace::Optics optics;
  optics.index = index;
  optics.mirror_facets = optics.lossless_entrance = true;
  raytrace::Sampling sampling;
  sampling.rays = 1U << 17;
  return raytrace::BallTracer(layer).trace(optics, {}, {0.5}, sampling, {}, cancel).cones[0];
}

/// Returns the zero of a function that changes its sign one time between two positions.
template <class Function>
double root_of(double low, double high, const Function& f) {
  const bool is_positive = f(low) > 0.0;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    ((f(middle) > 0.0) == is_positive ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::vector<ValidationRow> ball_validation() {
  std::vector<ValidationRow> rows;
  const auto add = appender(rows, "Balls with mirrors", kBeads);
  const BallLayer one{1.0, 0.0, 90.0, std::nullopt};
  add({.quantity = "n = 1.5: ratio of the radius of a bowl in the paraxial focus to that of the ball, n / (2 (n - 1))",
       .expected = 1.5 / (2.0 * 0.5),
       .allowed = 1e-6,
       .why = "found with a ray at 1e-4 of the radius",
       .compute = [](auto) {
         return root_of(1.1, 2.0, [](double bowl) { return return_error_rad(1e-4, 1.5, 1.0, bowl); });
       }});
  add({.quantity = "n = 1.93: ratio of height to radius without return error, n sqrt(1 - n^2 / 4)",
       .expected = 1.93 * std::sqrt(1.0 - 1.93 * 1.93 / 4.0),
       .allowed = 1e-9,
       .why = "rounding",
       .compute = [](auto) {
         return root_of(0.2, 0.9, [](double height) { return return_error_rad(height, 1.93, 1.0, 1.0); });
       }});
  add({.quantity = "n = 2: return error at 0.01 of the radius, h^3 / 4",
       .unit = "urad",
       .expected = 0.25,
       .allowed = 1e-4,
       .why = "terms of fifth order in h",
       .compute = [](auto) { return 1e6 * return_error_rad(0.01, 2.0, 1.0, 1.0); }});
  // Height h of the incident ray, in ball radii, at which the return error 2 asin h - 4 asin(h / 2) is 0.5 degrees.
  const double edge = root_of(0.0, 0.9, [](double h) {
    return 2.0 * std::asin(h) - 4.0 * std::asin(0.5 * h) - 0.5 * std::numbers::pi / 180.0;
  });
  add({.quantity = "n = 2: fraction of the aperture with a return error within 0.5 deg",
       .expected = edge * edge,
       .allowed = 2.5e-4,
       .why = "one ray of a replicate",
       .compute = [one](auto cancel) { return traced(one, 2.0, cancel).rre; }});
  add({.quantity = "fraction of the plan area that packed balls cover, pi / (2 sqrt 3)",
       .expected = 0.5 * std::numbers::pi / std::numbers::sqrt3,
       .allowed = 1e-3,
       .why = "131,072 rays",
       .compute = [](auto cancel) {
         const BallLayer packed{1.0, 0.0, 90.0, 1.0};
         return 1.0 - traced(packed, 2.0, cancel).ledger[raytrace::Account::transmitted];
       }});
  return rows;
}

}  // namespace retrace::studies
