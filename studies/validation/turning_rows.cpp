// Validation rows for turned surfaces and for planed flat lenses.

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "fabrication/planing/plan/chords.h"
#include "fabrication/planing/plan/zone_profile.h"
#include "fabrication/turning/finish.h"
#include "fabrication/turning/tool.h"
#include "studies/validation/rows.h"

namespace retrace::studies {
namespace {

using namespace fabrication::turning;

/// Returns the finish of a plane surface that is cut with a nose radius of 0.25 mm at a feed of 1 um. The finish is
/// computed from the cusps of the exact circle by numerical integration.
FinishFigures measured_finish() {
  return exact_finish({.nose_radius_mm = 0.25}, 1e-3);
}

/// Returns slopes of a convex circular cylinder along y at the rim of a round part.
/// \param edge_rad maximum slope angle at the rim
std::vector<SlopeSample> cylinder_slopes(double edge_rad) {
  std::vector<SlopeSample> samples;
  for (int turn = 0; turn < 3600; ++turn) {
    const double theta = turn * 0.1 * std::numbers::pi / 180.0;
    const double r = std::sin(edge_rad);
    const double x = r * std::cos(theta);
    const double slope = -x / std::sqrt(1.0 - x * x);
    samples.push_back({{x, r * std::sin(theta)}, slope * std::cos(theta), -slope * std::sin(theta)});
  }
  return samples;
}

void add_finish(std::vector<ValidationRow>& rows) {
  const auto add = [&](ValidationRow row) {
    row.topic = "Turning";
    row.unit = "nm";
    rows.push_back(std::move(row));
  };
  struct Figure {
    const char* name;
    double expected_nm;
    double FinishFigures::*figure;
  };
  for (const Figure& f : {Figure{"peak to valley, f^2 / (8 r)", 0.5, &FinishFigures::peak_to_valley_nm},
                          Figure{"Ra, f^2 / (18 sqrt 3 r)", 4.0 / (18.0 * std::numbers::sqrt3), &FinishFigures::ra_nm},
                          Figure{"Rq, f^2 / (12 sqrt 5 r)", 4.0 / (12.0 * std::sqrt(5.0)), &FinishFigures::rq_nm}})
    add({.quantity = fmt::format("feed 1 um, nose radius 0.25 mm, integrated over the circle of the nose: {}", f.name),
         .expected = f.expected_nm,
         .source = "docs/theory/turning.md",
         .allowed = 1e-4,
         .why = "the formulas replace the circle by a parabola",
         .compute = [figure = f.figure](auto) { return measured_finish().*figure; }});
  add({.quantity = "feed 1 um, nose radius 0.25 mm: Rq as printed, which is the mean height, f^2 / (24 r)",
       .reference = Reference::published,
       .expected = 4.0 / 24.0,
       .source = "Sohn and Naples, eq. 4",
       .allowed = 1e-9,
       .why = "rounding",
       .compute = [](auto) { return finish_figures(0.25, 1e-3).rq_of_paper_nm; }});
}

void add_clearance(std::vector<ValidationRow>& rows) {
  const auto add = [&](ValidationRow row) {
    row.topic = "Turning";
    row.unit = "deg";
    rows.push_back(std::move(row));
  };
  constexpr double kDegree = std::numbers::pi / 180.0;
  for (const double skew_deg : {30.0, 45.0, 60.0})
    add({.quantity = fmt::format(
             "maximum downward slope along the cut, clearance 12 deg, skew {} deg, by the vector test", skew_deg),
         .reference = Reference::published,
         .expected = std::asin(std::sin(12.0 * kDegree) / std::cos(skew_deg * kDegree)) / kDegree,
         .source = "Sohn and Naples, eq. 1",
         .allowed = 1e-6,
         .why = "found by bisection",
         .compute = [skew_deg](auto) {
           const ToolFrame frame = tool_frame({.skew_deg = skew_deg});
           double low = 0.0;
           double high = 80.0;
           for (int step = 0; step < 50; ++step) {
             const double middle = 0.5 * (low + high);
             const geometry::Vec3 normal(0.0, std::sin(middle * kDegree), std::cos(middle * kDegree));
             (contact_of(frame, normal).clearance_needed_deg > 12.0 ? high : low) = middle;
           }
           return low;
         }});
  for (const double skew_deg : {-30.0, 0.0, 30.0})
    add({.quantity = fmt::format("convex cylinder with a slope of 50 deg at the rim, skew {} deg: required clearance",
                                 skew_deg),
         .expected = std::asin(0.5 * std::sin(50.0 * kDegree) * (1.0 + std::sin(skew_deg * kDegree))) / kDegree,
         .source = "docs/theory/turning.md",
         .allowed = 1e-4,
         .why = "points along the rim are 0.1 deg apart",
         .compute = [skew_deg](auto) {
           const TurningTool tool = {.window_deg = 179.0, .skew_deg = skew_deg};
           return clearance_figures(tool, cylinder_slopes(50.0 * kDegree)).clearance_needed_deg;
         }});
}

void add_planing(std::vector<ValidationRow>& rows) {
  const auto add = appender(rows, "Flat zone lenses", "docs/theory/planing.md");
  add({.quantity = "chord of a circle of radius 10 mm within 0.01 mm, 2 sqrt(2 R t - t^2)",
       .unit = "mm",
       .expected = 2.0 * std::sqrt(2.0 * 10.0 * 0.01 - 0.01 * 0.01),
       .allowed = 1e-3,
       .why = "points of the circle are 1 um apart",
       .compute = [](auto) {
         std::vector<fabrication::ProfilePoint> points;
         for (int k = 0; k <= 1500; ++k)
           points.push_back({10.0 * std::sin(1e-4 * k), 10.0 * (std::cos(1e-4 * k) - 1.0)});
         const fabrication::ProfilePoint& end = points[fabrication::longest_chords(points, 0.01).at(1)];
         return std::hypot(end.x_mm, end.z_mm);
       }});
  // For a zone lens of focal length F with steps of at most w / (n - 1), the path difference r - F - n d is a whole
  // number of wavelengths w. Here, d is the depth of the profile, and r the distance from the profile to the focus.
  for (const auto& [x_mm, zone] : {std::pair{100.0, 1.0}, {150.0, 4.0}, {200.0, 7.0}})
    add({.quantity = fmt::format(
             "F 500 mm, wavelength 5 mm, n 1.52, {} mm from the axis: path difference to the axis, in wavelengths",
             x_mm),
         .expected = zone,
         .allowed = 1e-9,
         .why = "rounding",
         .compute = [x_mm = x_mm](auto) {
           const fabrication::ZoneLens lens = {500.0, 5.0, 1.52, 250.0};
           const double depth_mm = fabrication::ZoneProfile(lens).depth_mm(x_mm);
           return (std::hypot(x_mm, 500.0 + depth_mm) - 500.0 - 1.52 * depth_mm) / 5.0;
         }});
}

}  // namespace

std::vector<ValidationRow> turning_validation() {
  std::vector<ValidationRow> rows;
  add_finish(rows);
  add_clearance(rows);
  add_planing(rows);
  return rows;
}

}  // namespace retrace::studies
